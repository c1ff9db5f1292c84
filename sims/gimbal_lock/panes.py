"""The plot of the effort."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np

from geometry.gimbal import singular_values
from sims.gimbal_lock import digits
from sims.gimbal_lock.params import GimbalParams
from sims.gimbal_lock.solution import GimbalSolution
from sims.kit.pane import Pane
from sims.kit.plot import Plot


def panes(p: GimbalParams, s: GimbalSolution) -> Sequence[Pane]:
    """How the smallest singular value depends on the pitch."""
    least = s.singular_values.item(2)
    note = f"{digits.small(least)} at {digits.angle(p.pitch, 1)}"
    return (_curve().pane(note, (abs(p.pitch), least), handle="effort", label="Pitch of the middle ring"),)


@cache
def _curve() -> Plot:
    plot = Plot(
        "plot", "Smallest singular value", x="size of the pitch |θ| (°)", y="σ₃", x_max=180.0, y_max=1.0, x_step=45.0
    )
    pitches = np.linspace(0.0, 180.0, 121)
    least = singular_values(np.radians(pitches))[:, 2]
    plot.curve([(0.0, 0.5), (180.0, 0.5)], "half", ghost=True)
    plot.curve([*zip(pitches.tolist(), least.tolist(), strict=True)], "")
    return plot
