"""Three turns, and the one rotation that they make together. Needs NumPy."""

import numpy as np

# What is set: change it, and run again.
order = "zyx"  # axes of the three turns, in the order in which they are made
frame = "intrinsic"  # about the body's own axes; "extrinsic": about those of the world
yaw = 30.0  # degrees about z; the first angle of an order such as zxz
pitch = 20.0  # about y; the second angle
roll = 10.0  # about x; the third angle


def axis_rotation(axis, angle):
    """The turn about x, y or z by an angle in radians."""
    c, s = np.cos(angle), np.sin(angle)
    if axis == "x":
        return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    if axis == "y":
        return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


# The angles in the order of the turns.
proper = order[0] == order[2]
angles = (yaw, pitch, roll) if proper else [{"z": yaw, "y": pitch, "x": roll}[axis] for axis in order]
first, second, third = (axis_rotation(axis, np.radians(a)) for axis, a in zip(order, angles))

# Turns about own axes are multiplied in their order, turns about the world's axes the other way round.
R = first @ second @ third if frame == "intrinsic" else third @ second @ first

# The same rotation as one turn by one angle: its cosine is in the trace, its sine and axis in R − Rᵀ.
twice = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])  # 2 sin(angle) · axis
axis_angle = {"angle": np.degrees(np.arctan2(np.linalg.norm(twice), np.trace(R) - 1))}


# And as a quaternion (w, x, y, z): those of the turns are multiplied like their matrices.
def quaternion_multiply(p, q):
    (a, *v), (b, *u) = p, q
    return np.array([a * b - np.dot(v, u), *(a * np.array(u) + b * np.array(v) + np.cross(v, u))])


one, two, three = (
    np.array([np.cos(half), *(np.sin(half) * np.array([letter == axis for letter in "xyz"]))])
    for axis, half in zip(order, np.radians(angles) / 2)
)
made = (one, two, three) if frame == "intrinsic" else (three, two, one)
quaternion = quaternion_multiply(quaternion_multiply(made[0], made[1]), made[2])

# How far the middle angle is from where first and third turn share an axis.
middle = abs(angles[1])
lock_distance = min(middle, 180 - middle) if proper else abs(90 - middle)

print("R:", R, sep="\n")
print("q:", quaternion)
print("one turn by", axis_angle["angle"], "degrees")
print("degrees from gimbal lock:", lock_distance)
