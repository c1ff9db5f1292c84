"""Read-outs, and a sentence for people who listen."""

from __future__ import annotations

from collections.abc import Iterator

from sims.kit.readout import Fold, Formula, Note, Readout, Table, figure, mathml, quantity, row, symbol
from sims.transform_chain.labels import outcome
from sims.transform_chain.params import MOST, OWN, POINT, ChainParams
from sims.transform_chain.presets import known
from sims.transform_chain.solution import ENOUGH, ChainSolution
from sims.transform_chain.strip import AXES, Strip, linked, sub

STAGES, FREEDOM, INVERSE = "The transforms, one by one", "Freedom to move", "The inverse"


def caption(p: ChainParams, s: ChainSolution) -> str:
    """What to do, or what to see."""
    if s.swapped is not None:
        return "The ghost is the same arm with two transforms exchanged: see where the order matters."
    if p.target is not None and s.target_distance is not None and s.target_distance > ENOUGH:
        return "Bring the end effector to the target, joint by joint, or by dragging its ring."
    if s.singular:
        return "A singular pose: there is a direction in which no joint can move the end effector."
    if p.stage is not None:
        i = p.stage
        name = f"T{sub(i - 1)}{sub(i)}"
        return f"{name} alone: its columns are the axes and the origin of frame {i}, as frame {i - 1} sees them."
    return "Pull a link: all that follows moves as one piece, and only its own transform changes."


def readouts(p: ChainParams, s: ChainSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    n = p.count
    yield from _warnings(s)
    yield Strip(list(s.individual), list(s.composed), p.stage)
    yield from _watched(p, s)
    if s.swapped is not None:
        yield from _swapped(p, s)
    yield from _notes(p, s)
    yield Fold(STAGES)
    words = "From each frame to the next" if p.show == "individual" else "From the world to each frame"
    yield Note(f"{words}:")
    for i, T in enumerate(s.individual if p.show == "individual" else s.composed, start=1):
        what = _steps(p, i) if p.show == "individual" else _product(i)
        name = symbol("T", f"{i - 1 if p.show == 'individual' else 0}{i}")
        yield Formula(what, name, mathml(T, roles=AXES), link=linked(i))
    yield Fold(INVERSE)
    yield Formula("End effector from world: its inverse (Rᵀ, −Rᵀt)", symbol("T", f"{n}0"), mathml(s.inverse))
    yield Fold(POINT)
    yield _through(s)
    yield from _kept(s)
    yield Fold(FREEDOM)
    yield from _freedom(p, s)
    yield Fold(OWN)
    yield from _rows(p)


def _product(i: int) -> str:
    return "".join(f"T{sub(k)}{sub(k + 1)}" for k in range(i))


def _watched(p: ChainParams, s: ChainSolution) -> Iterator[Readout]:
    """The pose of the end effector; of a link that is shown alone, its transform and the product up to it."""
    n = p.count
    if p.stage is None:
        yield Formula(
            f"World from end effector: {_product(n)}", symbol("T", f"0{n}"), mathml(s.end_effector, roles=AXES)
        )
        return
    i = p.stage
    own = mathml(s.individual[i - 1], roles=AXES)
    yield Formula(_steps(p, i), symbol("T", f"{i - 1}{i}"), own, link=linked(i))
    if i > 1:
        yield Formula(f"{_product(i)}: up to here", symbol("T", f"0{i}"), mathml(s.composed[i - 1], roles=AXES))


def _steps(p: ChainParams, i: int) -> str:
    """In words: what a link's transform does, one thing after the other."""
    k, link = i - 1, p.arm.links[i - 1]
    axis, offset = p.axes[k], p.offset(k)
    angle = p.angles[k] + (p.starts[k] if p.starts else 0.0)
    steps = [] if p.kind(k) != "r" and not angle else [f"R{axis}({quantity(angle, '°', 1)})"]
    steps += [f"{quantity(offset, 'm', 2)} along {axis}"] if offset or p.slides(k) else []
    steps += [f"{quantity(link.length, 'm', 2)} along x"] if link.length or not p.rows else []
    steps += [f"Rx({quantity(p.twists[k], '°', 1)})"] if link.twist else []
    return ", then ".join(steps) or "nothing"


def _rows(p: ChainParams) -> Iterator[Readout]:
    """The arm as a table of Denavit and Hartenberg, where it is one."""
    if {*p.axes} != {"z"}:
        yield Note("A table of Denavit and Hartenberg describes arms whose axes are all z, with twists between them.")
        return
    zeros = (0.0,) * p.count
    twists, starts = p.twists or zeros, p.starts or zeros
    rows = [
        [
            f"{k + 1}", figure(p.lengths[k], 4), figure(twists[k], 1),
            figure(p.offset(k), 4) + (" ↕" if p.slides(k) else ""),
            figure(starts[k] + p.angles[k], 1) + (" ↻" if p.kind(k) == "r" else ""),
        ]
        for k in range(p.count)
    ]  # fmt: skip
    head = ["link", "a (m)", "α (°)", "d (m)", "θ (°)"]
    lights = [f"angles.{k}" for k in range(p.count)]
    yield Table("Denavit–Hartenberg parameters of this arm: ↻ turns, ↕ slides", [head, *rows], lights=lights)


def _warnings(s: ChainSolution) -> Iterator[Note]:
    if s.short is not None:
        yield Note(_short(s, s.short), "warn")
    if s.mobility == 0:
        yield Note("No joint moves the end effector: it lies on every axis.", "near")
    elif s.singular:
        left = s.mobility - 1 if s.lost is not None else None
        ways = f" in {left} of {s.mobility} directions only" if left is not None else " in fewer directions"
        along = f", not along {_place(s.lost.tolist())}" if s.lost is not None else ""
        yield Note(f"Singular pose: the joints can move the end effector{ways}{along}.", "warn")
    elif s.near_singular:
        yield Note("Near a singular pose: in one direction the end effector moves only a little.", "near")


def _notes(p: ChainParams, s: ChainSolution) -> Iterator[Note]:
    if p.target is not None and s.target_distance is not None:
        reached = "reached" if s.target_distance <= ENOUGH else f"{quantity(s.target_distance, 'm')} away"
        yield Note(f"Target {_place(p.target)} m: {reached}.")
    if (arm := known(p)) is not None:
        yield Note(arm.says)
    if p.count == MOST:
        yield Note(f"{MOST} links: the longest arm here.")


def _short(s: ChainSolution, metres: float) -> str:
    gap = quantity(metres, "m")
    if s.pull_outside:
        least, greatest = s.reach
        far = "as far as one likes" if greatest is None else quantity(greatest, "m", 2)
        bounds = f"from {quantity(least, 'm', 2)} to {far}"
        return f"Out of reach: this is as near as it gets, {gap} short. The arm reaches {bounds}."
    return f"Not reached: from here this is as near as it gets, {gap} short. Another posture may come nearer."


def _place(place: tuple[float, ...] | list[float]) -> str:
    return "(" + ", ".join(figure(v, 2) for v in place) + ")"


def _swapped(p: ChainParams, s: ChainSolution) -> Iterator[Readout]:
    assert s.swapped is not None
    assert p.swap is not None
    i, a, b = p.swap, p.axes[p.swap - 1], p.axes[p.swap]
    names = f"T{sub(i - 1)}{sub(i)} and T{sub(i)}{sub(i + 1)}"
    alike = outcome(s.swapped) == "the same pose"
    text = "the end effector stays where it is" if alike else f"the end effector is {outcome(s.swapped)}"
    sliding = any(p.slides(k) for k in (i - 1, i))
    if sliding:
        why = "A slide and a turn commute only along one axis"
    elif a == b:
        why = (
            f"Both turn about {a}: turns about one axis commute, steps along links don’t (set both lengths to 0 to see)"
        )
    else:
        why = f"They turn about {a} and {b}: turns about different axes don’t commute"
    yield Note(f"{names} swapped: {text}. {why}.")
    yield Formula("End effector with these two swapped", symbol("T", "swapped"), mathml(s.swapped_end_effector))


def _through(s: ChainSolution) -> Table:
    n = len(s.through) - 1
    names = [f"frame {n} (end)", *(f"frame {i}" for i in range(n - 1, 0, -1)), "frame 0 (world)"]
    rows = [[name, *(figure(v) for v in point)] for name, point in zip(names, s.through.tolist(), strict=True)]
    return Table("Point p, frame by frame: each row is T times the one above", [["", "x", "y", "z", "w"], *rows])


def _kept(s: ChainSolution) -> Iterator[Readout]:
    (own, world), angles = s.kept
    rows = [["", "in frame n", "in the world"], ["distance", quantity(own, "m"), quantity(world, "m")]]
    if angles is not None:
        rows.append(["angle to x", *(quantity(a, "°", 1) for a in angles)])
    yield Table("Kept by the transform: p as the end effector sees it", rows)


def _freedom(p: ChainParams, s: ChainSolution) -> Iterator[Readout]:
    unit = "m/rad, or 1" if "p" in p.joints else "m/rad"
    yield Formula("Geometric Jacobian: velocity, then turning, for each joint", symbol("J"), mathml(s.jacobian, 2))
    yield Formula("Singular values of its velocity rows", symbol("σ"), row(s.singular_values.tolist()), unit)
    kinds = {0: "", 1: ": σ₁", 2: ": σ₁σ₂", 3: ": σ₁σ₂σ₃"}
    yield Formula(f"Manipulability{kinds[s.mobility]}", symbol("w"), mathml(s.manipulability))


def describe(p: ChainParams, s: ChainSolution) -> str:
    """One sentence for people who listen."""
    turns = ", ".join(
        f"{axis} {figure(p.offset(k), 2)} metres" if p.slides(k) else f"{axis} {figure(p.angles[k], 0)}°"
        for k, axis in enumerate(p.axes)
        if p.kind(k) != "f"
    )
    x, y, z = (figure(v, 2) for v in s.end)
    pose = "; singular pose" if s.singular else ""
    short = "" if s.short is None else f"; {'out of reach' if s.pull_outside else 'not reached'}"
    far = s.target_distance
    target = "" if far is None else f"; target {'reached' if far <= ENOUGH else figure(far, 2) + ' metres away'}"
    joints = "1 joint" if p.count == 1 else f"{p.count} joints"
    return f"Arm of {joints}, {turns}; end effector at {x}, {y}, {z} metres{pose}{short}{target}."
