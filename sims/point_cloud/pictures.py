"""Beside the scene: what the colours say, and how a registration goes."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from geometry import clouds
from sims.kit.palette import RGB, Palette
from sims.kit.pane import Pane
from sims.kit.plot import Plot, room
from sims.kit.readout import figure, quantity
from sims.point_cloud import colors
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.model import CloudParams, CloudSolution
from sims.point_cloud.shown import MARKS
from sims.point_cloud.solving import source
from sims.point_cloud.work import measured, span

BINS = 48
WIDTH, HEIGHT, LEFT, END, FLOOR, TOP = 320, 112, 10, 310, 84, 8
UNITS = {"height": "m", "intensity": ""}
NAMES = {"height": "Height", "intensity": "Intensity"}
CHANNELS = ("Red", "Green", "Blue")


def panes(p: CloudParams, s: CloudSolution, _: Palette) -> list[Pane]:
    """The colour bar, and in a registration the error of each step."""
    return [legend(p, s), errors(s)] if s.registration is not None else [legend(p, s)]


def legend(p: CloudParams, s: CloudSolution) -> Pane:
    """What the colours of the points say."""
    if s.registration is not None:
        return _key("The two scans", [(MARKS["fixed"], "first scan, stays"), (MARKS["moves"], "second scan, moves")])
    if s.clusters is not None:
        return _clusters(s)
    if s.colored_by in NAMES:
        return _bar(source(p), s.colored_by)
    if s.colored_by == "normals":
        return _key("Normals", [(rgb, f"to {word}") for rgb, word in DIRECTIONS], "each direction has its colour")
    return _key("Measured colour", [], "as the scanner's camera saw it")


DIRECTIONS: tuple[tuple[RGB, str], ...] = (
    ((255, 128, 128), "+X"), ((128, 255, 128), "+Y"), ((128, 128, 255), "+Z, up"),
    ((0, 128, 128), "−X"), ((128, 0, 128), "−Y"), ((128, 128, 0), "−Z"),
)  # fmt: skip


def _clusters(s: CloudSolution) -> Pane:
    assert s.clusters is not None
    shown = [(tuple(int(c[i : i + 2], 16) for i in (1, 3, 5)), k) for k, c in enumerate(colors.CLUSTERS)]
    items = [((r, g, b), f"{k + 1}: {n:,}".replace(",", "\u2009")) for ((r, g, b), k), n in zip(shown, s.clusters.sizes, strict=False)]
    return _key("Clusters, by points", items[:9], "the largest first; grey: too small")


@lru_cache(maxsize=64)
def _bar(cloud: Cloud, kind: str) -> Pane:
    """How many points have each value, in its colour, with the values from and to which the colours go."""
    low, high = span(cloud, kind)
    values = np.clip(measured(cloud, kind), low, high)
    counts, _ = np.histogram(values, BINS, (low, high))
    heights = (FLOOR - 16 - TOP) * counts / max(1, counts.max())
    wide = (END - LEFT) / BINS
    chosen = colors.ramp(kind)[np.linspace(0, 255, BINS).astype(int)].tolist()
    bars = "".join(
        f'<path style="fill:rgb({r},{g},{b})" d="M{LEFT + k * wide:.1f} {FLOOR - 16 - h:.1f}h{wide + 0.3:.1f}'
        f'V{FLOOR - 16:.1f}h{-wide - 0.3:.1f}zM{LEFT + k * wide:.1f} {FLOOR - 12}h{wide + 0.3:.1f}v12h{-wide - 0.3:.1f}z"/>'
        for k, ((r, g, b), h) in enumerate(zip(chosen, heights.tolist(), strict=True))
    )
    ticks = "".join(
        f'<text x="{LEFT + (END - LEFT) * f:.0f}" y="{FLOOR + 18}" text-anchor="{anchor}">'
        f"{quantity(low + (high - low) * f, UNITS[kind], 2)}</text>"
        for f, anchor in ((0.0, "start"), (0.5, "middle"), (1.0, "end"))
    )
    note = f"from {figure(low, 2)} to {quantity(high, UNITS[kind], 2)}"
    return _pane(NAMES[kind], note, bars + ticks, HEIGHT)


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
    return plot.pane(f"{quantity(now, 'mm', 1)} at step {found.step}", (float(found.step), now))


def heights(cloud: Cloud) -> tuple[float, float]:
    """Least and greatest height, in metres."""
    low, high = clouds.bounds(cloud.points)
    return float(low[2]), float(high[2])
