"""Parameters of the sim."""

from __future__ import annotations

from typing import Literal

from sims.kit.frame import HEIGHT, WIDTH
from sims.kit.params import Params, choice, number, switch, vector

Method = Literal["dlt", "midpoint", "optimal"]
Pixel = tuple[float, float]
NAMES: dict[Method, str] = {"dlt": "DLT", "midpoint": "mid-point", "optimal": "optimal"}
LAST: Pixel = (WIDTH - 1.0, HEIGHT - 1.0)
NEAREST, FARTHEST = (-60.0, 0.0, -50.0), (60.0, 100.0, 50.0)
"""Places, in metres, that can be typed."""
LAST_SEED = 9999


class TriangulationParams(Params):
    """State of the sim."""

    baseline: float = number(
        0.6, 0.05, 2, step=0.01, unit="m", title="Baseline", symbol="b", description="Distance between the cameras"
    )
    focal: float = number(
        600, 200, 1500, step=10, unit="px", title="Focal length", symbol="f", description="Of both cameras"
    )
    left_uv: Pixel = vector(
        (410.0, 210.0), (0.0, 0.0), LAST, step=0.1, unit="px", title="Left point u, v",
        description="Where the point is in the left picture, before noise",
    )  # fmt: skip
    right_uv: Pixel = vector(
        (320.0, 210.0), (0.0, 0.0), LAST, step=0.1, unit="px", title="Right point u, v",
        description="Where the point is in the right picture, before noise",
    )  # fmt: skip
    noise: float = number(
        0, 0, 5, step=0.05, unit="px", title="Noise", symbol="σ",
        description="Standard deviation of Gaussian noise on both points; 0 is off",
    )  # fmt: skip
    seed: int = number(
        0, 0, LAST_SEED, step=1, title="Sample", description="Seed of the noise: the same seed, the same noise",
        control="number",
    )  # fmt: skip
    method: Method = choice(
        "dlt", title="Method", description="Which reconstruction is the result",
        labels={"dlt": "DLT (linear)", "midpoint": "Mid-point", "optimal": "Optimal (least error)"},
    )  # fmt: skip
    show_ellipsoid: bool = switch(
        True, title="Show ellipsoid", description="The uncertainty of the result, three standard deviations wide"
    )
