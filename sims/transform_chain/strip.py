"""The product factor by factor, as a strip: T₀₁ T₁₂ …, and under each what is multiplied up to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from geometry.arrays import Array
from sims.kit.readout import math, mathml

AXES = ("x", "y", "z")
OPEN = 3
"""Links of an arm at most whose matrices all stand in the strip."""
SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def sub(number: int) -> str:
    """A number as a subscript."""
    return str(number).translate(SUBSCRIPTS)


def linked(i: int) -> str:
    """What the i-th link, from 1, is highlighted with: its controls."""
    return " ".join(f"{name}.{i - 1}" for name in ("angles", "lengths", "axes", "offsets"))


@dataclass(frozen=True)
class Strip:
    """A radio button for each link, and one for all: what is chosen is shown alone. Few links show their matrices."""

    individual: Sequence[Array]
    composed: Sequence[Array]
    stage: int | None

    def html(self) -> str:
        whole = self.stage is None and len(self.individual) <= OPEN
        cards = "".join(self._card(i, whole) for i in range(1, len(self.individual) + 1))
        every = _radio("", "All transforms", self.stage is None) + "<span>All</span>"
        kind = "s3-stages s3-open" if whole else "s3-stages"
        return (
            f'<div class="{kind}" role="group" aria-label="Transforms: show one alone, or all">{cards}'
            f'<label class="s3-stage">{every}</label></div>'
        )

    def _card(self, i: int, whole: bool) -> str:
        own, product = f"T{sub(i - 1)}{sub(i)}", f"T{sub(0)}{sub(i)}"
        says = f"{own}, from frame {i - 1} to frame {i}, and the product {product} up to it"
        factor, so_far = (
            math(mathml(T, 2, roles=AXES)) if whole else "" for T in (self.individual[i - 1], self.composed[i - 1])
        )
        so = "so far " if whole else ""
        return (
            f'<label class="s3-stage" data-link="{linked(i)}">{_radio(str(i), says, i == self.stage)}<span>{own}</span>'
            f'{factor}<span class="s3-product">{so}{product}</span>{so_far}</label>'
        )


def _radio(value: str, says: str, chosen: bool) -> str:
    checked = ' checked=""' if chosen else ""
    return (
        f'<input type="radio" name="stage-of-strip" data-choice="stage" value="{value}" aria-label="{says}"{checked}/>'
    )
