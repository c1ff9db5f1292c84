"""A pointer that holds a node: where the node would go."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from geometry.rotations import axis_angle_to_matrix
from sims.kit.types import Line, Place, Vector

Path = Callable[[Place, Place], Place]
"""From where a node is and where it is pulled to where it may go."""
Hold = Callable[[bool], None]
"""Lets a node be held, or no more: a pointer that pulls there turns the view."""
STRIDE = math.radians(60.0)
"""How far round a circle one pull leads at most: a node doesn't jump to the circle's far side."""


def listen(handle: Any, drag: Callable[[Place], None], path: Path | None = None, body: Any = None) -> Hold:
    """Tell `drag` the place (world, metres) to which the pointer pulls a node of viser's.

    The node moves in the plane that faces the viewer; with Shift held, along the world axis nearest to the pull. One
    with a path goes where that leads. A `body` that is given is taken in the node's place, unless that is hidden, and
    moves it.
    """
    offset = np.zeros(3)
    origin = np.zeros(3)

    def moved(event: Any, straight: bool) -> None:
        nonlocal offset, origin
        if body is not None and not handle.visible:
            return
        if event.phase == "start":
            origin = np.array(handle.position)
            offset = origin - np.array(event.start_position)
        target = np.array(event.end_position) + offset
        if path is not None:
            target = np.array(path(tuple(handle.position), tuple(target)))
        elif straight:
            pull = target - origin
            keep = np.argmax(np.abs(pull))
            target = origin + np.where(np.arange(3) == keep, pull, 0.0)
        drag((float(target[0]), float(target[1]), float(target[2])))

    return _on_drag(handle if body is None else body, moved)


def listen_round(
    handle: Any, drag: Callable[[Place], None], grip: Any, line: Callable[[], Line | None], eye: Callable[[], Vector]
) -> Hold:
    """The same for a body that turns about a line, wherever it is taken; without a line it is carried along.

    `drag` is told the place to which its grip is turned, or carried: another node, which must be seen.
    """
    spot, taken, held = np.zeros(3), np.zeros(3), np.zeros(3)

    def moved(event: Any, straight: bool) -> None:
        nonlocal spot, taken, held
        if event.phase == "start":
            spot = taken = np.array(event.start_position)
            held = np.array(grip.position)
        if not grip.visible:
            return
        about = line()
        if about is None:
            x, y, z = (held + np.subtract(event.end_position, taken)).tolist()
        else:
            middle, normal = (np.asarray(v, dtype=float) for v in about)
            spot = middle + on_circle(spot - middle, normal, eye() - middle, np.subtract(event.end_position, middle))
            before, now = (v - normal * (normal @ v) for v in (taken - middle, spot - middle))
            angle = math.atan2(float(normal @ np.cross(before, now)), float(before @ now))
            x, y, z = (middle + axis_angle_to_matrix(normal, angle) @ (held - middle)).tolist()
        drag((x, y, z))

    return _on_drag(handle, moved)


def listen_anywhere(
    handle: Any, drag: Callable[[tuple[float, ...]], None], eye: Callable[[], Vector],
    turned: Callable[[], npt.NDArray[np.float64]], least: float,
) -> None:  # fmt: skip
    """The same for a body that turns about the world's origin every way: what was taken stays under the pointer.

    `drag` is told six numbers: the spot that was taken, in the frame of the body, whose orientation `turned` (3, 3)
    knows; and where in the world it is pulled to. Nearer to the middle than `least` (metres), where a small pull would
    turn the body a lot, a ball of that radius is taken in its place.
    """
    spot, radius, near = np.zeros(3), least, True

    def moved(event: Any, straight: bool) -> None:
        nonlocal spot, radius, near
        if event.phase == "start":
            at, viewer = np.array(event.start_position), np.asarray(eye(), dtype=float)
            radius = max(math.sqrt(at @ at), least)
            near = bool(at @ viewer >= at @ at)
            spot = turned().T @ on_sphere(radius, viewer, at, near=near)
        place = on_sphere(radius, eye(), event.end_position, near=near)
        drag((*spot.tolist(), *place.tolist()))

    _on_drag(handle, moved)


def _on_drag(handle: Any, moved: Callable[[Any, bool], None]) -> Hold:
    """Tell `moved` of each drag event, and whether Shift is held."""

    async def plain(event: Any) -> None:
        moved(event, False)

    async def straight(event: Any) -> None:
        moved(event, True)

    def hold(on: bool) -> None:
        if on:
            handle.on_drag("left")(plain)
            handle.on_drag("left", modifier="shift")(straight)
        else:
            handle.remove_drag_callback()

    hold(True)
    return hold


def on_sphere(radius: float, eye: Vector, pulled: Vector, *, near: bool) -> npt.NDArray[np.float64]:
    """Where the ray from the eye through `pulled` meets a sphere about the origin, on its near or its far side.

    One that passes by it leads to the sphere's rim, as seen from there.
    """
    start = np.asarray(eye, dtype=float)
    ray = np.subtract(pulled, start)
    ray /= math.sqrt(ray @ ray) or 1.0
    closest = start - ray * (ray @ start)
    past = math.sqrt(closest @ closest)
    if past >= radius:
        return np.asarray(closest * (radius / past))
    deep = math.sqrt(radius * radius - past * past)
    return np.asarray(closest + ray * (-deep if near else deep))


def on_circle(at: Vector, axis: Vector, eye: Vector, pulled: Vector) -> Place:
    """Where a node at `at` goes on its circle about a unit axis through the origin, pulled by whoever looks from `eye`.

    That is the place on the circle nearest to the ray from the eye through `pulled`, within a stride.
    """
    normal, start = np.asarray(axis, dtype=float), np.asarray(at, dtype=float)
    middle = normal * (normal @ start)
    spoke = start - middle
    turns = np.linspace(-STRIDE, STRIDE, 241)
    ray = np.subtract(pulled, eye)
    ray /= np.sqrt(ray @ ray)

    def places(angles: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        turned = np.stack([np.cos(angles), np.sin(angles)], axis=1) @ [spoke, np.cross(normal, spoke)]
        return np.asarray(middle + turned)

    across = places(turns) - eye
    gaps = (across * across).sum(axis=1) - (across @ ray) ** 2
    k = int(np.clip(gaps.argmin(), 1, len(turns) - 2))
    before, here, after = gaps[k - 1 : k + 2].tolist()
    curved = before - 2.0 * here + after
    between = 0.5 * (before - after) / curved if curved > 0.0 else 0.0  # the lowest place of a parabola through three
    x, y, z = places(turns[k] + (turns[1] - turns[0]) * np.clip([between], -1.0, 1.0))[0].tolist()
    return x, y, z
