"""A turn as a quaternion (w, x, y, z): what it does to a point and to an orientation. Needs NumPy."""

import numpy as np

# What is set: change it, and run again.
axis = (0.0, 0.0, 1.0)
angle = 90.0  # degrees
start = (1.0, 0.0, 0.0, 0.0)  # the orientation before the turn
point = (1.0, 0.0, 0.0)
interpolation = "slerp"  # or "nlerp"; Euler angles aren't done here
t = 1.0  # from start (0) to target (1)
long_way = False


def quaternion_from_axis_angle(axis, angle):
    """Half of the angle: q acts from both sides. Angle in radians."""
    length = np.linalg.norm(axis)
    if length == 0:
        raise ValueError("the axis must not be zero: zero has no direction")
    return np.array([np.cos(angle / 2), *(np.sin(angle / 2) * np.array(axis) / length)])


def quaternion_multiply(a, b):
    """The turn b, and after it the turn a."""
    w, v, x, u = a[0], np.array(a[1:]), b[0], np.array(b[1:])
    return np.array([w * x - v @ u, *(w * u + x * v + np.cross(v, u))])


def quaternion_rotate(q, point):
    """q p q*, with the point as a quaternion without w."""
    return quaternion_multiply(quaternion_multiply(q, [0, *point]), q * (1, -1, -1, -1))[1:]


q = quaternion_from_axis_angle(axis, np.radians(angle))
rotated_point = quaternion_rotate(q, point)

# After the start comes the turn: q stands at the left.
begin = np.array(start) / np.linalg.norm(start)
q_total = quaternion_multiply(q, begin)
R_total = np.column_stack([quaternion_rotate(q_total, unit) for unit in np.eye(3)])

# On the way: the short one needs start and target on the same side, for q and −q are the same turn.
end = -q_total if (begin @ q_total < 0) != long_way else q_total
apart = 2 * np.arctan2(np.linalg.norm(end - begin), np.linalg.norm(end + begin))
weights = (1 - t, t)
if interpolation == "slerp" and apart > 1e-6:
    weights = np.sin((1 - t) * apart), np.sin(t * apart)
if interpolation != "euler" and apart < np.pi - 1e-6:  # from one side to the other any axis leads
    way = weights[0] * begin + weights[1] * end
    interpolated = {"q": way / np.linalg.norm(way)}
    print("at t:", interpolated["q"])

print("q:", q, "turns the point to", rotated_point)
print("q after start:", q_total, "as a matrix:", R_total, sep="\n")
