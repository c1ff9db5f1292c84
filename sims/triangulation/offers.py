"""What the controls offer: a parallel rig's, or no more than the baseline of somebody's stereo pair."""

from __future__ import annotations

from collections.abc import Collection

from sims.kit.offers import Offers
from sims.triangulation.params import OF_RIG, TriangulationParams


class TriangulationOffers(Offers[TriangulationParams]):
    """What a state offers."""

    def idle(self) -> Collection[str]:
        return OF_RIG - {"baseline"} if self.params.pair is not None else ()
