"""The plot of depth uncertainty against depth: σ_Z = √2 σ Z² / (f b) in a parallel rig.

Of cameras that are turned, it is that of the places on the left camera's line to the point, with Z before that camera.

Its axes stay while a hand changes baseline, focal length or noise: they are those of the curve before the change, which
is seen too. Depths go up to a power of ten, so that they stay while the point is dragged.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from geometry.arrays import Array
from geometry.triangulation import covariance, depth_sigma
from sims.kit.pane import Pane
from sims.kit.plot import Plot, room
from sims.kit.readout import quantity
from sims.kit.stereo import Own, Size
from sims.kit.types import Pixel, Place
from sims.triangulation.params import TriangulationParams
from sims.triangulation.rig import turned
from sims.triangulation.solution import TriangulationSolution, sigma_of

NO_DEPTH = 4.0
"""Metres for which the plot has room when there is no point."""
INSIDE = 0.001
"""Part of the axis that a dragged point keeps from its ends."""
SAMPLES = 24
"""Depths at which the curve of turned cameras is worked out."""
Curve = tuple[float, float, float]
"""Baseline in metres, focal length in pixels, noise in pixels."""
Sight = tuple[Own, tuple[Size, Size], Pixel | Place]
"""Turned cameras with the sizes of their pictures, and what the left one looks at: a pixel, or a place in the world.

What stays while the baseline changes: so that is the line along which it would be before and after."""


def reach(depth: float) -> float:
    """The power of ten up to which depths are shown."""
    return float(10.0 ** math.ceil(math.log10(depth) - 1e-9))


def within(depth: float, now: float) -> float:
    """A depth that is shown on the same axis as the present one: what is dragged stays on its plot."""
    end = reach(now)
    return min(max(depth, (0.1 + INSIDE) * end), (1.0 - INSIDE) * end)


def sight(p: TriangulationParams, s: TriangulationSolution) -> Sight | None:
    """What else the curve depends on: nothing in a parallel rig."""
    if p.pair is None:
        return None
    if s.point is None or p.hold == "pixels":
        return p.pair, p.sizes, s.measured_left
    x, y, z = s.point.tolist()
    return p.pair, p.sizes, (x, y, z)


def sigmas(depths: Array, curve: Curve, own: Sight | None) -> Array:
    """Standard deviations (n,) of depths (n,), in metres; NaN for what isn't in front of both cameras."""
    if own is None:
        return depth_sigma(depths, *curve)
    pair, sizes, at = own
    left = turned(pair, sizes, curve[0]).left
    ahead = left.back_projection @ [*at, 1.0] if len(at) == 2 else np.array(at) - left.center
    with np.errstate(all="ignore"):  # at a place beside the camera nothing is ahead
        along = ahead / (left.R[2] @ ahead)
        return _sigmas(left.center + depths[:, None] * along, curve, own)


def sigma_before(p: TriangulationParams, s: TriangulationSolution) -> float:
    """The standard deviation of the depth that the point had before the change."""
    assert p.before is not None
    b, f, noise = p.before
    curve, own = (b, f, sigma_of(noise)), sight(p, s)
    if own is None:
        return float(depth_sigma(s.depth or 0.0, *curve))
    return float(_sigmas(np.array([s.point]), curve, own).item(0))


def _sigmas(points: Array, curve: Curve, own: Sight) -> Array:
    """Those of points (n, 3) that turned cameras see."""
    cameras = turned(own[0], own[1], curve[0])
    forward = cameras.left.R[2]
    C = covariance((cameras.left, cameras.right), points, curve[2])
    return np.asarray(np.sqrt(forward @ C @ forward))


def plot(p: TriangulationParams, s: TriangulationSolution) -> Pane:
    """The curve of the state with its point, which can be dragged along the depth."""
    now = p.baseline, p.focal, s.sigma_px
    before = now if p.before is None else (p.before[0], p.before[1], sigma_of(p.before[2]))
    own = sight(p, s)
    noise = f"at {quantity(s.sigma_px, 'px', 2)} noise"
    if s.depth is None or s.depth_sigma is None or s.vague:
        return _curves(now, before, reach(NO_DEPTH), own).pane(noise)
    drawn = _curves(now, before, reach(s.depth), own)
    beyond = " (beyond the top)" if s.depth_sigma > drawn.y_max else ""
    words = f"{quantity(s.depth, 'm', 2)} ± {quantity(s.depth_sigma, 'm')}{beyond} {noise}"
    mark = s.depth, min(s.depth_sigma, drawn.y_max)
    return drawn.pane(words, mark, handle="depth", label="Depth of the point")


@lru_cache(maxsize=128)
def _curves(now: Curve, before: Curve, x_max: float, own: Sight | None) -> Plot:
    """The curve now, and that before the change; without one, those of half and twice the baseline."""
    end = _sigma(before, x_max, own)
    y_max = room(end, 1.0)
    drawn = Plot("plot", "Depth", x="depth Z (m)", y="σ of Z (m)", x_max=x_max, y_max=y_max)
    b, f, sigma = now
    near = _sigma(now, x_max, own) / end if end else 1.0  # then its words would stand in those of the other
    others = (
        [("" if 0.8 < near < 1.25 else "before", before)]
        if before != now
        else [("½ b", (b / 2, f, sigma)), ("2 b", (2 * b, f, sigma))]
    )
    for words, curve in (*others, ("now" if before != now else "b", now)):
        points = _points(curve, x_max, y_max, own)
        if len(points) > 1:
            drawn.curve(points, words, ghost=curve != now)
    return drawn


def _points(curve: Curve, x_max: float, y_max: float, own: Sight | None) -> list[tuple[float, float]]:
    """The curve from zero to where it leaves the plot."""
    if own is None:
        end = min(x_max, math.sqrt(y_max / _sigma(curve, 1.0, None)))
        depths = np.linspace(0.0, end, 25)[1:]
    else:
        depths = np.linspace(0.0, x_max, SAMPLES + 1)[1:]
    found = sigmas(depths, curve, own)
    above = np.flatnonzero(found > y_max * (1.0 + 1e-9))
    last = int(above[0]) + 1 if len(above) else len(found)  # it ends beyond the top, where it is clipped
    exists = np.isfinite(found[:last])
    points = zip(depths[:last][exists].tolist(), found[:last][exists].tolist(), strict=True)
    return [(0.0, 0.0), *points]


def _sigma(curve: Curve, depth: float, own: Sight | None) -> float:
    """That of one depth; 0 where it doesn't exist."""
    found = sigmas(np.array([depth]), curve, own).item(0)
    return found if math.isfinite(found) else 0.0
