"""Two views of a point: the fundamental matrix and epipolar lines. Needs NumPy and OpenCV (opencv-python)."""

import cv2
import numpy as np

# What is set: change it, and run again.
left = (-0.6, 0.0, 1.0)  # centre of the left camera, metres
right = (0.6, 0.0, 1.0)
left_pan = 0.0  # degrees about the vertical
right_pan = 0.0
focal = 600.0  # pixels
point = (0.3, 4.0, 1.2)
own = None  # or two calibrated cameras in their place: fx, fy, cx, cy of both, then R (rotation vector, degrees) and t

LEVEL = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # axes of a level camera: x right, y down, z forward


def rotation(degrees):
    """R of a rotation vector."""
    return cv2.Rodrigues(np.radians(degrees))[0]


def lens(fx, fy, cx, cy):
    """The camera matrix."""
    return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]])


def unit(M):
    """F and E are defined up to scale: length 1, and the largest entry positive."""
    M = cv2.normalize(M, None)
    largest = np.flatnonzero(np.abs(M) >= (1 - 1e-9) * np.abs(M).max())[0]
    return M * np.sign(M.flat[largest])


if own is None:
    K = K_right = lens(focal, focal, 320, 240)
    R_left, R_right = ((rotation((0.0, 0.0, pan)) @ LEVEL).T for pan in (left_pan, right_pan))
else:  # each turned by half of R, to opposite sides, and 1.2 m apart
    K, K_right = lens(*own[:4]), lens(*own[4:8])
    half = rotation(np.divide(own[8:11], 2))
    R_left, R_right = (LEVEL @ half).T, (LEVEL @ half.T).T
    middle, to_right = np.array([0, 0, 1.0]), -LEVEL @ half.T @ own[11:]
    to_right *= 0.6 / np.linalg.norm(to_right)
    left, right = middle - to_right, middle + to_right
t_left, t_right = -R_left @ left, -R_right @ right
P_left, P_right = K @ np.column_stack((R_left, t_left)), K_right @ np.column_stack((R_right, t_right))
pixels = [
    cv2.projectPoints(np.array([point]), cv2.Rodrigues(R)[0], t, lens_of, None)[0][0]
    for R, t, lens_of in ((R_left, t_left, K), (R_right, t_right, K_right))
]
print("pixels:", *pixels)  # also of a point behind a camera, which then sees nothing

if np.any(np.subtract(right, left)):  # without a baseline there is no epipolar geometry
    # From the left camera's axes to the right one's, and E = [t]ₓ R.
    R = R_right @ R_left.T
    x, y, z = t_right - R @ t_left
    E = unit(np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ R)
    F = unit(cv2.invert(K_right)[1].T @ E @ cv2.invert(K)[1])
    print("F:", F, "E:", E, sep="\n")

    in_front = all((P @ [*point, 1])[2] > 0 for P in (P_left, P_right))
    if in_front and np.linalg.norm(np.cross(np.subtract(point, left), np.subtract(right, left))) > 1e-9:
        line_left = cv2.computeCorrespondEpilines(pixels[1], 2, F)[0, 0]
        line_right = cv2.computeCorrespondEpilines(pixels[0], 1, F)[0, 0]
        p, q = (np.array([*pixel[0], 1.0]) for pixel in pixels)
        sampson = np.sqrt(cv2.sampsonDistance(p, q, F))  # pixels; OpenCV gives its square
        print("lines:", line_left, line_right, "Sampson distance:", sampson)
