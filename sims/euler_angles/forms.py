"""A rotation as others write it, to be copied."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from sims.euler_angles.params import EulerParams
from sims.euler_angles.solution import EulerSolution
from sims.kit.readout import Copied


def forms(p: EulerParams, s: EulerSolution) -> Iterator[Copied]:
    """The whole rotation in all its forms."""
    w, x, y, z = s.quaternion.tolist()
    axis, degrees = s.axis_angle["axis"].tolist(), s.axis_angle["angle"]
    order = p.order.upper() if p.frame == "intrinsic" else p.order
    rows = ", ".join(f"[{_row(row)}]" for row in s.R.tolist())
    yield Copied("Matrix, by rows (NumPy)", f"np.array([{rows}])")
    yield Copied("Quaternion, w first (Eigen, Blender)", f"wxyz {_row((w, x, y, z))}")
    yield Copied("Quaternion, w last (SciPy)", f"Rotation.from_quat([{_row((x, y, z, w))}])")
    yield Copied("Quaternion (ROS)", " ".join(f"{n}: {_text(v)}" for n, v in zip("xyzw", (x, y, z, w), strict=True)))
    yield Copied(
        "Quaternion (Unity), number by number", f"new Quaternion({', '.join(f'{_text(v)}f' for v in (x, y, z, w))})"
    )
    yield Copied("Axis and angle", f"axis {_row(axis)}, angle {_text(degrees)} deg")
    vector = [math.radians(degrees) * v for v in axis]
    yield Copied("Rotation vector (SciPy, OpenCV)", f"Rotation.from_rotvec([{_row(vector)}])")
    yield Copied("Euler angles (SciPy)", f'Rotation.from_euler("{order}", [{_row(p.angles)}], degrees=True)')
    yield Copied("CSS, number by number", f"rotate3d({_row(axis)}, {_text(degrees)}deg)")


def _row(values: Sequence[float]) -> str:
    return ", ".join(map(_text, values))


def _text(value: float) -> str:
    """Ten digits, without rounding's last crumbs."""
    text = f"{value:.10g}"
    return "0" if abs(value) < 1e-15 else text
