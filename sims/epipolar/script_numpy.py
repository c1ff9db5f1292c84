"""Two views of a point: the fundamental matrix, epipoles and epipolar lines. Needs NumPy."""

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
    c, s = np.cos(np.radians(pan)), np.sin(np.radians(pan))
    R = np.array([[c, s, 0], [0, 0, -1], [-s, c, 0]])
    return R, -R @ center


def project(P, X):
    """The pixel of a place, or None behind the camera."""
    u, v, depth = P @ [*X, 1]
    return np.array([u, v]) / depth if depth > 0 else None


def unit(M):
    """F, E and epipoles are defined up to scale: length 1, and the largest entry positive."""
    M = M / np.linalg.norm(M)
    largest = np.flatnonzero(np.abs(M) >= (1 - 1e-9) * np.abs(M).max())[0]
    return M * np.sign(M.flat[largest])


def line(l):
    """a, b, c with a² + b² = 1: a u + b v + c is a distance in pixels."""
    return l / np.hypot(l[0], l[1])


(R_left, t_left), (R_right, t_right) = camera(left, left_pan), camera(right, right_pan)
P_left, P_right = (K @ np.column_stack(pose) for pose in ((R_left, t_left), (R_right, t_right)))
pixel_left, pixel_right = project(P_left, point), project(P_right, point)
print("pixels:", pixel_left, pixel_right)

if left != right:  # without a baseline there is no epipolar geometry
    # From the left camera's axes to the right one's, and E = [t]ₓ R.
    R = R_right @ R_left.T
    x, y, z = t_right - R @ t_left
    E = unit(np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ R)
    F = unit(np.linalg.inv(K).T @ E @ np.linalg.inv(K))

    # An epipole is the other camera's centre in the picture.
    epipole_left, epipole_right = unit(P_left @ [*right, 1]), unit(P_right @ [*left, 1])
    print("F:", F, "E:", E, "epipoles:", epipole_left, epipole_right, sep="\n")

    # The match of each pixel lies on a line.
    if pixel_left is not None and pixel_right is not None:
        p, q = np.array([*pixel_left, 1]), np.array([*pixel_right, 1])
        residual = q @ F @ p  # zero for a match
        to_right, to_left = F @ p, F.T @ q
        if min(np.hypot(*to_right[:2]), np.hypot(*to_left[:2])) > 1e-12:
            line_left, line_right = line(to_left), line(to_right)
            print("lines:", line_left, line_right)
