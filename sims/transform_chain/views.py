"""From where an arm is looked at, and what of it must be in sight."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from geometry.kinematics import Chain
from sims.kit.types import Place
from sims.kit.view import View
from sims.transform_chain.params import ChainParams
from sims.transform_chain.solution import USUAL, ChainSolution

VIEW = View((3.05, -3.0, 1.8), (1.0, 0.35, -0.25), 1.65)
NEARER = (0.5, 0.7)
"""Parts of the way, from the base, from which arms that are so much shorter than the usual one are looked at."""
SPARE = 1.1
"""How much longer than that part they may be."""
ROOM = 1.2
"""How much farther out than the middle of a frame what is at its origin reaches, with its letters."""


def view_of(p: ChainParams) -> View:
    """The first view of an arm: by its links alone, so that no joint moves it."""
    return _view(p.arm)


@lru_cache(maxsize=256)
def _view(arm: Chain) -> View:
    reach = sum(link.extent for link in arm.links)
    near = next((part for part in NEARER if reach <= SPARE * part * USUAL), None)
    if near is None:
        return VIEW
    position, look_at = _times(near, VIEW.position), _times(near, VIEW.look_at)
    return View(position, look_at, near * VIEW.radius)


def _times(factor: float, place: tuple[float, float, float]) -> Place:
    x, y, z = place
    return factor * x, factor * y, factor * z


def seen(p: ChainParams, s: ChainSolution) -> Iterator[npt.ArrayLike]:
    """What must be in sight: each frame, the target, and the arm of the swapped product."""
    middle = np.array(view_of(p).look_at)
    yield from middle + ROOM * (s.positions[1:] - middle)
    if p.target is not None:
        yield middle + ROOM * (p.target - middle)
    if s.swapped is not None:
        yield middle + ROOM * (s.swapped.end - middle)
