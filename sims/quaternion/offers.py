"""What opening and closing a fold leads to."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sims.kit.offers import Offers
from sims.quaternion.params import WHOLE, QuaternionParams

SHORT = 120.0
"""Degrees of a way on which SLERP and NLERP can hardly be told apart."""
TELLING: Mapping[str, Any] = {"axis": (1.0, 0.0, 1.0), "angle": 170.0}
"""A turn where SLERP, NLERP and Euler angles differ."""


class QuaternionOffers(Offers[QuaternionParams]):
    """The fold of what is shown is open; one that is opened begins where there is something to see."""

    def __init__(self, params: QuaternionParams, solution: object = None) -> None:
        topic = params.topic
        super().__init__(params if topic == "turn" else params.model_copy(update={"show": topic}), solution)

    def moved(self, changes: Mapping[str, Any]) -> QuaternionParams:
        """The state after a control moved, or a fold was opened or closed."""
        show = changes.get("show", self.params.topic) or "turn"
        return super().moved(changes if show == self.params.topic else {**_begin(self.params, show), **changes})


def _begin(p: QuaternionParams, show: str) -> Mapping[str, Any]:
    """What a topic begins with."""
    turned = p.angle % WHOLE
    if show == "path":
        short = min(turned, WHOLE - turned) < SHORT and not p.long_way
        return {"t": 0.25, **(TELLING if short else {})}
    return {"t": 1.0, **({"angle": 90.0} if show == "order" and turned == 0.0 else {})}
