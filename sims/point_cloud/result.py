"""What a process makes of a state: its numbers, and which points are shown how."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from geometry.arrays import Array
from sims.point_cloud.layers import Layer
from sims.point_cloud.processes import Clusters, Ground, Outliers
from sims.point_cloud.registration import Registered
from sims.point_cloud.surface import Surface


@dataclass
class Result:
    """What a process says, and which points it shows how."""

    base: Layer
    marked: Layer
    T: Array = field(default_factory=lambda: np.eye(4))
    ground: Ground | None = None
    clusters: Clusters | None = None
    outliers: Outliers | None = None
    registration: Registered | None = None
    surface: Surface | None = None
    names: list[tuple[str, Array]] = field(default_factory=list)
