"""The colours of scenes and image panes. `static/tokens.css` holds the same names for the pages."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

RGB = tuple[int, int, int]


def rgb(text: str) -> RGB:
    """Red, green, blue, 0–255, of #rrggbb."""
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)


@lru_cache(maxsize=256)
def before_tone_mapping(text: str, *, linear: bool = False) -> RGB:
    """The colour to send so that the browser shows #rrggbb.

    viser's renderer applies three.js's filmic curve to everything; this is its inverse. Colours of lines
    and arrows are taken as linear light there (`linear`), those of meshes as sRGB. Source: Hill's ACES fit, as in
    three.js.
    """
    light = _to_light(np.array(rgb(text)))
    for dimmed in np.linspace(1.0, 0.5, 101):  # the curve can't show the brightest colours: keep the hue
        sent = _before_film(dimmed * light)
        if np.all(sent <= 1.0):
            break
    sent = np.clip(sent, 0.0, 1.0)
    red, green, blue = np.rint(255.0 * sent if linear else _to_srgb(sent)).astype(int).tolist()
    return red, green, blue


def before_film(shown: npt.ArrayLike) -> npt.NDArray[np.uint8]:
    """As `before_tone_mapping`, of many colours (N, 3), 0–255, at once: for the points of a cloud."""
    light = _to_light(np.asarray(shown))
    sent = _before_film(light.T).T
    for _ in range(60):
        rows = np.flatnonzero(sent.max(axis=1) > 1.0)
        if not len(rows):
            break
        light[rows] *= 0.98
        sent[rows] = _before_film(light[rows].T).T
    return np.rint(_to_srgb(np.clip(sent, 0.0, 1.0))).astype(np.uint8)


def _to_light(shown: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Linear light, 0–1, of sRGB values 0–255. Source: IEC 61966-2-1, as in the next one."""
    share = shown / 255.0
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def _to_srgb(light: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return 255.0 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def _before_film(light: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    y = np.clip(np.linalg.solve(_FROM_FILM, light), 0.0, 1.0)
    a, b, c = 1.0 - 0.983729 * y, 0.0245786 - 0.4329510 * y, -0.000090537 - 0.238081 * y
    film = (-b + np.sqrt(b * b - 4.0 * a * c)) / (2.0 * a)
    sent: npt.NDArray[np.float64] = 0.6 * np.linalg.solve(_TO_FILM, film)
    return sent


_TO_FILM: npt.NDArray[np.float64] = np.array(
    [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]]
)
_FROM_FILM: npt.NDArray[np.float64] = np.array(
    [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]]
)


FAINT = 0.3
"""Share of its own colour in a faint one."""


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

    @property
    def solid(self) -> RGB:
        """What to send for a body that has no role: the grey of things."""
        return (96, 108, 122) if self.dark else (201, 208, 216)

    def surface(self, role: str) -> RGB:
        """What to send for a mesh of a role, so that it shows in the role's colour."""
        return before_tone_mapping(getattr(self, role))

    def line(self, role: str) -> RGB:
        """What to send for lines and arrows of a role, so that they show in the role's colour."""
        return before_tone_mapping(getattr(self, role), linear=True)

    def faint(self, role: str) -> RGB:
        """The same for lines that are only there to measure by: their colour is mostly the page's."""
        mixed = [FAINT * a + (1.0 - FAINT) * b for a, b in zip(rgb(getattr(self, role)), rgb(self.page), strict=True)]
        return before_tone_mapping("#{:02x}{:02x}{:02x}".format(*map(round, mixed)), linear=True)


LIGHT = Palette(
    x="#d1242f", y="#1a7f37", z="#0b5fd7", held="#b35900", left="#8250df", right="#0b7285",
    ghost="#6e7781", warn="#d1242f", ink="#1f2328", page="#ffffff", dark=False,
)  # fmt: skip
DARK = Palette(
    x="#ff6b6b", y="#4ac26b", z="#6cb0ff", held="#ffb454", left="#c297ff", right="#4dd0e1",
    ghost="#9aa4af", warn="#ff6b6b", ink="#e6edf3", page="#15191f", dark=True,
)  # fmt: skip
AXES = ("x", "y", "z")
DASHES: dict[str, tuple[float, float] | None] = {"x": None, "y": (0.12, 0.05), "z": (0.05, 0.05)}
"""The axes' second cue: metres on and off."""
