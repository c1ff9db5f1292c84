"""The simulated clouds: what they hold, that they stay the same, and that they show what they are for."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from geometry import clouds, se3
from sims.point_cloud import SIM
from sims.point_cloud.datasets import DATASETS, RINGS, dataset


@pytest.mark.parametrize("name", DATASETS)
def test_each_has_points_and_what_belongs_to_them(name: str) -> None:
    cloud = dataset(name)
    count = len(cloud)
    assert 50_000 <= count <= 200_000
    assert cloud.simulated
    assert np.isfinite(cloud.points).all()
    assert cloud.sensor is not None
    assert cloud.intensity is not None
    assert cloud.intensity.shape == (count,)
    assert 0.0 <= cloud.intensity.min() < cloud.intensity.max() <= 1.0
    for values in (cloud.colors, cloud.ring, cloud.scan):
        assert values is None or len(values) == count


@pytest.mark.parametrize("name", DATASETS)
def test_each_is_the_same_every_time(name: str) -> None:
    np.testing.assert_array_equal(DATASETS[name]().points, dataset(name).points)


def test_each_is_made_once_however_many_ask() -> None:
    with ThreadPoolExecutor(4) as pool:
        clouds = list(pool.map(dataset, ["room"] * 4))
    assert len(set(map(id, clouds))) == 1


def test_all_are_made_ahead() -> None:
    assert [piece() for piece in SIM.ahead] == [dataset(name) for name in DATASETS]


def test_the_room_stands_on_its_floor() -> None:
    room = dataset("room")
    ground = clouds.ransac_plane(room.points, 0.02, up=[0.0, 0.0, 1.0], tilt=0.2)
    assert ground.normal[2] > 0.9999
    assert abs(ground.offset) < 0.01
    assert room.colors is not None
    assert len(np.unique(room.colors, axis=0)) > 100


def test_the_street_has_rings_shadows_and_two_posts() -> None:
    street = dataset("street")
    assert street.ring is not None
    assert street.intensity is not None
    assert set(np.unique(street.ring)) <= set(range(RINGS))
    assert len(np.unique(street.ring)) > 50
    assert street.colors is None
    # nothing comes back from the road behind the nearest car, which is there between the sensor and it
    behind = street.points[(np.abs(street.points[:, 0] + 4.2) < 0.2) & (np.abs(street.points[:, 1] - 9.3) < 0.2)]
    assert not (behind[:, 2] < 0.3).any()
    posts = street.points[
        (np.abs(street.points[:, 0] - 5.0) < 0.1) & (street.points[:, 2] > 0.5) & (street.points[:, 2] < 2.2)
    ]
    near = posts[(posts[:, 1] > 1.3) & (posts[:, 1] < 2.4)]
    assert len(clouds.clusters(near, 0.3, least=10).sizes) == 2
    assert len(clouds.clusters(near, 0.6, least=10).sizes) == 1
    paint = street.intensity[(np.abs(street.points[:, 0]) < 0.06) & (np.abs(street.points[:, 1]) < 20.0)]
    assert np.percentile(paint, 90) > 2.0 * np.percentile(paint, 10)


def test_the_statue_has_points_off_it() -> None:
    statue = dataset("statue")
    kept = clouds.outliers(statue.points, 16, 2.0).keep
    assert 0.9 < kept.mean() < 0.995
    size = np.ptp(statue.points[kept], axis=0)
    assert size[2] == pytest.approx(2.31, abs=0.1)
    assert size[2] < np.ptp(statue.points, axis=0)[2]


def test_the_two_scans_come_together_within_5_mm() -> None:
    both = dataset("two-scans")
    assert both.truth is not None
    first, second = both.points[both.scan == 0], both.points[both.scan == 1]
    coarse = clouds.register(second, first, 0.3, method="plane")
    fine = clouds.register(second, first, 0.05, method="plane", start=coarse.T_target_source, thin=())
    corners = np.array([[-2.2, 1.5, 0.0], [2.2, 1.5, 0.0], [-2.2, 1.5, 2.0], [1.0, -1.5, 0.0]])
    there, truth = se3.apply(fine.T_target_source, corners), se3.apply(both.truth, corners)
    assert np.linalg.norm(there - truth, axis=1).max() < 0.005
    untouched = np.linalg.norm(corners - truth, axis=1).max()
    assert untouched > 0.15
    assert fine.observability is not None
    assert not len(fine.observability.unobservable())
