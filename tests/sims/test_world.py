"""The little world: corners of solid things that stand on the ground, and the picture of them against ray casting."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial import ConvexHull

from geometry.affine_camera import AffineCamera
from geometry.camera import Camera, aim, pan_tilt_roll
from geometry.projection import frame_planes
from sims.kit.pane import Picture
from sims.kit.world import BODIES, NAMES, POINTS, TITLES
from sims.kit.world_drawing import FILLS, MARGIN, OF_FACE, PAINTER, draw_in_picture
from tests.geometry.test_painting import UNSURE, planes, rays, topmost

Array = npt.NDArray[np.float64]
FROM = [(0.0, -4.0, 1.2), (-4.0, -5.0, 4.0), (4.0, 6.0, 2.0), (0.1, 1.0, 0.4), (-1.5, -2.0, 7.0), (-6.0, 2.0, 0.5)]


def camera(place: tuple[float, float, float], target: tuple[float, float, float] = (0.0, 1.0, 0.5)) -> Camera:
    pan, tilt = aim(place, target)
    T = np.eye(4)
    T[:3, :3] = pan_tilt_roll(pan or 0.0, tilt, 0.1).T
    T[:3, 3] = -T[:3, :3] @ place
    return Camera.from_intrinsics(500.0, 500.0, 320.0, 240.0, T_camera_world=T)


FAN = [(number, face[0], b, c) for number, face in enumerate(PAINTER.faces) for b, c in pairwise(face[1:])]
NUMBER, A, B, C = (np.array(each) for each in zip(*FAN, strict=True))
"""The faces as fans of triangles: the face of each, and its corners."""
OUTWARDS = np.array([np.cross(face[1] - face[0], face[2] - face[0]) for face in PAINTER.faces])[NUMBER]


def first_met(origin: Array, direction: Array) -> int:
    """Number of the face that a ray meets first, of those turned to it; -1 if it meets none."""
    turned = OUTWARDS @ direction < 0.0
    a, b, c = A[turned], B[turned], C[turned]
    along = np.broadcast_to(-direction, a.shape)
    u, v, t = np.linalg.solve(np.stack([b - a, c - a, along], axis=2), (origin - a)[..., None])[..., 0].T
    met = np.where(np.minimum.reduce([u, v, 1.0 - u - v, t]) >= 0.0, t, np.inf)
    nearest = int(np.argmin(met))
    return int(NUMBER[turned][nearest]) if np.isfinite(met[nearest]) else -1


@pytest.mark.parametrize("place", FROM)
@pytest.mark.parametrize("affine", [False, True])
def test_what_is_painted_last_is_what_the_ray_meets_first(place: tuple[float, float, float], affine: bool) -> None:
    inner = camera(place)
    seen: Camera | AffineCamera = AffineCamera(inner, 4.0) if affine else inner
    painted = PAINTER.paint(seen.P, planes(seen))
    pixels = np.random.default_rng(5).uniform((0, 0), (639, 479), (60, 2))
    faces = topmost(painted, pixels)
    met = [first_met(origin, direction) for origin, direction in zip(*rays(seen, pixels), strict=True)]
    assert faces == [face if face == UNSURE else other for face, other in zip(faces, met, strict=True)]
    assert faces.count(UNSURE) < 5


def test_named_points_are_corners_of_things_and_all_stands_on_the_ground() -> None:
    assert set(NAMES) == set(TITLES)
    corners = np.concatenate(PAINTER.faces)
    assert corners[:, 2].min() == 0.0
    for point in POINTS:
        assert np.linalg.norm(corners - point, axis=1).min() < 1e-12
    for body in BODIES:
        assert body.paint in ("sleeper", "rail", "roof") or min(z for face in body.faces for *_, z in face) == 0.0


def test_bodies_are_convex_and_their_faces_look_outwards() -> None:
    for body in BODIES:
        if body.paint == "sleeper":
            continue
        corners = np.unique(np.concatenate([np.array(face) for face in body.faces]).round(9), axis=0)
        hull = ConvexHull(corners)
        assert len(hull.vertices) == len(corners)
        for face in body.faces:
            a, b, c = np.array(face[:3])
            normal = np.cross(b - a, c - a)
            normal /= np.linalg.norm(normal)
            assert min(np.linalg.norm(hull.equations[:, :3] - normal, axis=1)) < 1e-6


def test_moved_with_the_camera_the_picture_stays_the_same() -> None:
    offset = (0.5, 4.0, 0.25)
    pictures = []
    for moved in ((0.0, 0.0, 0.0), offset):
        x, y, z = np.add((0.3, -4.0, 1.2), moved).tolist()
        a, b, c = np.add((0.0, 1.0, 0.5), moved).tolist()
        picture = Picture("p", "P")
        draw_in_picture(picture, camera((x, y, z), (a, b, c)), moved)
        faces = picture.pane().svg.partition('class="s3-faces"')[2]
        pictures.append(np.array(re.findall(r"-?\d+\.\d", faces), dtype=float))
    np.testing.assert_allclose(pictures[0], pictures[1], rtol=0, atol=0.11)
    assert len(pictures[0]) > 200


def test_the_picture_has_the_painted_faces_in_their_order() -> None:
    picture = Picture("p", "P")
    view = camera((0.0, -4.0, 1.2))
    draw_in_picture(picture, view)
    svg = picture.pane().svg.partition('class="s3-faces"')[2]
    drawn = [outline for path in re.findall(r' d="([^"]+)"', svg) for outline in re.findall(r"M([^z]+)z", path)]
    nearest = view.depth_row - (0.0, 0.0, 0.0, 1e-3)
    painted = PAINTER.paint(view.P, np.vstack([frame_planes(view.P, 640, 480) + MARGIN * view.P[2], nearest]))
    assert len(drawn) == len(painted) > 30
    for outline, (_, corners) in zip(drawn, painted, strict=True):
        found = np.array([pair.split() for pair in outline.split("L")], dtype=float)
        np.testing.assert_allclose(found, corners, rtol=0, atol=0.06)


def test_faces_of_one_thing_differ_in_shade_and_have_a_colour_in_each_theme() -> None:
    walls = {fill for fill, paint in zip(FILLS, OF_FACE, strict=True) if paint == "wall"}
    assert len(walls) == 6
    assert all(re.fullmatch(r"light-dark\(#[0-9a-f]{6}, #[0-9a-f]{6}\)", fill) for fill in FILLS)
