"""Alpha shapes: areas and volumes that are known, closed and outward, sheets of one layer, and degenerate input."""

import math

import numpy as np
import pytest
from hypothesis import given, settings

from geometry import Array, GeometryError
from geometry.clouds import Indices, alpha_shape, mesh_area, mesh_volume
from tests.geometry.cloud_shapes import DEGENERATE, blob, wavy
from tests.geometry.strategies import seeds


def sphere(count: int) -> Array:
    """Points spread evenly over the unit sphere, on a spiral."""
    z = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = math.pi * (3.0 - math.sqrt(5.0)) * np.arange(count)
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)


def edges(triangles: Indices) -> Indices:
    return np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])


def test_a_ball_rolled_over_a_cube_finds_the_cube() -> None:
    corners = np.stack(np.meshgrid(*3 * [np.arange(6.0)]), axis=-1).reshape(-1, 3)
    jitter = np.where(
        (corners > 0.0) & (corners < 5.0), np.random.default_rng(0).uniform(-0.2, 0.2, corners.shape), 0.0
    )
    found = alpha_shape(corners + jitter, 20.0)
    assert found.area == pytest.approx(150.0, rel=1e-3)
    assert found.volume == pytest.approx(125.0, rel=1e-3)
    assert found.solid.all()


def test_a_sphere_is_closed_and_has_nearly_its_area_and_volume() -> None:
    found = alpha_shape(sphere(3000), 2.0)
    assert found.area == pytest.approx(4.0 * math.pi, rel=0.01)
    assert found.volume == pytest.approx(4.0 / 3.0 * math.pi, rel=0.01)
    directed = {tuple(edge) for edge in edges(found.triangles).tolist()}
    assert len(directed) == 3 * len(found.triangles)
    assert {(b, a) for a, b in directed} == directed
    a, b, c = found.points[found.triangles].transpose(1, 0, 2)
    assert (np.vecdot(np.cross(b - a, c - a), a + b + c) > 0.0).all()


def test_a_hollow_sphere_is_a_sheet_when_the_ball_is_small() -> None:
    found = alpha_shape(sphere(3000), 0.08)
    assert found.area == pytest.approx(4.0 * math.pi, rel=0.02)
    assert not found.solid.all()
    assert found.volume == pytest.approx(4.0 / 3.0 * math.pi, rel=0.02)


def torus(count: int, large: float, small: float) -> Array:
    """Points about evenly spread over a torus about Z."""
    k = np.arange(count)
    along, round_ = 2.0 * math.pi * k * 0.7548776662466927, 2.0 * math.pi * k * 0.5698402909980532
    radius = large + small * np.cos(round_)
    return np.stack([radius * np.cos(along), radius * np.sin(along), small * np.sin(round_)], axis=1)


@pytest.mark.parametrize("alpha", [0.2, 0.4])
def test_a_torus_encloses_its_volume_whatever_the_ball_that_stays_outside(alpha: float) -> None:
    """2π²Rr², by Pappus."""
    found = alpha_shape(torus(4_000, 2.0, 0.6), alpha)
    assert found.volume == pytest.approx(2.0 * math.pi**2 * 2.0 * 0.36, rel=0.02)


def test_a_shell_with_a_hole_that_the_ball_passes_encloses_nothing() -> None:
    shell = sphere(1200)
    shell = shell[shell[:, 2] < 0.9]  # the hole's radius is 0.44
    assert alpha_shape(shell, 0.13).volume < 0.05
    stopped = alpha_shape(shell, 0.6).volume
    assert stopped == pytest.approx(4.0 / 3.0 * math.pi, rel=0.05)


def test_a_shell_in_a_shell_is_not_counted_twice() -> None:
    found = alpha_shape(np.concatenate([sphere(1200), 0.5 * sphere(400)]), 0.13)
    assert found.volume == pytest.approx(4.0 / 3.0 * math.pi, rel=0.03)


@settings(max_examples=10)
@given(seeds)
def test_the_ball_rests_on_each_triangle_of_a_sheet(seed: int) -> None:
    points = wavy(seed, 300)
    alpha = 0.5
    found = alpha_shape(points, alpha)
    for i, j, k in found.triangles[:40]:
        a, b, c = points[[i, j, k]]
        across = np.cross(b - a, c - a)
        square = across @ across
        u, v = b - a, c - a
        centre = a + np.cross((u @ u) * v - (v @ v) * u, across) / (2.0 * square)
        rise = math.sqrt(max(alpha**2 - (centre - a) @ (centre - a), 0.0)) * across / math.sqrt(square)
        inside = [(np.linalg.norm(points - (centre + side * rise), axis=1) < alpha - 1e-9).any() for side in (1, -1)]
        assert not all(inside)


@settings(max_examples=10)
@given(seeds)
def test_large_balls_leave_the_convex_hull_and_small_ones_nothing(seed: int) -> None:
    from scipy.spatial import ConvexHull

    points = blob(seed, 60)
    hull = ConvexHull(points)
    found = alpha_shape(points, 1e9)
    assert found.volume == pytest.approx(hull.volume, rel=1e-6)
    assert found.area == pytest.approx(hull.area, rel=1e-6)
    nothing = alpha_shape(points, 1e-6)
    assert nothing.triangles.shape == (0, 3)
    assert nothing.area == nothing.volume == 0.0


def test_area_and_volume_of_a_known_tetrahedron() -> None:
    points = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    found = alpha_shape(points, 10.0)
    assert len(found.triangles) == 4
    assert found.volume == pytest.approx(1.0 / 6.0, abs=1e-12)
    assert found.area == pytest.approx(1.5 + math.sqrt(3.0) / 2.0, abs=1e-12)
    assert mesh_area(points, found.triangles) == found.area
    assert mesh_volume(points + 100.0, found.triangles) == pytest.approx(1.0 / 6.0, abs=1e-11)


@pytest.mark.parametrize("name", DEGENERATE)
def test_what_spans_no_volume_is_refused(name: str) -> None:
    with pytest.raises(GeometryError, match="points"):
        alpha_shape(DEGENERATE[name], 0.5)


@pytest.mark.parametrize("alpha", [0.0, -1.0, math.nan])
def test_wrong_radii_are_refused(alpha: float) -> None:
    with pytest.raises(GeometryError, match="alpha"):
        alpha_shape(blob(0, 10), alpha)


def test_points_so_far_apart_that_qhull_would_not_survive_are_refused() -> None:
    points = np.random.default_rng(3).random((500, 3)) * 1e150
    with pytest.raises(GeometryError, match="apart"):
        alpha_shape(points, 1e149)
