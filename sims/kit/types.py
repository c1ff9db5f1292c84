"""Plain values that are passed about: places, directions and orientations as numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Place = tuple[float, float, float]
"""x, y, z in metres."""
Pixel = tuple[float, float]
"""u, v in a picture: from the left and from the top, integers in the middle of pixels."""
Quaternion = tuple[float, float, float, float]
"""w, x, y, z."""
IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)
ORIGIN: Place = (0.0, 0.0, 0.0)
Segment = tuple[Place, Place]
"""Both ends of a straight piece."""
Vector = Sequence[float] | npt.NDArray[np.float64]
"""Three numbers, in any form."""
Line = tuple[Vector, Vector]
"""A place on a straight line, in metres, and its direction at length one."""
