"""Lens distortion against OpenCV."""

import math

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geometry import Array, GeometryError
from geometry.distortion import Distortion
from tests.geometry.strategies import seeds

LENSES = {
    "none": Distortion(),
    "barrel": Distortion(-0.28, 0.07, 0.0002, 0.00002),
    "pincushion": Distortion(0.15, 0.02, 0.001, -0.002, 0.01),
    "wide, of an action camera": Distortion(-0.26, 0.08, 0.0005, -0.0003, -0.012),
    "tangential alone": Distortion(0.0, 0.0, 0.01, -0.02),
}
each = pytest.mark.parametrize("lens", LENSES.values(), ids=LENSES.keys())
K = np.array([[500.0, 0.0, 320.0], [0.0, 480.0, 240.0], [0.0, 0.0, 1.0]])


def vector(lens: Distortion) -> Array:
    return np.array([lens.k1, lens.k2, lens.p1, lens.p2, lens.k3])


@given(st.builds(Distortion, *[st.floats(-0.5, 0.5)] * 2, *[st.floats(-0.02, 0.02)] * 2, st.floats(-0.5, 0.5)), seeds)
def test_applied_it_is_opencvs_projection(lens: Distortion, seed: int) -> None:
    points = np.random.default_rng(seed).uniform(-1.0, 1.0, (20, 2))
    theirs, _ = cv2.projectPoints(np.column_stack([points, np.ones(20)]), np.zeros(3), np.zeros(3), K, vector(lens))
    ours = lens.apply(points) * (500.0, 480.0) + (320.0, 240.0)
    np.testing.assert_allclose(ours, theirs.reshape(-1, 2), rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(lens.apply(points[0]), lens.apply(points)[0], rtol=1e-14, atol=1e-15)


@each
def test_undone_it_is_as_before_and_opencvs(lens: Distortion) -> None:
    points = np.random.default_rng(2).uniform(-0.6, 0.6, (200, 2))
    seen = lens.apply(points)
    np.testing.assert_allclose(lens.undo(seen), points, rtol=0, atol=1e-10)
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 200, 1e-14)
    theirs = cv2.undistortPoints(seen[:, None], np.eye(3), vector(lens), R=None, P=None, criteria=criteria)
    np.testing.assert_allclose(lens.undo(seen), theirs[:, 0], rtol=0, atol=1e-8)


def test_the_reach_is_where_the_picture_would_fold_back() -> None:
    assert LENSES["none"].reach == LENSES["pincushion"].reach == math.inf
    lens = Distortion(k1=-0.3)
    assert lens.reach == pytest.approx(1.0 / math.sqrt(0.9))
    radii = np.linspace(0.0, 2.0 * lens.reach, 1001)
    seen = lens.apply(np.column_stack([radii, np.zeros(1001)]))[:, 0]
    assert radii[np.argmax(seen)] == pytest.approx(lens.reach, abs=2e-3)
    beyond = [seen.max() + 0.01, 0.0]
    assert np.isnan(lens.undo(beyond)).all()
    assert np.isfinite(lens.undo([[0.2, 0.1], beyond])[0]).all()


def test_whether_a_lens_changes_anything() -> None:
    assert not Distortion()
    assert Distortion(p2=1e-9)
    with pytest.raises(GeometryError, match="k2"):
        Distortion(k2=math.nan)
