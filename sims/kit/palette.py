"""The colours of scenes and image panes. `static/tokens.css` holds the same names for the pages."""

from __future__ import annotations

from dataclasses import dataclass, fields

RGB = tuple[int, int, int]


def _rgb(text: str) -> RGB:
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)


@dataclass(frozen=True)
class Palette:
    """One theme; each colour has a role, and each role a second cue besides its colour."""

    x: str
    y: str
    z: str
    held: str
    left: str
    right: str
    ghost: str
    warn: str
    ink: str
    page: str
    dark: bool

    def rgb(self, role: str) -> RGB:
        """Red, green, blue, 0–255, of a role."""
        return _rgb(getattr(self, role))

    def style(self) -> str:
        """CSS custom properties (`--x: #…`) for an image pane."""
        return ";".join(f"--{f.name}:{getattr(self, f.name)}" for f in fields(self) if f.name != "dark")


LIGHT = Palette(
    x="#d1242f", y="#1a7f37", z="#0b5fd7", held="#b35900", left="#8250df", right="#0b7285",
    ghost="#6e7781", warn="#d1242f", ink="#1f2328", page="#ffffff", dark=False,
)  # fmt: skip
DARK = Palette(
    x="#ff6b6b", y="#4ac26b", z="#6cb0ff", held="#ffb454", left="#c297ff", right="#4dd0e1",
    ghost="#9aa4af", warn="#ff6b6b", ink="#e6edf3", page="#15191f", dark=True,
)  # fmt: skip
AXES = ("x", "y", "z")
