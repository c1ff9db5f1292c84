"""What the properties are tested on: everywhere, and within 1e-9 to 1e-6 of what is singular."""

import math

import numpy as np
from hypothesis import assume
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
stereo_moves = st.builds(
    lambda axis, angle, direction, baseline: pose(rotation_by_scipy(axis, angle), baseline * direction),
    *(units(), st.floats(-0.4, 0.4), units(), st.floats(0.1, 2.0)),
)


@st.composite
def stereo_pairs(draw: st.DrawFn) -> tuple[Camera, Camera]:
    """Two cameras of their own focal lengths that look roughly the same way, 0.1 to 2 m apart."""
    left, T_right_left = draw(cameras), draw(stereo_moves)
    focal = draw(focals)
    return left, camera(focal, 1.1 * focal, 320.0, 240.0, 10.0, T_right_left @ left.T_camera_world)


@st.composite
def seen_points(draw: st.DrawFn) -> tuple[Camera, Camera, Array]:
    """Two cameras, and a point in front of both that they see at an angle of a degree or more."""
    left, right = draw(stereo_pairs())
    x, y, z = draw(st.floats(-0.6, 0.6)), draw(st.floats(-0.6, 0.6)), draw(st.floats(0.5, 20.0))
    point = left.center + z * (left.R.T @ [x, y, 1.0])
    assume(float(right.project(point)[1]) > 0.2)
    a, b = point - left.center, point - right.center
    assume(math.hypot(*np.cross(a, b)) > 0.0175 * math.hypot(*a) * math.hypot(*b))
    return left, right, point
