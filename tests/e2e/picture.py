"""A screenshot of the scene, and where on it a place in the world is, by the camera that the page told the server."""

from __future__ import annotations

import colorsys
import io

import numpy as np
import numpy.typing as npt
from PIL import Image
from playwright.sync_api import Page

from sims.kit.palette import LIGHT, Palette, rgb
from tests.e2e.learner import Learner, box, project

Array = npt.NDArray[np.float64]
GREY = 0.25
"""Colours less saturated than this have no hue that counts."""
ALIKE = 25.0
"""Degrees within which a hue is taken for a colour of the palette: light and shade move it."""


class Picture:
    """What a learner sees of the scene."""

    def __init__(self, learner: Learner, palette: Palette = LIGHT) -> None:
        self._canvas = box(learner.frame.locator("canvas[data-engine]"))
        self._camera = dict(learner.sockets.camera)
        self._palette = palette
        self._pixels = screenshot(learner.page)

    def place(self, world: npt.ArrayLike) -> tuple[float, float]:
        """Pixel on the page where a point of the world is."""
        return project(world, self._camera, self._canvas)

    def shows(self, role: str, world: npt.ArrayLike, *, within: int = 3) -> bool:
        """Whether a colour of the palette is at a place in the world, or within a few pixels of it."""
        return any(self._alike(role, pixel) for pixel in self.patch(world, within))

    def patch(self, world: npt.ArrayLike, within: int) -> npt.NDArray[np.uint8]:
        """The pixels (n, 3) at most so far, across and down, from a place in the world."""
        x, y = self.place(world)
        row, column = round(y), round(x)
        return self._pixels[row - within : row + within + 1, column - within : column + within + 1].reshape(-1, 3)

    def around(self, world: npt.ArrayLike) -> str:
        """For a failed test: the place and the colour that is there."""
        x, y = self.place(world)
        return f"at pixel {x:.0f}, {y:.0f} the colour is {self._pixels[round(y), round(x)].tolist()}"

    def _alike(self, role: str, pixel: npt.NDArray[np.uint8]) -> bool:
        wanted, _, _ = _hsv(rgb(getattr(self._palette, role)))
        hue, saturation, _ = _hsv(pixel.tolist())
        gap = abs(hue - wanted) % 360.0
        return saturation > GREY and min(gap, 360.0 - gap) < ALIKE


def screenshot(page: Page) -> npt.NDArray[np.uint8]:
    """The page as seen, (height, width, 3)."""
    png = page.screenshot(scale="css")
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"))


def _hsv(color: tuple[int, int, int] | list[int]) -> tuple[float, float, float]:
    red, green, blue = (v / 255 for v in color)
    hue, saturation, value = colorsys.rgb_to_hsv(red, green, blue)
    return 360.0 * hue, saturation, value
