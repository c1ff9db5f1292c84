"""A turn as a quaternion (w, x, y, z): what it does to a point and to an orientation. Needs NumPy and SciPy."""

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

# What is set: change it, and run again.
axis = (0.0, 0.0, 1.0)
angle = 90.0  # degrees
start = (1.0, 0.0, 0.0, 0.0)  # the orientation before the turn
point = (1.0, 0.0, 0.0)
interpolation = "slerp"  # SciPy has this one, and only the short way
t = 1.0  # from start (0) to target (1)
long_way = False

# The direction of a rotation vector is the axis, its length the angle in radians.
turn = Rotation.from_rotvec(np.radians(angle) * np.array(axis) / np.linalg.norm(axis))
begin = Rotation.from_quat(start, scalar_first=True)  # of any length but zero
total = turn * begin  # first the start, then the turn

# A rotation doesn't know whether it came from q or from −q: the signs may differ from the sim's.
q = turn.as_quat(scalar_first=True)
q_total = total.as_quat(scalar_first=True)
R_total = total.as_matrix()
rotated_point = turn.apply(point)

if interpolation == "slerp" and not long_way:
    way = Slerp([0, 1], Rotation.concatenate([begin, total]))(t)
    interpolated = {"q": way.as_quat(scalar_first=True)}
    print("at t:", interpolated["q"])

print("q:", q, "turns the point to", rotated_point)
print("q after start:", q_total, "as a matrix:", R_total, sep="\n")
