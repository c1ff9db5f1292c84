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

K = np.array([[focal, 0, 320], [0, focal, 240], [0, 0, 1.0]])


def camera(center, pan):
    """R and t of a level camera: x right, y down, z forward."""
    turn, _ = cv2.Rodrigues(np.radians([0.0, 0.0, pan]))
    R = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]) @ turn.T
    return R, -R @ center


def unit(M):
    """F and E are defined up to scale: length 1, and the largest entry positive."""
    M = cv2.normalize(M, None)
    largest = np.flatnonzero(np.abs(M) >= (1 - 1e-9) * np.abs(M).max())[0]
    return M * np.sign(M.flat[largest])


(R_left, t_left), (R_right, t_right) = camera(left, left_pan), camera(right, right_pan)
P_left, P_right = (K @ np.column_stack(pose) for pose in ((R_left, t_left), (R_right, t_right)))
pixels = [
    cv2.projectPoints(np.array([point]), cv2.Rodrigues(R)[0], t, K, None)[0][0]
    for R, t in ((R_left, t_left), (R_right, t_right))
]
print("pixels:", *pixels)  # also of a point behind a camera, which then sees nothing

if left != right:  # without a baseline there is no epipolar geometry
    # From the left camera's axes to the right one's, and E = [t]ₓ R.
    R = R_right @ R_left.T
    x, y, z = t_right - R @ t_left
    E = unit(np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ R)
    F = unit(cv2.invert(K)[1].T @ E @ cv2.invert(K)[1])
    print("F:", F, "E:", E, sep="\n")

    in_front = all((P @ [*point, 1])[2] > 0 for P in (P_left, P_right))
    if in_front and np.linalg.norm(np.cross(np.subtract(point, left), np.subtract(right, left))) > 1e-9:
        line_left = cv2.computeCorrespondEpilines(pixels[1], 2, F)[0, 0]
        line_right = cv2.computeCorrespondEpilines(pixels[0], 1, F)[0, 0]
        p, q = (np.array([*pixel[0], 1.0]) for pixel in pixels)
        sampson = np.sqrt(cv2.sampsonDistance(p, q, F))  # pixels; OpenCV gives its square
        print("lines:", line_left, line_right, "Sampson distance:", sampson)
