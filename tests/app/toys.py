"""A sim for tests of what is round the sims: its solving can be watched, can fail, and can be slow."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

from geometry import GeometryError
from sims.kit.fields import Choice, Slider
from sims.kit.params import Params
from sims.kit.scene.stage import Stage
from sims.kit.sim import Action, Sim, Step
from sims.kit.view import View

IMPOSSIBLE = 13.0
"""At this size there is no solution."""


class ToyParams(Params):
    """A size, a colour, and how slow the solving is."""

    size: Annotated[float, Slider(0, 100, step=1, title="Size")] = 1
    """How large"""
    kind: Annotated[Literal["red", "blue"], Choice(title="Kind", labels={"red": "Red", "blue": "Blue"})] = "red"
    """Which"""


@dataclass(frozen=True)
class ToySolution:
    double: float


@dataclass
class Solver:
    """Counts what it solves."""

    seconds: float = 0.0
    solved: list[float] = field(default_factory=list)
    broken: bool = False

    def __call__(self, params: ToyParams) -> ToySolution:
        self.solved.append(params.size)
        time.sleep(self.seconds)
        if self.broken:
            raise ZeroDivisionError
        if params.size == IMPOSSIBLE:
            raise GeometryError("size", params.size, "anything but 13")
        return ToySolution(2.0 * params.size)


class ToyScene:
    """A label."""

    def __init__(self, stage: Stage) -> None:
        self.label = stage.label("/label", "")

    def draw(self, params: ToyParams, solution: ToySolution) -> None:
        self.label.text(f"{solution.double}")


def grow(_: ToyParams) -> Iterator[Step]:
    yield Step({"size": 0.0}, 0.0)
    yield Step({"size": 50.0}, 0.3)
    yield Step({"size": 100.0}, 0.3)


def explain(_: ToyParams) -> Iterator[Step]:
    yield Step({"size": 5.0}, 0.1, words="It grows.")
    yield Step({}, 0.1, words="Now it <rests>.")
    yield Step({"size": 7.0}, 0.1)


def paint(params: ToyParams) -> Mapping[str, Any]:
    return {"kind": "blue" if params.kind == "red" else "red"}


def toy(seconds: float = 0.0, *, heavy: bool = False) -> tuple[Sim[Any, Any], Solver]:
    """The sim, and what it has solved."""
    solver = Solver(seconds)
    sim: Sim[Any, Any] = Sim(
        slug="toy",
        title="Toy",
        summary="A toy.",
        concepts=(),
        objectives=(),
        params=ToyParams,
        solve=solver,
        scene=ToyScene,
        caption=lambda p, s: "Make it grow.",
        readouts=lambda p, s: (),
        describe=lambda p, s: f"Size {p.size:g}, double {s.double:g}.",
        view=View((3.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.0),
        actions=(
            Action("grow", "Grow", "Slowly", grow),
            Action("explain", "Explain", "In words", explain),
            Action("paint", "Paint", "The other one", paint, aliases=("dye",)),
            Action("burst", "Burst", "Too much", lambda p: {"size": 1000.0}),
        ),
        handles={"/grip": lambda p, place: {"size": place[0]}},
        heavy=heavy,
    )
    return sim, solver
