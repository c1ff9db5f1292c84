"""Beside the scene: what the colours say, and how a registration goes."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from sims.kit.palette import RGB, rgb
from sims.kit.pane import Pane
from sims.kit.plot import Plot, room
from sims.kit.readout import THIN, figure, quantity
from sims.point_cloud import colors
from sims.point_cloud.cloud import Colors
from sims.point_cloud.derived import BINS, Tally
from sims.point_cloud.layers import MARKS
from sims.point_cloud.params import CloudParams
from sims.point_cloud.selected import Selected
from sims.point_cloud.solution import CloudSolution

WIDTH, HEIGHT, LEFT, END, FLOOR, TOP = 320, 112, 10, 310, 84, 8
NAMES = {"height": "Height", "intensity": "Intensity", "variation": "Surface variation"}
ITSELF, OTHERS = 'r="5" class="s3-core"', 'r="3" style="fill:var(--ink)"'
UNITS = {"height": "m", "intensity": "", "variation": ""}


def panes(_: CloudParams, s: CloudSolution) -> list[Pane]:
    """The colour bar, and in a registration the error of each step."""
    if not s.points_in:
        return []
    more = [marked(s)] if len(s.drawn.marked.rows) and (s.ground or s.outliers) else []
    near = [] if s.selected is None else [section(s.selected)]
    return [legend(s), *([errors(s)] if s.registration is not None else more), *near]


def legend(s: CloudSolution) -> Pane:
    """What the colours of the points say."""
    if s.registration is not None:
        return _key("The two scans", [(MARKS["fixed"], "first scan, stays"), (MARKS["moves"], "second scan, moves")])
    if s.clusters is not None:
        return _clusters(s)
    if s.drawn.tally is None:
        return _key("Normals", [(color, f"to {word}") for color, word in DIRECTIONS], "each direction has its colour")
    return _bar(s.drawn.tally)


def marked(s: CloudSolution) -> Pane:
    """What the process has found."""
    what, words = ("ground", "points of the ground") if s.ground is not None else ("outliers", "outliers, larger")
    pane = _key("Marked", [(MARKS[what], words)])
    return replace(pane, name="marked")


DIRECTIONS: tuple[tuple[RGB, str], ...] = (
    ((255, 128, 128), "+X"), ((128, 255, 128), "+Y"), ((128, 128, 255), "+Z, up"),
    ((0, 128, 128), "−X"), ((128, 0, 128), "−Y"), ((128, 128, 0), "−Z"),
)  # fmt: skip


def _clusters(s: CloudSolution) -> Pane:
    assert s.clusters is not None
    shown = zip(colors.CLUSTERS, s.clusters.sizes[:9], strict=False)
    items = [(rgb(color), f"{k + 1}: {size:,}".replace(",", THIN)) for k, (color, size) in enumerate(shown)]
    return _key("Clusters, by points", items, "grey: too small")


@lru_cache(maxsize=64)
def _bar(tally: Tally) -> Pane:
    """How many points have each value, in its colour, with the values from and to which the colours go."""
    bars = _bars(tally.counts, tally.paint)
    if tally.kind == "rgb":
        return _pane("Measured colour", "by brightness", bars + _words("dark", "", "bright"), HEIGHT)
    low, high, unit = tally.low, tally.high, UNITS[tally.kind]
    digits = max(2, 1 - math.floor(math.log10(high))) if tally.kind == "variation" else 2
    ticks = _words(*(quantity(low + (high - low) * f, unit, digits) for f in (0.0, 0.5, 1.0)))
    note = f"from {figure(low, digits)} to {quantity(high, unit, digits)}"
    return _pane(NAMES[tally.kind], note, bars + ticks, HEIGHT)


def _bars(counts: npt.NDArray[Any], paint: Colors) -> str:
    """A bar for each count, over a band of its colour."""
    heights = (FLOOR - 16 - TOP) * counts / max(1, counts.max())
    wide = (END - LEFT) / BINS
    return "".join(  # no band where there is nothing that has a colour
        f'<path style="fill:rgb({r},{g},{b})" d="M{LEFT + k * wide:.1f} {FLOOR - 16 - h:.1f}h{wide + 0.3:.1f}'
        f"V{FLOOR - 16:.1f}h{-wide - 0.3:.1f}z"
        f'M{LEFT + k * wide:.1f} {FLOOR - 12}h{wide + 0.3:.1f}v12h{-wide - 0.3:.1f}z"/>'
        for k, ((r, g, b), h) in enumerate(zip(paint.tolist(), heights.tolist(), strict=True))
        if (r, g, b) != (0, 0, 0)
    )


def _words(*words: str) -> str:
    """At the left end, in the middle and at the right end of the band."""
    ends = zip(words, (LEFT, (LEFT + END) // 2, END), ("start", "middle", "end"), strict=True)
    return "".join(f'<text x="{x}" y="{FLOOR + 18}" text-anchor="{anchor}">{text}</text>' for text, x, anchor in ends)


def _key(title: str, items: list[tuple[RGB, str]], note: str = "") -> Pane:
    """Squares of colour with words, three a row."""
    across = 2 if len(items) < 3 else 3
    cells = "".join(
        f'<rect x="{LEFT + (k % across) * (300 // across)}" y="{8 + 24 * (k // across)}" width="14" height="14" rx="3"'
        f' style="fill:rgb({r},{g},{b})"/><text x="{LEFT + 20 + (k % across) * (300 // across)}"'
        f' y="{20 + 24 * (k // across)}">{words}</text>'
        for k, ((r, g, b), words) in enumerate(items)
    )
    return _pane(title, note, cells, 10 + 24 * -(-len(items) // across))


def _pane(title: str, note: str, inside: str, height: int) -> Pane:
    words = f"{title}: {note}" if note else title
    svg = f'<svg class="s3-plot" viewBox="0 0 {WIDTH} {height}" role="img" aria-label="{words}">{inside}</svg>'
    return Pane("colours", title, svg, note, wide=True)


def section(chosen: Selected) -> Pane:
    """The selected point's nearest ones from the side, on the plane that is fitted to them; one scale both ways."""
    wide, thick = np.maximum(np.abs(chosen.section).max(axis=0), 1e-9).tolist()
    middle, level = (LEFT + END) / 2.0, HEIGHT / 2.0
    scale = min(0.95 * (END - middle) / wide, 0.85 * level / thick)
    dots = "".join(
        f'<circle cx="{middle + scale * x:.1f}" cy="{level - scale * y:.1f}" {OTHERS if k else ITSELF}/>'
        for k, (x, y) in enumerate(chosen.section.tolist())
    )
    plane = f'<path d="M{LEFT} {level}H{END}" class="s3-ghost"/><text x="{LEFT}" y="{level - 6}">plane</text>'
    note = f"{quantity(1000.0 * float(np.sqrt(chosen.eigenvalues[0])), 'mm', 1)} thick"
    pane = _pane("Its neighbours from the side", note, plane + dots, HEIGHT)
    return replace(pane, name="section")


def errors(s: CloudSolution) -> Pane:
    """Root mean square distance of the pairs at each step of ICP."""
    found = s.registration
    assert found is not None
    rmses = [1000.0 * v for v in found.rmses]
    plot = Plot(
        "errors", "Error of the pairs", x="step", y="rms distance, mm", x_max=float(max(found.steps, 1)),
        y_max=room(max(*rmses, 1e-6), 1.1),
    )  # fmt: skip
    plot.curve([(float(k), v) for k, v in enumerate(rmses)], "")
    now = rmses[found.step]
    narrow = next((k for k, reach in enumerate(found.reaches) if reach < found.reaches[0]), None)
    finer = "" if narrow is None else f"; finer from {narrow}"
    return plot.pane(f"{quantity(now, 'mm', 1)} at step {found.step}{finer}", (float(found.step), now))
