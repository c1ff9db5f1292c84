"""An arm as a chain of rigid transforms, each a 4×4 matrix. Needs NumPy."""

import numpy as np

# What is set, one entry for each joint: change it, and run again.
axes = "zyy"  # that the joints turn about
angles = (30.0, 40.0, -30.0)  # degrees
lengths = (1.0, 0.8, 0.5)  # metres along the x axis behind the joint
offsets = ()  # metres along the joint's own axis; empty: none
twists = ()  # degrees about the x axis at a link's end; empty: none
starts = ()  # degrees that are added to the angles; empty: none
point = (0.1, 0.2, 0.0)  # in the end effector's frame
swap = None  # 1: exchange the transforms of link 1 and link 2


def rotation(axis, degrees):
    """A turn about x, y or z as a 4×4 matrix."""
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    T, angle = np.eye(4), np.radians(degrees)
    T[[i, j], [i, j]] = np.cos(angle)
    T[j, i] = np.sin(angle)
    T[i, j] = -np.sin(angle)
    return T


def translation(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def link(axis, angle, length, offset, twist):
    """Turn, slide along the axis, go along x, twist: each in the frame that the one before has made."""
    slide = translation(*(offset * (letter == axis) for letter in "xyz"))
    return rotation(axis, angle) @ slide @ translation(length, 0, 0) @ rotation("x", twist)


none = (0,) * len(axes)
turned = np.add(angles, starts or none)
individual = [link(*row) for row in zip(axes, turned, lengths, offsets or none, twists or none)]


def chained(links):
    """The products up to each link: from the world to its end."""
    products = [np.eye(4)]
    for T in links:
        products.append(products[-1] @ T)
    return products


frames = chained(individual)
composed = frames[1:]
end_effector = composed[-1]
positions = [T[:3, 3] for T in frames]

# The inverse of a rigid transform needs no general inverse: R is turned back by its transpose.
R, p = end_effector[:3, :3], end_effector[:3, 3]
inverse = np.eye(4)
inverse[:3, :3], inverse[:3, 3] = R.T, -R.T @ p

# A point through the chain, from the end effector to the world.
through = [np.array([*point, 1])]
for T in reversed(individual):
    through.append(T @ through[-1])

# Matrices don't commute: in another order they are another arm.
swapped_end_effector = None
if swap is not None:
    other = list(individual)
    other[swap - 1], other[swap] = other[swap], other[swap - 1]
    swapped_end_effector = chained(other)[-1]

print("end effector:", end_effector, "its inverse:", inverse, sep="\n")
print("the point in the world:", through[-1][:3], "swapped:", swapped_end_effector)
