"""One exception, which names the argument, what it was and what is allowed."""

import copy
import math
import pickle

import numpy as np
import pytest

from geometry import GeometryError
from geometry.errors import as_angle, as_array, as_choice, as_finite_array, as_number


def test_names_argument_received_and_allowed() -> None:
    error = GeometryError("axis", "w", "x, y, z")
    assert (error.argument, error.received, error.allowed) == ("axis", "w", "x, y, z")
    assert str(error) == "axis is 'w'; allowed: x, y, z"
    assert isinstance(error, ValueError)


def test_survives_a_copy_and_a_trip_between_processes() -> None:
    original = GeometryError("angle", math.inf, "finite")
    for error in (copy.copy(original), pickle.loads(pickle.dumps(original))):
        assert (error.argument, error.received, error.allowed) == ("angle", math.inf, "finite")
        assert str(error) == str(original)


def test_shortens_what_is_long_to_one_line() -> None:
    message = str(GeometryError("points", np.zeros((1000, 3)).tolist(), "fewer"))
    assert len(message) < 300
    assert "\n" not in message


@pytest.mark.parametrize("value", [[1.0, 2.0], np.zeros((3, 2)), 1.0, "abc", [[1.0], [1.0, 2.0]], None, object()])
def test_rejects_what_has_not_the_shape(value: object) -> None:
    with pytest.raises(GeometryError) as caught:
        as_array("point", value, 3)
    assert caught.value.argument == "point"


def test_accepts_any_batch_of_the_shape() -> None:
    assert as_array("R", np.zeros((2, 5, 3, 3)), 3, 3).shape == (2, 5, 3, 3)
    assert as_array("point", (1, 2, 3), 3).dtype == np.float64


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_rejects_numbers_that_are_not_finite(value: float) -> None:
    for check in (as_number, as_angle, as_finite_array):
        with pytest.raises(GeometryError, match="a is"):
            check("a", value)


def test_rejects_numbers_out_of_bounds() -> None:
    assert as_number("depth", 1, above=0.0) == 1.0
    assert as_number("sigma", 0.0, least=0.0) == 0.0
    with pytest.raises(GeometryError, match=r"depth is 0.0; allowed: a finite number above 0"):
        as_number("depth", 0.0, above=0.0)
    with pytest.raises(GeometryError, match=r"sigma is -1.0; allowed: a finite number at least 0"):
        as_number("sigma", -1.0, least=0.0)


def test_rejects_choices_that_are_not_offered() -> None:
    assert as_choice("frame", "intrinsic", ("intrinsic", "extrinsic")) == "intrinsic"
    with pytest.raises(GeometryError, match="frame is 'both'; allowed: intrinsic, extrinsic"):
        as_choice("frame", "both", ("intrinsic", "extrinsic"))


def test_one_angle_is_a_float_and_many_are_an_array() -> None:
    assert isinstance(as_angle("angle", np.float64(1.0)), float)
    assert isinstance(as_angle("angle", 1), float)
    assert isinstance(as_angle("angle", np.array(1.0)), float)
    assert isinstance(as_angle("angle", [1.0, math.nan]), np.ndarray)
