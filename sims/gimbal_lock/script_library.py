"""Three rings in each other: which turns they can make. Needs NumPy and SciPy."""

import numpy as np
from scipy.linalg import null_space, svdvals
from scipy.spatial.transform import Rotation

# What is set: change it, and run again.
yaw = 0.0  # degrees: the outer ring, about z
pitch = 0.0  # the middle ring, about its y
roll = 0.0  # the inner ring, about its x

# The orientation: each ring turns what is inside it. Capitals are own axes.
R = Rotation.from_euler("ZYX", [yaw, pitch, roll], degrees=True).as_matrix()
outer = Rotation.from_euler("Z", yaw, degrees=True)
middle = Rotation.from_euler("ZY", [yaw, pitch], degrees=True)

# The axis about which each ring turns now, in the world: outer, middle and inner as columns.
axes = np.column_stack([(0, 0, 1), outer.apply((0, 1, 0)), middle.apply((1, 0, 0))])

# How much of each way to turn the rings can give. One that is zero is lost: gimbal lock.
singular_values = svdvals(axes)
lost = null_space(axes.T, rcond=1e-6)
dof = 3 - lost.shape[1]
conditioning = abs(np.linalg.det(axes))  # |cos pitch|
lost_axis = lost[:, 0] if dof < 3 else None  # or the opposite direction

print("R:", R, "axes of the rings:", axes, sep="\n")
print("singular values:", singular_values, "degrees of freedom:", dof)
print("conditioning:", conditioning, "lost axis:", lost_axis)
