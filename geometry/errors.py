"""The one exception of the package, and the checks that raise it.

Input that is wrong as a whole raises; a failing row of a batch is NaN, and False in a mask if there is one.
"""

import math
from reprlib import Repr

import numpy as np

from .arrays import Array

_short = Repr()
_short.maxother = _short.maxstring = 120


class GeometryError(ValueError):
    """An argument for which the geometry doesn't exist: which one, what it was, and what is allowed."""

    def __init__(self, argument: str, received: object, allowed: str) -> None:
        super().__init__(argument, received, allowed)
        self.argument = argument
        self.received = received
        self.allowed = allowed

    def __str__(self) -> str:
        received = " ".join(_short.repr(self.received).split())
        return f"{self.argument} is {received}; allowed: {self.allowed}"


def as_array(argument: str, value: object, *shape: int) -> Array:
    """Return the value as float64 whose last dimensions are `shape`, or raise GeometryError."""
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise GeometryError(argument, value, "numbers") from None
    if array.ndim < len(shape) or array.shape[array.ndim - len(shape) :] != shape:
        wanted = ", ".join(["...", *map(str, shape)])
        raise GeometryError(argument, f"an array of shape {array.shape}", f"shape ({wanted})")
    return array


def as_finite_array(argument: str, value: object, *shape: int) -> Array:
    """Return the value as finite float64 whose last dimensions are `shape`, or raise GeometryError."""
    array = as_array(argument, value, *shape)
    if not np.isfinite(array).all():
        raise GeometryError(argument, value, "finite numbers")
    return array


def as_angle(argument: str, value: object) -> float | Array:
    """Return a batch of angles as an array, or one angle as a float: GeometryError if that isn't finite."""
    if isinstance(value, float) and math.isfinite(value):
        return value
    array = as_array(argument, value)
    return array if array.ndim else as_number(argument, array.item())


def as_number(argument: str, value: float, *, above: float = -math.inf, least: float = -math.inf) -> float:
    """Return a finite number greater than `above` and not less than `least`, or raise GeometryError."""
    if math.isfinite(value) and value > above and value >= least:
        return float(value)
    bounds = [f"above {above:g}"] * (above > -math.inf) + [f"at least {least:g}"] * (least > -math.inf)
    raise GeometryError(argument, value, " ".join(["a finite number", *bounds]))


def as_choice(argument: str, value: str, allowed: tuple[str, ...]) -> str:
    """Return the value if it is one of the allowed strings, or raise GeometryError."""
    if value not in allowed:
        raise GeometryError(argument, value, ", ".join(allowed))
    return value
