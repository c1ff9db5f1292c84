"""A robot's description in URDF as rows of Denavit and Hartenberg: its one chain of joints that turn or slide.

Runs on strangers' texts in a child with limits, and takes no document type: nothing in it is expanded or fetched.
"""

from __future__ import annotations

import math
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

from geometry import se3
from geometry.arrays import Array
from geometry.euler import euler_to_matrix
from sims.kit.spelling import clipped

KINDS = {"revolute": "r", "continuous": "r", "prismatic": "p", "fixed": "f"}
DEEPEST = 200
"""Joints one after the other at most."""
TINY = 1e-9
"""Metres below which two lines meet."""
PARALLEL = 1e-5
"""Sine of the angle below which two axes are parallel: files have 1.5708 for a right angle."""
DIGITS = 9


class Row(NamedTuple):
    """A link: metres and degrees; `joint` says what moves, r, p or f."""

    a: float
    alpha: float
    d: float
    theta: float
    joint: str


class Moving(NamedTuple):
    """A joint where nothing has moved: its kind, a point of its axis, and the axis, in the world."""

    kind: str
    point: Array
    axis: Array


def rows_of(text: str) -> list[Row]:
    """The rows of a robot's chain, from its root to the end of its longest branch. Raises ValueError in words."""
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise ValueError("A document type can’t be taken: leave out the line with <!DOCTYPE.")
    try:
        robot = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise ValueError(f"This isn’t XML: {error}.") from None
    if robot.tag != "robot":
        raise ValueError(f"A URDF begins with <robot>, this with <{clipped(robot.tag, 30)}>; expand xacro first.")
    joints, end = _placed(_chain(robot))
    if not joints:
        raise ValueError("No joint of it turns or slides.")
    return _rows(joints, end)


def _chain(robot: ElementTree.Element) -> list[ElementTree.Element]:
    """Joints from the root on: of branches the one with the moving joints, which only one may have."""
    children: dict[str, list[ElementTree.Element]] = {}
    joints = robot.findall("joint")
    for joint in joints:
        children.setdefault(_link(joint, "parent"), []).append(joint)
    (*roots,) = children.keys() - {_link(joint, "child") for joint in joints}
    if len(roots) != 1:
        raise ValueError(f"Its joints must hang on one root; {len(roots)} links are no joint’s child.")
    return _branch(roots[0], children, DEEPEST)


def _branch(link: str, children: dict[str, list[ElementTree.Element]], left: int) -> list[ElementTree.Element]:
    if not left:
        raise ValueError(f"More than {DEEPEST} joints hang on one another.")
    branches = [[joint, *_branch(_link(joint, "child"), children, left - 1)] for joint in children.get(link, ())]
    moving = [branch for branch in branches if any(_kind(joint) != "f" for joint in branch)]
    if len(moving) > 1:
        raise ValueError(f"It forks at the link “{clipped(link, 40)}”: only one chain of joints can be taken.")
    return max(moving or branches, key=len, default=[])


def _link(joint: ElementTree.Element, which: str) -> str:
    found = joint.find(which)
    if found is None or not found.get("link"):
        raise ValueError(f"The joint “{_name(joint)}” has no {which} link.")
    return str(found.get("link"))


def _name(joint: ElementTree.Element) -> str:
    return clipped(joint.get("name", ""), 40)


def _kind(joint: ElementTree.Element) -> str:
    word = joint.get("type", "")
    if word not in KINDS:
        said = clipped(word, 20) or "of no type"
        raise ValueError(f"The joint “{_name(joint)}” is {said}: {', '.join(KINDS)} are taken.")
    return KINDS[word]


def _numbers(joint: ElementTree.Element, tag: str, name: str, default: str) -> Array:
    found = joint.find(tag)
    text = default if found is None else found.get(name, default)
    try:
        numbers = np.array([float(part) for part in text.split()])
    except ValueError:
        numbers = np.empty(0)
    if numbers.shape != (3,) or not np.isfinite(numbers).all():
        raise ValueError(f"The joint “{_name(joint)}”: {name} is “{clipped(text, 30)}”, and not three numbers.")
    return numbers


def _placed(chain: list[ElementTree.Element]) -> tuple[list[Moving], Array]:
    """The joints that move, and the frame at the end of the chain, where nothing has moved."""
    T, joints = np.eye(4), []
    for joint in chain:
        roll, pitch, yaw = _numbers(joint, "origin", "rpy", "0 0 0").tolist()
        R = euler_to_matrix([yaw, pitch, roll], "zyx", "intrinsic")
        T = T @ se3.transform(R, _numbers(joint, "origin", "xyz", "0 0 0"))
        if (kind := _kind(joint)) == "f":
            continue
        axis = _numbers(joint, "axis", "xyz", "1 0 0")
        if math.hypot(*axis) < TINY:
            raise ValueError(f"The joint “{_name(joint)}” has an axis without a direction.")
        joints.append(Moving(kind, T[:3, 3], T[:3, :3] @ axis / math.hypot(*axis)))
    return joints, T


def _rows(joints: list[Moving], end: Array) -> list[Row]:
    """Frames along the common normals of one axis and the next: the world's z, each joint's, and z of the end.

    Source: Siciliano et al. 2009, "Robotics", sec. 2.8.2.
    """
    frame, rows = np.eye(4), []
    lines = [(joint.point, joint.axis) for joint in joints] + [(end[:3, 3], end[:3, 2])]
    for kind, (point, axis) in zip(["f", *(joint.kind for joint in joints)], lines, strict=True):
        frame, row = _next(frame, point, axis, kind)
        rows.append(row)
    last = np.linalg.inv(frame) @ end
    rows.append(_clean(Row(0.0, 0.0, last[2, 3], math.degrees(math.atan2(last[1, 0], last[0, 0])), "f")))
    return _joined(rows)


def _next(frame: Array, point: Array, axis: Array, kind: str) -> tuple[Array, Row]:
    """The frame whose z is that axis and whose x is the common normal, on the side of x before; and its row."""
    x, z, origin = frame[:3, 0], frame[:3, 2], frame[:3, 3]
    way, across = point - origin, np.cross(z, axis)
    parallel = math.hypot(*across) < PARALLEL
    axis = math.copysign(1.0, axis @ z) * z if parallel else axis
    d = 0.0 if parallel else float(np.cross(way, axis) @ across / (across @ across))
    normal = way - (way @ z) * z if parallel else across
    size = math.hypot(*normal)
    normal = x if size < TINY else normal / size
    normal = -normal if normal @ x < -TINY else normal
    a = float(way @ normal)
    after = np.eye(4)
    after[:3, :3] = np.column_stack([normal, np.cross(axis, normal), axis])
    after[:3, 3] = origin + d * z + a * normal
    alpha = math.atan2(float(normal @ np.cross(z, axis)), float(z @ axis))
    theta = math.atan2(float(z @ np.cross(x, normal)), float(x @ normal))
    return after, _clean(Row(a, math.degrees(alpha), d, math.degrees(theta), kind))


def _clean(row: Row) -> Row:
    a, alpha, d, theta = (round(float(v), DIGITS) + 0.0 for v in row[:4])
    return Row(a, alpha, d, theta, row.joint)


def _joined(rows: list[Row]) -> list[Row]:
    """Without the fixed rows at either end where the joint beside takes them in."""
    first, *rest, last = rows
    if not first.a and not first.alpha:  # along and about the first joint's own axis
        rest[0] = rest[0]._replace(d=first.d + rest[0].d, theta=first.theta + rest[0].theta)
    else:
        rest.insert(0, first)
    before = rest[-1]
    if not before.a and not before.alpha:
        rest[-1] = before._replace(d=before.d + last.d, theta=before.theta + last.theta)
    elif not before.alpha and not last.theta:
        rest[-1] = before._replace(d=before.d + last.d)
    elif last.d or last.theta:
        rest.append(last)
    return rest
