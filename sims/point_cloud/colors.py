"""Colours of points: ramps for numbers, directions as colours, and the way past the browser's film curve."""

from __future__ import annotations

from functools import cache

import numpy as np
import numpy.typing as npt

from geometry.arrays import Array
from sims.kit.palette import before_film, rgb
from sims.point_cloud.cloud import Colors

RAMPS = {
    "height": ("#3b2a86", "#31629e", "#21918c", "#4fb562", "#c9c61f"),
    "intensity": ("#2d1a52", "#7a2080", "#c43c6b", "#ee7a45", "#f0c34e"),
    "variation": ("#1f3b73", "#4a5a80", "#7c7a76", "#aa9d5c", "#dcc23e"),
}
"""From low to high, darker to lighter, so that they are told apart without hue and on both pages."""
CLUSTERS = (
    "#0b5fd7",
    "#d1642f",
    "#1a9a5f",
    "#b23fb5",
    "#8a7a00",
    "#0d9aa8",
    "#d1345b",
    "#5a6fe0",
    "#6f9a1f",
    "#a0522d",
)
GREY = (140, 147, 155)
_STEPS = 256


@cache
def ramp(kind: str) -> Colors:
    """Colours (256, 3) as they are to be seen, from low to high."""
    stops = np.array([rgb(text) for text in RAMPS[kind]], dtype=float)
    at = np.linspace(0.0, len(stops) - 1.0, _STEPS)
    columns = [np.interp(at, np.arange(len(stops)), column) for column in stops.T]
    return np.asarray(np.rint(np.stack(columns, axis=1)).astype(np.uint8))


@cache
def _sent_ramp(kind: str) -> Colors:
    return before_film(ramp(kind))


def of_values(values: Array, span: tuple[float, float], kind: str, bright: Array | None = None) -> Colors:
    """Colours to send (N, 3) for numbers (N,); beyond the span they stay at its ends, and what is NaN is grey.

    `bright` (N,) darkens them.
    """
    low, high = span
    place = np.clip((values - low) * ((_STEPS - 1) / (high - low)), 0.0, _STEPS - 1.0)
    unknown = np.isnan(place)
    at = np.rint(np.where(unknown, 0.0, place)).astype(np.intp)
    sent = _sent_ramp(kind)[at] if bright is None else of_rgb(darkened(ramp(kind)[at], bright))
    sent[unknown] = of_rgb(np.array([GREY], np.uint8))[0]
    return np.asarray(sent)


def darkened(colors: Colors, bright: Array | None) -> Colors:
    """Colours (N, 3) times how bright (N,) they are, 0 to 1; themselves where that isn't known."""
    return colors if bright is None else np.rint(colors * bright[:, None]).astype(np.uint8)


def of_directions(normals: Array) -> Colors:
    """Colours to send for unit vectors (N, 3): x, y and z as red, green and blue; grey where there is none."""
    shown = np.rint(127.5 * (normals + 1.0)).astype(np.uint8)
    shown[~normals.any(axis=1)] = GREY
    return of_rgb(shown)


def of_rgb(colors: Colors) -> Colors:
    """Colours to send (N, 3) so that the browser shows these; to 1 part in 64, of which each is worked out once."""
    key = colors.astype(np.int64) >> 2
    return np.asarray(_table()[(key[:, 0] << 12) | (key[:, 1] << 6) | key[:, 2]])


@cache
def _table() -> Colors:
    """For each of 64³ colours what to send."""
    level = np.rint(np.arange(64) * (255.0 / 63.0))
    return before_film(np.stack(np.meshgrid(level, level, level, indexing="ij"), axis=-1).reshape(-1, 3))


def shaded(color: tuple[int, int, int], measured: Colors | None, count: int) -> Colors:
    """One colour, to send, for a number of points; as bright as they were measured, so that shapes stay visible."""
    if measured is None or not count:
        return np.broadcast_to(of_rgb(np.array([color], np.uint8))[0], (count, 3)).copy()
    light = measured.max(axis=1, keepdims=True) / 255.0
    return of_rgb(np.rint(np.array(color) * (0.35 + 0.65 * light)).astype(np.uint8))


def of_clusters(labels: npt.NDArray[np.intp]) -> Colors:
    """Colours to send for numbers of clusters (N,), from 0."""
    chosen = before_film(np.array([rgb(text) for text in CLUSTERS], dtype=float))
    return chosen[labels % len(CLUSTERS)]
