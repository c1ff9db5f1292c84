"""How sure a triangulated point is: by first-order propagation of pixel noise, and by drawing noisy samples."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ..arrays import Array, components, stack
from ..camera import Camera
from ..errors import GeometryError, as_array, as_number
from .optimal import triangulate_optimal

_SINGULAR = 1e-12  # ratio of singular values: about the parallax below which rays count as parallel


def projection_jacobian(camera: Camera, points: npt.ArrayLike) -> Array:
    """Return the derivatives (..., 2, 3) of the pixel by the world point (..., 3), in pixels per metre.

    NaN where the point isn't in front of the camera.
    Source: Hartley and Zisserman 2004, sec. A6.3, for the pinhole camera.
    """
    x, y, z = components(camera.to_camera(points))
    z = np.where(np.asarray(z) > 0.0, z, np.nan)
    (fx, skew, _), (_, fy, _), _ = camera.K.tolist()
    u_row = stack(fx / z, skew / z, -(fx * x + skew * y) / z**2)
    v_row = stack(0.0 * z, fy / z, -fy * y / z**2)
    return np.stack([u_row, v_row], axis=-2) @ camera.R


def covariance(cameras: Sequence[Camera], point: npt.ArrayLike, sigma_px: float) -> Array:
    """Return the covariance (..., 3, 3) in m² of points (..., 3) seen by the cameras: (Jᵀ Σ⁻¹ J)⁻¹, Σ = σ² I.

    For the best estimator, and independent noise of sigma_px pixels in each coordinate of each pixel.
    NaN where a point isn't in front of all cameras, or they don't determine it (zero baseline, parallel rays).
    Raises GeometryError without cameras, or unless sigma_px is above 0.
    Source: Hartley and Zisserman 2004, result 5.10.
    """
    sigma = as_number("sigma_px", sigma_px, above=0.0)
    if not cameras:
        raise GeometryError("cameras", cameras, "one camera or more")
    points = as_array("point", point, 3)
    J = np.concatenate([projection_jacobian(camera, points) for camera in cameras], axis=-2)
    known = np.isfinite(J).all(axis=(-2, -1))[..., None, None]
    _, singular, Vt = np.linalg.svd(
        np.where(known, J, 0.0), full_matrices=False
    )  # JᵀJ would square the conditioning
    known = known & (singular[..., -1:, None] > _SINGULAR * singular[..., :1, None])
    half = Vt * (sigma / np.where(known[..., 0], singular, np.nan))[..., None]
    return np.asarray(half.swapaxes(-1, -2) @ half)


def ellipsoid_axes(covariance: npt.ArrayLike) -> tuple[Array, Array]:
    """Return the 1σ lengths (..., 3), longest first, and the directions (..., 3, 3) of covariances (..., 3, 3).

    The columns of the directions are unit vectors of a right-handed frame. NaN where the covariance isn't finite.
    Source: Hartley and Zisserman 2004, sec. A6.4.
    """
    C = as_array("covariance", covariance, 3, 3)
    known = np.isfinite(C).all(axis=(-2, -1))[..., None]
    variances, axes = np.linalg.eigh(np.where(known[..., None], C, 0.0))
    axes = axes[..., ::-1] * np.sign(np.linalg.det(axes[..., ::-1]))[..., None, None]
    lengths = np.sqrt(np.maximum(variances[..., ::-1], 0.0))
    return np.where(known, lengths, np.nan), np.where(known[..., None], axes, np.nan)


def pixel_noise(count: int, seed: int) -> Array:
    """Return standard normal noise (count, 2, 2) for the left and the right pixel of `count` pairs.

    The same seed gives the same noise; scaled by σ it moves smoothly with σ.
    """
    return np.random.default_rng(seed).standard_normal((count, 2, 2))


def monte_carlo(
    left: Camera,
    right: Camera,
    uv_left: npt.ArrayLike,
    uv_right: npt.ArrayLike,
    sigma: float,
    count: int,
    seed: int,
) -> Array:
    """Return `count` points (count, 3) by the optimal method from one pair of pixels (2,) with seeded Gaussian noise.

    NaN where a sample has no point. Raises GeometryError at zero baseline, or for a sigma below 0.
    """
    noise = as_number("sigma", sigma, least=0.0) * pixel_noise(count, seed)
    pixels_left = as_array("uv_left", uv_left, 2) + noise[:, 0]
    pixels_right = as_array("uv_right", uv_right, 2) + noise[:, 1]
    return triangulate_optimal(left, right, pixels_left, pixels_right).point
