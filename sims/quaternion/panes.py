"""The picture of what is shown: the half angle, the ball of all turns, or how far each way has turned."""

from __future__ import annotations

import math

import numpy as np

from geometry.interpolation import nlerp_angle
from sims.kit.pane import Pane
from sims.kit.plot import Plot
from sims.kit.readout import figure
from sims.quaternion.ball import ball
from sims.quaternion.dial import dial
from sims.quaternion.params import QuaternionParams
from sims.quaternion.solution import QuaternionSolution

TIMES = np.linspace(0.0, 1.0, 41)
TITLE = "Turned so far"


def panes(p: QuaternionParams, s: QuaternionSolution) -> list[Pane]:
    """The one picture that belongs to the topic; two turns in both orders need none."""
    match p.topic:
        case "order":
            return []
        case "ball":
            return [ball(p, s)]
        case "path":
            return [_turned_so_far(p, s)]
    return [dial(p)]


def _turned_so_far(p: QuaternionParams, s: QuaternionSolution) -> Pane:
    """Degrees over t: SLERP's line is straight, NLERP's is steep in the middle."""
    plot = Plot("turned", TITLE, x="t", y="°", x_max=1.0, y_max=max(s.way_angle, 1.0), x_step=0.2)
    uneven = np.degrees(nlerp_angle(math.radians(s.way_angle), TIMES))
    plot.curve([(0.0, 0.0), (1.0, s.way_angle)], "")
    plot.curve(list(zip(TIMES.tolist(), uneven.tolist(), strict=True)), "", ghost=True)
    at = p.t, p.t * s.way_angle
    return plot.pane("SLERP straight, NLERP dashed", at, handle="t", label=f"t = {figure(p.t, 2)}")
