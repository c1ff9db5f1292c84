"""How sure a triangulated point is: by propagation of pixel noise to first order, and by noisy samples."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ..arrays import Array, components, dot, if_positive, stack
from ..camera import Camera
from ..errors import GeometryError, as_array, as_number
from .optimal import triangulate_optimal

_SINGULAR = 1e-12  # ratio of singular values: about the parallax below which rays count as parallel


@np.errstate(invalid="ignore")
def projection_jacobian(camera: Camera, points: npt.ArrayLike) -> Array:
    """Return the derivatives (..., 2, 3) of the pixel by the world point (..., 3), in pixels per metre.

    NaN where the point isn't in front of the camera.
    Source: Hartley and Zisserman 2004, sec. 6.1, differentiated.
    """
    x, y, z = components(camera.to_camera(points))
    (fx, skew, _), (_, fy, _), _ = camera.K.tolist()
    w = 1.0 / if_positive(z)
    u, v = (fx * w, skew * w, -(fx * x + skew * y) * w * w), (0.0 * w, fy * w, -fy * y * w * w)
    rows = stack(*(dot(by_camera, axis) for by_camera in (u, v) for axis in camera.R.T.tolist()))
    return rows.reshape(*rows.shape[:-1], 2, 3)


def covariance(cameras: Sequence[Camera], point: npt.ArrayLike, sigma_px: float) -> Array:
    """Return the covariance (..., 3, 3) in m² of points (..., 3) seen by cameras: (Jᵀ Σ⁻¹ J)⁻¹ with Σ = σ² I.

    For the best estimator, and independent noise of sigma_px pixels in each coordinate of each pixel.
    NaN where a point isn't in front of all cameras, or isn't fixed by them (zero baseline, parallel rays).
    Raises GeometryError for fewer than two cameras, or unless sigma_px is above 0.
    Source: Hartley and Zisserman 2004, sec. 5.2.2.
    """
    sigma = as_number("sigma_px", sigma_px, above=0.0)
    if len(cameras) < 2:
        raise GeometryError("cameras", cameras, "two cameras or more")
    points = as_array("point", point, 3)
    J = np.concatenate([projection_jacobian(camera, points) for camera in cameras], axis=-2)
    known = np.isfinite(J.sum(axis=(-2, -1), keepdims=True))[..., 0]
    # By the singular values of J: to invert JᵀJ would square its conditioning.
    _, singular, Vt = np.linalg.svd(np.where(known[..., None], J, 0.0), full_matrices=False)
    fixed = known & (singular[..., 2:] > _SINGULAR * singular[..., :1])
    half = Vt * (sigma / np.where(fixed, singular, np.nan))[..., None]
    return np.asarray(half.swapaxes(-1, -2) @ half)


def ellipsoid_axes(covariance: npt.ArrayLike) -> tuple[Array, Array]:
    """Return the 1σ lengths (..., 3), longest first, and directions (..., 3, 3) of covariances (..., 3, 3).

    The columns of the directions are unit vectors of a right-handed frame. NaN for a covariance that is NaN.
    Source: Golub and Van Loan 2013, "Matrix Computations", sec. 8.1.
    """
    C = as_array("covariance", covariance, 3, 3)
    known = np.isfinite(C.sum(axis=(-2, -1), keepdims=True))[..., 0]
    variances, axes = np.linalg.eigh(np.where(known[..., None], C, 0.0))
    longest_first = axes[..., ::-1] * np.where(np.linalg.det(axes) < 0.0, 1.0, -1.0)[..., None, None]
    lengths = np.sqrt(np.maximum(variances[..., ::-1], 0.0))
    return np.where(known, lengths, np.nan), np.where(known[..., None], longest_first, np.nan)


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
    """Return points (count, 3) by the optimal method from a pair of pixels (2,) with seeded Gaussian noise.

    NaN where a sample has no point. Raises GeometryError at zero baseline, or for a sigma below 0.
    """
    noise = as_number("sigma", sigma, least=0.0) * pixel_noise(count, seed)
    pixels_left = as_array("uv_left", uv_left, 2) + noise[:, 0]
    pixels_right = as_array("uv_right", uv_right, 2) + noise[:, 1]
    return triangulate_optimal(left, right, pixels_left, pixels_right).point
