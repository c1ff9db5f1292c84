"""A real camera's K, picture size and lens distortion, from the text that calibration tools write.

OpenCV's YAML, XML and JSON, ROS's camera_info (its files, and messages as `rostopic` and `ros2 topic echo` print them),
Kalibr's camchain, and plain `fx: 525` lines have the same few names, each followed by its numbers.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from sims.camera.params import COEFFICIENTS, CameraParams
from sims.kit.spelling import plain

NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
ENTRY = re.compile(r"""^[\s{-]*["']?([A-Za-z_][\w.]*)["']?\s*[:=](.*)$""")
TAG = re.compile(r"<([A-Za-z_]\w*)[^>]*>([^<]*)")
K_NAMES = {"cameramatrix", "intrinsicmatrix", "k", "m", "m1", "mtx"}
D_NAMES = {"distortioncoefficients", "distortioncoeffs", "distcoeffs", "dist", "d", "d1"}
SIZE_NAMES = {"resolution", "imagesize"}
SINGLE = {**{name: name for name in ("fx", "fy", "cx", "cy", "width", "height", *COEFFICIENTS)},
          "imagewidth": "width", "imageheight": "height"}  # fmt: skip
MODELS = {"plumbbob", "radtan", "pinhole", "rationalpolynomial", "none"}
"""Names of models that the five coefficients are part of."""
NEAR = 6
"""Entries within which a matrix's numbers come after its name."""
EXAMPLE = """\
image_width: 752
image_height: 480
camera_matrix:
  data: [458.7, 0, 367.2, 0, 457.3, 248.4, 0, 0, 1]
distortion_coefficients:
  data: [-0.283, 0.074, 0.0002, 0.00002]"""
Entries = Sequence[tuple[str, str]]


def read(text: str) -> dict[str, float]:
    """What the text says of fx, fy, cx, cy, skew, width, height and distortion. Raises ValueError in words."""
    entries = list(_entries(text))
    _check_models(entries)
    found = {
        SINGLE[name]: numbers[0] for name, words in reversed(entries) if name in SINGLE and (numbers := _all(words))
    }
    found |= _size(entries) | _intrinsics(entries) | _distortion(entries)
    missing = [name for name in ("fx", "fy", "cx", "cy") if name not in found]
    if missing:
        raise ValueError(f"No {', '.join(missing)} found: a camera matrix is wanted, or Kalibr’s intrinsics.")
    return found


def changes(p: CameraParams, data: Mapping[str, float]) -> dict[str, Any]:
    """The state with that camera, where it stands now. Raises ValueError in words."""
    made: dict[str, Any] = {"projection": "perspective", "skew": 0.0, **dict.fromkeys(COEFFICIENTS, 0.0), **data}
    for name in ("width", "height"):
        made[name] = int(made.get(name, getattr(p, name)))
    state = p.model_copy(update=made)
    for name in ("width", "height", "fx", "fy", "cx", "cy", "skew", *COEFFICIENTS):
        low, high = state.bounds(name)
        if not low <= made[name] <= high:
            size = (
                "" if "width" in data else " The text doesn’t say how large the picture is (image_width, image_height)."
            )
            raise ValueError(
                f"{name} is {plain(made[name])}, and only {plain(low)} to {plain(high)} can be shown"
                f" in a picture of {made['width']} × {made['height']}.{size}"
            )
    return made


def _entries(text: str) -> Iterator[tuple[str, str]]:
    """Names, in lower case without anything between letters, with all that follows up to the next name."""
    if text.lstrip().startswith("<"):
        yield from ((_plain(name), words) for name, words in TAG.findall(text))
        return
    name, words = "", ""
    for line in re.sub(r"([{,])\s*(?=[\"'][A-Za-z_])", r"\1\n", text).splitlines():
        if entry := ENTRY.match(line.partition("#")[0]):
            if name:
                yield name, words
            name, words = _plain(entry[1].rpartition(".")[2]), entry[2]
        else:
            words += "\n" + re.sub(r"^\s*-\s+", " ", line)
    if name:
        yield name, words


def _plain(name: str) -> str:
    return re.sub(r"[\W_]", "", name).lower()


def _all(words: str) -> list[float]:
    return [number for number in map(float, NUMBER.findall(words)) if math.isfinite(number)]


def _numbers(entries: Entries, names: set[str]) -> list[float] | None:
    """The numbers of the first entry of one of these names: its own, or those of the `data` that come after it."""
    for k, (name, words) in enumerate(entries):
        if name in names:
            if numbers := _all(words):
                return numbers
            data = [words for name, words in entries[k + 1 : k + NEAR] if name == "data"]
            return _all(data[0]) if data else []
    return None


def _intrinsics(entries: Entries) -> dict[str, float]:
    if (four := _numbers(entries, {"intrinsics"})) is not None:
        if len(four) != 4:
            raise ValueError(f"intrinsics has {len(four)} numbers; those of a pinhole camera are fx, fy, cx, cy.")
        return dict(zip(("fx", "fy", "cx", "cy"), four, strict=True))
    if (K := _numbers(entries, K_NAMES)) is None:
        return {}
    if len(K) != 9:
        raise ValueError(f"The camera matrix has {len(K)} numbers; it must have 9.")
    fx, skew, cx, a, fy, cy, *last = K
    if [a, *last] != [0.0, 0.0, 0.0, 1.0] or min(fx, fy) <= 0.0:
        raise ValueError(
            "The camera matrix must be fx, skew, cx, then 0, fy, cy, then 0, 0, 1, with fx and fy above 0."
        )
    return {"fx": fx, "fy": fy, "cx": cx, "cy": cy, "skew": skew}


def _size(entries: Entries) -> dict[str, float]:
    size = _numbers(entries, SIZE_NAMES)
    return dict(zip(("width", "height"), size, strict=True)) if size is not None and len(size) == 2 else {}


def _distortion(entries: Entries) -> dict[str, float]:
    if not (values := _numbers(entries, D_NAMES)):
        return {}
    if len(values) < 4 or any(values[5:]):
        raise ValueError(
            f"There are {len(values)} distortion coefficients; this sim has k1, k2, p1, p2 and, as the fifth, k3."
        )
    return dict(zip(COEFFICIENTS, values[:5], strict=False))


def _check_models(entries: Entries) -> None:
    for name, words in entries:
        model = _plain(words)
        if name in {"distortionmodel", "cameramodel"} and model and model not in MODELS:
            raise ValueError(f"“{words.strip()[:40]}” isn’t the model of k1, k2, p1, p2, k3: plumb_bob, or radtan.")
