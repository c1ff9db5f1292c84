"""What the angles and axes of each order are called: in controls, words, hints and the scene alike."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

from geometry import euler

PARAMETERS = {"z": "yaw", "y": "pitch", "x": "roll"}
WORDS = {"yaw": ("yaw", "ψ"), "pitch": ("pitch", "θ"), "roll": ("roll", "φ")}
NUMBERS = (("first angle", "α"), ("second angle", "β"), ("third angle", "γ"))
PLACES = ("First", "Second", "Third")
POSITIVE = {
    "z": "turns the nose to the left",
    "y": "lowers the nose: with Z up, the right hand’s rule about the left wing takes Z to X",
    "x": "lifts the left wing",
}
"""What a positive turn about each axis does."""


class TurnName(NamedTuple):
    """One turn of an order: the parameter of its angle, the angle's word and symbol, its axis (as X or Y′), a hint."""

    parameter: str
    word: str
    symbol: str
    axis: str
    about: str

    @property
    def said(self) -> str:
        """As in a sentence: yaw ψ."""
        return f"{self.word} {self.symbol}"

    @property
    def short(self) -> str:
        """As beside an arc: a word that says which, or the symbol."""
        return self.symbol if " " in self.word else self.word

    @property
    def label(self) -> str:
        """As beside its control: Yaw ψ · Z."""
        word = self.word.removesuffix(" angle")
        return f"{word[0].upper()}{word[1:]} {self.symbol} · {self.axis}"


@cache
def turns(order: str, frame: str) -> tuple[TurnName, ...]:
    """The three turns, in the order in which they are made."""
    proper = euler.is_proper(order)
    named = [(tuple(WORDS)[k], *NUMBERS[k]) for k in range(3)]
    if not proper:
        named = [(PARAMETERS[axis], *WORDS[PARAMETERS[axis]]) for axis in order]
    return tuple(TurnName(*name, *_axis(order, frame, k)) for k, name in enumerate(named))


def _axis(order: str, frame: str, k: int) -> tuple[str, str]:
    """The axis of the k-th turn, and what its angle is for."""
    letter = order[k].upper()
    if frame == "extrinsic":
        return letter, f"{PLACES[k]} turn, about the world’s fixed {letter}. A positive angle {POSITIVE[order[k]]}"
    axis = letter + "′" * k
    by_then = ("where it starts", "where one turn has taken it", "where two turns have taken it")[k]
    return (
        axis,
        f"{PLACES[k]} turn, about the aircraft’s own {letter}, {by_then}. A positive angle {POSITIVE[order[k]]}",
    )
