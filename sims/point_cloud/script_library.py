"""What is in a cloud of points. Needs NumPy, SciPy and trimesh, and the sim's Download point-cloud.ply.

Its points are those that the sim shows, thinned as they are there; put it beside this script.
"""

import numpy as np
import trimesh
from scipy.spatial import KDTree

# What is set in the sim.
dataset = "room"
process = "none"
second = None  # a second scan
selected = None  # number of a point; None: none
neighbors = 16

points = np.array(trimesh.load("point-cloud.ply", process=False).vertices)

# The box along the axes that all points are in.
points_out = len(points)
minimum, maximum = points.min(axis=0), points.max(axis=0)
dimensions = maximum - minimum
print(points_out, "points from", minimum, "to", maximum, "metres, so", dimensions)

# What the nearest points say of the selected one. Each of two scans has neighbours of its own.
one_scan = process == "none" and dataset != "two-scans" and second is None
if selected is not None and selected < points_out and one_scan:
    position = points[selected]
    _, rows = KDTree(points).query(position, min(neighbors, points_out))
    eigenvalues, directions = np.linalg.eigh(np.cov(points[rows].T, bias=True))
    normal = directions[:, 0]  # across the plane that fits best; or the opposite direction
    variation = eigenvalues[0] / eigenvalues.sum()  # 0 on a plane
    print("point", selected, "at", position, "with normal", normal, "and variation", variation)
