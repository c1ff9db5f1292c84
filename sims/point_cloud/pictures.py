"""Beside the scene: what the colours say, and how a registration goes."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from sims.kit.palette import RGB, Palette, rgb
from sims.kit.pane import Pane
from sims.kit.plot import Plot, room
from sims.kit.readout import THIN, figure, quantity
from sims.point_cloud import colors
from sims.point_cloud.cloud import Cloud, Colors
from sims.point_cloud.model import CloudParams, CloudSolution
from sims.point_cloud.shown import MARKS
from sims.point_cloud.solving import source
from sims.point_cloud.work import measured, span

BINS = 48
WIDTH, HEIGHT, LEFT, END, FLOOR, TOP = 320, 112, 10, 310, 84, 8
UNITS = {"height": "m", "intensity": ""}
NAMES = {"height": "Height", "intensity": "Intensity"}


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
        return _key("Normals", [(color, f"to {word}") for color, word in DIRECTIONS], "each direction has its colour")
    return _brightness(source(p))


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
def _bar(cloud: Cloud, kind: str) -> Pane:
    """How many points have each value, in its colour, with the values from and to which the colours go."""
    low, high = span(cloud, kind)
    values = np.clip(measured(cloud, kind), low, high)
    counts, _ = np.histogram(values, BINS, (low, high))
    bars = _bars(counts, colors.ramp(kind)[np.linspace(0, 255, BINS).astype(int)])
    ticks = _words(*(quantity(low + (high - low) * f, UNITS[kind], 2) for f in (0.0, 0.5, 1.0)))
    note = f"from {figure(low, 2)} to {quantity(high, UNITS[kind], 2)}"
    return _pane(NAMES[kind], note, bars + ticks, HEIGHT)


@lru_cache(maxsize=64)
def _brightness(cloud: Cloud) -> Pane:
    """How many points are how bright, and the mean colour of those."""
    assert cloud.colors is not None
    level = np.minimum(cloud.colors.max(axis=1).astype(np.intp) * BINS // 256, BINS - 1)
    counts = np.bincount(level, minlength=BINS)
    means = np.stack([np.bincount(level, c, BINS) for c in cloud.colors.T.astype(float)], axis=1)
    bars = _bars(counts, np.rint(means / np.maximum(counts, 1)[:, None]).astype(np.uint8))
    return _pane("Measured colour", "by brightness", bars + _words("dark", "", "bright"), HEIGHT)


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
