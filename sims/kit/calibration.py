"""Calibrated cameras in a text as people have it: their K, picture sizes, distortion, and poses to each other.

OpenCV's YAML, XML and JSON, ROS's camera_info (its files, and messages as `rostopic` and `ros2 topic echo` print them),
Kalibr's camchain, the files of Middlebury and KITTI, and plain `fx: 525` lines: all have names with numbers after them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from geometry.arrays import Array
from geometry.rotations import is_rotation, nearest_rotation

NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
LINE = re.compile(r"""^[\s{-]*["']?([A-Za-z_][\w.]*)["']?\s*[:=](.*)$""")
TAG = re.compile(r"<([A-Za-z_]\w*)[^>]*>([^<]*)")
ABOUT_A_MATRIX = {"rows", "cols", "dt", "typeid"}
"""What stands between a matrix's name and its `data`."""
OF_A_CAMERA = re.compile(
    r"(k|m|mtx|cameramatrix|d|distcoeffs|distortioncoefficients|imagesize|cam|p|prect0|srect0)(\d|left|right)"
)
"""K1, cameraMatrix2, K_left, Middlebury's and Kalibr's cam0, KITTI's P0 and P_rect_00."""
FROM_THE_FIRST = re.compile(r"([rt])1([2-9])")
"""R12, T12: the second camera's pose, as that of any further one, from the first one's axes."""
NUMBERS = {"left": 1, "right": 2}
MATRIX = ("cameramatrix", "intrinsicmatrix", "k", "m", "mtx", "cam")
PROJECTION = ("prect0", "p", "projectionmatrix")
DISTORTION = ("distortioncoefficients", "distortioncoeffs", "distcoeffs", "dist", "d")
LENS = ("fx", "fy", "cx", "cy")
CHAIN, POSE = "tcncnm1", ("r", "t")
ROTATION = 1e-4
"""By how much the entries of a matrix may differ from those of a rotation: files have a few digits."""


@dataclass(frozen=True)
class Entry:
    """A name as it is written, and what comes after it."""

    name: str
    words: str

    @property
    def numbers(self) -> list[float]:
        """All that are finite."""
        return [number for number in map(float, NUMBER.findall(self.words)) if math.isfinite(number)]


@dataclass(frozen=True, eq=False)
class Written:
    """What a text says of one camera. Its numbers are looked at when they are asked for; ValueError says what is wrong.

    Names are in lower case, without anything between letters.
    """

    name: str
    entries: Mapping[str, Entry]

    def numbers(self, name: str, count: int, shown: str = "") -> list[float]:
        """So many numbers of that name; `shown` is how it would be written, where it isn't there."""
        entry = self.entries.get(name, Entry(shown or name, ""))
        if len(numbers := entry.numbers) != count:
            raise ValueError(f"“{entry.name}” should have {count} number{'s' * (count > 1)}, and has {len(numbers)}.")
        return numbers

    def first(self, names: Sequence[str]) -> str:
        """The first of some names that it has, or ''."""
        return next((name for name in names if name in self.entries), "")

    @property
    def K(self) -> Array | None:
        """The camera matrix (3, 3), if there is anything of one."""
        if "intrinsics" in self.entries:
            fx, fy, cx, cy = self.numbers("intrinsics", 4)
            return np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])
        if name := self.first(MATRIX):
            K = np.reshape(self.numbers(name, 9), (3, 3))
        elif name := self.first(PROJECTION):
            K = np.reshape(self.numbers(name, 12), (3, 4))[:, :3]
        elif not (found := {name: self.numbers(name, 1)[0] for name in LENS if self._has(name)}):
            return None
        elif missing := [name for name in LENS if name not in found]:
            raise ValueError(f"No {', '.join(missing)} found: a camera matrix is wanted, or Kalibr’s intrinsics.")
        else:
            K = np.array([[found["fx"], 0.0, found["cx"]], [0.0, found["fy"], found["cy"]], [0.0, 0.0, 1.0]])
        if K[1, 0] or K[2].tolist() != [0.0, 0.0, 1.0] or min(K[0, 0], K[1, 1]) <= 0.0:
            raise ValueError(
                "A camera matrix must be fx, skew, cx, then 0, fy, cy, then 0, 0, 1, with fx and fy above 0."
            )
        return K

    @property
    def size(self) -> dict[str, float]:
        """Width and height of its pictures: what is said of them."""
        for name in ("resolution", "imagesize", "srect0"):
            if self._has(name, 2):
                return dict(zip(("width", "height"), self.entries[name].numbers, strict=True))
        found = {name: [n for n in (f"image{name}", name) if self._has(n)] for name in ("width", "height")}
        return {name: self.entries[each[0]].numbers[0] for name, each in found.items() if each}

    @property
    def distortion(self) -> list[float]:
        """Its coefficients in the order of OpenCV."""
        name = self.first(DISTORTION)
        return self.entries[name].numbers if name else []

    def _has(self, name: str, count: int = 1) -> bool:
        return name in self.entries and len(self.entries[name].numbers) >= count


def cameras(text: str) -> list[Written]:
    """The cameras of a text, in its order."""
    entries = _entries(text)
    found = _numbered(entries) or _in_turn(entries)
    return [camera for camera in found if camera.first((*MATRIX, *PROJECTION, *LENS, "intrinsics"))]


def poses(found: Sequence[Written]) -> list[Array]:
    """T (4, 4) of each camera: to its axes, from axes that they all have in common. Raises ValueError in words."""
    if any(CHAIN in camera.entries for camera in found):
        made = [np.eye(4)]
        for camera in found[1:]:
            T = np.reshape(camera.numbers(CHAIN, 16, "T_cn_cnm1"), (4, 4))
            made.append(_rigid(T[:3, :3], T[:3, 3]) @ made[-1])
        return made
    if found[0].first(("projectionmatrix", "rectificationmatrix")) or {"p", "r", "k"} <= found[0].entries.keys():
        return [_rectified(camera) for camera in found]
    if {"cam", "baseline"} <= found[0].entries.keys():
        (millimetres,) = found[0].numbers("baseline", 1)
        return [_rigid(np.eye(3), np.array([-k * millimetres / 1000.0, 0.0, 0.0])) for k in range(len(found))]
    if not found[0].first(MATRIX) and (name := found[0].first(PROJECTION)):
        return [_shifted(camera, name) for camera in found]
    others = [_rigid(np.reshape(c.numbers("r", 9, "R"), (3, 3)), np.array(c.numbers("t", 3, "T"))) for c in found[1:]]
    return [np.eye(4), *others]


def _rigid(R: Array, t: Array) -> Array:
    if not is_rotation(R, ROTATION):
        raise ValueError("R should be a rotation: its rows have length 1, and are at right angles.")
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = nearest_rotation(R), t
    return T


def _shifted(camera: Written, name: str) -> Array:
    """From P = K [I | t]."""
    P = np.reshape(camera.numbers(name, 12, "projection_matrix"), (3, 4))
    return _rigid(np.eye(3), np.linalg.solve(P[:, :3], P[:, 3]))


def _rectified(camera: Written) -> Array:
    """As ROS has it: x_rectified = R x, and rectified cameras are shifted against each other, and no more."""
    turn = camera.first(("rectificationmatrix", "r"))
    R = np.reshape(camera.numbers(turn, 9, "rectification_matrix"), (3, 3))
    back = _rigid(R.T, np.zeros(3))
    return np.asarray(back @ _shifted(camera, camera.first(("projectionmatrix", "p"))))


def _entries(text: str) -> list[tuple[str, Entry]]:
    """Names, in lower case without anything between letters, with all that follows up to the next name."""
    found: list[tuple[str, Entry]] = []
    for name, words in _named(text):
        match re.sub(r"[\W_]", "", name).lower():
            case "data" if found:
                key, owner = found.pop()
                found.append((key, Entry(owner.name, words)))
            case key if key not in ABOUT_A_MATRIX:
                found.append((key, Entry(name, words)))
    return found


def _named(text: str) -> Iterator[tuple[str, str]]:
    if text.lstrip().startswith("<"):
        yield from TAG.findall(text)
        return
    name, words = "", ""
    for line in re.sub(r"([{,])\s*(?=[\"'][A-Za-z_])", r"\1\n", text).splitlines():
        if entry := LINE.match(line.partition("#")[0]):
            if name:
                yield name, words
            name, words = entry[1].rpartition(".")[2], entry[2]
        else:
            words += "\n" + re.sub(r"^\s*-\s+", " ", line)
    if name:
        yield name, words


def _numbered(entries: Sequence[tuple[str, Entry]]) -> list[Written]:
    """Cameras whose names have numbers: K1 and K2, cam0 and cam1. What has none is of all of them, but for R and T."""
    common: dict[str, Entry] = {}
    blocks: dict[int, dict[str, Entry]] = {}
    names: dict[int, str] = {}
    current = common
    for key, entry in entries:
        number, name = _of_a_camera(key, len(entry.numbers))
        if number is None:
            current.setdefault(name, entry)
            continue
        block = blocks.setdefault(number, {})
        if name:
            block.setdefault(name, entry)
        else:
            current = block
        if name not in POSE:
            names.setdefault(number, entry.name)
    pair: dict[str, Entry] = {key: common.pop(key) for key in POSE if key in common}
    made = [Written(names.get(k, f"{k}"), {**common, **blocks[k]}) for k in sorted(blocks)]
    return [Written(c.name, {**pair, **c.entries}) if k == 1 else c for k, c in enumerate(made)]


def _of_a_camera(key: str, count: int) -> tuple[int | None, str]:
    """The number of the camera that an entry of so many numbers is of, and its name without it.

    The name is '' for a heading of Kalibr's, after which all is of that camera.
    """
    if one := OF_A_CAMERA.fullmatch(key):
        number = NUMBERS.get(one[2]) or int(one[2])
        if count > 1:  # with one number it is a coefficient: k1, p2
            return number, one[1]
        if one[1] == "cam" and not count:
            return number, ""
    if further := FROM_THE_FIRST.fullmatch(key):
        return int(further[2]), further[1]
    return None, key


def _in_turn(entries: Sequence[tuple[str, Entry]]) -> list[Written]:
    """Cameras that are told of one after the other: with a name that comes again, another one begins.

    Of ROS's the first is that which the others are shifted against.
    """
    blocks: list[dict[str, Entry]] = [{}]
    for key, entry in entries:
        if key in blocks[-1]:
            blocks.append({})
        blocks[-1][key] = entry
    made = [
        Written(b["cameraname"].words.strip(" \"'") if "cameraname" in b else f"camera {k}", b)
        for k, b in enumerate(blocks, start=1)
    ]
    return sorted(made, key=_shift)


def _shift(camera: Written) -> float:
    name = camera.first(PROJECTION)
    return abs(([*camera.entries[name].numbers, 0.0, 0.0, 0.0, 0.0] if name else [0.0] * 4)[3])
