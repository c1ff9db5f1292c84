"""Bodies that people recognise at 100 pixels, modelled with trimesh; light to send."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import trimesh
from trimesh.creation import box, cone, cylinder, icosphere, torus


def moved(mesh: trimesh.Trimesh, offset: tuple[float, float, float]) -> trimesh.Trimesh:
    """Move a body, which is also the answer."""
    mesh.apply_translation(offset)
    return mesh


def joined(parts: list[trimesh.Trimesh]) -> trimesh.Trimesh:
    """Several bodies as one."""
    whole = trimesh.util.concatenate(parts)
    assert isinstance(whole, trimesh.Trimesh)
    return whole


def _slab(outline: list[tuple[float, float]], thickness: float) -> trimesh.Trimesh:
    """A flat convex plate: outline (x, y), centred on z = 0."""
    flat = np.array(outline)
    corners = np.concatenate([np.column_stack([flat, np.full(len(flat), z)]) for z in (-thickness / 2, thickness / 2)])
    hull: trimesh.Trimesh = trimesh.convex.convex_hull(corners)
    return hull


@lru_cache(maxsize=4)
def aircraft(scale: float = 1.0) -> dict[str, trimesh.Trimesh]:
    """An aircraft of length 2, or `scale` times that; nose +X, left wing +Y, fin +Z.

    `hull`, and `mark`, the tip of the left wing.
    """
    fuselage = icosphere(subdivisions=3).apply_scale((0.86, 0.13, 0.13))
    nose = cone(radius=0.085, height=0.3, sections=24)
    nose.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (0, 1, 0)))
    moved(nose, (0.68, 0.0, 0.0))
    canopy = moved(icosphere(subdivisions=2).apply_scale((0.2, 0.075, 0.09)), (0.3, 0.0, 0.1))
    right = _slab([(0.26, 0.0), (-0.06, -0.98), (-0.24, -0.98), (-0.22, 0.0)], 0.035)
    left = _slab([(0.26, 0.0), (0.017, 0.745), (-0.24, 0.745), (-0.22, 0.0)], 0.035)
    tail = _slab([(-0.6, 0.0), (-0.76, 0.36), (-0.88, 0.36), (-0.84, 0.0), (-0.88, -0.36), (-0.76, -0.36)], 0.028)
    fin = _slab([(-0.52, 0.0), (-0.78, 0.36), (-0.9, 0.36), (-0.86, 0.0)], 0.03)
    fin.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0)))
    mark = _slab([(0.017, 0.745), (-0.06, 0.98), (-0.24, 0.98), (-0.24, 0.745)], 0.05)
    hull = joined([fuselage, nose, canopy, left, right, tail, fin])
    return {"hull": hull.apply_scale(scale), "mark": mark.apply_scale(scale)}


@lru_cache(maxsize=32)
def rings(radius: float, thickness: float) -> tuple[trimesh.Trimesh, trimesh.Trimesh]:
    """Two rings round the origin, one in the plane of x and y and one upright, across y."""
    flat = torus(major_radius=radius, minor_radius=thickness / 2.0, major_sections=48, minor_sections=8)
    upright = flat.copy().apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0]))
    return flat, upright


@lru_cache(maxsize=3)
def camera(bands: int = 0) -> dict[str, trimesh.Trimesh]:
    """A camera about 0.3 long that looks along +Z with y down, its centre of projection at the origin.

    `body`, `lens`, and with one or two bands round the body also `mark`, which tells cameras apart.
    """
    body = moved(box((0.24, 0.16, 0.16)), (0.0, 0.0, -0.12))
    bump = moved(box((0.1, 0.05, 0.09)), (0.0, -0.1, -0.12))
    barrel = moved(cylinder(radius=0.062, height=0.1, sections=32), (0.0, 0.0, 0.0))
    rim = moved(cylinder(radius=0.07, height=0.02, sections=32), (0.0, 0.0, 0.05))
    parts = {"body": joined([body, bump]), "lens": joined([barrel, rim])}
    if bands:
        parts["mark"] = joined([moved(box((0.02, 0.168, 0.168)), (0.1 - 0.045 * k, 0.0, -0.12)) for k in range(bands)])
    return parts
