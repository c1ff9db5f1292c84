"""A place from two image points. Needs NumPy and OpenCV (opencv-python)."""

import cv2
import numpy as np

# What is set: change it, and run again.
baseline = 0.6  # metres
focal = 600.0  # pixels
cx = 320.0
cy = 240.0
doffs = 0.0  # how much farther right the principal point of the right picture is
left_uv = (410.0, 210.0)
right_uv = (320.0, 210.0)
noise = 0.0  # standard deviation in pixels
seed = 0

# Parallel cameras 1 m above the ground that look along +Y.
level = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
K = [np.array([[focal, 0, c], [0, focal, cy], [0, 0, 1.0]]) for c in (cx, cx + doffs)]
P = [np.column_stack([level, -level @ (x, 0, 1)]) for x in (-baseline / 2, baseline / 2)]

pixels = np.array([left_uv, right_uv]) + noise * np.random.default_rng(seed).standard_normal((2, 2))
measured_left, measured_right = pixels
disparity = pixels[0, 0] - pixels[1, 0]


def triangulate(pixels):
    """The linear method (DLT); None for rays that are parallel, or meet behind the cameras."""
    flat = [cv2.undistortPoints(pixel[None], k, None)[0].T for pixel, k in zip(pixels, K)]
    X = cv2.triangulatePoints(P[0], P[1], *flat)[:, 0]
    return X[:3] / X[3] if abs(X[3]) > 1e-12 and X[1] / X[3] > 0 else None


# The optimal method first moves both pixels, by as little as can be, to where their rays meet.
E = np.array([[0.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # [t]ₓ for cameras that are side by side
F = np.linalg.inv(K[1]).T @ E @ np.linalg.inv(K[0])
corrected = np.array(cv2.correctMatches(F, pixels[:1, None], pixels[1:, None]))[:, 0, 0]

by_method = {"dlt": {"point": triangulate(pixels)}, "optimal": {"point": triangulate(corrected)}}
print("disparity:", disparity, "pixels")
print("the point:", by_method)
