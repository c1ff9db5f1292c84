"""euler-angles: how three turns compose into one rotation.

An aircraft (nose +X, left wing +Y, top +Z) is turned three times. Intrinsic turns are about the axes that the
aircraft has by then, extrinsic ones about the fixed axes of the world.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from geometry import euler, quaternion
from geometry.arrays import Array
from geometry.rotations import matrix_to_axis_angle
from sims.kit import bodies
from sims.kit.params import Params, choice, number
from sims.kit.readout import Formula, Note, Readout, figure, mathml, quantity, row, symbol
from sims.kit.sim import Action, Objective, Sim, Step, View
from sims.kit.stage import Quaternion, Stage

Order = Literal["zyx", "xyz", "zxz", "xzy", "yxz", "yzx", "zxy", "xyx", "xzx", "yxy", "yzy", "zyz"]
NEAR_LOCK = 15.0
"""Degrees from lock within which the sim warns."""
TAIT_BRYAN = {"z": "yaw", "y": "pitch", "x": "roll"}
TURNS = {
    order: ("yaw", "pitch", "roll")
    if order[0] == order[2]
    else (TAIT_BRYAN[order[0]], TAIT_BRYAN[order[1]], TAIT_BRYAN[order[2]])
    for order in euler.ORDERS
}
NAMES = {"yaw": "Yaw ψ", "pitch": "Pitch θ", "roll": "Roll φ"}
PROPER = {"yaw": "First α", "pitch": "Second β", "roll": "Third γ"}
SHORT = {"yaw": "α", "pitch": "β", "roll": "γ"}
# In which direction each turn is seen: the nose for turns about z and y, the left wing for turns about x.
SEEN = {"z": "x", "y": "x", "x": "y"}


class EulerParams(Params):
    """State of the sim."""

    order: Order = choice(
        "zyx", title="Order", description="Axes of the three turns, in the order in which they are made",
        labels={o: o.upper() for o in euler.ORDERS},
    )  # fmt: skip
    frame: Literal["intrinsic", "extrinsic"] = choice(
        "intrinsic", title="Frame", description="Turns about the aircraft's own axes, or about the world's",
        labels={"intrinsic": "Intrinsic: own axes", "extrinsic": "Extrinsic: fixed axes"},
    )  # fmt: skip
    yaw: float = number(
        30,
        -180,
        180,
        step=1,
        unit="°",
        title="Yaw",
        symbol="ψ",
        description="Angle about Z; first angle of a proper Euler order",
    )
    pitch: float = number(
        20,
        -90,
        180,
        step=1,
        unit="°",
        title="Pitch",
        symbol="θ",
        description="Angle about Y; second angle of a proper Euler order",
    )
    roll: float = number(
        10,
        -180,
        180,
        step=1,
        unit="°",
        title="Roll",
        symbol="φ",
        description="Angle about X; third angle of a proper Euler order",
    )
    progress: float = number(
        3,
        0,
        3,
        step=0.01,
        title="Progress",
        description="How much of the sequence is applied: 1 is the first turn, 3 all of it",
    )

    @property
    def proper(self) -> bool:
        return self.order[0] == self.order[2]

    @property
    def names(self) -> tuple[str, str, str]:
        """Parameter names of the three turns, in the order of the turns."""
        return TURNS[self.order]

    @property
    def angles(self) -> tuple[float, float, float]:
        """First, second and third angle in degrees."""
        a, b, c = (getattr(self, name) for name in self.names)
        return a, b, c

    def bounds(self, name: str) -> tuple[float, float]:
        if name == "pitch":
            return (0.0, 180.0) if self.proper else (-90.0, 90.0)
        return super().bounds(name)

    def label(self, name: str) -> str:
        if name not in NAMES:
            return super().label(name)
        k = self.names.index(name)
        primes = "" if self.frame == "extrinsic" else "′" * k
        return f"{(PROPER if self.proper else NAMES)[name]} · {self.order[k].upper()}{primes}"

    def regions(self) -> dict[str, list[tuple[float, float]]]:
        """Where the middle angle is near lock, for the slider's track."""
        name = self.names[1]
        low, high = self.bounds(name)
        return {name: [(max(low, v - NEAR_LOCK), min(high, v + NEAR_LOCK)) for v in self.locks]}

    @property
    def locks(self) -> tuple[float, float]:
        """Values of the middle angle, in degrees, at which the order locks."""
        return (0.0, 180.0) if self.proper else (-90.0, 90.0)


@dataclass(frozen=True)
class Turn:
    """One turn as it is drawn: in the frame before it."""

    name: str
    applied: float
    """Degrees applied so far."""
    wxyz: Quaternion
    """The frame after it, in the frame before it."""
    seen: Quaternion
    """Frame of its arc, in the frame before it: z along the axis of the turn, x where the arc starts."""
    current: bool


@dataclass(frozen=True)
class EulerSolution:
    """R is the whole rotation; `R_progress` the part that is applied, which the aircraft shows."""

    R: Array
    factors: tuple[dict[str, Any], ...]
    quaternion: Array
    axis_angle: dict[str, Any]
    lock_distance: float
    locked: bool
    R_progress: Array
    recovered: dict[str, float]
    turns: tuple[Turn, ...]


def solve(p: EulerParams) -> EulerSolution:
    """All the mathematics of a state."""
    radians = [math.radians(a) for a in p.angles]
    product = euler.factors(radians, p.order, p.frame)
    R = product[0].R @ product[1].R @ product[2].R
    axis, angle = matrix_to_axis_angle(R)
    distance = math.degrees(float(euler.lock_distance(radians[1], p.order)))
    recovered, locked = euler.matrix_to_euler(R, p.order, p.frame)
    part = [min(max(p.progress - k, 0.0), 1.0) for k in range(3)]
    applied = [a * f for a, f in zip(radians, part, strict=True)]
    return EulerSolution(
        R=R,
        factors=tuple({"axis": f.axis, "angle": math.degrees(float(f.angle)), "R": f.R} for f in product),
        quaternion=quaternion.from_matrix(R),
        axis_angle={"axis": axis, "angle": math.degrees(float(angle))},
        lock_distance=distance,
        locked=bool(locked),
        R_progress=R if p.progress >= 3.0 else euler.euler_to_matrix(applied, p.order, p.frame),
        recovered={n: math.degrees(float(a)) for n, a in zip(p.names, recovered, strict=True)},
        turns=_turns(p, applied),
    )


def _turns(p: EulerParams, applied: list[float]) -> tuple[Turn, ...]:
    turns = []
    before: Any = (1.0, 0.0, 0.0, 0.0)
    for k, (axis, angle) in enumerate(zip(p.order, applied, strict=True)):
        turn = quaternion.axis_quaternion(axis, angle)
        seen = ARC_FRAMES[axis]
        if p.frame == "extrinsic" and k:
            # About an axis of the world: seen from the frame before, turn and arc are turned back.
            back = quaternion.conjugate(before)
            in_world = quaternion.multiply(turn, before)
            turn = _floats(quaternion.multiply(back, in_world))
            seen = _floats(quaternion.multiply(back, _seen_from(before, axis)))
            before = in_world
        else:
            before = quaternion.multiply(before, turn) if p.frame == "extrinsic" else before
        current = k < p.progress < k + 1
        name = SHORT[p.names[k]] if p.proper else p.names[k]
        turns.append(Turn(name, math.degrees(angle), turn, seen, current))
    return tuple(turns)


def _seen_from(before: Array, axis: str) -> Array:
    """Frame (a quaternion in the world) of an arc about a world axis, from where the nose (or wing) now points."""
    body = quaternion.to_matrix(before)
    normal = np.eye(3)["xyz".index(axis)]
    flat = [v - normal * (normal @ v) for v in (body[:, "xyz".index(SEEN[axis])], body[:, 1], body[:, 2])]
    start = next(v for v in flat if v @ v > 0.01)
    start = start / math.sqrt(start @ start)
    return quaternion.from_matrix(np.column_stack([start, np.cross(normal, start), normal]))


def _floats(q: Array) -> Quaternion:
    w, x, y, z = q.tolist()
    return w, x, y, z


def _arc_frame(axis: str) -> Quaternion:
    normal, start = np.eye(3)["xyz".index(axis)], np.eye(3)["xyz".index(SEEN[axis])]
    return _floats(quaternion.from_matrix(np.column_stack([start, np.cross(normal, start), normal])))


ARC_FRAMES = {axis: _arc_frame(axis) for axis in "xyz"}


class EulerScene:
    """World frame, ghost frames after one and two turns, the aircraft, and an arc for each turn."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=6.0, height=-1.3)
        stage.axes("/world", 1.55, radius=0.008)
        parents = ["/turn1", "/turn1/turn2", "/turn1/turn2/turn3"]
        self.frames = [
            stage.axes(parents[0], 1.15, ghost=True, letters=None),
            stage.axes(parents[1], 1.15, ghost=True, letters=None),
            stage.axes(parents[2], 1.15, radius=0.02, letters=("x", "y", "z")),
        ]
        body = bodies.aircraft()
        grey = (96, 108, 122) if stage.palette.dark else (201, 208, 216)
        stage.mesh(f"{parents[2]}/hull", body["hull"], grey)
        stage.mesh(f"{parents[2]}/mark", body["mark"], "held")
        self.stage = stage
        self.befores = ["", *parents[:2]]
        self.arcs: list[Any] = []
        self.order = ""

    def draw(self, p: EulerParams, s: EulerSolution) -> None:
        if p.order != self.order:
            self._rebuild(p)
        for frame, arc, turn in zip(self.frames, self.arcs, s.turns, strict=True):
            frame.pose(turn.wxyz)
            arc.draw(turn, near_lock=s.lock_distance < NEAR_LOCK)

    def _rebuild(self, p: EulerParams) -> None:
        self.order = p.order
        for arc in self.arcs:
            arc.remove()
        self.arcs = [
            Arc(self.stage, f"{before}/arc{k}", axis, 1.5 - 0.3 * k, p.locks if k == 1 else ())
            for k, (before, axis) in enumerate(zip(self.befores, p.order, strict=True))
        ]


class Arc:
    """The arc of one turn with its label, its axis while the turn is being made, and the region near lock."""

    def __init__(self, stage: Stage, name: str, axis: str, radius: float, locks: tuple[float, ...]) -> None:
        self.node = stage.group(name)
        self.radius = radius
        dash = {"x": None, "y": (0.14, 0.05), "z": (0.06, 0.045)}[axis]
        self.line = stage.lines(f"{name}/line", [(radius, 0, 0), (radius, 0, 0.001)], axis, width=4.0, dash=dash)
        self.start = stage.lines(f"{name}/start", [(0, 0, 0), (radius, 0, 0)], "ghost", width=1.2)
        self.end = stage.lines(f"{name}/end", [(0, 0, 0), (radius, 0, 0)], axis, width=1.5)
        self.axis = stage.lines(f"{name}/axis", [(0, 0, -1.7), (0, 0, 1.7)], axis, width=5.0)
        self.axis.show(False)
        # the outermost label hangs lower, clear of the next one where the two arcs meet
        self.label = stage.label(f"{name}/label", "", anchor="top-center" if name == "/arc0" else "center-center")
        self.warning = stage.label(f"{name}/warning", "⚠ lock") if locks else None
        self.locks = locks
        self.shown: tuple[Turn, bool] | None = None
        for lock in locks:
            region = stage.lines(f"{name}/lock{lock:.0f}", np.zeros((2, 3)), "warn", width=3.0, dash=(0.03, 0.03))
            region.arc(radius, math.radians(2 * NEAR_LOCK), math.radians(lock - NEAR_LOCK))

    def draw(self, turn: Turn, *, near_lock: bool) -> None:
        if self.shown == (turn, near_lock):
            return
        self.shown = (turn, near_lock)
        radians = math.radians(turn.applied)
        self.node.pose(turn.seen)
        visible = abs(turn.applied) > 0.5
        self.line.arc(self.radius, radians)
        self.end.pose((math.cos(radians / 2), 0.0, 0.0, math.sin(radians / 2)))
        for part in (self.line, self.start, self.end, self.label):
            part.show(visible)
        self.axis.show(turn.current)
        self.label.pose(
            position=(
                1.1 * self.radius * math.cos(radians / 2),
                1.1 * self.radius * math.sin(radians / 2),
                0.0,
            )
        )
        self.label.text(f"{turn.name} {quantity(turn.applied, '°', 0)}")
        if self.warning is not None:
            lock = math.radians(min(self.locks, key=lambda v: abs(v - turn.applied)))
            self.warning.show(near_lock)
            self.warning.pose(position=(1.12 * self.radius * math.cos(lock), 1.12 * self.radius * math.sin(lock), 0.0))

    def remove(self) -> None:
        self.node.handle.remove()


def readouts(p: EulerParams, s: EulerSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    if s.locked:
        yield Note(f"Gimbal lock: the first and third axes coincide. Only {_sum(p)} matters.", "warn")
    elif s.lock_distance < NEAR_LOCK:
        yield Note(
            f"{quantity(s.lock_distance, '°', 1)} from gimbal lock: first and third axes almost coincide.",
            "near",
        )
    else:
        yield Note(f"{quantity(s.lock_distance, '°', 1)} from gimbal lock.")
    names = " ".join(f"R{f['axis']}({quantity(f['angle'], '°', 0)})" for f in s.factors)
    yield Formula(f"Rotation: {names}", symbol("R"), mathml(s.R))
    for factor in s.factors:
        yield Formula(
            f"Turn about {factor['axis']} by {quantity(factor['angle'], '°', 1)}",
            symbol("R", factor["axis"]),
            mathml(factor["R"]),
        )
    yield Formula("Quaternion (w, x, y, z)", symbol("q"), row(s.quaternion.tolist()))
    yield Formula("Axis", symbol("n"), row(s.axis_angle["axis"].tolist()))
    yield Formula("Angle about it", symbol("θ"), mathml(s.axis_angle["angle"], 2), "°")
    got = ", ".join(f"{n} {quantity(a, '°', 2)}" for n, a in s.recovered.items())
    zero = " (at lock the third is set to zero)" if s.locked else ""
    yield Note(f"Angles read back from R: {got}{zero}.")
    if p.progress < 3.0:
        yield Formula(f"Aircraft now, after {figure(p.progress, 2)} turns", symbol("R", "now"), mathml(s.R_progress))


def _sum(p: EulerParams) -> str:
    first, _, third = p.names
    return f"one combination of {first} and {third}"


def describe(p: EulerParams, s: EulerSolution) -> str:
    """One sentence for people who listen."""
    angles = ", ".join(f"{n} {quantity(a, '°', 0)}" for n, a in zip(p.names, p.angles, strict=True))
    lock = "at gimbal lock" if s.locked else f"{quantity(s.lock_distance, '°', 0)} from gimbal lock"
    return f"{p.order.upper()} {p.frame}: {angles}; {lock}."


def animate(p: EulerParams) -> Iterator[Step]:
    """The three turns one after another."""
    yield Step({"progress": 0.0}, 0.0)
    for k in (1.0, 2.0, 3.0):
        yield Step({"progress": k}, 1.1)
        yield Step({"progress": k}, 0.35)


SIM = Sim(
    slug="euler-angles",
    title="Euler angles",
    summary="Turn an aircraft three times, see each turn in its own frame, and read the one rotation they make.",
    concepts=("Euler angles", "Gimbal lock"),
    objectives=(
        Objective("Predict the orientation that three turns in a given order produce", "Apply"),
        Objective(
            "Tell intrinsic from extrinsic turns, and order the matrices of the product accordingly",
            "Analyze",
        ),
        Objective("Find the middle angle at which an order locks, and say what is lost there", "Analyze"),
    ),
    params=EulerParams,
    solve=solve,
    scene=EulerScene,
    readouts=readouts,
    describe=describe,
    view=View((3.3, -3.0, 2.0), (0.0, 0.0, 0.0), 1.9),
    actions=(Action("animate", "Animate sequence", "Make the three turns one after another", animate),),
    states={
        "zero": {"yaw": 0, "pitch": 0, "roll": 0},
        "lock up": {"pitch": 90},
        "lock down": {"pitch": -90},
        "proper lock 0": {"order": "zxz", "pitch": 0},
        "proper lock 180": {"order": "zyz", "pitch": 180},
        "middle is yaw": {"order": "xzy", "yaw": 90},
        "extrinsic": {"frame": "extrinsic", "order": "xyz", "progress": 1.5},
        "half-way": {"progress": 1.5},
    },
)
