"""One point, read in two coordinate systems. Needs NumPy and OpenCV (opencv-python)."""

import cv2
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
basis = np.column_stack(AXES[convention])
if handedness not in (None, "right" if cv2.determinant(basis) > 0 else "left"):
    basis[:, 2] *= -1

# The matrix that leads from the first frame's coordinates to the second one's.
turned = np.column_stack(AXES[to]).T @ basis
matrix = np.eye(4)
matrix[:3, :3] = turned
matrix[:3, 3] = -turned @ origin
determinant = cv2.determinant(matrix)

# OpenCV takes rows of points; perspectiveTransform puts a 1 below each, and divides by what becomes of it.
if w != 0:
    cartesian = np.array(point) / w
    cartesian_to = cv2.perspectiveTransform(cartesian[None, None], matrix)[0, 0]
    point_world = cv2.transform(cartesian[None, None], basis)[0, 0]
else:
    cartesian = cartesian_to = point_world = None  # a direction: no point to divide

print("matrix:", matrix, "determinant:", determinant, sep="\n")
print("the point:", cartesian, "in the second frame:", cartesian_to, "in the world:", point_world)
