"""A place from two image points, by three methods. Needs NumPy."""

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
method = "dlt"  # or "midpoint", "optimal"

# Parallel cameras 1 m above the ground that look along +Y.
level = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
centers = np.array([[-baseline / 2, 0, 1], [baseline / 2, 0, 1]])
intrinsics = [np.array([[focal, 0, c], [0, focal, cy], [0, 0, 1.0]]) for c in (cx, cx + doffs)]
P1, P2 = (np.column_stack([level, -level @ center]) for center in centers)

pixels = np.array([left_uv, right_uv]) + noise * np.random.default_rng(seed).standard_normal((2, 2))
measured_left, measured_right = pixels
disparity = pixels[0, 0] - pixels[1, 0]
away = disparity + doffs
depth_from_disparity = focal * baseline / away if away > 0 else None


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
    rays = np.array([[*p1, 1], [*p2, 1]]) @ level
    A = np.column_stack([rays[0], -rays[1]])
    depths = np.linalg.lstsq(A, centers[1] - centers[0], rcond=None)[0]
    return (centers + depths[:, None] * rays).mean(axis=0)


# Both rays meet once both points are in one row: the least change brings each to the mean.
one_row = np.column_stack([pixels[:, 0], np.full(2, pixels[:, 1].mean())])
found = {
    "dlt": triangulate(*flat(pixels)),
    "midpoint": midpoint(*flat(pixels)),
    "optimal": triangulate(*flat(one_row)),
}
by_method = {name: {"point": X if np.isfinite(X).all() and X[1] > 0 else None} for name, X in found.items()}
point = by_method[method]["point"]  # None: the rays are parallel, or meet behind the cameras
equations = dlt_equations(*flat(pixels))
singular_values = np.linalg.svd(equations, compute_uv=False)

print("disparity:", disparity, "pixels, and the depth from it:", depth_from_disparity)
print("the point:", point, "by each method:", by_method)
