"""Painted faces against ray casting: what is painted last at a pixel is what its ray meets first."""

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry import Array, GeometryError
from geometry.affine_camera import AffineCamera
from geometry.camera import Camera
from geometry.painting import Painter, clip_polygon
from geometry.projection import frame_planes, ground_line, viewpoint
from geometry.ray_casting import Body, cast
from tests.geometry.strategies import cameras, pose, seeds

BOX = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
"""Faces of a box whose corners are numbered by the bits x, y, z of 4, 2, 1."""
SIZE = 640, 480


def box(half: Array, T: Array) -> list[Array]:
    corners = np.array(list(product((-1.0, 1.0), repeat=3))) * half @ T[:3, :3].T + T[:3, 3]
    return [corners[list(reversed(face))] for face in BOX]


def boxes(seed: int) -> list[Body]:
    """Boxes in cells of a grid, all turned alike: between columns, rows and layers there is always a plane."""
    rng = np.random.default_rng(seed)
    R = Rotation.random(rng=rng).as_matrix()
    found = []
    for cell in product(range(3), repeat=3):
        if rng.random() < 0.4:
            half = rng.uniform(0.1, 0.4, 3)
            middle = np.array(cell) - 1.0 + rng.uniform(-1.0, 1.0, 3) * (0.45 - half)
            found.append(Body("box", half, pose(R, R @ middle)))
    return found or [Body("box", np.full(3, 0.3), pose(R, np.zeros(3)))]


def looking(seed: int, away: float | None = None) -> Camera:
    """A camera that looks at the middle of the boxes, more or less: in between them or outside, or so far away."""
    rng = np.random.default_rng(seed)
    shift = np.array([*rng.uniform(-0.5, 0.5, 2), rng.uniform(0.0, 6.0) if away is None else away])
    T = pose(Rotation.random(rng=rng).as_matrix(), shift)
    return Camera.from_intrinsics(rng.uniform(200, 900), rng.uniform(200, 900), 320.0, 240.0, 30.0, T_camera_world=T)


def rays(camera: Camera | AffineCamera, pixels: Array) -> tuple[Array, Array]:
    """Places on the camera's plane, and unit directions, of the lines of sight of pixels."""
    if isinstance(camera, Camera):
        origin, directions = camera.pixel_ray(pixels)
        return np.tile(origin, (len(pixels), 1)), directions
    inner = camera.perspective
    flat = np.column_stack([camera.depth * inner.normalized(pixels), np.zeros(len(pixels))])
    return inner.center + flat @ inner.R, np.tile(inner.R[2], (len(pixels), 1))


UNSURE = -2


def topmost(painted: list[tuple[int, list[tuple[float, float]]]], pixels: Array) -> list[int]:
    """The faces that are painted last at pixels, −1 for none, or UNSURE so near an edge that rounding decides."""
    found = np.full(len(pixels), -1)
    for face, corners in painted:
        ring = np.array(corners)
        along = np.roll(ring, -1, axis=0) - ring
        lengths = np.linalg.norm(along, axis=1)
        ring, along = ring[lengths > 1e-9], along[lengths > 1e-9] / lengths[lengths > 1e-9, None]
        away = pixels[:, None] - ring
        off = along[:, 0] * away[..., 1] - along[:, 1] * away[..., 0]
        within = np.maximum(off.min(axis=1), -off.max(axis=1))  # whichever way round the corners go
        found[within > 1e-4] = face
        found[np.abs(within) <= 1e-4] = UNSURE
    return found.tolist()


def planes(camera: Camera | AffineCamera) -> Array:
    return np.vstack([frame_planes(camera.P, *SIZE), camera.depth_row - (0.0, 0.0, 0.0, 1e-6)])


@given(seeds, st.booleans())
def test_what_is_painted_last_is_what_the_ray_meets_first(seed: int, affine: bool) -> None:
    bodies = boxes(seed)
    camera = AffineCamera(looking(seed + 1, 20.0), 4.0) if affine else looking(seed + 1)
    painter = Painter([box(body.half, body.T_world_body) for body in bodies])
    painted = painter.paint(camera.P, planes(camera))
    pixels = np.random.default_rng(seed).uniform((0, 0), (639, 479), (80, 2))
    origins, directions = rays(camera, pixels)
    hits = cast(origins, directions, bodies)
    within = (np.vecdot(directions, hits.normals) > 0.0) & (hits.body >= 0)
    for face, hit, normal, inside in zip(topmost(painted, pixels), hits.body, hits.normals, within, strict=True):
        if face != UNSURE and not inside:  # a ray that begins in a body meets faces that aren't painted
            assert face // 6 == hit
            if face >= 0:
                np.testing.assert_allclose(painter.planes[face, :3], normal, rtol=0, atol=1e-9)


@given(seeds)
def test_all_that_is_painted_is_in_the_picture_and_faces_the_viewer(seed: int) -> None:
    camera = looking(seed)
    painter = Painter([box(body.half, body.T_world_body) for body in boxes(seed)])
    painted = painter.paint(camera.P, planes(camera))
    assert len({face for face, _ in painted}) == len(painted)
    for face, corners in painted:
        u, v = np.array(corners).T
        assert (u > -0.5 - 1e-6).all()
        assert (u < 639.5 + 1e-6).all()
        assert (v > -0.5 - 1e-6).all()
        assert (v < 479.5 + 1e-6).all()
        assert painter.planes[face] @ [*camera.center, 1.0] > 0.0
        np.testing.assert_allclose(painter.faces[face] @ painter.planes[face, :3], -painter.planes[face, 3], atol=1e-9)


def test_bodies_that_no_plane_parts_are_refused() -> None:
    first, second = box(np.ones(3), np.eye(4)), box(np.ones(3), pose(np.eye(3), np.full(3, 0.5)))
    with pytest.raises(GeometryError, match="bodies"):
        Painter([first, second])


def test_nothing_is_painted_of_nothing() -> None:
    camera = looking(1)
    behind = box(np.full(3, 0.1), pose(np.eye(3), camera.center - 2.0 * camera.R[2]))
    assert Painter([behind]).paint(camera.P, planes(camera)) == []


@given(cameras)
def test_the_viewpoint_is_the_centre_and_the_direction_of_an_affine_camera(camera: Camera) -> None:
    x, y, z, w = viewpoint(camera.P)
    assert w > 0.0
    np.testing.assert_allclose(np.array([x, y, z]) / w, camera.center, rtol=1e-9, atol=1e-9)
    x, y, z, w = viewpoint(AffineCamera(camera, 3.0).P)
    assert w == 0.0
    np.testing.assert_allclose(np.array([x, y, z]) / math.hypot(x, y, z), -camera.R[2], rtol=0, atol=1e-9)


@given(cameras, seeds)
def test_the_ground_line_parts_rays_that_go_down_from_those_that_go_up(camera: Camera, seed: int) -> None:
    line = np.array(ground_line(camera.P))
    pixels = np.random.default_rng(seed).uniform((0, 0), (639, 479), (50, 2))
    _, directions = camera.pixel_ray(pixels)
    reaches = directions[:, 2] * camera.center[2]  # towards the ground from whichever side of it
    sides = np.column_stack([pixels, np.ones(50)]) @ line
    clear = np.abs(reaches) > 1e-9 * max(1.0, abs(camera.center[2]))
    np.testing.assert_array_equal((sides > 0.0)[clear], (reaches < 0.0)[clear])


def test_an_affine_camera_shows_the_ground_all_over_or_nowhere() -> None:
    down, level = pose(np.diag([1.0, -1.0, -1.0]), np.array([0.0, 0.0, 5.0])), np.eye(4)
    level[:3, :3] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
    for T, expected in ((down, 1.0), (level, 0.0)):
        camera = AffineCamera(Camera.from_intrinsics(500, 500, 320, 240, T_camera_world=T), 4.0)
        a, b, c = ground_line(camera.P)
        assert (a, b) == (0.0, 0.0)
        assert np.sign(c) == expected


def test_a_polygon_is_cut_where_its_distances_change_their_sign() -> None:
    square = [(u, v, 3.0 - u - v) for u, v in ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))]
    kept = [(u, v) for u, v, _ in clip_polygon(square, [2])]
    assert kept == [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 2.0), (0.0, 2.0)]
    assert clip_polygon([(0.0, -1.0), (1.0, -1.0), (1.0, -2.0)], [1]) == []
    assert clip_polygon([], [1]) == []
