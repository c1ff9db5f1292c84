"""What is in a cloud of points. Needs NumPy, and the file that the sim gives by Download point-cloud.ply.

Its points are those that the sim shows, thinned as they are there; put it beside this script.
"""

from pathlib import Path

import numpy as np

# What is set in the sim.
dataset = "room"
process = "none"  # of a process, what was found of each point is in the column "label"
second = None  # a second scan
selected = None  # number of a point; None: none
neighbors = 16

# A PLY file: lines that name the columns, then the numbers, one point after the other.
header, _, numbers = Path("point-cloud.ply").read_bytes().partition(b"end_header\n")
lines = [line.split() for line in header.decode().splitlines()]
kinds = {"double": "<f8", "float": "<f4", "uchar": "u1", "int": "<i4"}
fields = [(line[2], kinds[line[1]]) for line in lines if line[0] == "property" and line[1] in kinds]
count = next(int(line[2]) for line in lines if line[:2] == ["element", "vertex"])
table = np.frombuffer(numbers, np.dtype(fields), count)
points = np.column_stack([table[axis] for axis in "xyz"])

# The box along the axes that all points are in.
points_out = len(points)
minimum, maximum = points.min(axis=0), points.max(axis=0)
dimensions = maximum - minimum
print(points_out, "points with", table.dtype.names)
print("from", minimum, "to", maximum, "metres, so", dimensions)

# What the nearest points say of the selected one. Each of two scans has neighbours of its own.
one_scan = process == "none" and dataset != "two-scans" and second is None
if selected is not None and selected < points_out and one_scan:
    position = points[selected]
    near = points[np.argsort(np.linalg.norm(points - position, axis=1))[:neighbors]]
    eigenvalues, directions = np.linalg.eigh(np.cov(near.T, bias=True))
    normal = directions[:, 0]  # across the plane that fits best; or the opposite direction
    variation = eigenvalues[0] / eigenvalues.sum()  # 0 on a plane
    print("point", selected, "at", position, "with normal", normal, "and variation", variation)
