"""Point clouds: thinning, normals, outliers, planes, clusters, registration, surfaces and picking.

Points are (N, 3), in metres, and finite. Long work takes `progress`, a function that is told how much is done and
may raise to end it.
"""

from .alignment import Observability, observability, onto_planes, onto_points
from .clusters import Clusters, clusters
from .neighbours import Neighbours, spacing
from .normals import Neighbourhood, Normals, neighbourhood, normals, orient
from .outliers import Outliers, outliers
from .picking import Pick, pick
from .planes import Plane, fit_plane, ransac_plane
from .points import Indices, Progress, bounds
from .registration import SETTLED, Registration, Step, Target, certainty, icp, register
from .surface import Surface, alpha_shape, mesh_area, mesh_volume
from .voxels import Voxels, voxels

__all__ = [
    "SETTLED",
    "Clusters",
    "Indices",
    "Neighbourhood",
    "Neighbours",
    "Normals",
    "Observability",
    "Outliers",
    "Pick",
    "Plane",
    "Progress",
    "Registration",
    "Step",
    "Surface",
    "Target",
    "Voxels",
    "alpha_shape",
    "bounds",
    "certainty",
    "clusters",
    "fit_plane",
    "icp",
    "mesh_area",
    "mesh_volume",
    "neighbourhood",
    "normals",
    "observability",
    "onto_planes",
    "onto_points",
    "orient",
    "outliers",
    "pick",
    "ransac_plane",
    "register",
    "spacing",
    "voxels",
]
