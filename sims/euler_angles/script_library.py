"""Three turns, and the one rotation that they make together. Needs NumPy and SciPy."""

import numpy as np
from scipy.spatial.transform import Rotation

# What is set: change it, and run again.
order = "zyx"  # axes of the three turns, in the order in which they are made
frame = "intrinsic"  # about the body's own axes; "extrinsic": about those of the world
yaw = 30.0  # degrees about z; the first angle of an order such as zxz
pitch = 20.0  # about y; the second angle
roll = 10.0  # about x; the third angle

# The angles in the order of the turns.
proper = order[0] == order[2]
angles = (yaw, pitch, roll) if proper else [{"z": yaw, "y": pitch, "x": roll}[axis] for axis in order]

# SciPy writes own axes in capitals, and the world's in small letters.
rotation = Rotation.from_euler(order.upper() if frame == "intrinsic" else order, angles, degrees=True)
R = rotation.as_matrix()
quaternion = rotation.as_quat(scalar_first=True)  # w, x, y, z; q and −q are the same rotation
axis_angle = {"angle": np.degrees(rotation.magnitude())}

# How far the middle angle is from where first and third turn share an axis.
middle = abs(angles[1])
lock_distance = min(middle, 180 - middle) if proper else abs(90 - middle)

print("R:", R, sep="\n")
print("q:", quaternion)
print("one turn by", axis_angle["angle"], "degrees")
print("degrees from gimbal lock:", lock_distance)
