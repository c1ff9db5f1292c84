"""A real camera's K, picture size and lens distortion, from the text that calibration tools write."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from sims.camera.params import COEFFICIENTS, CameraParams
from sims.kit.calibration import LENS, Written, cameras
from sims.kit.spelling import plain

MODELS = {"plumbbob", "radtan", "pinhole", "rationalpolynomial", "none"}
"""Names of models that the five coefficients are part of."""
EXAMPLE = """\
image_width: 752
image_height: 480
camera_matrix:
  data: [458.7, 0, 367.2, 0, 457.3, 248.4, 0, 0, 1]
distortion_coefficients:
  data: [-0.283, 0.074, 0.0002, 0.00002]"""


def read(text: str) -> dict[str, float]:
    """What the text says of fx, fy, cx, cy, skew, width, height and distortion. Raises ValueError in words."""
    found = cameras(text)
    K = found[0].K if found else None
    if K is None:
        raise ValueError(f"No {', '.join(LENS)} found: a camera matrix is wanted, or Kalibr’s intrinsics.")
    _check_model(found[0])
    (fx, skew, cx), (_, fy, cy), _ = K.tolist()
    return {"fx": fx, "fy": fy, "cx": cx, "cy": cy, "skew": skew, **found[0].size, **_distortion(found[0])}


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


def _distortion(camera: Written) -> dict[str, float]:
    if not (values := camera.distortion):
        return {name: camera.numbers(name, 1)[0] for name in COEFFICIENTS if name in camera.entries}
    if len(values) < 4 or any(values[5:]):
        raise ValueError(
            f"There are {len(values)} distortion coefficients; this sim has k1, k2, p1, p2 and, as the fifth, k3."
        )
    return dict(zip(COEFFICIENTS, values[:5], strict=False))


def _check_model(camera: Written) -> None:
    for name in ("distortionmodel", "cameramodel"):
        words = camera.entries[name].words if name in camera.entries else ""
        model = re.sub(r"[\W_]", "", words).lower()
        if model and model not in MODELS:
            raise ValueError(f"“{words.strip()[:40]}” isn’t the model of k1, k2, p1, p2, k3: plumb_bob, or radtan.")
