"""What the controls offer: those of the sim's cameras, or of somebody's stereo pair."""

from __future__ import annotations

from collections.abc import Collection

from sims.epipolar.params import EpipolarParams
from sims.kit.offers import Offers

OF_THE_SIM, OF_THE_PAIR = ("left", "right", "left_pan", "right_pan", "focal"), ("own_left", "own_right")


class EpipolarOffers(Offers[EpipolarParams]):
    """What a state offers."""

    def idle(self) -> Collection[str]:
        return OF_THE_PAIR if self.params.pair is None else OF_THE_SIM
