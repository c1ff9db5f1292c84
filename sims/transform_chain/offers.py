"""What the controls of an arm offer: a joint that turns its angle, one that slides its way."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sims.kit.offers import Offers
from sims.transform_chain.params import ChainParams
from sims.transform_chain.presets import known

ONLY = {"angles": "r", "offsets": "p"}
"""Lists in which only joints of a kind have a control."""


class ChainOffers(Offers[ChainParams]):
    """Offers of a state of this sim."""

    def form(self) -> tuple[Any, ...]:
        return *super().form(), known(self.params) if "p" in self.params.joints else None

    def bounds(self, name: str) -> tuple[float, float]:
        arm = known(self.params) if name == "offsets" else None
        return super().bounds(name) if arm is None or arm.stroke is None else arm.stroke

    def entries(self, name: str) -> Sequence[Any]:
        entries: Sequence[Any] = super().entries(name)
        if name not in ONLY:
            return entries
        joints = self.params.joints or "r" * self.params.count
        return [value if joint == ONLY[name] else None for value, joint in zip(entries, joints, strict=False)]
