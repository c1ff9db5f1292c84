"""Triangulation: a 3D point from its pixels in two cameras, by three methods, and how sure it is.

Each method takes the left and the right camera and pixels (..., 2), and returns a `Triangulation`.
"""

from .dlt import dlt_equations, triangulate_dlt
from .midpoint import Midpoint, triangulate_midpoint
from .optimal import correct_matches, triangulate_optimal
from .result import Status, Triangulation, reprojection_errors
from .stereo import depth_from_disparity, depth_sigma, disparity
from .uncertainty import covariance, ellipsoid_axes, monte_carlo, pixel_noise, projection_jacobian

__all__ = [
    "Midpoint",
    "Status",
    "Triangulation",
    "correct_matches",
    "covariance",
    "depth_from_disparity",
    "depth_sigma",
    "disparity",
    "dlt_equations",
    "ellipsoid_axes",
    "monte_carlo",
    "pixel_noise",
    "projection_jacobian",
    "reprojection_errors",
    "triangulate_dlt",
    "triangulate_midpoint",
    "triangulate_optimal",
]
