"""A place from two image points, by three methods. Needs NumPy."""

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
method = "dlt"  # or "midpoint", "optimal"

level = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # axes of a level camera: x right, y down, z forward along +Y


def cross(x, y, z):
    """The matrix that multiplies by (x, y, z) as the cross product does."""
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def rotation(degrees):
    """R of a rotation vector, by Rodrigues' formula."""
    angle = np.radians(np.linalg.norm(degrees))
    W = cross(*np.radians(degrees) / angle) if angle else np.zeros((3, 3))
    return np.eye(3) + np.sin(angle) * W + (1 - np.cos(angle)) * W @ W


def lens(fx, fy, cx, cy):
    """The camera matrix."""
    return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]])


if own is None:  # parallel cameras, 1 m above the ground
    K_left, K_right = lens(focal, focal, cx, cy), lens(focal, focal, cx + doffs, cy)
    R_left = R_right = level.T
    to_right = np.array([1.0, 0, 0])
else:  # each turned by half of R, to opposite sides
    K_left, K_right = lens(*own[:4]), lens(*own[4:8])
    half = rotation(np.divide(own[8:11], 2))
    R_left, R_right = (level @ half).T, (level @ half.T).T
    to_right = -level @ half.T @ own[11:]
    to_right /= np.linalg.norm(to_right)
centers = np.array([0, 0, 1.0]) + baseline / 2 * np.array([-to_right, to_right])
rotations, intrinsics = (R_left, R_right), (K_left, K_right)
P1, P2 = (np.column_stack([R, -R @ center]) for R, center in zip(rotations, centers))

pixels = np.array([left_uv, right_uv]) + noise * np.random.default_rng(seed).standard_normal((2, 2))
measured_left, measured_right = pixels
if own is None:  # what follows from the disparity needs parallel cameras
    disparity = pixels[0, 0] - pixels[1, 0]
    away = disparity + doffs
    depth_from_disparity = focal * baseline / away if away > 0 else None
    print("disparity:", disparity, "pixels, and the depth from it:", depth_from_disparity)


def flat(pixels):
    """Pixels on the plane at depth 1: numbers near 1, with which the equations are well conditioned."""
    return [(np.linalg.inv(K) @ [*pixel, 1])[:2] for K, pixel in zip(intrinsics, pixels)]


def dlt_equations(p1, p2):
    """A of A X = 0: x (p₃ · X) − p₁ · X and y (p₃ · X) − p₂ · X for each picture."""
    return np.array([value * P[2] - P[row] for P, p in ((P1, p1), (P2, p2)) for row, value in enumerate(p)])


def triangulate(p1, p2):
    """The linear method (DLT): the singular vector of the least singular value."""
    X = np.linalg.svd(dlt_equations(p1, p2))[2][3]
    return X[:3] / X[3] if abs(X[3]) > 1e-12 else np.full(3, np.inf)


def midpoint(p1, p2):
    """The middle of the shortest way between both rays."""
    rays = np.array([R.T @ [*p, 1] for R, p in zip(rotations, (p1, p2))])
    A = np.column_stack([rays[0], -rays[1]])
    depths = np.linalg.lstsq(A, centers[1] - centers[0], rcond=None)[0]
    return (centers + depths[:, None] * rays).mean(axis=0)


def corrected(p, q):
    """The least change of both pixels after which their rays meet (Lindström 2010, until it settles)."""
    R = R_right @ R_left.T
    E = cross(*(R_right @ (centers[0] - centers[1]))) @ R
    F = np.linalg.inv(K_right).T @ E @ np.linalg.inv(K_left)
    F /= np.linalg.norm(F[:, :2])
    p1, q1 = np.array([*p, 1]), np.array([*q, 1])
    residual, slope_p, slope_q = q1 @ F @ p1, (F.T @ q1)[:2], (F @ p1)[:2]
    n, m, bend = slope_p, slope_q, F[:2, :2]
    for _ in range(20):
        a, b = m @ bend @ n, (n @ slope_p + m @ slope_q) / 2
        step = residual / (b + np.sqrt(b * b - a * residual))
        p, q = p1[:2] - step * n, q1[:2] - step * m
        n, m = slope_p - step * bend.T @ m, slope_q - step * bend @ n
    return p, q


def before_both(X):
    """Whether a point is before both cameras."""
    return np.isfinite(X).all() and all((P @ [*X, 1])[2] > 0 for P in (P1, P2))


found = {
    "dlt": triangulate(*flat(pixels)),
    "midpoint": midpoint(*flat(pixels)),
    "optimal": triangulate(*flat(corrected(*pixels))),
}
by_method = {name: {"point": X if before_both(X) else None} for name, X in found.items()}
point = by_method[method]["point"]  # None: the rays are parallel, or meet behind a camera
point_left = None if point is None else P1 @ [*point, 1]  # in the left camera's axes
depth = None if point is None else point_left[2]
equations = dlt_equations(*flat(pixels))
singular_values = np.linalg.svd(equations, compute_uv=False)

print("the point:", point, "by each method:", by_method)
print("in the left camera's axes:", point_left)
