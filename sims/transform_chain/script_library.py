"""An arm as a chain of rigid transforms. Needs NumPy and SciPy 1.16 or newer."""

from itertools import accumulate

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

# What is set, one entry for each joint: change it, and run again.
axes = "zyy"  # that the joints turn about
angles = (30.0, 40.0, -30.0)  # degrees
lengths = (1.0, 0.8, 0.5)  # metres along the x axis behind the joint
offsets = ()  # metres along the joint's own axis; empty: none
twists = ()  # degrees about the x axis at a link's end; empty: none
starts = ()  # degrees that are added to the angles; empty: none
point = (0.1, 0.2, 0.0)  # in the end effector's frame
swap = None  # 1: exchange the transforms of link 1 and link 2


def link(axis, angle, length, offset, twist):
    """Turn, slide along the axis, go along x, twist: each in the frame that the one before has made."""
    turn = RigidTransform.from_rotation(Rotation.from_euler(axis, angle, degrees=True))
    slide = RigidTransform.from_translation([offset * (letter == axis) for letter in "xyz"])
    along = RigidTransform.from_translation([length, 0, 0])
    return turn * slide * along * RigidTransform.from_rotation(Rotation.from_euler("x", twist, degrees=True))


none = (0,) * len(axes)
turned = np.add(angles, starts or none)
links = [link(*row) for row in zip(axes, turned, lengths, offsets or none, twists or none)]
chain = list(accumulate(links, RigidTransform.__mul__))  # the products up to each link

individual = [T.as_matrix() for T in links]
composed = [T.as_matrix() for T in chain]
end_effector = composed[-1]
inverse = chain[-1].inv().as_matrix()
positions = [np.zeros(3), *(T.translation for T in chain)]
in_world = chain[-1].apply(point)

# Transforms don't commute: in another order they are another arm.
swapped_end_effector = None
if swap is not None:
    links[swap - 1], links[swap] = links[swap], links[swap - 1]
    *_, last = accumulate(links, RigidTransform.__mul__)
    swapped_end_effector = last.as_matrix()

print("end effector:", end_effector, "its inverse:", inverse, sep="\n")
print("the point in the world:", in_world, "swapped:", swapped_end_effector)
