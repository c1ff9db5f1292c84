"""Pictures of solid things: faces turned away are left out, and what is far is painted before what is near."""

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from .arrays import Array, dot
from .errors import GeometryError, as_array, as_finite_array
from .projection import viewpoint

Pixels: TypeAlias = list[tuple[float, float]]
Tree: TypeAlias = "int | tuple[list[float], Tree, Tree]"

_TOUCHING = 1e-9  # metres by which a corner may be on the other side of a plane


class Painter:
    """Bodies, each of them convex or flat, that planes through their faces can be put between.

    A body is its faces, each of them corners (n, 3) of a convex polygon, counter-clockwise as seen from outside; only
    that side is seen. A tree of planes, each with whole bodies on both sides, gives the order from every viewpoint:
    nothing on the far side of a plane can hide what is on the near side.
    Raises GeometryError where bodies meet, or stand round each other so that no such plane is left.
    Source: Fuchs, Kedem and Naylor 1980.
    """

    def __init__(self, bodies: Sequence[Sequence[npt.ArrayLike]]) -> None:
        outlines = [[as_finite_array("bodies", face, 3) for face in body] for body in bodies]
        self.faces: list[Array] = [face for body in outlines for face in body]
        """All faces, in the order in which they were given; they are known by their numbers."""
        most = max((len(face) for face in self.faces), default=3)
        self._corners = np.array([np.concatenate([face, face[-1:].repeat(most - len(face), 0)]) for face in self.faces])
        self._counts = [len(face) for face in self.faces]
        ends = np.cumsum([0, *map(len, outlines)]).tolist()
        self._of_body = [range(first, end) for first, end in pairwise(ends)]
        self._tree = self._divided(list(range(len(bodies)))) if bodies else None

    @cached_property
    def planes(self) -> Array:
        """Rows (a, b, c, d) for each face: its outward unit normal, and a x + b y + c z + d = 0 on it."""
        a, b, c = self._corners[:, 0], self._corners[:, 1], self._corners[:, 2]
        normals = np.cross(b - a, c - a)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return np.column_stack([normals, -np.vecdot(normals, a)])

    def _divided(self, bodies: list[int]) -> Tree:
        """A tree of planes over some of the bodies: the one that parts them most evenly, and both sides of it."""
        if len(bodies) == 1:
            return bodies[0]
        best: tuple[list[int], list[int], list[float]] | None = None
        for plane in self.planes[[face for body in bodies for face in self._of_body[body]]]:
            distances = [self._corners[self._of_body[body]] @ plane[:3] + plane[3] for body in bodies]
            ends = [(body, d.min(), d.max()) for body, d in zip(bodies, distances, strict=True)]
            back = [body for body, _, most in ends if most <= _TOUCHING]
            front = [body for body, least, most in ends if least >= -_TOUCHING and most > _TOUCHING]
            parted = len(front) + len(back) == len(bodies) and front and back
            if parted and (best is None or max(len(front), len(back)) < max(len(best[0]), len(best[1]))):
                best = front, back, plane.tolist()
        if best is None:
            raise GeometryError("bodies", bodies, "convex bodies that a plane through one of their faces can part")
        return best[2], self._divided(best[0]), self._divided(best[1])

    def order(self, viewer: npt.ArrayLike) -> list[int]:
        """Return the numbers of all faces, far ones first, for a homogeneous viewpoint (4,) as `viewpoint` gives it."""
        place = as_finite_array("viewer", viewer, 4).tolist()
        found: list[int] = []
        waiting = [] if self._tree is None else [self._tree]
        while waiting:
            match waiting.pop():
                case (plane, front, back):
                    near = dot(plane, place) + plane[3] * place[3] >= 0.0
                    waiting += (front, back) if near else (back, front)  # the last one is taken next
                case body:
                    found += self._of_body[body]
        return found

    @np.errstate(all="ignore")
    def paint(self, P: npt.ArrayLike, planes: npt.ArrayLike) -> list[tuple[int, Pixels]]:
        """Return what P (3, 4) shows of the faces inside all planes (m, 4): numbers and pixels, far ones first.

        A row (a, b, c, d) of planes keeps a x + b y + c z + d ≥ 0. For a perspective camera one of them must keep away
        from the plane through its centre.
        """
        P, planes = as_finite_array("P", P, 3, 4), as_array("planes", planes, 4)
        rows, viewer = np.concatenate([P, planes]), viewpoint(P)
        flat = self._corners.reshape(-1, 3).dot(rows[:, :3].T) + rows[:, 3]
        values = flat.reshape(*self._corners.shape[:2], -1)
        # Outside of which planes a corner is, as the bits of a number: one comparison for all of them.
        outside = (flat[:, 3:] < 0.0).dot(2.0 ** np.arange(len(planes))).astype(np.int64).reshape(values.shape[:2])
        seen = (self.planes.dot(viewer) > 0.0) & (np.bitwise_and.reduce(outside, axis=1) == 0)
        cut = np.bitwise_or.reduce(outside, axis=1).tolist()
        pixels = (values[..., :2] / values[..., 2:3]).tolist()
        shown = seen.tolist()
        painted: list[tuple[int, Pixels]] = []
        for face in self.order(viewer):
            if shown[face]:
                count = self._counts[face]
                corners = _cut(values[face, :count].tolist(), cut[face]) if cut[face] else pixels[face][:count]
                if len(corners) > 2:
                    painted.append((face, corners))
        return painted


def _cut(corners: list[list[float]], planes: int) -> Pixels:
    """The pixels of what is inside the planes whose bits are set."""
    entries = [3 + k for k in range(planes.bit_length()) if planes >> k & 1]
    return [(u / w, v / w) for u, v, w, *_ in clip_polygon(corners, entries)]


def clip_polygon(corners: Sequence[Sequence[float]], entries: Sequence[int]) -> Sequence[Sequence[float]]:
    """Return the part of a convex polygon where none of these entries of the corners, by their numbers, is negative.

    Corners are rows of as many numbers as one likes, all of them linear over the polygon: places, then distances from
    what it is to be cut off at. Fewer than three are left of a polygon that is outside, or only touches.
    Source: Sutherland and Hodgman 1974.
    """
    for k in entries:
        kept: list[Sequence[float]] = []
        before = corners[-1] if corners else ()
        for corner in corners:
            if (corner[k] < 0.0) != (before[k] < 0.0):
                part = before[k] / (before[k] - corner[k])
                kept.append([a + part * (b - a) for a, b in zip(before, corner, strict=True)])
            if corner[k] >= 0.0:
                kept.append(corner)
            before = corner
        corners = kept
    return corners
