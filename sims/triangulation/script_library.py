"""A place from two image points. Needs NumPy and OpenCV (opencv-python)."""

import cv2
import numpy as np

# What is set: change it, and run again.
baseline = 0.6  # metres
focal = 600.0  # pixels
cx = 320.0
cy = 240.0
doffs = 0.0  # how much farther right the principal point of the right picture is
own = None  # or two calibrated cameras in their place: fx, fy, cx, cy of both, then R (rotation vector, degrees) and t
left_uv = (410.0, 210.0)
right_uv = (320.0, 210.0)
noise = 0.0  # standard deviation in pixels
seed = 0

level = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # axes of a level camera: x right, y down, z forward along +Y


def lens(fx, fy, cx, cy):
    """The camera matrix."""
    return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]])


if own is None:  # parallel cameras, 1 m above the ground
    K_left, K_right = lens(focal, focal, cx, cy), lens(focal, focal, cx + doffs, cy)
    R_left = R_right = level.T
    to_right = np.array([1.0, 0, 0])
else:  # each turned by half of R, to opposite sides
    K_left, K_right = lens(*own[:4]), lens(*own[4:8])
    half = cv2.Rodrigues(np.radians(own[8:11]) / 2)[0]
    R_left, R_right = (level @ half).T, (level @ half.T).T
    to_right = -level @ half.T @ own[11:]
    to_right /= np.linalg.norm(to_right)
left, right = (np.array([0, 0, 1.0]) + side * baseline / 2 * to_right for side in (-1, 1))
K = K_left, K_right
P = np.column_stack([R_left, -R_left @ left]), np.column_stack([R_right, -R_right @ right])

pixels = np.array([left_uv, right_uv]) + noise * np.random.default_rng(seed).standard_normal((2, 2))
measured_left, measured_right = pixels
if own is None:  # of other cameras it is no measure of depth
    disparity = pixels[0, 0] - pixels[1, 0]
    print("disparity:", disparity, "pixels")


def triangulate(pixels):
    """The linear method (DLT); None for rays that are parallel, or meet behind a camera."""
    flat = [cv2.undistortPoints(pixel[None], k, None)[0].T for pixel, k in zip(pixels, K)]
    X = cv2.triangulatePoints(P[0], P[1], *flat)[:, 0]
    in_front = abs(X[3]) > 1e-12 and all((p @ X)[2] / X[3] > 0 for p in P)
    return X[:3] / X[3] if in_front else None


# The optimal method first moves both pixels, by as little as can be, to where their rays meet.
x, y, z = R_right @ (left - right)
E = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ R_right @ R_left.T  # [t]ₓ R
between = cv2.normalize(np.linalg.inv(K_right).T @ E @ np.linalg.inv(K_left), None)  # the fundamental matrix
corrected = np.array(cv2.correctMatches(between, pixels[:1, None], pixels[1:, None]))[:, 0, 0]

by_method = {"dlt": {"point": triangulate(pixels)}, "optimal": {"point": triangulate(corrected)}}
print("the point:", by_method)
