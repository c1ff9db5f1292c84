"""Where a node goes that the pointer leads round a circle."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sims.kit.scene.dragging import STRIDE, on_circle, on_sphere

EYES = [(0.0, 0.0, 5.0), (0.0, -5.0, 0.5), (3.0, -4.0, 0.0), (1.0, 2.0, -6.0)]
each_eye = pytest.mark.parametrize("eye", EYES)


def at(degrees: float) -> tuple[float, float, float]:
    """A place on a circle about z, above the origin."""
    return 1.2 * math.cos(math.radians(degrees)), 1.2 * math.sin(math.radians(degrees)), 0.4


@each_eye
@pytest.mark.parametrize("turn", [-50.0, -13.0, 0.0, 4.0, 59.0])
def test_it_goes_to_where_the_pointer_sees_it(eye: tuple[float, float, float], turn: float) -> None:
    """However far from the eye the place is to which the pointer pulls; on a circle seen from its edge too."""
    for start in (0.0, 130.0, -70.0):
        for far in (0.5, 1.0, 1.7):
            pulled = np.add(eye, far * np.subtract(at(start + turn), eye))
            found = on_circle(at(start), (0.0, 0.0, 1.0), eye, pulled)
            back = np.subtract(found, eye) / math.dist(found, eye)
            seen = np.subtract(at(start + turn), eye) / math.dist(at(start + turn), eye)
            np.testing.assert_allclose(back, seen, rtol=0, atol=2e-3)
            assert math.hypot(found[0], found[1]) == pytest.approx(1.2)
            assert found[2] == pytest.approx(0.4)


@each_eye
def test_it_never_jumps_to_the_other_side(eye: tuple[float, float, float]) -> None:
    for start in np.arange(0.0, 360.0, 45.0):
        x, y, _ = on_circle(at(start), (0.0, 0.0, 1.0), eye, at(start + 180.0))
        gone = math.remainder(math.atan2(y, x) - math.radians(start), 2.0 * math.pi)
        assert abs(gone) <= STRIDE + 1e-9


@each_eye
def test_a_spot_of_a_sphere_goes_to_where_the_pointer_sees_it(eye: tuple[float, float, float]) -> None:
    """On the side where it is; past the rim it stays on it."""
    for spot in np.random.default_rng(4).normal(size=(20, 3)):
        spot *= 0.8 / math.sqrt(spot @ spot)
        near = bool(spot @ eye >= spot @ spot)
        for far in (0.5, 1.0, 1.7):
            np.testing.assert_allclose(
                on_sphere(0.8, eye, eye + far * (spot - eye), near=near), spot, rtol=0, atol=1e-9
            )
    rim = on_sphere(0.8, eye, 3.0 * np.cross(eye, (1.0, 2.0, 3.0)), near=True)
    assert math.sqrt(rim @ rim) == pytest.approx(0.8)
