"""What the properties are tested on: everywhere, and within 1e-9 to 1e-6 of what is singular."""

import math

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry import Array
from geometry.camera import Camera

EXACT = 1e-12

offsets = st.builds(lambda sign, power: sign * 10.0**power, st.sampled_from((-1.0, 1.0)), st.floats(-9.0, -6.0))


def near(*values: float) -> st.SearchStrategy[float]:
    """Each value itself, and numbers within 1e-9 to 1e-6 of it on both sides."""
    return st.builds(lambda value, offset: value + offset, st.sampled_from(values), st.just(0.0) | offsets)


def vectors(size: int, reach: float = 1.0) -> st.SearchStrategy[Array]:
    return st.tuples(*[st.floats(-reach, reach)] * size).map(np.array)


def directions(size: int = 3) -> st.SearchStrategy[Array]:
    """Vectors of any direction, the coordinate axes among them, and of any length above 0.01."""
    return vectors(size).filter(lambda v: math.hypot(*v) > 0.01)


def units(size: int = 3) -> st.SearchStrategy[Array]:
    return directions(size).map(lambda v: np.asarray(v / math.hypot(*v)))


def rotation_by_scipy(axis: Array, angle: float) -> Array:
    return np.asarray(Rotation.from_rotvec(angle * axis).as_matrix())


def pose(R: Array, t: Array) -> Array:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, t
    return T


def camera(fx: float, fy: float, cx: float, cy: float, skew: float, T_camera_world: Array) -> Camera:
    return Camera.from_intrinsics(fx, fy, cx, cy, skew, T_camera_world=T_camera_world)


angles = st.floats(-2.0 * math.pi, 2.0 * math.pi) | near(*(k * math.pi / 2.0 for k in range(-4, 5)))
axis_letters = st.sampled_from("xyz")
rotations = st.builds(rotation_by_scipy, units(), angles)
poses = st.builds(pose, rotations, vectors(3, 5.0))
focals = st.floats(100.0, 2000.0)
cameras = st.builds(
    camera, focals, focals, st.floats(0.0, 640.0), st.floats(0.0, 480.0), st.floats(-200.0, 200.0), poses
)


# focal length, aspect ratio, principal point, skew
INTRINSICS = ((200.0, 1500.0), (0.7, 1.4), (0.0, 640.0), (0.0, 480.0), (-50.0, 50.0))


def stereo_pair(seed: int) -> tuple[Camera, Camera]:
    """Two cameras of any pose and intrinsics that look roughly the same way, 0.1 to 2 m apart."""
    rng = np.random.default_rng(seed)
    T_left_world = pose(Rotation.random(rng=rng).as_matrix(), rng.uniform(-5.0, 5.0, 3))
    turn = rotation_by_scipy(rng.uniform(-0.25, 0.25, 3), 1.0)
    T_right_left = pose(turn, rng.uniform(0.1, 2.0) * Rotation.random(rng=rng).as_matrix()[0])
    left, right = (
        camera(focal, aspect * focal, cx, cy, skew, T)
        for T, focal, aspect, cx, cy, skew in zip(
            (T_left_world, T_right_left @ T_left_world),
            *(rng.uniform(low, high, 2) for low, high in INTRINSICS),
            strict=True,
        )
    )
    return left, right


def seen_point(seed: int) -> tuple[Camera, Camera, Array]:
    """Two such cameras, and a point in front of both that they see at an angle of a degree or more."""
    left, right = stereo_pair(seed)
    rng = np.random.default_rng(seed + 1)
    while True:
        x, y, z = rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6), rng.uniform(0.5, 20.0)
        point = left.center + z * (left.R.T @ [x, y, 1.0])
        a, b = point - left.center, point - right.center
        if right.project(point)[1] > 0.2 and math.hypot(*np.cross(a, b)) > 0.0175 * math.hypot(*a) * math.hypot(*b):
            return left, right, point


seeds = st.integers(0, 2**32 - 1)
stereo_pairs = st.builds(stereo_pair, seeds)
seen_points = st.builds(seen_point, seeds)
