"""One point, read in two coordinate systems. Needs NumPy."""

import numpy as np

# What is set: change it, and run again.
convention = "opengl"
handedness = None  # "right" or "left"; None is the convention's own, the other one mirrors z
to = "opengl"
origin = (0.0, 0.0, 0.0)  # of the second frame, in the first one's coordinates
point = (1.0, 0.8, 0.6)
w = 1.0

# Where x, y and z of each convention point, in a world with X right, Y forward and Z up.
RIGHT, FORWARD, UP = np.eye(3)
AXES = {
    "opengl": (RIGHT, UP, -FORWARD),
    "directx": (RIGHT, UP, FORWARD),
    "ros": (FORWARD, -RIGHT, UP),
    "camera": (RIGHT, -UP, FORWARD),
    "aviation": (FORWARD, RIGHT, -UP),
    "enu": (RIGHT, FORWARD, UP),
    "unreal": (FORWARD, RIGHT, UP),
}


def axes_of(convention, handedness=None):
    """The axes as columns; the sign of their determinant is the handedness."""
    axes = np.column_stack(AXES[convention])
    own = "right" if np.linalg.det(axes) > 0 else "left"
    return axes if handedness in (None, own) else axes * (1, 1, -1)


# The matrix that leads from the first frame's coordinates to the second one's.
basis = axes_of(convention, handedness)
turned = axes_of(to).T @ basis
matrix = np.eye(4)
matrix[:3, :3] = turned
matrix[:3, 3] = -turned @ origin
determinant = np.linalg.det(matrix)

# The same matrix takes points (w = 1) and directions (w = 0).
homogeneous = np.array([*point, w])
homogeneous_to = matrix @ homogeneous
direction_to = matrix @ [*point, 0]
cartesian = homogeneous[:3] / w if w != 0 else None
cartesian_to = homogeneous_to[:3] / w if w != 0 else None
point_world = basis @ cartesian if w != 0 else None

print("matrix:", matrix, "determinant:", determinant, sep="\n")
print("in the first frame:", homogeneous, "in the second:", homogeneous_to)
print("the point:", cartesian, "in the second frame:", cartesian_to, "in the world:", point_world)
