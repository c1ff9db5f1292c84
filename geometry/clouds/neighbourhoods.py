"""Covariances of points' nearest neighbours: near points share the search for candidates."""

import math

import numpy as np

from ..arrays import Array, Mask
from .neighbours import Neighbours
from .points import Indices, squares

_PAIRS = (0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)
_FEWEST = 24  # members of a group, twice as many at most
_PART = 128  # groups at a time: their distances stay in the cache
_ROUNDED = 4e-6
"""What float32 may say wrong about a squared distance, as part of the candidates' squared radius: 64 roundings."""
_TINY = 1 / 256  # squared: neighbours closer together lose digits beside such a radius


@np.errstate(divide="ignore", invalid="ignore", over="ignore")  # groups in one place have no radius: NaN is never sure
def covariances(near: Neighbours, rows: slice, count: int) -> Array:
    """Return xx, xy, xz, yy, yz, zz (6, n) of the covariance of the nearest points of some ordered rows.

    Rows are put together in groups, and the tree is asked for the points nearest to a group's centre c: all within
    a radius r of it. A member p whose neighbours are within r − ‖p − c‖ finds them all among these, and products of
    matrices compare and average them: quicker than to ask the tree for each point. Who can't be sure of that, or
    that the last neighbour is nearer than the next by more than rounding, asks alone.
    """
    xyz = near.xyz[:, rows]
    result, sure = np.empty((6, xyz.shape[1])), np.zeros(xyz.shape[1], bool)
    groups = _groups(xyz)
    candidates = _candidates(groups.shape[1], count)
    if candidates < len(near):
        for first in range(0, len(groups), _PART):
            part = groups[first : first + _PART]
            sure[part], result[:, part] = _together(near, xyz.take(part, axis=1), count, candidates)
    alone = np.flatnonzero(~sure)
    if len(alone):
        result[:, alone] = _alone(near, alone + rows.start, count)
    return result


def _candidates(members: int, count: int) -> int:
    """How many points round a compact group on a surface have nearly each member's neighbours among them."""
    return int((1.25 * math.sqrt(members) + math.sqrt(count)) ** 2)


def _groups(xyz: Array) -> Indices:
    """Cut points, columns (3, n), into halves across the longer side, again and again, to equal groups (g, m).

    A few may be left over.
    """
    halvings = max(0, (xyz.shape[1] // _FEWEST).bit_length() - 1)
    groups = np.arange(xyz.shape[1] >> halvings << halvings)[None]
    for _ in range(halvings):
        members = xyz.take(groups, axis=1)
        longest = np.ptp(members, axis=2).argmax(axis=0)
        along = members[longest, np.arange(len(groups))]
        halves = np.argpartition(along, groups.shape[1] // 2, axis=1)
        halves += np.arange(0, groups.size, groups.shape[1])[:, None]
        groups = groups.ravel().take(halves).reshape(2 * len(groups), -1)
    return groups


def _together(near: Neighbours, members: Array, count: int, candidates: int) -> tuple[Mask, Array]:
    """Which members (3, g, m) of groups are sure of their neighbours (g, m), and the covariances (6, g, m).

    All is relative to the group's centre and the candidates' radius: no digits are lost far from the origin.
    """
    center = members.mean(axis=2, keepdims=True)
    distance, places = near.query(center[..., 0].T, candidates)
    radius = distance[:, -1:]
    p, q = (members - center) / radius, np.empty((9, *places.shape))
    q[:3] = (near.xyz.take(places, axis=1) - center) / radius
    q[3:6] = q[:3] * q[0]
    q[6:8] = q[1:3] * q[1]
    q[8] = q[2] * q[2]
    left = np.ones((*places.shape[:1], p.shape[2], 4), np.float32)
    left[..., :3] = p.transpose(1, 2, 0)
    right = np.empty((len(places), 4, candidates), np.float32)
    right[:, :3] = q[:3].transpose(1, 0, 2)
    right[:, :3] *= -2.0
    right[:, 3] = q[3] + q[6] + q[8]
    compared = left @ right  # squared distances, less ‖p‖²
    smallest = np.partition(compared, count, axis=2)
    last, beyond = smallest[..., :count].max(axis=2), smallest[..., count]
    square = squares(p)
    reach, most = last + square, np.maximum(1.0 - np.sqrt(square), 0.0) ** 2
    sure = (beyond - last > _ROUNDED) & (reach + _ROUNDED < most) & (reach > _TINY)
    chosen = (compared <= last[..., None]).astype(np.float64)
    means = (q.transpose(1, 0, 2) @ chosen.transpose(0, 2, 1)).transpose(1, 0, 2) / count
    means[3:6] -= means[:3] * means[0]
    means[6:8] -= means[1:3] * means[1]
    means[8] -= means[2] * means[2]
    return sure, means[3:] * (radius * radius)


def _alone(near: Neighbours, rows: Indices, count: int) -> Array:
    """Covariances (6, n) of ordered rows' own neighbours, relative to each point."""
    places = near.nearest(rows, count)[1]
    scale = 1.0 / count
    offsets = [row[places] - row[rows, None] for row in near.xyz]
    for offset in offsets:
        offset -= scale * offset.sum(axis=1, keepdims=True)
    return np.stack([scale * np.einsum("nk,nk->n", offsets[i], offsets[j]) for i, j in _PAIRS])
