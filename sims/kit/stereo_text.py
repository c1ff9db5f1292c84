"""A stereo pair from a text as OpenCV, Kalibr, ROS, Middlebury or KITTI write it, which may have more cameras."""

from __future__ import annotations

from typing import Any, TypedDict

import numpy as np

from geometry.arrays import Array
from geometry.rotations import matrix_to_axis_angle
from sims.kit.calibration import Written, cameras, poses
from sims.kit.stereo import CLOSEST, FARTHEST, LARGEST, SHORTEST, SMALLEST, Size, length

ENDINGS = (".yaml", ".yml", ".json", ".xml", ".txt")
"""How files end that such a text may come from."""


class Found(TypedDict):
    """One camera: fx, fy, cx, cy; the size of its pictures, if that is said; whether it has distortion; its pose."""

    name: str
    lens: list[float]
    size: list[int]
    distorted: bool
    pose: list[list[float]]


def read(text: str) -> list[Found]:
    """The cameras of a text: two or more. Raises ValueError in words."""
    found = cameras(text)
    if len(found) < 2:
        raise ValueError(
            "No pair was found: there should be K1, K2, R and T, or Kalibr’s or Middlebury’s cam0 and cam1, or both"
            " cameras’ ROS files, or KITTI’s P0 and P1."
        )
    lenses = [_lens(each) for each in found]
    return [
        {
            "name": each.name,
            "lens": lens,
            "size": _size(each),
            "distorted": any(each.distortion),
            "pose": pose.tolist(),
        }
        for each, lens, pose in zip(found, lenses, poses(found), strict=True)
    ]


def chosen(found: list[Found], left: int, right: int) -> tuple[Found, Found]:
    """The left and the right camera, by their numbers from 1. Raises ValueError in words."""
    if max(left, right) > len(found) or left == right:
        names = ", ".join(f"{k} is {each['name']}" for k, each in enumerate(found, start=1))
        raise ValueError(f"There is no pair of cameras {left} and {right} in the text: {names}.")
    return found[left - 1], found[right - 1]


def between(left: Found, right: Found) -> Array:
    """The pose (4, 4) of the left camera's axes in the right one's: x_right = R x_left + T."""
    return np.asarray(np.array(right["pose"]) @ np.linalg.inv(left["pose"]))


def calibrated(left: Found, right: Found) -> dict[str, Any]:
    """What of a state such a pair is: `own` and `own_size` of `sims.kit.stereo`. Raises ValueError in words."""
    T = between(left, right)
    axis, angle = matrix_to_axis_angle(T[:3, :3])
    own = *left["lens"], *right["lens"], *np.degrees(axis * angle).tolist(), *T[:3, 3].tolist()
    size = (*left["size"], *right["size"]) if left["size"] and right["size"] else None
    if (f := min(own[:2] + own[4:6])) < SHORTEST:
        raise ValueError(f"A focal length is {f:g}: this sim takes {SHORTEST:g} or more, for it is in pixels.")
    if (long := length(own)) < CLOSEST:
        raise ValueError(
            f"T is {long:g} long: this sim takes {CLOSEST:g} or more, for without a baseline there is no F, and no"
            " depth."
        )
    if abs(most := max(own, key=abs)) > FARTHEST:
        raise ValueError(f"There is {most:g} in K1, K2 or T: this sim takes numbers up to {FARTHEST:,.0f}.")
    if size and not all(SMALLEST <= pixels <= LARGEST for pixels in size):
        across = " and ".join(f"{width} × {height}" for width, height in (left["size"], right["size"]))
        raise ValueError(f"The pictures have {across} pixels: this sim takes {SMALLEST} to {LARGEST} across and down.")
    return {"own": own, "own_size": size}


def taken(found: list[Found], pair: tuple[int, int], sizes: tuple[Size, Size], *, said: bool) -> str:
    """Which cameras were taken, by their numbers from 1, and of which pictures; or that their size wasn't `said`."""
    left, right = (found[k - 1] for k in pair)
    seen = " and ".join(f"{width} × {height}" for width, height in sizes)
    guessed = "" if said else ", if the principal points are in their middle: the text doesn’t say how large they are"
    more = f"; for others of its {len(found)}, choose them and take it again" if len(found) > 2 else ""
    free = " Pixels are those after distortion was taken out." if left["distorted"] or right["distorted"] else ""
    names = f"{left['name']} on the left and {right['name']} on the right"
    return f"Taken: {names}{more}. Their pictures have {seen} pixels{guessed}.{free}"


def _lens(each: Written) -> list[float]:
    K = each.K
    assert K is not None, "for there is a name of one"
    (fx, skew, cx), (_, fy, cy), _ = K.tolist()
    if abs(skew) > 1e-6 * fx:
        raise ValueError("A camera matrix should be (fx, 0, cx; 0, fy, cy; 0, 0, 1): this sim has no skew.")
    return [fx, fy, cx, cy]


def _size(each: Written) -> list[int]:
    return [round(value) for value in each.size.values()] if len(each.size) == 2 else []
