"""What is to be reached with a camera."""

from __future__ import annotations

import math

from sims.camera.params import CameraParams
from sims.camera.solution import CameraSolution
from sims.kit.challenge import Challenge, Progress, nearer
from sims.kit.readout import quantity
from sims.kit.types import Pixel
from sims.kit.world import TITLES

START = CameraParams()
AIM: Pixel = 400.0, 160.0
"""The pixel where the middle of the house is to be."""
WITHIN = 6.0
"""Pixels: half a degree at the focal length that the sim begins with."""
ALIKE = 0.02
"""Part by which two heights in the picture may differ and be called the same."""
SAME = 1.0
"""Pixels within which two points share a pixel."""
KNOWN = {"near-post", "far-post"}
"""The pair that the lesson shows."""


def _same_height(p: CameraParams, s: CameraSolution) -> Progress:
    if p.projection != "perspective":
        return Progress(0.2, "Without perspective that is easy. Go back to perspective.")
    heights = [_tall(s, post) for post in ("near", "far")]
    if min(heights) <= 0.0:
        return Progress(0.0, "Both posts, from top to foot, must be in the picture.")
    more = max(heights) / min(heights) - 1.0
    words = f"One is {quantity(100.0 * more, '%', 0)} taller than the other"
    return nearer(more, 2.0, ALIKE, words, f"Both are {quantity(heights[0], 'px', 0)} tall")


def _tall(s: CameraSolution, post: str) -> float:
    """Pixels from a post's foot to its top; 0 where one of them isn't in the picture."""
    top, foot = (s.point(f"{post}-{end}") for end in ("post", "foot"))
    if top.pixel is None or foot.pixel is None or not (top.in_image and foot.in_image):
        return 0.0
    return math.dist(top.pixel, foot.pixel)


def _shift(p: CameraParams, s: CameraSolution) -> Progress:
    return _at_aim(p, s, ("cx", "cy"), "Shifted, and nothing has changed its shape")


def _turn(p: CameraParams, s: CameraSolution) -> Progress:
    return _at_aim(p, s, ("pan", "tilt"), "Turned: walls that stood upright lean now")


def _at_aim(p: CameraParams, s: CameraSolution, by: tuple[str, str], done: str) -> Progress:
    """How near the house is to where it should be; only two parameters may bring it there."""
    if s.subject.pixel is None:
        return Progress(0.0, "The house is behind the camera.")
    left = math.dist(s.subject.pixel, AIM)
    found = nearer(left, 640.0, WITHIN, f"{quantity(left, 'px', 0)} to go", done)
    if p.model_copy(update={name: getattr(START, name) for name in (*by, "selected")}) == START:
        return found
    words = f"Only {by[0]} and {by[1]} may differ from how the camera stood first: press Reset."
    return Progress(min(found.fraction, 0.9), words)


def _one_pixel(p: CameraParams, s: CameraSolution) -> Progress:
    chosen = s.point(p.selected)
    if chosen.pixel is None:
        return Progress(0.0, f"{TITLES[p.selected]} has no pixel: choose a point in front of the camera.")
    others = [
        (math.dist(each.pixel, chosen.pixel), each.name)
        for each in s.points
        if each.pixel and each != chosen and {each.name, chosen.name} != KNOWN
    ]
    if not others:
        return Progress(0.0, "No other point has a pixel.")
    apart, name = min(others)
    pair = f"{TITLES[p.selected]} and {TITLES[name]}"
    words = f"{pair} are {quantity(apart, 'px', 0 if apart > 10.0 else 1)} apart"
    return nearer(apart, 200.0, SAME, words, f"{pair}: one pixel")


CHALLENGES: tuple[Challenge[CameraParams, CameraSolution], ...] = (
    Challenge(
        id="same-height", title="Near and far, equally tall",
        goal="In perspective, make the near post and the far post the same height in the picture.",
        near=_same_height, solves={"position": (6, -0.5, 1.2), "pan": 75},
        misses=({"position": (0, -18, 1.2)}, {"position": (6, 1, 1.2), "pan": 90}, {"projection": "orthographic"}),
    ),
    Challenge(
        id="shift", title="Move the picture",
        goal="Bring the middle of the house to the pixel (400, 160) by cx and cy alone.",
        near=_shift, solves={"cx": 558.5, "cy": 122.2},
        misses=({"cx": 550, "cy": 122}, {"cx": 558.5, "cy": 122.2, "pan": 1}),
    ),
    Challenge(
        id="turn", title="Turn the camera",
        goal="Bring the middle of the house to the pixel (400, 160) by pan and tilt alone.",
        near=_turn, solves={"pan": 22.6, "tilt": -11},
        misses=({"pan": 20, "tilt": -11}, {"pan": 22.6, "tilt": -11, "cx": 321}),
    ),
    Challenge(
        id="one-pixel", title="Two points, one pixel",
        goal="Find two other points, not the tops of the posts, that share a pixel: choose one, and move the camera.",
        near=_one_pixel, solves={"selected": "roof-near", "position": (-3.05, -4.35, 1.7)},
        misses=(
            {"selected": "roof-near", "position": (-3.0, -4.35, 1.7)},
            {"selected": "roof-near", "position": (-3.05, -4.35, 1.75)},
            {"selected": "near-post", "position": (-0.5, -4.2, 1.0)},
        ),
    ),
)  # fmt: skip
