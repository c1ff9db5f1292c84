"""The two cameras of a state: the sim's own level ones, or a stereo pair of somebody's."""

from __future__ import annotations

import math
from functools import lru_cache

from geometry.camera import R_WORLD_LEVEL
from geometry.rotations import axis_rotation
from sims.epipolar.params import CENTER, EpipolarParams
from sims.kit.frame import HEIGHT, WIDTH
from sims.kit.stereo import Eye, stand
from sims.kit.types import Place

BASELINE = 1.2
"""Metres that the baseline of somebody's pair has in the scene, in whatever unit their T is: it has no part in F."""


def eyes(p: EpipolarParams) -> tuple[Eye, Eye]:
    """The left and the right camera."""
    if p.pair is not None:
        return stand(p.pair, p.sizes, BASELINE)
    return level(p.left, p.left_pan, p.focal), level(p.right, p.right_pan, p.focal)


@lru_cache(maxsize=256)
def level(center: Place, pan: float, focal: float) -> Eye:
    """A level camera at a place in metres, turned by degrees about the vertical."""
    R = axis_rotation("z", math.radians(pan)) @ R_WORLD_LEVEL
    return Eye((focal, focal, *CENTER), center, tuple(R.ravel().tolist()), (WIDTH, HEIGHT))
