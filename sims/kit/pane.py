"""Image panes: SVG pictures in pixel coordinates, with handles that pointer and keyboard can drag.

A picture is drawn from the same Solution as the scene. Coordinates are pixels: x right, y down, integer
pixel centres, so the picture's edge runs from -0.5 to width - 0.5.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from html import escape

from sims.kit.frame import Point, across, border, inside

safe = lru_cache(maxsize=1024)(escape)
"""`escape` for words that come again in each picture."""
Outline = Sequence[tuple[float, float]]
"""Corners of a polygon."""
GRAB = 44.0
"""Pixels round a handle in which it can be taken."""


@dataclass(frozen=True)
class Pane:
    """One picture or plot: its name, a title that people see, the SVG, and what is said beside the title."""

    name: str
    title: str
    svg: str
    note: str = ""
    wide: bool = False
    """It takes the whole width where pictures stand side by side."""
    large: bool = False
    """It is what the sim is about: the column makes room for it, and the read-outs stand under it, by the controls."""
    line: str = ""
    """HTML of a read-out that stands over it."""


class Picture:
    """Collects SVG in pixel coordinates; what is outside the frame is clipped."""

    def __init__(self, name: str, title: str, width: int = 640, height: int = 480) -> None:
        self.name, self.title = name, title
        self.width, self.height = width, height
        self._parts: list[str] = []
        self._over: list[str] = []
        self._points: list[tuple[float, float, str]] = []
        self._handles: list[tuple[float, float, str]] = []
        self._ground = 'class="s3-frame"'

    def line(
        self, a: Point, b: Point, role: str, *, width: float = 2, dash: str = "", css: str = "", link: str = ""
    ) -> None:
        """A straight stroke; `dash` as in SVG, `role` a colour of the palette. It is highlighted where `link` is."""
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        self._parts.append(
            f'<line x1="{a[0]:.2f}" y1="{a[1]:.2f}" x2="{b[0]:.2f}" y2="{b[1]:.2f}" stroke="var(--{role})"'
            f' stroke-width="{width}"{dashed}{css}{_linked(link)} vector-effect="non-scaling-stroke"/>'
        )

    def curve(self, points: Iterable[Point], role: str, *, width: float = 2) -> None:
        """A stroke through points."""
        path = "L".join([f"{x:.1f} {y:.1f}" for x, y in points])
        self._parts.append(
            f'<path d="M{path}" fill="none" stroke="var(--{role})" stroke-width="{width}"'
            ' stroke-linejoin="round" vector-effect="non-scaling-stroke"/>'
        )

    def strokes(
        self, pieces: Iterable[tuple[float, float, float, float]], role: str, *, width: float = 2, dash: str = ""
    ) -> None:
        """Many straight strokes (x, y, x', y') of one kind; cheaper than one by one."""
        if drawn := "".join([f"M{a:.2f} {b:.2f}L{c:.2f} {d:.2f}" for a, b, c, d in pieces]):
            dashed = f' stroke-dasharray="{dash}"' if dash else ""
            self._parts.append(
                f'<path d="{drawn}" fill="none" stroke="var(--{role})" stroke-width="{width}"{dashed}'
                ' vector-effect="non-scaling-stroke"/>'
            )

    def areas(self, painted: Iterable[tuple[str, Iterable[Outline]]], *, edges: bool = True) -> None:
        """Filled polygons, each over those before it: a colour of CSS, and outlines that have it."""
        drawn = "".join([f'<path fill="{fill}" d="{"".join(map(_outline, outlines))}"/>' for fill, outlines in painted])
        stroke = ' class="s3-faces"' if edges else ""
        self._parts.append(f"<g{stroke}>{drawn}</g>" if drawn else "")

    def homogeneous_line(self, line: Point, role: str, *, width: float = 2, dash: str = "", link: str = "") -> None:
        """The line a x + b y + c = 0 across the whole picture."""
        ends = across(line, self.width, self.height)
        if ends:
            self.line(ends[0], ends[1], role, width=width, dash=dash, link=link)

    def arrow(self, a: Point, b: Point, role: str, *, width: float = 2) -> None:
        """A vector from a to b."""
        self.line(a, b, role, width=width, css=f' marker-end="url(#{self.name}-tip)"')

    def cross(self, at: Point, role: str, size: float = 9, *, link: str = "") -> None:
        """An × mark."""
        x, y = at[0], at[1]
        self.line((x - size, y - size), (x + size, y + size), role, width=2.5, link=link)
        self.line((x - size, y + size), (x + size, y - size), role, width=2.5, link=link)

    def dot(self, at: Point, role: str, radius: float = 6, *, hollow: bool = False) -> None:
        """A round mark; hollow to show what is behind it."""
        fill = "none" if hollow else f"var(--{role})"
        kind = "s3-hollow" if hollow else "s3-dot"
        self._parts.append(
            f'<circle class="{kind}" cx="{at[0]:.2f}" cy="{at[1]:.2f}" r="{radius}" fill="{fill}"'
            f' stroke="var(--{role})" stroke-width="2" vector-effect="non-scaling-stroke"/>'
        )

    def text(
        self, at: Point, words: str, role: str = "ink", *, anchor: str = "start", size: float = 26, fine: bool = False
    ) -> None:
        """Words, outlined in the page's colour so that they stay readable over lines; `fine` ones go in small panes."""
        kind = "s3-halo s3-fine" if fine else "s3-halo"
        self._over.append(
            f'<text x="{at[0]:.2f}" y="{at[1]:.2f}" fill="var(--{role})" font-size="{size}" text-anchor="{anchor}"'
            f' class="{kind}">{escape(words)}</text>'
        )

    def pickable(self, name: str, label: str) -> None:
        """Let people choose a place by a click, or Enter: the session hears of it as of a handle of that name."""
        self._ground = (
            f'class="s3-frame" data-pick="{name}" tabindex="0" role="button" aria-label="{escape(label)}:'
            ' click a place, or press Enter for the middle."'
        )

    def handle(
        self, name: str, at: Point, label: str, letter: str, *, where: str = "", link: str = "",
        corner: tuple[int, int] = (1, -1),
    ) -> None:  # fmt: skip
        """A point that pointer and keyboard can move; the session hears of it under `name`.

        `where` says its place where that isn't the pixel. It is highlighted with what else `link` is, and a click on it
        selects that. Its letter stands at a `corner`: to the right (1) or left (-1), below (1) or above (-1).
        """
        right, down = corner
        anchor = ' text-anchor="end"' if right < 0 else ""
        x, y = float(at[0]), float(at[1])
        mark = (
            f'<circle class="s3-grab" r="{GRAB:g}"/><circle class="s3-ring" r="15"/><circle class="s3-core" r="5"/>'
            f'<text x="{22 * right}" y="{-18 if down < 0 else 38}"{anchor} class="s3-halo" fill="var(--held)"'
            f' font-size="28">{escape(letter)}</text>'
        )
        self._handles.append((x, y, held(name, (x, y), f"{label}: {where or f'{x:.1f}, {y:.1f} pixels'}", mark, link)))

    def shows(self, at: Point) -> bool:
        """Whether a place is inside the frame."""
        return inside(at[0], at[1], self.width, self.height)

    def point(
        self, link: str, at: Point, title: str, role: str = "ink", *, chosen: bool = False, label: str = "",
        quiet: bool = False,
    ) -> None:  # fmt: skip
        """A named point: where else `link` stands (table, other pictures) is highlighted too, and a click selects it.

        A quiet one is only seen while it is highlighted.
        """
        kind = "s3-point s3-selected" if chosen else "s3-point s3-quiet" if quiet else "s3-point"
        ring = '<circle class="s3-ring" r="13"/>' if chosen else ""
        side, anchor = (-18, "end") if at[0] > 0.6 * self.width else (18, "start")
        words = (
            f'<text x="{side}" y="-14" text-anchor="{anchor}" class="s3-halo" fill="var(--held)">{safe(label)}</text>'
            if label
            else ""
        )
        drawn = (
            f'<g data-link="{safe(link)}" class="{kind}" transform="translate({at[0]:.2f} {at[1]:.2f})">'
            f'<title>{safe(title)}</title><circle class="s3-reach" r="16"/>{ring}'
            f'<circle class="s3-spot" r="7" fill="var(--{"held" if chosen else role})"/>{words}</g>'
        )
        self._points.append((at[0], at[1], drawn))

    def outside(
        self, point: Point, role: str, words: str, *, link: str = "", title: str = "", chosen: bool = False
    ) -> None:
        """An arrowhead at the border towards a homogeneous point (x, y, w) that isn't in the picture.

        At infinity (w = 0) it is a double one, and the words end in the sign for infinity.
        """
        if (found := border(point, self.width, self.height)) is None:
            return
        (x, y), (dx, dy) = found
        far = point[2] == 0.0
        head = "M-11 -9L5 0L-11 9z" + ("M-23 -9L-7 0L-23 9z" if far else "")
        anchor = "end" if dx > 0.4 else "start" if dx < -0.4 else "middle"
        beside = 36.0 if chosen or y < 60.0 else -16.0
        down = 9.0 - (44.0 if far else 32.0) * dy if anchor == "middle" else beside
        text = (
            f'<text x="0" y="{down:.1f}" text-anchor="{anchor}" class="s3-halo"'
            f' fill="var(--{role})">{safe(words)}{" ∞" if far else ""}</text>'
            if words
            else ""
        )
        kind = "s3-point s3-selected" if chosen else "s3-point"
        self._over.append(
            f'<g{_linked(link)} class="{kind}" transform="translate({x:.2f} {y:.2f})">'
            f"<title>{safe(title or words)}</title>"
            f'<path class="s3-spot" d="{head}" fill="var(--{role})"'
            f' transform="rotate({math.degrees(math.atan2(dy, dx)):.1f})"/>{text}</g>'
        )

    def copy(self) -> Picture:
        """Another picture that begins with what is in this one: for what stays the same from state to state."""
        other = Picture(self.name, self.title, self.width, self.height)
        other._parts, other._over, other._ground = [*self._parts], [*self._over], self._ground
        other._points, other._handles = [*self._points], [*self._handles]
        return other

    def pane(self, note: str = "", *, wide: bool = False, large: bool = False, line: str = "") -> Pane:
        """The finished picture."""
        w, h, name = self.width, self.height, escape(self.name)
        frame = f'<rect x="-0.5" y="-0.5" width="{w}" height="{h}" {self._ground}/>'
        tip = (
            f'<marker id="{name}-tip" viewBox="0 0 10 10" refX="8" refY="5" markerWidth="5" markerHeight="5"'
            ' orient="auto-start-reverse"><path d="M0 0L10 5L0 10z" fill="context-stroke"/></marker>'
        )
        clip = f'<clipPath id="{name}-clip"><rect x="-0.5" y="-0.5" width="{w}" height="{h}"/></clipPath>'
        svg = (
            f'<svg data-pane="{name}" viewBox="-0.5 -0.5 {w} {h}" role="group" aria-label="{escape(self.title)}">'
            f'<defs>{tip}{clip}</defs>{frame}<g clip-path="url(#{name}-clip)">{"".join(self._parts)}</g>'
            f"{''.join(self._over)}{''.join(self._reachable())}</svg>"
        )
        return Pane(self.name, self.title, svg, note, wide, large, line)

    def _reachable(self) -> list[str]:
        """Points and handles: a handle goes over what is so near that the pointer may mean it, and under the rest."""
        near, far = [], self._points
        for u, v, _ in self._handles:
            near += [point for point in far if abs(point[0] - u) < GRAB > abs(point[1] - v)]
            far = [point for point in far if abs(point[0] - u) >= GRAB or abs(point[1] - v) >= GRAB]
        return [drawn for *_, drawn in (*near, *self._handles, *far)]


def _outline(corners: Outline) -> str:
    return f"M{'L'.join(['%.1f %.1f' % (u, v) for u, v in corners])}z"  # noqa: UP031 — half the time of an f-string


def held(name: str, at: tuple[float, float], says: str, mark: str, link: str = "") -> str:
    """A mark, drawn round the origin, that pointer and keyboard move from where it is; `says` what it is, and where."""
    x, y = at
    return (
        f'<g data-handle="{name}"{_linked(link)} data-x="{x!r}" data-y="{y!r}" tabindex="0"'
        f' role="application" aria-roledescription="movable point" aria-label="{escape(says)}.'
        f' Arrow keys move it." transform="translate({x:.3f} {y:.3f})">{mark}</g>'
    )


def _linked(link: str) -> str:
    return f' data-link="{safe(link)}"' if link else ""


def figure(pane: Pane) -> str:
    """Where a pane goes."""
    kind = "s3-pane" + " s3-wide" * pane.wide + " s3-large" * pane.large
    return f'<figure class="{kind}" data-part="pane:{escape(pane.name)}"></figure>'


def still(pane: Pane) -> str:
    """Its picture with the line over it, for a page on which nothing can be held: marks are said as places."""
    svg = re.sub(r' (data-(handle|pick)|tabindex|aria-roledescription)="[^"]*"', "", pane.svg)
    return pane.line + (
        svg.replace('role="application"', 'role="img"')
        .replace('role="button"', 'role="img"')
        .replace(" Arrow keys move it.", "")
    )


def content(pane: Pane) -> str:
    """What is in its frame."""
    title = safe(pane.title)
    larger = f'<button type="button" data-s3="enlarge" aria-label="{title}: larger" title="Large or small">⤢</button>'
    note = f"<span> {escape(pane.note)}</span>"
    return f"<figcaption><b>{title}{note}</b>{larger}</figcaption>{pane.line}{pane.svg}"
