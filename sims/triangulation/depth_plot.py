"""The plot of depth uncertainty against depth: σ_Z = √2 σ Z² / (f b).

Its axes stay while a hand changes baseline, focal length or noise: they are those of the curve before the change, which
is seen too. Depths go up to a power of ten, so that they stay while the point is dragged.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from geometry.triangulation import depth_sigma
from sims.kit.pane import Pane
from sims.kit.plot import Plot, room
from sims.kit.readout import quantity
from sims.triangulation.params import TriangulationParams
from sims.triangulation.solution import TriangulationSolution, sigma_of

NO_DEPTH = 4.0
"""Metres for which the plot has room when there is no point."""
INSIDE = 0.001
"""Part of the axis that a dragged point keeps from its ends."""
Curve = tuple[float, float, float]
"""Baseline in metres, focal length in pixels, noise in pixels."""


def reach(depth: float) -> float:
    """The power of ten up to which depths are shown."""
    return float(10.0 ** math.ceil(math.log10(depth) - 1e-9))


def within(depth: float, now: float) -> float:
    """A depth that is shown on the same axis as the present one: what is dragged stays on its plot."""
    end = reach(now)
    return min(max(depth, (0.1 + INSIDE) * end), (1.0 - INSIDE) * end)


def plot(p: TriangulationParams, s: TriangulationSolution) -> Pane:
    """The curve of the state with its point, which can be dragged along the depth."""
    now = p.baseline, p.focal, s.sigma_px
    before = now if p.before is None else (p.before[0], p.before[1], sigma_of(p.before[2]))
    noise = f"at {quantity(s.sigma_px, 'px', 2)} noise"
    if s.depth is None or s.depth_sigma is None or s.vague:
        return _curves(now, before, reach(NO_DEPTH)).pane(noise)
    drawn = _curves(now, before, reach(s.depth))
    beyond = " (beyond the top)" if s.depth_sigma > drawn.y_max else ""
    words = f"{quantity(s.depth, 'm', 2)} ± {quantity(s.depth_sigma, 'm')}{beyond} {noise}"
    mark = s.depth, min(s.depth_sigma, drawn.y_max)
    return drawn.pane(words, mark, handle="depth", label="Depth of the point")


@lru_cache(maxsize=128)
def _curves(now: Curve, before: Curve, x_max: float) -> Plot:
    """The curve now, and that before the change; without one, those of half and twice the baseline."""
    y_max = room(_sigma(before, x_max), 1.0)
    drawn = Plot("plot", "Depth", x="depth Z (m)", y="σ of Z (m)", x_max=x_max, y_max=y_max)
    b, f, sigma = now
    near = before[0] * before[1] / before[2] / (b * f / sigma)  # then its words would stand in those of the other
    others = (
        [("" if 0.8 < near < 1.25 else "before", before)]
        if before != now
        else [("½ b", (b / 2, f, sigma)), ("2 b", (2 * b, f, sigma))]
    )
    for words, curve in (*others, ("now" if before != now else "b", now)):
        end = min(x_max, math.sqrt(y_max / _sigma(curve, 1.0)))
        depths = np.linspace(0.0, end, 25)[1:]
        sigmas = depth_sigma(depths, *curve)
        points = [(0.0, 0.0), *zip(depths.tolist(), sigmas.tolist(), strict=True)]
        drawn.curve(points, words, ghost=curve != now)
    return drawn


def _sigma(curve: Curve, depth: float) -> float:
    return float(depth_sigma(depth, *curve))
