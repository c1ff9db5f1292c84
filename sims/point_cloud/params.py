"""Parameters of the sim."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import model_validator

from sims.kit.fields import Choice, Letters, NumberBox, Slider, Switch, Text, Vector
from sims.kit.params import Params, with_entries
from sims.kit.spelling import spell
from sims.kit.view import View
from sims.point_cloud.files.meaning import ROLES, letters_of
from sims.point_cloud.processes import LAST
from sims.point_cloud.registration import MOST_STEPS

MOST_POINTS = 10_000_000
VIEWS = {
    "room": View((4.6, -5.8, 4.4), (0.0, 0.0, 1.15), 3.65),
    "street": View((26.0, -44.0, 34.0), (4.0, 0.0, 0.0), 33.0),
    "statue": View((2.6, -3.6, 2.2), (0.05, 0.0, 1.15), 1.85),
    "two-scans": View((3.4, -5.6, 3.4), (-0.1, -0.1, 0.95), 3.3),
}
OWN = "Your own data"
UPLOAD = "upload-"
"""What the name of a learner's file begins with."""
NAME = r'^[^/\\\x00-\x1f"<>|:*?]{1,120}$'
"""A file's name, without a path."""
Chosen = tuple[str, str]
"""What columns and units are taken for: a letter for each of the first columns (`files.meaning.LETTERS`), a unit."""
MOST_COLUMNS = 12
"""That can be chosen; those behind are as they are guessed."""
REACH = {"voxel_size": 1.0, "distance": 2.0}
"""Greatest lengths of the built-in clouds, in metres; those of a file follow from its size."""
LONGEST = 100_000.0
KEEPS_POINTS = {
    "color", "point_size", "show_normals", "show_box", "show_original", "shading", "selected", "measure", "other",
    "shift", "turn",
}  # fmt: skip
"""Parameters that leave every shown point its index."""
WHAT_DISTANCE_IS = {
    "none": "Distance of the process",
    "ground": "Half thickness of the ground",
    "clusters": "Widest gap in a cluster",
    "outliers": "Distance of the process",
    "register": "Reach of the pairs",
    "surface": "Radius of the ball",
}


STARTS = {"shift", "turn"}
"""Parameters of where a registration begins."""


def first_color(dataset: Any) -> str:
    """What a cloud is coloured by when nobody says what: the street has no measured colours."""
    return "height" if dataset == "street" else "rgb"


def first_step(process: Any) -> int:
    """Where a process is when nobody says where."""
    return 0 if process == "register" else LAST


LOOK, CHOSEN = "Show", "The selected point"
"""Titles of folds."""


class CloudParams(Params):
    dataset: Annotated[
        Literal["room", "street", "statue", "two-scans", "file"],
        Choice(
            title="Dataset",
            labels={
                "room": "Room, colour scanner",
                "street": "Street, rotating lidar",
                "statue": "Statue, noise and outliers",
                "two-scans": "Two scans of a court",
                "file": "From a file",
            },
        ),
    ] = "room"
    """Which cloud. The first four were simulated: rays cast at simple bodies"""
    color: Annotated[
        Literal["height", "intensity", "rgb", "normals", "variation"],
        Choice(
            title="Colour by",
            labels={
                "height": "Height",
                "intensity": "Intensity",
                "rgb": "Measured colour",
                "normals": "Normals",
                "variation": "Surface variation",
            },
        ),
    ] = "rgb"
    """What the colour of each point says. At first the measured colour; the street has none, and is shown by height"""
    point_size: Annotated[float, Slider(0.5, 10.0, step=0.5, title="Point size", group=LOOK)] = 2.0
    """About in pixels, as the sim opens"""
    voxel_size: Annotated[float, Slider(0.0, LONGEST, step=0.005, unit="m", title="Voxel size")] = 0.0
    """Edge of the cells; the points in each become their mean. At 0 all are shown. At most 1 m, but for a file"""
    show_normals: Annotated[bool, Switch(title="Normals", group=LOOK)] = False
    """Short arrows along some normals"""
    neighbors: Annotated[int, Slider(5, 50, step=1, title="Neighbours k", group=LOOK)] = 16
    """How many nearest points, itself included, a normal and an outlier are judged by"""
    show_box: Annotated[bool, Switch(title="Bounding box", group=LOOK)] = True
    """The box along the axes that all points are in"""
    show_original: Annotated[bool, Switch(title="Original behind voxels", group=LOOK)] = True
    """Some of the points as they were measured, small and grey, behind what they were thinned to"""
    shading: Annotated[bool, Switch(title="Shading", group=LOOK)] = True
    """Surfaces that face away from a light above are darker, where points are coloured by height or as measured"""
    selected: Annotated[int | None, NumberBox(0, MOST_POINTS - 1, step=1, title="Selected point", group=CHOSEN)] = None
    """Click a point, or type its number; empty for none"""
    measure: Annotated[bool, Switch(title="Measure from it", group=CHOSEN)] = False
    """While it is on, a click says how far another point is from the selected one"""
    other: Annotated[int | None, NumberBox(0, MOST_POINTS - 1, step=1, title="Measure to point", group=CHOSEN)] = None
    """Click a point, or type its number"""
    process: Annotated[
        Literal["none", "ground", "clusters", "outliers", "register", "surface"],
        Choice(
            title="Process",
            labels={
                "none": "None",
                "ground": "Ground plane (RANSAC)",
                "clusters": "Euclidean clusters",
                "outliers": "Remove outliers",
                "register": "Register two scans (ICP)",
                "surface": "Surface (alpha shape)",
            },
        ),
    ] = "none"
    """What to do with the points that are left after downsampling"""
    step: Annotated[int, Slider(0, MOST_STEPS, step=1, title="Step")] = 2
    """How far the process has come: 0 before, 1 found, 2 done, as at first; of a registration, steps of ICP, first 0"""
    method: Annotated[
        Literal["plane", "point"],
        Choice(
            title="ICP pairs",
            labels={"plane": "Point to plane", "point": "Point to point"},
            group="Settings of the process",
        ),
    ] = "plane"
    """What each point of the second scan is drawn to"""
    distance: Annotated[
        float,
        Slider(0.0, LONGEST, step=0.01, unit="m", title="Distance of the process", group="Settings of the process"),
    ] = 0.0
    """At 0 it follows from how dense the cloud is. At most 2 m, but for a file"""
    deviations: Annotated[
        float, Slider(0.5, 4.0, step=0.1, title="Deviations of an outlier", group="Settings of the process")
    ] = 2.0
    """Outliers are this many standard deviations farther from their neighbours than is usual"""
    shift: Annotated[
        tuple[float, float, float],
        Vector(-1000.0, 1000.0, step=0.05, unit="m", title="Second scan begins at", group="Settings of the process"),
    ] = (0.0, 0.0, 0.0)
    """How far the second scan is moved before ICP: drag it in the scene. From too far away ICP fails"""
    turn: Annotated[
        float, Slider(-180.0, 180.0, step=1, unit="°", title="And is turned by", group="Settings of the process")
    ] = 0.0
    """About the upright through its middle, before ICP"""

    file: Annotated[
        str | None, Text(title="File", pattern=NAME, format="the name of a file, without a path", group=OWN)
    ] = None
    """A cloud of your own, or one of this server's folder"""
    units: Annotated[
        Literal["auto", "metres", "millimetres", "feet", "us-feet", "degrees"],
        Choice(
            title="Unit of the file",
            labels={
                "auto": "As guessed",
                "metres": "Metres",
                "millimetres": "Millimetres",
                "feet": "Feet",
                "us-feet": "US survey feet",
                "degrees": "Degrees (longitude, latitude)",
            },
            group=OWN,
        ),
    ] = "auto"
    """What the file's coordinates are in. Guessed from its coordinate system, names and size"""
    columns: Annotated[
        str,
        Letters(
            title="Columns",
            labels={letters_of([role]): words for role, words in ROLES.items()},
            entry="Column {}",
            most=MOST_COLUMNS,
            fewest=0,
            group=OWN,
        ),
    ] = ""
    """What each column of the file is taken for; of one for which nothing is chosen, it is guessed"""
    second: Annotated[
        str | None, Text(title="Second scan", pattern=NAME, format="the name of a file, without a path", group=OWN)
    ] = None
    """A file to register to the first. While you register, a file that you bring becomes the second scan"""

    @model_validator(mode="before")
    @classmethod
    def _begun(cls, values: Any) -> Any:
        """Without a step, a registration is at its start, every other process at its result; so with colours."""
        if not isinstance(values, Mapping):
            return values
        return {"step": first_step(values.get("process")), "color": first_color(values.get("dataset")), **values}

    def query_items(self) -> dict[str, str]:
        items = super().query_items()
        for name, first in (("step", first_step(self.process)), ("color", first_color(self.dataset))):
            items.pop(name, None)
            if (value := getattr(self, name)) != first:
                items[name] = spell(value)
        return items

    @property
    def choice(self) -> Chosen:
        """In which way the file is read."""
        return self.columns, self.units

    @property
    def facing(self) -> int:
        """Neighbours that a registration's normals follow from: to points it needs none, and they change nothing."""
        return self.neighbors if self.method == "plane" else 16

    def bounds(self, name: str) -> tuple[float, float]:
        if name == "step":
            last = MOST_STEPS if self.process == "register" else LAST
            return 0, max(last, self.step)  # a link may name any step: beyond the last one is the last
        if name in REACH and self.dataset != "file":
            return 0.0, REACH[name]
        return super().bounds(name)

    def label(self, name: str) -> str:
        return WHAT_DISTANCE_IS[self.process] if name == "distance" else super().label(name)

    def moved(self, changes: Mapping[str, Any]) -> Self:
        """What `changed` does; no step is beyond the last, and a point that may be another is let go."""
        now = self._begun_anew(self._of_files(with_entries(changes, self.__dict__.__getitem__)))
        turned = {name for name, value in now.items() if value != getattr(self, name)}
        if turned & STARTS and self.process == "register":
            now.setdefault("step", 0)
        if "step" in now and now.get("process", self.process) != "register":
            now["step"] = min(now["step"], LAST)
        if (self.selected, self.other) != (None, None) and self._renumbers(turned):
            now = {"selected": None, "other": None, **now}
        return super().moved(now)

    def changed(self, changes: Mapping[str, Any]) -> Self:
        """A process begins at its result, a registration at its start; a cloud in the colours that it has."""
        return super().changed(self._begun_anew(changes))

    def _begun_anew(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        now = dict(changes)
        process, dataset = now.get("process", self.process), now.get("dataset", self.dataset)
        if process != self.process:
            now.setdefault("step", first_step(process))
        if dataset != self.dataset and self.color == first_color(self.dataset):
            now.setdefault("color", first_color(dataset))
        return now

    def _of_files(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """Whoever chooses a file sees it; one that is brought while another is registered is its second scan."""
        now = dict(changes)
        file = now.get("file", self.file)
        if file == self.file:
            return {"process": "register", **now} if now.get("second", self.second) not in (None, self.second) else now
        registers = self.process == "register" and self.dataset == "file" and self.file is not None
        if registers and file is not None and file.startswith(UPLOAD):
            return {"second": file}
        return {"columns": "", "units": "auto", **({"dataset": "file"} if file else {}), "second": None, **now}

    def _renumbers(self, turned: set[str]) -> bool:
        others = turned - KEEPS_POINTS
        if self.process != "outliers":
            others -= {"neighbors", "deviations"}
        return bool(others - {"step", "method", "distance"} if self.process == "register" else others)


def view_of(p: CloudParams) -> View:
    """A view that fits the cloud: they are of very different sizes."""
    return VIEWS.get(p.dataset, VIEWS["room"])
