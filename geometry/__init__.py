"""The mathematics of Sim3: NumPy in, NumPy out.

Conventions, stated once:

- Right-handed world, X right, Y forward, Z up, in metres. Angles are in radians.
- Rotations are active and act on column vectors. ``T_a_b`` maps coordinates in b to coordinates in a.
- Quaternions are Hamilton's, ``(w, x, y, z)``.
- Cameras look along z, x right, y down. Pixels are ``(u, v)`` with integer pixel centres; ``p ~ K [R | t] X``
  with ``[R | t]`` from ``T_camera_world``, and ``p_right^T F p_left = 0``.
- Arrays are float64 and take leading batch dimensions, written ``(..., 3)``.
- Input that is wrong as a whole raises `GeometryError`; a failing row of a batch is NaN in the result.
"""

from .arrays import Array, Mask
from .errors import GeometryError

__all__ = ["Array", "GeometryError", "Mask"]
