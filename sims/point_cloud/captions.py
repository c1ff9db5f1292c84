"""What to do, or what to see, in one sentence."""

from __future__ import annotations

from collections.abc import Callable

from sims.kit.readout import quantity
from sims.point_cloud.params import CloudParams
from sims.point_cloud.registration import Registered
from sims.point_cloud.solution import CloudSolution


def caption(p: CloudParams, s: CloudSolution) -> str:
    """What to do, or what to see."""
    if s.trouble:
        return "This can’t be shown: see why below."
    if s.registration is not None:
        return _registering(s.registration)
    if p.process == "register":
        return "To register takes two scans: choose “Two scans of a court”, or bring two files of your own."
    if s.measured is not None:
        return f"The two points are {quantity(s.measured.distance, 'm')} apart: click another one to measure to it."
    if p.measure:
        return "Click another point: how far is it?" if s.selected else "Click a point to measure from."
    if p.process != "none":
        nothing = p.step > 0 and FOUND[p.process](s) is None and (p.process != "clusters" or p.step > 1)
        return "Nothing was found: see why below." if nothing else DOING[p.process][min(p.step, 2)]
    if s.selected is not None:
        return "Its nearest points say how the surface lies: the plane through them, and how flat they are."
    if p.voxel_size > 0.0:
        return "The points in each cell have become their mean: point at one, or click it, to see its cell."
    return "Thin the cloud with the voxel size, colour it, or click a point to read what is known of it."


DOING = {
    "ground": (
        "Which points are the ground? “Next step” looks for the level plane that most points are near to.",
        "The marked points are near one plane, which three points chosen at random gave, over and over.",
        "The ground is taken away: what stood on it is left.",
    ),
    "clusters": (
        "Which points are one thing? “Next step” takes the ground away, and then links near points.",
        "Without the ground, things stand apart: the next step links points that are near each other.",
        "Points with no wide gap between them have one colour: change the gap, and things part or merge.",
    ),
    "outliers": (
        "Which points were thrown off? “Next step” compares how far each is from its nearest points.",
        "The marked points are unusually far from their nearest ones; the next step takes them away.",
        "Points that were unusually far from their nearest ones are gone: watch the size of the box.",
    ),
    "surface": (
        "What surface do the points lie on? “Next step” rolls a ball over them.",
        "Where the ball comes to rest on three points, there is a triangle.",
        "A smaller ball falls through between the points, a larger one bridges gaps: change its radius.",
    ),
}
"""Captions of each process before, when something is found, and when it is done."""


FOUND: dict[str, Callable[[CloudSolution], object]] = {
    "ground": lambda s: s.ground,
    "clusters": lambda s: s.clusters,
    "outliers": lambda s: s.outliers,
    "surface": lambda s: s.surface if s.surface and s.surface.triangles else None,
}


def _registering(r: Registered) -> str:
    """What a step of a registration shows."""
    if not r.pairs:
        return "No point is near enough to the first scan: nothing pulls the second one. Bring it nearer."
    if r.step == 0:
        return "Drag the second scan by its ball, or go on: each step pairs nearest points and brings them together."
    if r.step < r.steps:
        return "Each step pairs points with their nearest, and moves the second scan to bring the pairs together."
    if r.off is not None and r.off > ASTRAY:
        return "It ends in the wrong place: ICP finds the fit that is nearest to where it begins."
    if r.off is None:
        return "It ends here: do the scans fit? Nobody knows the truth; see how many points have a pair, and how near."
    return "The scans fit: from farther away they may not. Go back to step 0 and drag the second scan off."


ASTRAY = 0.05
"""How far a corner may be from where it belongs, in metres, before a registration has plainly failed."""
