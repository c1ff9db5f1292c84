"""Three rings in each other: which turns they can make. Needs NumPy."""

import numpy as np

# What is set: change it, and run again.
yaw = 0.0  # degrees: the outer ring, about z
pitch = 0.0  # the middle ring, about its y
roll = 0.0  # the inner ring, about its x

# The orientation: each ring turns what is inside it.
(cy, cp, cr), (sy, sp, sr) = np.cos(np.radians([yaw, pitch, roll])), np.sin(np.radians([yaw, pitch, roll]))
Rz = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
Ry = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
Rx = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
R = Rz @ Ry @ Rx

# The axis about which each ring turns now, in the world: outer, middle and inner as columns.
axes = np.column_stack([(0, 0, 1), Rz @ (0, 1, 0), Rz @ Ry @ (1, 0, 0)])

# How much of each way to turn the rings can give. One that is zero is lost: gimbal lock.
singular_values = np.linalg.svd(axes, compute_uv=False)
dof = int(np.sum(singular_values > 1e-6 * singular_values[0]))
conditioning = abs(np.linalg.det(axes))  # |cos pitch|
lost_axis = np.array([cy, sy, 0]) if dof < 3 else None

print("R:", R, "axes of the rings:", axes, sep="\n")
print("singular values:", singular_values, "degrees of freedom:", dof)
print("conditioning:", conditioning, "lost axis:", lost_axis)
