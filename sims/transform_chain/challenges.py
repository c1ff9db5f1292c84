"""What is to be reached with an arm."""

from __future__ import annotations

import math

from sims.kit.challenge import Challenge, Progress, nearer
from sims.kit.readout import quantity
from sims.transform_chain.labels import outcome
from sims.transform_chain.params import ChainParams
from sims.transform_chain.solution import ENOUGH, ChainSolution

TURN = 10.0
"""Degrees that each of two exchanged turns must have, to be seen."""
ALIKE = "the same pose"


def _reach(p: ChainParams, s: ChainSolution) -> Progress:
    if s.target_distance is None:
        return Progress(0.0, "Ask for a new target first.")
    away = s.target_distance
    return nearer(away, 2.0 * sum(map(abs, p.lengths)) or 1.0, ENOUGH, f"{quantity(away, 'm', 2)} to go", "Reached")


def _two_orders(
    p: ChainParams, s: ChainSolution, before: ChainParams | None, _: ChainSolution | None = None
) -> Progress:
    if s.swapped is None or p.swap is None:
        return Progress(0.0, "Swap two neighbouring transforms first.")
    k = p.swap - 1
    if any(p.slides(i) or p.lengths[i] or p.offset(i) for i in (k, k + 1)):
        return Progress(0.1, "Both must be turns alone: set the lengths of these two links to 0.")
    if min(abs(p.angles[k]), abs(p.angles[k + 1])) < TURN:
        return Progress(0.2, f"Let both turn by {TURN:.0f}° or more, so that something is to be seen.")
    if outcome(s.swapped) == ALIKE:
        return Progress(0.5, "The same. Now let the two turn about different axes, and change nothing else.")
    if before is not None and _only_an_axis(before, p, k):
        return Progress(1.0, "Alike about one axis, not about two")
    return Progress(0.3, "They end apart. Let both turn about one axis first, then change an axis and nothing else.")


def _only_an_axis(before: ChainParams, p: ChainParams, k: int) -> bool:
    """Whether the two turned about one axis before, and nothing but an axis has changed."""
    alone = before == p.model_copy(update={"axes": before.axes})  # so it had as many joints
    return alone and before.axes[k] == before.axes[k + 1]


def _singular(p: ChainParams, s: ChainSolution) -> Progress:
    if p.plane is None or p.count != 2 or 0.0 in p.lengths:
        return Progress(0.0, "Take the planar 2R arm first, from the presets: two joints about one axis.")
    bend = abs(math.remainder(p.angles[1], 180.0))
    words = f"The elbow is {quantity(bend, '°', 1)} from such a pose"
    return nearer(bend, 90.0, 1e-6, words, "Singular: along the arm nothing moves")


CHALLENGES: tuple[Challenge[ChainParams, ChainSolution], ...] = (
    Challenge(
        id="reach", title="Reach the target",
        goal="Ask for a new target, and bring the end effector there.",
        near=_reach, solves={"angles": (90, 0, 0), "target": (0.0, 2.3, 0.0)},
        misses=(
            {"angles": (88, 0, 0), "target": (0.0, 2.3, 0.0)},
            {"angles": (60, 0, 0), "target": (0.0, 2.3, 0.0)},
        ),
    ),
    Challenge(
        id="two-orders", title="When the order matters",
        goal=(
            "Swap two turns about the same axis and see that nothing changes. Then change one axis, nothing else, and"
            " see that it does."
        ),
        near=_two_orders, path=True,
        starts={"axes": "zzy", "lengths": (0, 0, 1), "swap": 1},
        solves={"axes": "zyy", "lengths": (0, 0, 1), "swap": 1},
        misses=(
            {"axes": "zzy", "lengths": (0, 0, 1), "swap": 1},
            {"axes": "zyy", "lengths": (0, 0.5, 1), "swap": 1},
            {"axes": "zyy", "lengths": (0, 0, 1), "swap": 1, "angles": (30, 50, 0)},
        ),
    ),
    Challenge(
        id="singular", title="A pose that loses a direction",
        goal="Put a planar arm of two links in a pose from which it can’t move along itself.",
        near=_singular, solves={"axes": "zz", "lengths": (1, 0.8), "angles": (30, 0)},
        misses=(
            {"axes": "zz", "lengths": (1, 0.8), "angles": (30, 2)},
            {"axes": "zz", "lengths": (1, 0.8), "angles": (0, 60)},
        ),
    ),
)  # fmt: skip
