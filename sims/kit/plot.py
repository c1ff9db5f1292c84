"""Plots: one curve over two axes from zero, as crisp SVG in the theme's colours."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

from sims.kit.pane import Pane
from sims.kit.readout import figure

LEFT, TOP, RIGHT, BOTTOM = 44, 24, 14, 34


def step(greatest: float, most: int = 6) -> float:
    """A round distance between ticks (1, 2 or 5 times a power of ten) that gives `most` or fewer."""
    power = 10.0 ** math.floor(math.log10(greatest / most))
    return next(power * k for k in (1.0, 2.0, 5.0, 10.0) if power * k * most >= greatest * (1.0 - 1e-9))


def ticks(greatest: float, most: int = 6) -> list[tuple[float, str]]:
    """Values of the ticks from 0 to `greatest`, with their words."""
    gap = step(greatest, most)
    digits = max(0, -math.floor(math.log10(gap) + 1e-9))
    return [(k * gap, figure(k * gap, digits)) for k in range(int(greatest / gap + 1e-9) + 1)]


class Plot:
    """Collects SVG over axes that run from 0 to `x_max` and `y_max`; what is beyond is clipped."""

    def __init__(
        self, name: str, title: str, *, x: str, y: str, x_max: float, y_max: float, width: int = 320, height: int = 160
    ) -> None:
        self.name, self.title, self.x, self.y = name, title, x, y
        self.x_max, self.y_max = x_max, y_max
        self.width, self.height = width, height
        self._parts: list[str] = []
        self._over: list[str] = []
        self._words = title

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Where a value is in the picture."""
        across = LEFT + (self.width - LEFT - RIGHT) * x / self.x_max
        return across, TOP + (self.height - TOP - BOTTOM) * (1.0 - y / self.y_max)

    def curve(self, points: Sequence[tuple[float, float]], words: str, *, ghost: bool = False) -> None:
        """A rising line through points, named where it leaves the picture; a ghost for what could be instead."""
        path = "L".join(f"{u:.1f} {v:.1f}" for u, v in (self.at(x, y) for x, y in points))
        self._parts.append(f'<path d="M{path}" class="{"s3-ghost" if ghost else "s3-curve"}"/>')
        u, v = self.at(*[point for point in points if point[1] <= self.y_max][-1])
        self._over.append(
            f'<text x="{u - 6:.1f}" y="{v + 4:.1f}" text-anchor="end" class="s3-halo">{escape(words)}</text>'
        )

    def mark(self, x: float, y: float, words: str, role: str = "held") -> None:
        """A point of the curve with strokes to both axes; the words are for people who listen."""
        u, v = self.at(x, y)
        floor = self.height - BOTTOM
        self._parts.append(f'<path d="M{LEFT} {v:.1f}H{u:.1f}V{floor}" class="s3-guide"/>')
        self._over.append(f'<circle cx="{u:.1f}" cy="{v:.1f}" r="4.5" fill="var(--{role})"/>')
        self._words = f"{self.title}: {words}"

    def pane(self, note: str = "") -> Pane:
        """The finished plot."""
        w, h, name = self.width, self.height, escape(self.name)
        floor, end = h - BOTTOM, w - RIGHT
        inside = f'<rect x="{LEFT}" y="{TOP}" width="{end - LEFT}" height="{floor - TOP}"/>'
        svg = (
            f'<svg class="s3-plot" viewBox="0 0 {w} {h}" role="img" aria-label="{escape(self._words)}">'
            f'<defs><clipPath id="{name}-clip">{inside}</clipPath></defs>{self._grid()}'
            f'<g clip-path="url(#{name}-clip)">{"".join(self._parts)}</g>'
            f'<path d="M{LEFT} {TOP}V{floor}H{end}" class="s3-axis"/>'
            f'<text x="{end}" y="{h - 4}" text-anchor="end">{escape(self.x)}</text>'
            f'<text x="4" y="14">{escape(self.y)}</text>{"".join(self._over)}</svg>'
        )
        return Pane(self.name, self.title, svg, note, wide=True)

    def _grid(self) -> str:
        lines, words = [], []
        for value, text in ticks(self.x_max):
            u, _ = self.at(value, 0.0)
            lines.append(f"M{u:.1f} {TOP}V{self.height - BOTTOM}")
            words.append(f'<text x="{u:.1f}" y="{self.height - BOTTOM + 14}" text-anchor="middle">{text}</text>')
        for value, text in ticks(self.y_max, 4):
            _, v = self.at(0.0, value)
            lines.append(f"M{LEFT} {v:.1f}H{self.width - RIGHT}")
            words.append(f'<text x="{LEFT - 5}" y="{v + 4:.1f}" text-anchor="end">{text}</text>')
        return f'<path d="{"".join(lines)}" class="s3-grid"/>{"".join(words)}'


def room(value: float, spare: float) -> float:
    """A round end (1, 2 or 5 times a power of ten) for an axis that leaves a value some room."""
    return step(value * spare, 1)
