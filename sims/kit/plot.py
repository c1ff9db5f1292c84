"""Plots: one curve over two axes from zero, as crisp SVG in the theme's colours."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from html import escape

from sims.kit.pane import Pane, held
from sims.kit.readout import figure

WIDTH, HEIGHT = 320, 160
LEFT, TOP, END, FLOOR = 44, 24, 306, 126
"""Ends of the axes, in the picture."""
GRIP = '<circle class="s3-grab" r="24"/><circle class="s3-ring" r="9"/><circle class="s3-core" r="4"/>'


def step(greatest: float, most: int = 6) -> float:
    """A round distance between ticks (1, 2 or 5 times a power of ten) that gives `most` or fewer."""
    power = 10.0 ** math.floor(math.log10(greatest / most))
    return next(power * k for k in (1.0, 2.0, 5.0, 10.0) if power * k * most >= greatest * (1.0 - 1e-9))


def ticks(greatest: float, most: int = 6, gap: float | None = None) -> list[tuple[float, str]]:
    """Values of the ticks from 0 to `greatest`, with their words."""
    gap = gap or step(greatest, most)
    digits = max(0, -math.floor(math.log10(gap) + 1e-9))
    return [(k * gap, figure(k * gap, digits)) for k in range(int(greatest / gap + 1e-9) + 1)]


class Plot:
    """Collects curves over axes that run from 0 to `x_max` and `y_max`; what is beyond is clipped."""

    def __init__(
        self, name: str, title: str, *, x: str, y: str, x_max: float, y_max: float, x_step: float | None = None
    ) -> None:
        """`x_step`: distance between ticks, where a round one isn't wanted (angles)."""
        self.name, self.title, self.x, self.y = name, title, x, y
        self.x_max, self.y_max, self.x_step = x_max, y_max, x_step
        self._curves: list[str] = []
        self._words: list[str] = []

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Where a value is in the picture."""
        return LEFT + (END - LEFT) * x / self.x_max, FLOOR - (FLOOR - TOP) * y / self.y_max

    def curve(self, points: Sequence[tuple[float, float]], words: str, *, ghost: bool = False) -> None:
        """A rising line through points, named where it leaves the picture; a ghost for what could be instead."""
        path = "L".join(f"{u:.1f} {v:.1f}" for u, v in (self.at(x, y) for x, y in points))
        self._curves.append(f'<path d="M{path}" class="{"s3-ghost" if ghost else "s3-curve"}"/>')
        u, v = self.at(*[point for point in points if point[1] <= self.y_max][-1])
        self._words.append(
            f'<text x="{u - 6:.1f}" y="{v + 4:.1f}" text-anchor="end" class="s3-halo">{escape(words)}</text>'
        )

    @cached_property
    def _drawn(self) -> str:
        """Everything but the mark; later curves aren't in it."""
        name = escape(self.name)
        inside = f'<rect x="{LEFT}" y="{TOP}" width="{END - LEFT}" height="{FLOOR - TOP}"/>'
        return (
            f'<defs><clipPath id="{name}-clip">{inside}</clipPath></defs>{self._grid()}'
            f'<g clip-path="url(#{name}-clip)">{"".join(self._curves)}</g>'
            f'<path d="M{LEFT} {TOP}V{FLOOR}H{END}" class="s3-axis"/>'
            f'<text x="{END}" y="{HEIGHT - 4}" text-anchor="end">{escape(self.x)}</text>'
            f'<text x="4" y="14">{escape(self.y)}</text>{"".join(self._words)}'
        )

    def pane(
        self, note: str = "", mark: tuple[float, float] | None = None, *, handle: str = "", label: str = ""
    ) -> Pane:
        """The finished plot, with a point marked on it; the note says what and where it is.

        With the name of a `handle` the mark can be moved: the session hears of the values where it would be. `label`
        says what it is.
        """
        dot = ""
        if mark is not None:
            u, v = self.at(*mark)
            dot = f'<path d="M{LEFT} {v:.1f}H{u:.1f}V{FLOOR}" class="s3-guide"/>'
            dot += (
                held(handle, (u, v), f"{label}: {note}", GRIP)
                if handle
                else f'<circle cx="{u:.1f}" cy="{v:.1f}" r="4.5" class="s3-core"/>'
            )
        words = escape(f"{self.title}: {note}" if note else self.title)
        role = f'role="group" {self._axes()}' if handle else 'role="img"'
        frame = f'class="s3-plot" data-pane="{escape(self.name)}" viewBox="0 0 {WIDTH} {HEIGHT}" {role}'
        svg = f'<svg {frame} aria-label="{words}">{self._drawn}{dot}</svg>'
        return Pane(self.name, self.title, svg, note, wide=True)

    def _axes(self) -> str:
        """For the page: the values at the picture's corner, and how much of each a pixel is."""
        x, y = self.x_max / (END - LEFT), self.y_max / (FLOOR - TOP)
        return f'data-axes="{-LEFT * x!r} {x!r} {FLOOR * y!r} {-y!r}"'

    def _grid(self) -> str:
        lines, words = [], []
        for value, text in ticks(self.x_max, gap=self.x_step):
            u, _ = self.at(value, 0.0)
            lines.append(f"M{u:.1f} {TOP}V{FLOOR}")
            words.append(f'<text x="{u:.1f}" y="{FLOOR + 14}" text-anchor="middle">{text}</text>')
        for value, text in ticks(self.y_max, 4):
            _, v = self.at(0.0, value)
            lines.append(f"M{LEFT} {v:.1f}H{END}")
            words.append(f'<text x="{LEFT - 5}" y="{v + 4:.1f}" text-anchor="end">{text}</text>')
        return f'<path d="{"".join(lines)}" class="s3-grid"/>{"".join(words)}'


def room(value: float, spare: float) -> float:
    """A round end (1, 2 or 5 times a power of ten) for an axis that leaves a value some room; 1e-9 at least."""
    return step(max(value * spare, 1e-9), 1)
