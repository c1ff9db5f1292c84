"""ICP: against SciPy's alignment, poses found again, the error that never rises, and what the data can't tell."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from geometry import Array, GeometryError, se3
from geometry.clouds import Target, icp, normals, observability, onto_planes, onto_points, register
from tests.geometry.cloud_shapes import blob, wavy
from tests.geometry.strategies import pose, poses, seeds


def small_pose(seed: int, angle: float = 0.05, shift: float = 0.08) -> Array:
    rng = np.random.default_rng(seed)
    return pose(Rotation.from_rotvec(rng.uniform(-angle, angle, 3)).as_matrix(), rng.uniform(-shift, shift, 3))


@given(seeds, poses, st.integers(3, 100))
def test_known_pairs_give_their_transform(seed: int, T: Array, count: int) -> None:
    p = blob(seed, count)
    np.testing.assert_allclose(onto_points(p, se3.apply(T, p)), T, rtol=0, atol=1e-9)


@given(seeds, poses)
def test_noisy_pairs_agree_with_scipy(seed: int, T: Array) -> None:
    p = blob(seed, 40)
    q = se3.apply(T, p) + blob(seed + 1, 40, 0.3)
    expected, _ = Rotation.align_vectors(q - q.mean(axis=0), p - p.mean(axis=0))
    found = onto_points(p, q)
    np.testing.assert_allclose(found[:3, :3], expected.as_matrix(), rtol=0, atol=1e-9)
    np.testing.assert_allclose(found @ [*p.mean(axis=0), 1.0], [*q.mean(axis=0), 1.0], rtol=0, atol=1e-12 * 50)


def test_mirrored_points_give_a_rotation_all_the_same() -> None:
    p = blob(0, 30)
    assert np.linalg.det(onto_points(p, p * [1.0, 1.0, -1.0])[:3, :3]) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("p", [np.ones((1, 3)), np.ones((5, 3)), np.outer(np.arange(5.0), [1.0, 2.0, 3.0])])
def test_few_collinear_and_coincident_pairs_have_a_best_transform(p: Array) -> None:
    T = small_pose(3)
    found = onto_points(p, se3.apply(T, p))
    np.testing.assert_allclose(se3.apply(found, p), se3.apply(T, p), rtol=0, atol=1e-8)
    np.testing.assert_allclose(found[:3, :3] @ found[:3, :3].T, np.eye(3), rtol=0, atol=1e-12)


@given(seeds)
def test_a_step_to_planes_solves_the_linear_equations(seed: int) -> None:
    p, n = blob(seed, 60), blob(seed + 1, 60)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    T = small_pose(seed, 1e-5, 1e-5)
    q = se3.apply(T, p)
    np.testing.assert_allclose(onto_planes(p, q, n), T, rtol=0, atol=1e-8)


@pytest.mark.parametrize("method", ["point", "plane"])
@settings(max_examples=12)
@given(seed=seeds)
def test_a_moved_cloud_is_found_again(method: str, seed: int) -> None:
    target = wavy(seed, 4000)
    T = small_pose(seed)
    source = se3.apply(se3.inverse(T), target)
    found = register(source, target, 0.5, method=method, settled=1e-12, most=300)
    np.testing.assert_allclose(found.T_target_source, T, rtol=0, atol=1e-6)
    assert found.converged
    assert found.last.fitness == 1.0
    assert found.last.rmse < 1e-6


def written_out(source: Array, target: Array, facing: Array | None, reach: float, steps: int) -> Array:
    """ICP by SciPy: a new search for all pairs at each step, each step by least squares."""
    tree, T = cKDTree(target), np.eye(4)
    for _ in range(steps):
        p = se3.apply(T, source)
        distance, place = tree.query(p)
        p, q, place = p[distance <= reach], target[place][distance <= reach], place[distance <= reach]
        if facing is None:
            R = Rotation.align_vectors(q - q.mean(axis=0), p - p.mean(axis=0))[0].as_matrix()
            T = pose(R, q.mean(axis=0) - R @ p.mean(axis=0)) @ T
        else:
            n, center = facing[place], p.mean(axis=0)
            J = np.concatenate([np.cross(p - center, n), n], axis=1)
            turn, move = np.split(np.linalg.lstsq(J, np.vecdot(n, q - p))[0], 2)
            R = Rotation.from_rotvec(turn).as_matrix()
            T = pose(R, center + move - R @ center) @ T
    return T


@pytest.mark.parametrize("method", ["point", "plane"])
@settings(max_examples=8)
@given(seed=seeds)
def test_the_same_steps_from_the_same_start_come_to_the_same_pose(method: str, seed: int) -> None:
    target = wavy(seed, 1500, 0.01)
    source = se3.apply(se3.inverse(small_pose(seed)), wavy(seed + 1, 1500, 0.01))
    facing = normals(target).normals if method == "plane" else None
    expected = written_out(source, target, facing, 0.5, 30)
    found = register(source, target, 0.5, method=method, thin=(), most=30, settled=0.0)
    np.testing.assert_allclose(found.T_target_source, expected, rtol=0, atol=1e-9)


@settings(max_examples=10)
@given(seeds)
def test_point_to_point_never_makes_the_error_larger(seed: int) -> None:
    """With all points in reach each step lowers E, or keeps it: Besl and McKay 1992, theorem."""
    source = se3.apply(small_pose(seed), wavy(seed, 600, 0.02))
    errors = [step.error for step in icp(source, wavy(seed + 1, 600, 0.02), 100.0)]
    assert len(errors) > 2
    assert (np.diff(errors) <= 1e-12).all()


@pytest.mark.parametrize("method", ["point", "plane"])
def test_pairs_that_are_kept_are_those_a_new_search_finds(method: str) -> None:
    source, target = se3.apply(small_pose(4), wavy(8, 1500)), wavy(9, 1500)
    source = np.concatenate([source, source[:50] + np.array([0.0, 0.0, 0.35])])
    tree = cKDTree(target)
    for step in icp(source, target, 0.3, method=method, settled=1e-9):
        distance, place = tree.query(se3.apply(step.T_target_source, source), distance_upper_bound=0.3)
        expected = np.where(np.isfinite(distance), place, -1)
        np.testing.assert_array_equal(step.target, expected)
        near = distance[np.isfinite(distance)]
        assert step.error == pytest.approx(float(near @ near), rel=1e-9)
        assert step.fitness == len(near) / len(source)
        assert step.rmse == pytest.approx(math.sqrt((near**2).mean()), rel=1e-9)


def test_the_first_step_is_the_start() -> None:
    T = small_pose(1)
    first = next(icp(wavy(0, 100), wavy(1, 100), 1.0, start=T))
    np.testing.assert_array_equal(first.T_target_source, T)


def test_coarse_to_fine_ends_where_all_points_do() -> None:
    target = wavy(0, 40_000)
    source = se3.apply(se3.inverse(small_pose(2)), wavy(1, 40_000))
    plain = register(source, target, 0.5, thin=(), settled=1e-10)
    thinned = register(source, target, 0.5, settled=1e-10)
    np.testing.assert_allclose(thinned.T_target_source, plain.T_target_source, rtol=0, atol=1e-4)
    assert sum(len(step.target) for step in thinned.steps) < sum(len(step.target) for step in plain.steps)


def test_what_a_floor_and_a_corridor_leave_open() -> None:
    rng = np.random.default_rng(0)
    floor = np.concatenate([rng.uniform(-3.0, 3.0, (500, 2)), np.zeros((500, 1))], axis=1)
    up = np.tile([0.0, 0.0, 1.0], (500, 1))
    seen = observability(floor, up)
    open_ = seen.unobservable()
    assert len(open_) == 3
    # turning about the normal, and both translations along it
    expected = np.zeros((3, 6))
    expected[[0, 1, 2], [2, 3, 4]] = 1.0
    assert np.linalg.matrix_rank(np.concatenate([open_, expected]), tol=1e-9) == 3
    wall = floor[:, [2, 0, 1]] + [3.0, 0.0, 0.0]
    corridor = observability(np.concatenate([floor, wall]), np.repeat([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], 500, axis=0))
    (along,) = corridor.unobservable()
    np.testing.assert_allclose(np.abs(along), [0.0, 0.0, 0.0, 0.0, 1.0, 0.0], atol=1e-9)


def test_points_on_a_line_leave_the_turn_about_it_open() -> None:
    seen = observability(np.outer(np.linspace(-1.0, 1.0, 50), [1.0, 0.0, 0.0]))
    (about,) = seen.unobservable()
    np.testing.assert_allclose(np.abs(about), [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], atol=1e-9)


def test_a_flat_floor_is_registered_without_sliding() -> None:
    rng = np.random.default_rng(0)
    target = np.concatenate([rng.uniform(-3.0, 3.0, (3000, 2)), np.zeros((3000, 1))], axis=1)
    source = target[:1000] + np.array([0.0, 0.0, 0.1])
    found = register(source, target, 0.5, method="plane")
    np.testing.assert_allclose(found.T_target_source, se3.transform(np.eye(3), [0.0, 0.0, -0.1]), rtol=0, atol=1e-9)
    assert found.observability is not None
    assert len(found.observability.unobservable()) == 3


@pytest.mark.parametrize("method", ["point", "plane"])
def test_clouds_out_of_reach_stay_where_they_are(method: str) -> None:
    found = register(wavy(0, 700), wavy(0, 700) + 50.0, 0.2, method=method)
    np.testing.assert_array_equal(found.T_target_source, np.eye(4))
    assert not found.converged
    assert found.last.fitness == 0.0
    assert math.isnan(found.last.rmse)
    assert found.observability is None


@pytest.mark.parametrize("cloud", [np.full((20, 3), 0.3), np.outer(np.arange(20.0), [1.0, 0.5, 0.2]), np.zeros((1, 3))])
@pytest.mark.parametrize("method", ["point", "plane"])
def test_degenerate_clouds_are_answered(cloud: Array, method: str) -> None:
    found = register(cloud, cloud, 0.5, method=method)
    np.testing.assert_allclose(found.T_target_source, np.eye(4), rtol=0, atol=1e-9)


def test_given_normals_are_used() -> None:
    points = wavy(0, 500)
    target = Target(points, np.tile([0.0, 0.0, 1.0], (500, 1)))
    found = register(points + np.array([0.1, 0.0, 0.05]), target, 0.5)
    assert found.T_target_source[0, 3] == pytest.approx(0.0, abs=0.02)  # nothing pulls it along x
    moved = se3.apply(small_pose(5), points)
    own = register(moved, Target(points, normals(points).normals), 0.5)
    np.testing.assert_array_equal(own.T_target_source, register(moved, points, 0.5).T_target_source)


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ({"reach": 0.0}, "reach"),
        ({"method": "lines"}, "method"),
        ({"source": np.empty((0, 3))}, "source"),
        ({"target": np.empty((0, 3))}, "target"),
        ({"start": np.eye(3)}, "start"),
        ({"thin": (0,)}, "thin"),
    ],
)
def test_wrong_arguments_are_refused(arguments: dict[str, object], name: str) -> None:
    given_ = {"source": wavy(0, 10), "target": wavy(0, 10), "reach": 1.0, **arguments}
    with pytest.raises(GeometryError, match=name):
        register(**given_)  # type: ignore[arg-type]


def test_progress_rises_to_one() -> None:
    seen: list[float] = []
    register(wavy(0, 5000), wavy(1, 5000), 0.5, progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0
