"""The sentence at the top: what to do, or what a change of the cameras has done."""

from __future__ import annotations

from sims.kit.readout import THIN, figure
from sims.triangulation.depth_plot import sigma_before
from sims.triangulation.params import OF_CURVE, TriangulationParams
from sims.triangulation.readouts import length
from sims.triangulation.solution import TriangulationSolution

PLUS_MINUS = "±\u00a0"
LESS_AND_MORE = (("shorter baseline", "longer baseline"), ("shorter focal length", "longer focal length"))


def caption(p: TriangulationParams, s: TriangulationSolution) -> str:
    """What to do, or what to see."""
    if s.point is None and p.pair is not None:
        return "The rays don’t meet in front of both cameras: pull the right point onto the dashed line, and along it."
    if s.point is None:
        return "The rays don’t meet in front of the cameras: pull the right point to the left in its picture."
    if changed := _change(p, s):
        return changed
    if s.matched is not None and p.noise == 0.0:
        return f"That is a corner of {s.matched.of}: your point is {length(s.matched.apart)} from it."
    if p.noise > 0.0:
        return "Noise makes the rays miss each other: the point may be anywhere in the ellipsoid."
    # The 3D point first: a low frame shows the scene, and the pictures only to who scrolls.
    return "Drag the 3D point onto a corner; or its place in one picture, then match it in the other."


def _change(p: TriangulationParams, s: TriangulationSolution) -> str:
    """What the change of the cameras since `before` means, if that and no noise is what changed."""
    if p.before is None or s.depth is None or s.depth_sigma is None or s.vague:
        return ""
    now = tuple([getattr(p, name) for name in OF_CURVE])
    changed = [k for k, (was, is_now) in enumerate(zip(p.before, now, strict=True)) if was != is_now]
    if not changed or OF_CURVE.index("noise") in changed:
        return ""
    b, f, _ = p.before
    more, what = now[0] * now[1] > b * f, "Another rig"
    if len(changed) == 1:
        what = LESS_AND_MORE[changed[0]][more]
        if p.hold == "pixels":
            where = "farther" if more else "nearer"
            return f"With the pixels kept, a {what} means a {where} point, and so a {_sure(not more)} one."
        what = f"A {what}"
    was = sigma_before(p, s)
    if not was > 0.0:  # it wasn't in front of both cameras
        return ""
    change = f"from {PLUS_MINUS}{figure(was)} to {PLUS_MINUS}{figure(s.depth_sigma)}{THIN}m"
    surer = more if p.pair is None else s.depth_sigma < was
    return f"{what}, a {_sure(surer)} depth: {change} at the same point."


def _sure(more: bool) -> str:
    return "surer" if more else "less sure"
