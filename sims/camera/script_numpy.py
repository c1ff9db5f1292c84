"""How a camera makes pixels of places: K, R, t and the lens. Needs NumPy."""

import numpy as np

# What is set: change it, and run again.
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
projection = "perspective"  # or "orthographic"; weak perspective isn't done here
ortho_scale = 100.0  # pixels of a metre, in an orthographic picture
k1 = 0.0  # what the lens bends, in OpenCV's terms
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
c, s = np.cos(np.radians(15)), np.sin(np.radians(15))
street = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
world = np.array(list(HOUSE.values())) @ street.T + (-0.5, -1.5, 0)

# Intrinsic parameters: from the camera's axes to pixels.
K = np.array([[fx, skew, cx], [0, fy, cy], [0, 0, 1.0]])
# Its pixels are centred at whole numbers: the picture goes from -0.5 to width - 0.5.
fov_x = np.degrees(np.arctan((cx + 0.5) / fx) + np.arctan((width - 0.5 - cx) / fx))
fov_y = np.degrees(np.arctan((cy + 0.5) / fy) + np.arctan((height - 0.5 - cy) / fy))


# Extrinsic parameters: from the world to the camera's axes, x right, y down, z forward.
def turn(i, j, degrees):
    R, angle = np.eye(3), np.radians(degrees)
    R[[i, j], [i, j]] = np.cos(angle)
    R[j, i], R[i, j] = np.sin(angle), -np.sin(angle)
    return R


level = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
R = (turn(0, 1, pan) @ level @ turn(1, 2, tilt) @ turn(0, 1, roll)).T
t = -R @ position


def project_point(X):
    """The pixel of a place in the world, or None for one behind the camera."""
    x, y, depth = R @ X + t
    if depth <= 0:
        return None
    if projection == "orthographic":  # near and far alike
        x, y = x * ortho_scale / fx, y * ortho_scale / fx
    else:
        x, y = x / depth, y / depth
        r2 = x * x + y * y
        d = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
        x, y = (
            x * d + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * d + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
        )
    return (K @ [x, y, 1])[:2]  # skew and all


print("K:", K, "R:", R, "t:", t, sep="\n")
print("field of view:", fov_x, fov_y, "degrees")
if projection != "weak":
    points = [
        {"name": name, "world": X, "depth": (R @ X + t)[2], "pixel": project_point(X)} for name, X in zip(HOUSE, world)
    ]
    print(*((each["name"], each["pixel"]) for each in points), sep="\n")
