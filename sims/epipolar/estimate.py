"""F estimated from the pixels of the points, with noise, by the eight-point algorithm."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from geometry.arrays import Array
from geometry.eight_point import FEWEST, eight_point
from geometry.epipolar import epipolar_line_left, epipolar_line_right, normalize, sampson_distance
from geometry.triangulation import pixel_noise
from sims.epipolar.params import ENOUGH, ESTIMATE_ACTION, OTHERS, EpipolarParams
from sims.epipolar.rig import Pair, Views, existing_line
from sims.kit.readout import Formula, Note, Readout, Table, figure, mathml, quantity, significant, spelled, symbol


@dataclass(frozen=True, eq=False)
class Estimate:
    """F from the pixels of the points with noise, and how far pixels are from each F: root mean square, in pixels."""

    status: Literal["few", "ambiguous", "found"]
    seen: int
    measured_left: Array
    measured_right: Array
    conditioning: float | None = None
    F: Array | None = None
    singular_values: Array | None = None
    line_right: Array | None = None
    line_left: Array | None = None
    noisy_rms: float | None = None
    exact_rms: float | None = None
    noisy_rms_true: float | None = None
    difference: float | None = None
    """Frobenius norm of the difference of K′ᵀ F K from E, both of norm 1: in pixels F's entries don't compare."""


# ---- F from the points
@lru_cache(maxsize=64)
def _unit_noise(seed: int) -> Array:
    return pixel_noise(len(OTHERS) + 1, seed)


def estimate(p: EpipolarParams, both: Pair, seen: Views) -> Estimate:
    """What the pixels of the points with noise say of F."""
    noise = p.noise * _unit_noise(p.seed)[: p.points]
    left, right = seen.pixels_left + noise[:, 0], seen.pixels_right + noise[:, 1]
    both_see = np.isfinite(left[:, 0] + right[:, 0])
    count = int(both_see.sum())
    if count < FEWEST:
        return Estimate("few", count, left, right)
    found = eight_point(left[both_see], right[both_see])
    if not found.unique:
        return Estimate("ambiguous", count, left, right, found.conditioning)
    noisy, exact = (left, right), (seen.pixels_left, seen.pixels_right)
    pixel_left, pixel_right = exact[0][0], exact[1][0]
    return Estimate(
        "found", count, left, right, found.conditioning, found.F, found.singular_values,
        line_right=existing_line(epipolar_line_right(found.F, pixel_left)),
        line_left=existing_line(epipolar_line_left(found.F, pixel_right)),
        noisy_rms=_rms(found.F, *noisy),
        exact_rms=_rms(found.F, *exact),
        noisy_rms_true=None if both.F is None else _rms(both.F, *noisy),
        difference=None if both.E is None else _difference(normalize(both.right.K.T @ found.F @ both.left.K), both.E),
    )  # fmt: skip


def _rms(F: Array, left: Array, right: Array) -> float:
    squares = sampson_distance(F, left, right) ** 2
    return math.sqrt(float(np.nanmean(squares)))


def _difference(matrix: Array, other: Array) -> float:
    """How far two matrices are apart that are defined up to sign."""
    return min(float(np.linalg.norm(matrix - other)), float(np.linalg.norm(matrix + other)))


def readouts(p: EpipolarParams, e: Estimate) -> Iterator[Readout]:
    """Numbers of the estimate, or what it takes."""
    if e.status == "few":
        more = "" if p.points >= FEWEST else f" “{ESTIMATE_ACTION}” shows {ENOUGH}."
        yield Note(f"To estimate F takes 8 points that both cameras see; here are {e.seen}.{more}")
    elif e.status == "ambiguous":
        yield Note("These pixels fit more than one F: no estimate.", "warn")
    elif e.F is not None and e.conditioning is not None:
        words = f"F estimated from {e.seen} points with {quantity(p.noise, 'px', 2)} of noise"
        yield Formula(words, "<mover><mi>F</mi><mo>^</mo></mover>", significant(e.F), copy=spelled(e.F))
        yield _errors(e)
        if e.difference is not None:
            yield Formula("Frobenius norm of the error of E that this means", symbol("Δ"), mathml(e.difference))
        yield Formula("Conditioning of the equations, σ₈ : σ₁", symbol("κ"), mathml(e.conditioning, 4))


def _errors(e: Estimate) -> Table:
    rows = [("F", "noisy pixels", "exact pixels")]
    if e.noisy_rms_true is not None:
        rows.append(("true", figure(e.noisy_rms_true, 3), figure(0.0, 3)))
    if e.noisy_rms is not None and e.exact_rms is not None:
        rows.append(("estimated", figure(e.noisy_rms, 3), figure(e.exact_rms, 3)))
    return Table("Sampson distance in pixels, root mean square", rows)
