"""Parameters of the sim."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import model_validator

from sims.kit.fields import Choice, Letters, NumberBox, Slider, Switch, Text
from sims.kit.params import Params
from sims.kit.sim import View
from sims.kit.spelling import spell
from sims.point_cloud import library, processes
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files.meaning import ROLES, letters_of
from sims.point_cloud.layers import whole
from sims.point_cloud.processes import MOST_STEPS

MOST_POINTS = 10_000_000
VIEWS = {
    "room": View((4.6, -5.8, 4.4), (0.0, 0.0, 1.15), 3.65),
    "street": View((26.0, -44.0, 34.0), (4.0, 0.0, 0.0), 33.0),
    "statue": View((2.6, -3.6, 2.2), (0.05, 0.0, 1.15), 1.85),
    "two-scans": View((3.4, -5.6, 3.4), (-0.1, -0.1, 0.95), 3.3),
}
OWN = "Your own data"
MOST_COLUMNS = 12
"""That can be chosen; those behind are as they are guessed."""
REACH = {"voxel_size": 1.0, "distance": 2.0}
"""Greatest lengths of the built-in clouds, in metres; those of a file follow from its size."""
LONGEST = 100_000.0
KEEPS_POINTS = {"color", "point_size", "show_normals", "show_box", "selected"}
"""Parameters that leave every shown point its index."""
WHAT_DISTANCE_IS = {
    "none": "Distance of the process",
    "ground": "Half thickness of the ground",
    "clusters": "Widest gap in a cluster",
    "outliers": "Distance of the process",
    "register": "Reach of the pairs",
    "surface": "Radius of the ball",
}


def first_step(process: Any) -> int:
    """Where a process is when nobody says where."""
    return 0 if process == "register" else 2


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
    """What the colour of each point says"""
    point_size: Annotated[float, Slider(0.5, 10.0, step=0.5, title="Point size")] = 2.0
    """About in pixels, as the sim opens"""
    voxel_size: Annotated[float, Slider(0.0, LONGEST, step=0.005, unit="m", title="Voxel size")] = 0.0
    """Edge of the cells; the points in each become their mean. At 0 all are shown. At most 1 m, but for a file"""
    show_normals: Annotated[bool, Switch(title="Normals")] = False
    """Short arrows along some normals"""
    neighbors: Annotated[int, Slider(5, 50, step=1, title="Neighbours k")] = 16
    """How many nearest points, itself included, a normal and an outlier are judged by"""
    show_box: Annotated[bool, Switch(title="Bounding box")] = True
    """The box along the axes that all points are in"""
    selected: Annotated[int | None, NumberBox(0, MOST_POINTS - 1, step=1, title="Selected point")] = None
    """Click a point, or type its number; −1 for none"""
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

    file: Annotated[
        str | None, Text(title="File", pattern=library.NAME, format="the name of a file, without a path", group=OWN)
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

    def options(self, name: str) -> Mapping[Any, str]:
        return library.offered(self.file) if name == "file" else super().options(name)

    @model_validator(mode="before")
    @classmethod
    def _begun(cls, values: Any) -> Any:
        """Without a step, a registration is at its start; every other process is at its result."""
        if isinstance(values, Mapping) and "step" not in values:
            return {**values, "step": first_step(values.get("process"))}
        return values

    def query_items(self) -> dict[str, str]:
        items = {name: text for name, text in super().query_items().items() if name != "step"}
        return items if self.step == first_step(self.process) else {**items, "step": spell(self.step)}

    @property
    def choice(self) -> library.Choice:
        """In which way the file is read."""
        return self.columns, self.units

    def _known(self) -> Cloud:
        """The file's cloud, as far as it has been read."""
        return library.known(self.file, self.choice) if self.dataset == "file" else library.NOTHING

    def guess(self) -> Cloud:
        """The file's cloud with columns and units as guessed, as far as it has been read."""
        return library.known(self.file) if self.dataset == "file" else library.NOTHING

    def entries(self, name: str) -> Any:
        """The columns' dropdowns say what is guessed where nothing is chosen."""
        if name != "columns":
            return super().entries(name)
        guessed = letters_of(self.guess().roles[:MOST_COLUMNS])
        return self.columns + guessed[len(self.columns) :]

    def entry_label(self, name: str, k: int) -> str:
        names = self.guess().columns if name == "columns" else ()
        label = super().entry_label(name, k)
        return f"{label}: {names[k][:24]}" if k < len(names) and names[k] else label

    @property
    def facing(self) -> int:
        """Neighbours that a registration's normals follow from: to points it needs none, and they change nothing."""
        return self.neighbors if self.method == "plane" else 16

    @property
    def course(self) -> tuple[Any, ...]:
        """All that a registration follows from."""
        return self.dataset, self.file, self.choice, self.voxel_size, self.facing, self.method, self.distance

    @property
    def last_step(self) -> int:
        """The process's last step, as far as that is known: a registration must have been worked out once."""
        return processes.LENGTHS.get(self.course, MOST_STEPS) if self.process == "register" else 2

    def bounds(self, name: str) -> tuple[float, float]:
        if name == "step":
            return 0, max(self.last_step, self.step, 1)  # a link may name any step: beyond the last one is the last
        if name in REACH:
            return 0.0, REACH[name] if self.dataset != "file" else max(self._reach(name), getattr(self, name))
        return super().bounds(name)

    def _reach(self, name: str) -> float:
        """The greatest length that a slider offers: a round one, about a tenth of the cloud's size."""
        cloud = self._known()
        if not len(cloud):
            return REACH[name]
        wanted = 0.2 * whole(cloud).radius * REACH[name]
        power = 10.0 ** math.floor(math.log10(wanted))
        return min(next(k * power for k in (1.0, 2.0, 5.0, 10.0) if k * power >= wanted * 0.999), LONGEST)

    def increment(self, name: str) -> float:
        """As many steps for a file of any size."""
        return self._reach(name) / 200.0 if name in REACH and self.dataset == "file" else super().increment(name)

    def form(self) -> tuple[Any, ...]:
        return *super().form(), self.last_step, self._known(), self.guess()

    def label(self, name: str) -> str:
        return WHAT_DISTANCE_IS[self.process] if name == "distance" else super().label(name)

    def moved(self, changes: Mapping[str, Any]) -> Self:
        """What `changed` does; no step is beyond the last, and a point that may be another is let go."""
        now = self._with_step(self._exchanged(changes))
        turned = {name for name, value in now.items() if value != getattr(self, name)}
        if "file" in turned and now["file"]:
            now.setdefault("dataset", "file")
        if "file" in turned:
            now = {"columns": "", "units": "auto", **now}
        if "step" in now:
            now["step"] = min(now["step"], self.model_copy(update=now).last_step)
        if self.selected is not None and self._renumbers(turned):
            now.setdefault("selected", None)
        return super().moved(now)

    def _exchanged(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """A column that becomes what another one was gives that one its own role, so that no two are the same."""
        before, now = self.entries("columns"), self._whole(changes)
        columns = now.get("columns")
        if columns is None or "columns" in changes:
            return now
        for old, new in zip(before, columns, strict=True):
            if old != new and new != "-":
                at = before.index(new) if new in before else -1
                columns = "".join(old if k == at else letter for k, letter in enumerate(columns))
        guessed = letters_of(self.guess().roles[:MOST_COLUMNS])
        return {**now, "columns": "" if columns == guessed else columns}

    def changed(self, changes: Mapping[str, Any]) -> Self:
        """A process begins at its result, a registration at its start."""
        return super().changed(self._with_step(changes))

    def _with_step(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        turned = changes.get("process", self.process) != self.process
        return {**({"step": first_step(changes["process"])} if turned else {}), **changes}

    def _renumbers(self, turned: set[str]) -> bool:
        others = turned - KEEPS_POINTS
        if self.process != "outliers":
            others -= {"neighbors", "deviations"}
        return bool(others - {"step", "method", "distance"} if self.process == "register" else others)


def view_of(p: CloudParams) -> View:
    """A view that fits the cloud: they are of very different sizes."""
    return VIEWS.get(p.dataset, VIEWS["room"])
