"""Colours, intensities and normals on one scale each; one value that is out of range moves no other."""

from __future__ import annotations

import numpy as np

from geometry.arrays import Array
from sims.point_cloud.cloud import Colors
from sims.point_cloud.files.columns import Values, finite, floats

SCALES = {"as bytes": 1.0, "from 16 bits": 255.0 / 65535.0, "from 0–1": 255.0}


def colors_of(channels: list[Values], declared: bool) -> tuple[Colors, str]:
    """Colours (N, 3) as 0–255, and which scale they were on, in words: a key of `SCALES`.

    A declared type says the scale, but for 16 bits, which many programs fill with bytes.
    """
    rgb = np.stack([finite(c) for c in channels], axis=1)
    scale = _scale(channels[0].dtype, rgb, declared)
    return np.clip(np.rint(rgb * SCALES[scale]), 0.0, 255.0).astype(np.uint8), scale


def _scale(dtype: np.dtype[np.generic], rgb: Array, declared: bool) -> str:
    if declared and dtype.itemsize == 1:
        return "as bytes"
    usual = float(np.percentile(rgb, 99)) if len(rgb) else 0.0
    if usual <= 1.5 and (dtype.kind == "f" or not declared):
        return "from 0–1"
    return "as bytes" if usual <= 300.0 else "from 16 bits"


def intensity_of(values: Values) -> tuple[Array, tuple[float, float]]:
    """Intensities (N,) from 0 to 1, and the values that 0 and 1 stand for; NaN where there is none.

    What is from 0 to 1 stays. All else goes from 0, or the least of negative values, to the greatest, but for the
    outermost percents where they are so far off that they would leave the rest one shade.
    """
    raw = floats(values)
    raw[~np.isfinite(raw)] = np.nan
    given = raw[~np.isnan(raw)]
    if not len(given) or (given.min() >= 0.0 and given.max() <= 1.0):
        return raw, (0.0, 1.0)
    low, usual_low, usual_high, high = np.percentile(given, (0, 1, 99, 100)).tolist()
    reach = usual_high - usual_low
    low = 0.0 if low >= 0.0 else low if usual_low - low <= reach else usual_low
    high = high if high - usual_high <= 2.0 * reach or usual_high <= low else usual_high
    high = high if high > low else low + 1.0
    return np.clip((raw - low) / (high - low), 0.0, 1.0), (low, high)


def normals_of(components: list[Values]) -> Array | None:
    """Unit normals (N, 3), zero where the file has none; None where it has none at all."""
    vectors = np.stack([finite(c) for c in components], axis=1)
    lengths = np.linalg.norm(vectors, axis=1)
    vectors[lengths > 0.0] /= lengths[lengths > 0.0, None]
    return vectors if lengths.any() else None
