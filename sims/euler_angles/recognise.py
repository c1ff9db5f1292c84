"""Which rotation a text means: as NumPy, SciPy, ROS, Unity and CSS write it, or plain numbers with a word about them.

What has one meaning is taken; where there are several, the refusal asks which one is meant.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from geometry import euler, quaternion
from geometry.arrays import Array
from geometry.rotations import axis_angle_to_matrix, nearest_rotation, unit
from sims.kit.spelling import clipped

Found = dict[str, Any]
"""`what` it is in words and `R`, its rows; of Euler angles also `order`, `frame` and `angles` in degrees."""
ROUNDED = 0.02
"""By how much rounded numbers may be off what a rotation must be."""
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
ORDER = re.compile(r"(?<![A-Za-z])([xyz]{3}|[XYZ]{3})(?![A-Za-z])")
UNITS = {"deg": math.pi / 180.0, "rad": 1.0, "turn": 2.0 * math.pi, "grad": math.pi / 200.0}
CSS = re.compile(rf"rotate([xyz]?)\(\s*({NUMBER})\s*(deg|grad|rad|turn)\s*\)")
UNITY = {"up": (0, 1, 0), "down": (0, -1, 0), "right": (1, 0, 0), "left": (-1, 0, 0), "forward": (0, 0, 1)}


def read(text: str) -> Found:
    """The rotation that a text means. Raises ValueError in words: what is asked, or what isn't one."""
    plain = text.translate(str.maketrans("−–′″", "--  ")).replace("°", " deg ").strip()
    for reader in (_css, _unity, _labelled_quaternion, _labelled_angles, _numbers):
        if (found := reader(plain)) is not None:
            return found
    raise ValueError(
        f"“{clipped(text, 30)}” isn’t a rotation that is known here: paste 9 or 16 numbers of a matrix, 4 of a"
        " quaternion or an axis with its angle, or 3 of a rotation vector or of Euler angles."
    )


def _css(text: str) -> Found | None:
    lower = text.lower()
    numbers = _values(lower)
    if "rotate3d(" in lower and len(numbers) == 4:
        return _axis_angle(numbers[:3], _angle(numbers[3:], lower)[0], "an axis and an angle, as in CSS")
    if "matrix3d(" in lower and len(numbers) == 16:
        return _matrix(np.reshape(numbers, (4, 4)).T[:3, :3], "a matrix, by columns as in CSS")
    turns = [(axis or "z", float(value) * UNITS[unit]) for axis, value, unit in CSS.findall(lower)]
    if not turns:
        return None
    order = "".join(axis for axis, _ in turns)
    if order in euler.ORDERS:
        return _euler([angle for _, angle in turns], order, "intrinsic", "in CSS")
    R = np.eye(3)
    for axis, angle in turns:
        R = R @ axis_angle_to_matrix(np.eye(3)["xyz".index(axis)], angle)
    return _found("turns one after another, as in CSS", R)


def _unity(text: str) -> Found | None:
    lower, numbers = text.lower(), _values(text.lower())
    if "quaternion.euler" in lower and len(numbers) == 3:
        x, y, z = (math.radians(v) for v in numbers)
        return _euler([y, x, z], "yxz", "intrinsic", "in Unity")
    if "angleaxis" not in lower:
        return None
    named = re.search(r"vector3\.(\w+)", lower)
    axis = UNITY.get(named[1]) if named and len(numbers) == 1 else numbers[1:]
    if axis is None or len(axis) != 3:
        return None
    return _axis_angle(axis, math.radians(numbers[0]), "an angle and an axis, as in Unity")


def _labelled_quaternion(text: str) -> Found | None:
    named = dict(re.findall(rf"(?<!\w)([wxyz])[\"']?\s*[:=]\s*({NUMBER})", text.lower()))
    if len(named) != 4:
        return None
    return _quaternion([float(named[letter]) for letter in "wxyz"], "with its numbers named")


def _labelled_angles(text: str) -> Found | None:
    lower = text.lower()
    named = dict(re.findall(rf"(?<!\w)(roll|pitch|yaw)[\"']?\s*[:=]?\s*({NUMBER})", lower))
    if len(named) != 3:
        return None
    angles = _angle([float(named[name]) for name in ("yaw", "pitch", "roll")], lower)
    return _euler(angles, "zyx", "intrinsic", "as roll, pitch and yaw, as in ROS")


def _numbers(text: str) -> Found | None:
    numbers = _values(text.lower())
    by_count: dict[int, Callable[[list[float], str], Found | None]] = {
        3: _three, 4: _four, 9: lambda v, _: _matrix(np.reshape(v, (3, 3)), "a matrix, by rows"), 16: _sixteen,
    }  # fmt: skip
    reader = by_count.get(len(numbers))
    return None if reader is None else reader(numbers, text)


def _three(numbers: list[float], text: str) -> Found:
    lower, order = text.lower(), ORDER.search(text)
    if re.search(r"rotvec|rotation vector|rodrigues", lower):
        scale = math.radians(1.0) if _unit(lower) == "deg" else 1.0
        angle = scale * float(np.linalg.norm(numbers))
        return _axis_angle(numbers if angle else (0.0, 0.0, 1.0), angle, "a rotation vector")
    if order is None:
        raise ValueError(
            "Three numbers can be a rotation vector or Euler angles. Which? Write “rotvec” before them, or the order of"
            " the turns: ZYX about the turned axes, zyx about the fixed ones."
        )
    if order[1].lower() not in euler.ORDERS:
        raise ValueError(f"{order[1]} is no order of three turns: two in a row would be about one axis.")
    frame = "intrinsic" if order[1].isupper() else "extrinsic"
    frame = next((word for word in euler.FRAMES if word in lower), frame)
    return _euler(_angle(numbers, lower), order[1].lower(), frame, "")


def _four(numbers: list[float], text: str) -> Found:
    lower = text.lower()
    if re.search(r"axis|angle", lower) or not _one(numbers):
        if not _one(numbers[:3]) and "axis" not in lower:
            raise ValueError(
                "These four numbers are neither a quaternion of length 1 nor an axis of length 1 with an angle."
            )
        return _axis_angle(numbers[:3], _angle(numbers[3:], lower)[0], "an axis and an angle")
    if re.search(r"wxyz|w first|scalar.first(?!\s*=\s*false)|quaternion[df]\b", lower):
        return _quaternion(numbers, "w first")
    if re.search(r"xyzw|w last|scalar.last|from_quat|new quaternion", lower):
        return _quaternion([numbers[3], *numbers[:3]], "w last")
    raise ValueError(
        "A quaternion: is w the first of these four numbers or the last? Write “wxyz” or “xyzw” before them."
    )


def _sixteen(numbers: list[float], _: str) -> Found:
    """A pose by rows, or by columns: its last row is 0 0 0 1."""
    pose = np.reshape(numbers, (4, 4))
    if not np.allclose(pose[3, :3], 0.0) and np.allclose(pose[:3, 3], 0.0):
        return _matrix(pose.T[:3, :3], "the rotation of a 4 × 4 matrix, by columns")
    return _matrix(pose[:3, :3], "the rotation of a 4 × 4 matrix, by rows")


def _matrix(M: Array, what: str) -> Found:
    off = float(np.abs(M.T @ M - np.eye(3)).max())
    if off > ROUNDED:
        must = "its columns must have length 1 and be perpendicular"
        raise ValueError(f"This matrix isn’t a rotation: {must}, and are off by {off:.2g}.")
    if np.linalg.det(M) < 0.0:
        raise ValueError("This matrix isn’t a rotation but a mirroring: its determinant is −1.")
    return _found(what, nearest_rotation(M))


def _quaternion(q: Sequence[float], what: str) -> Found:
    """What w, x, y, z mean."""
    if not any(q):
        raise ValueError("A quaternion of four zeros is no rotation.")
    return _found(f"a quaternion, {what}", quaternion.to_matrix(quaternion.normalize(q)))


def _axis_angle(axis: Sequence[float], angle: float, what: str) -> Found:
    if not any(axis):
        raise ValueError("An axis of three zeros has no direction.")
    return _found(what, axis_angle_to_matrix(unit(axis), angle))


def _euler(angles: Sequence[float], order: str, frame: str, whose: str) -> Found:
    """What three angles in radians mean, in the order as written."""
    about = "turned" if frame == "intrinsic" else "fixed"
    found = _found(
        f"Euler angles {order.upper()} about {about} axes{f', {whose}' * bool(whose)}",
        euler.euler_to_matrix(angles, order, frame),
    )
    return {**found, "order": order, "frame": frame, "angles": tuple(round(math.degrees(a), 12) for a in angles)}


def _found(what: str, R: Array) -> Found:
    return {"what": what, "R": tuple(tuple(row) for row in R.tolist())}


def _angle(values: Sequence[float], text: str) -> list[float]:
    """Angles in radians. Raises ValueError that asks for the unit."""
    unit = _unit(text)
    if unit is None and any(abs(v) > 2.0 * math.pi for v in values):
        unit = "deg"
    if unit is None and any(values):
        raise ValueError("Is the angle in degrees or in radians? Write “deg” or “rad” after the numbers.")
    return [v * UNITS[unit or "rad"] for v in values]


def _unit(text: str) -> str | None:
    if re.search(r"degrees\s*=\s*false", text):
        return "rad"
    said = re.search(r"(?<![a-z])(deg|grad|rad|turn)", text)
    return said[1] if said else "rad" if "from_euler" in text else None


def _values(text: str) -> list[float]:
    """The numbers of a text, without those that are parts of names, such as float32."""
    return [*_floats(re.sub(r"(?<![\w.])[a-z_][\w.]*", " ", text))]


def _floats(text: str) -> Iterator[float]:
    for found in re.findall(NUMBER, text):
        value = float(found)
        if not math.isfinite(value):
            raise ValueError(f"{clipped(found, 20)} is too large.")
        yield value


def _one(values: Sequence[float]) -> bool:
    return abs(math.hypot(*values) - 1.0) < ROUNDED
