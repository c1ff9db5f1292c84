"""Parameters of the sim."""

from __future__ import annotations

from typing import Annotated, Literal

from sims.kit.fields import Choice, NumberBox, Slider, Switch, Vector
from sims.kit.frame import HEIGHT, WIDTH
from sims.kit.params import Params

Method = Literal["dlt", "midpoint", "optimal"]
Pixel = tuple[float, float]
NAMES: dict[Method, str] = {"dlt": "DLT", "midpoint": "mid-point", "optimal": "optimal"}
LAST: Pixel = (WIDTH - 1.0, HEIGHT - 1.0)
NEAREST, FARTHEST = (-60.0, 0.0, -50.0), (60.0, 100.0, 50.0)
"""Places, in metres, that can be typed."""
LAST_SEED = 9999


IMAGES, SURENESS = "Image points", "How sure it is"
"""Titles of folds."""


class TriangulationParams(Params):
    """State of the sim."""

    baseline: Annotated[float, Slider(0.05, 2, step=0.01, unit="m", symbol="b", title="Baseline")] = 0.6
    """Distance between the cameras"""
    focal: Annotated[float, Slider(200, 1500, step=10, unit="px", symbol="f", title="Focal length")] = 600
    """The same for both cameras"""
    left_uv: Annotated[Pixel, Vector((0.0, 0.0), LAST, step=0.1, unit="px", title="Left point u, v", group=IMAGES)] = (
        410.0,
        210.0,
    )
    """Where the point is in the left picture, before noise"""
    right_uv: Annotated[
        Pixel, Vector((0.0, 0.0), LAST, step=0.1, unit="px", title="Right point u, v", group=IMAGES)
    ] = (320.0, 210.0)
    """Where the point is in the right picture, before noise"""
    noise: Annotated[float, Slider(0, 5, step=0.05, unit="px", symbol="σ", title="Noise")] = 0
    """Standard deviation of Gaussian noise on both points; 0 is off"""
    seed: Annotated[int, NumberBox(0, LAST_SEED, step=1, title="Sample", group=SURENESS)] = 0
    """Seed of the noise: the same seed, the same noise"""
    method: Annotated[
        Method,
        Choice(
            title="Method", labels={"dlt": "DLT (linear)", "midpoint": "Mid-point", "optimal": "Optimal (least error)"}
        ),
    ] = "dlt"
    """Which reconstruction is the result"""
    show_ellipsoid: Annotated[bool, Switch(title="Show ellipsoid", group=SURENESS)] = True
    """The uncertainty of the result, three standard deviations wide"""
