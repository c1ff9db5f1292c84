"""The sims, in the order in which the launcher shows them."""

from __future__ import annotations

from typing import Any

from sims.camera import SIM as CAMERA
from sims.coordinate_frames import SIM as COORDINATE_FRAMES
from sims.epipolar import SIM as EPIPOLAR
from sims.euler_angles import SIM as EULER_ANGLES
from sims.gimbal_lock import SIM as GIMBAL_LOCK
from sims.kit.sim import Sim
from sims.point_cloud import SIM as POINT_CLOUD
from sims.quaternion import SIM as QUATERNION
from sims.transform_chain import SIM as TRANSFORM_CHAIN
from sims.triangulation import SIM as TRIANGULATION

SIMS: tuple[Sim[Any, Any], ...] = (
    COORDINATE_FRAMES,
    EULER_ANGLES,
    GIMBAL_LOCK,
    QUATERNION,
    TRANSFORM_CHAIN,
    CAMERA,
    EPIPOLAR,
    TRIANGULATION,
    POINT_CLOUD,
)


def by_slug(slug: str) -> Sim[Any, Any] | None:
    """The sim of that name, or None."""
    return next((sim for sim in SIMS if sim.slug == slug), None)
