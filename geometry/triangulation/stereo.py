"""Depth from disparity in a parallel rig, and how depth uncertainty grows."""

import numpy as np
import numpy.typing as npt

from ..arrays import Array
from ..errors import as_array, as_number


def disparity(uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> Array:
    """Return u_left − u_right (...) of pixels (..., 2): above 0 for points in front of a parallel rig."""
    return np.asarray(as_array("uv_left", uv_left, 2)[..., 0] - as_array("uv_right", uv_right, 2)[..., 0])


def depth_from_disparity(disparity: npt.ArrayLike, baseline: float, focal: float, doffs: float = 0.0) -> Array:
    """Return the depth Z = f b / (d + doffs) (...) in metres of a disparity d (...) in pixels.

    doffs is how much farther right the right principal point is, in pixels. NaN unless d + doffs is above 0, and where
    the depth is beyond all numbers.

    baseline in metres, focal in pixels, both above 0: GeometryError otherwise.
    Source: Szeliski 2022, "Computer Vision", eq. 12.1; with doffs, Scharstein et al. 2014, the calibration of their
    data sets.
    """
    d = as_array("disparity", disparity) + as_number("doffs", doffs)
    scale = as_number("focal", focal, above=0.0) * as_number("baseline", baseline, above=0.0)
    with np.errstate(over="ignore"):
        depth = scale / np.where(np.isfinite(d) & (d > 0.0), d, np.nan)
    return np.asarray(np.where(np.isinf(depth), np.nan, depth))


def depth_sigma(depth: npt.ArrayLike, baseline: float, focal: float, sigma: float) -> Array:
    """Return the standard deviation (...) in metres of the depth (...) of a point seen by a parallel rig.

    √2 σ Z² / (f b), for independent noise of sigma pixels in each coordinate of both pixels: the depth entry
    of `covariance`, exactly, and wherever the point is, since the two v tell no more than its height.
    NaN unless the depth is above 0. Raises GeometryError unless baseline, focal and sigma are above 0.
    Source: Hartley and Zisserman 2004, sec. 5.2.1, applied to Z = f b / d with σ_d = √2 σ.
    """
    Z = as_array("depth", depth)
    scale = as_number("focal", focal, above=0.0) * as_number("baseline", baseline, above=0.0)
    factor = np.sqrt(2.0) * as_number("sigma", sigma, above=0.0) / scale
    return np.asarray(factor * np.where(np.isfinite(Z) & (Z > 0.0), Z, np.nan) ** 2)
