"""Clouds for the tests: on surfaces, in volumes, and the degenerate ones."""

import numpy as np
from hypothesis import strategies as st

from geometry import Array
from tests.geometry.strategies import seeds


def wavy(seed: int, count: int, noise: float = 0.003) -> Array:
    """Points on a wavy floor and a wall, about 20 points per square metre at a thousand."""
    rng = np.random.default_rng(seed)
    u, v = rng.uniform(0.0, 6.0, (2, count))
    floor = np.stack([u, v, 0.3 * np.sin(u) + 0.2 * np.cos(1.3 * v)], axis=1)
    wall = np.stack([u, np.full(count, 6.0), 0.5 * v], axis=1)
    return np.where((rng.random(count) < 0.7)[:, None], floor, wall) + rng.normal(0.0, noise, (count, 3))


def blob(seed: int, count: int, scale: float = 1.0, center: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Array:
    """Points of a normal distribution."""
    return np.asarray(np.random.default_rng(seed).normal(center, scale, (count, 3)))


DEGENERATE: dict[str, Array] = {
    "none": np.empty((0, 3)),
    "one": np.array([[1.0, -2.0, 3.0]]),
    "two": np.array([[1.0, -2.0, 3.0], [1.5, -2.0, 3.0]]),
    "all in one place": np.full((40, 3), 0.1),
    "on a line": np.outer(np.arange(40.0), [1.0, 2.0, -0.5]) * 0.1,
    "on a plane": np.pad(np.random.default_rng(1).random((40, 2)), ((0, 0), (0, 1))),
}

clouds = st.builds(wavy, seeds, st.integers(1, 400)) | st.builds(blob, seeds, st.integers(1, 400))
