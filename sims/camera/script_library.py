"""How a camera makes pixels of places. Needs NumPy and OpenCV (opencv-python)."""

import cv2
import numpy as np

# What is set: change it, and run again. All of it in perspective, as OpenCV has it.
fx = 600.0  # pixels
fy = 600.0
cx = 320.0
cy = 240.0
skew = 0.0
width = 640
height = 480
position = (0.0, -4.0, 1.2)  # metres
pan = 0.0  # degrees
tilt = 0.0
roll = 0.0
projection = "perspective"
k1 = 0.0
k2 = 0.0
p1 = 0.0
p2 = 0.0
k3 = 0.0

# Corners of the house: metres across, along and up in its street, which is turned by 15 degrees.
HOUSE = {
    "roof-near": (-1.725, 1.8, 1.7), "roof-far": (-1.725, 3.6, 1.7),
    "eave-near-left": (-2.4, 1.8, 1.1), "eave-near-right": (-1.05, 1.8, 1.1),
    "eave-far-right": (-1.05, 3.6, 1.1), "eave-far-left": (-2.4, 3.6, 1.1),
    "wall-near-left": (-2.4, 1.8, 0.0), "wall-near-right": (-1.05, 1.8, 0.0),
    "wall-far-right": (-1.05, 3.6, 0.0), "wall-far-left": (-2.4, 3.6, 0.0),
}  # fmt: skip
street, _ = cv2.Rodrigues(np.radians([0.0, 0.0, -15.0]))
world = np.array(list(HOUSE.values())) @ street.T + (-0.5, -1.5, 0)

K = np.array([[fx, skew, cx], [0, fy, cy], [0, 0, 1.0]])
# Pixels are centred at whole numbers here; calibrationMatrixValues counts from the edge of the first one.
from_edge = np.add(K, [[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]])
fov_x, fov_y, *_ = cv2.calibrationMatrixValues(from_edge, (width, height), 1, 1)

# The camera's axes in the world: levelled, then turned about the world's z, its own x and its own z.
level = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
turns = [cv2.Rodrigues(np.radians(way))[0] for way in ([0.0, 0, pan], [tilt, 0.0, 0], [0.0, 0, roll])]
R = (turns[0] @ level @ turns[1] @ turns[2]).T
t = -R @ position

# OpenCV's K has no skew: it projects to the plane at depth 1, lens and all, and K does the rest.
rvec, _ = cv2.Rodrigues(R)
flat, _ = cv2.projectPoints(world, rvec, t, np.eye(3), np.array([k1, k2, p1, p2, k3], dtype=float))
pixels = cv2.convertPointsToHomogeneous(flat)[:, 0] @ K[:2].T
depths = (world @ R.T + t)[:, 2]
print("K:", K, "R:", R, "t:", t, sep="\n")
print("field of view:", fov_x, fov_y, "degrees")
if projection == "perspective":
    P = K @ np.column_stack([R, t])
    points = [  # OpenCV projects what is behind the camera too
        {"name": name, "depth": depth, "pixel": pixel if depth > 0 else None}
        for name, depth, pixel in zip(HOUSE, depths, pixels)
    ]
    print("P:", P, *((each["name"], each["pixel"]) for each in points), sep="\n")
