"""A point cloud as the sim holds it, whether it was simulated or came from a file."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from geometry.arrays import Array

Colors = npt.NDArray[np.uint8]
EACH = ("points", "colors", "intensity", "ring", "scan", "normals", "counts")
"""What a cloud has of each point."""


@dataclass(frozen=True, eq=False)
class Cloud:
    """Points (N, 3) in metres, and what is known of each: None if nothing is.

    `colors` (N, 3) are RGB 0–255, `intensity` (N,) is 0–1, `ring` (N,) the laser of a rotating lidar, `scan` (N,)
    the number of the scan a point is from, `sensor` (3,) or (N, 3) where it was seen from, `counts` (N,) how many
    measured points it is the mean of, if it is one. `dropped` points of the
    file had no finite coordinates. `apart` says that scans 0 and 1 aren't registered yet; `truth` (4, 4) brings
    scan 1 onto scan 0, where that is known.
    Of points too many to show, `left_out` aren't here, and `strays` were far from all others. `origin` (3,) was taken
    from coordinates that were far away. Of a file: `normals` (N, 3) are its own, of length 1 or, where it has none, 0;
    `intensity_span` are the file's values for intensities 0 and 1; `columns` are its columns' names, `roles` what each
    was taken for (`files.meaning.ROLES`), `preview` its first entries; `unit` is that of its coordinates
    (`files.units.METRES`); `notes` and `cautions` say in words how it was read.
    """

    name: str
    points: Array
    colors: Colors | None = None
    intensity: Array | None = None
    ring: npt.NDArray[np.uint8] | None = None
    scan: npt.NDArray[np.uint8] | None = None
    sensor: Array | None = None
    dropped: int = 0
    apart: bool = False
    truth: Array | None = None
    simulated: bool = False
    left_out: int = 0
    origin: Array | None = None
    normals: Array | None = None
    strays: int = 0
    intensity_span: tuple[float, float] | None = None
    columns: tuple[str, ...] = ()
    roles: tuple[str, ...] = ()
    preview: tuple[tuple[str, ...], ...] = ()
    unit: str = "metres"
    notes: tuple[str, ...] = ()
    cautions: tuple[str, ...] = ()
    counts: npt.NDArray[np.intp] | None = None

    def __len__(self) -> int:
        return len(self.points)

    def only(self, rows: npt.NDArray[np.bool_] | npt.NDArray[np.intp]) -> Cloud:
        """The same cloud with some of its points."""
        each: dict[str, Any] = {name: getattr(self, name) for name in EACH}
        kept: dict[str, Any] = {name: None if values is None else values[rows] for name, values in each.items()}
        sensor = self.sensor if self.sensor is None or self.sensor.ndim == 1 else self.sensor[rows]
        return replace(self, **kept, sensor=sensor)

    def with_means(
        self, points: Array, colors: Colors | None, intensity: Array | None, normals: Array | None = None,
        counts: npt.NDArray[np.intp] | None = None,
    ) -> Cloud:  # fmt: skip
        """The same cloud with these in place of each point's."""
        return replace(self, points=points, colors=colors, intensity=intensity, normals=normals, counts=counts)

    @property
    def measured(self) -> npt.NDArray[np.intp]:
        """How many measured points (N,) each stands for."""
        return np.ones(len(self), np.intp) if self.counts is None else self.counts

    def followed_by(self, other: Cloud) -> Cloud:
        """Both clouds' points; what only one of them knows is lost."""
        joined: dict[str, Any] = {}
        for name in (*EACH, "sensor"):
            both = getattr(self, name), getattr(other, name)
            joined[name] = None if any(v is None for v in both) else np.concatenate(both)
        return replace(self, **joined)

    def with_second(self, other: Cloud) -> Cloud:
        """This cloud as the first scan and another one as the second, which isn't registered to it yet.

        Each stays where it is; of two that are far from their origin, both from this one's.
        """
        points = other.points
        if self.origin is not None and other.origin is not None:
            points = points + (other.origin - self.origin)
        first, second = (
            replace(one, scan=np.full(len(one), k, np.uint8), sensor=one.sensor_of_each)
            for k, one in enumerate((self, replace(other, points=points)))
        )
        return replace(first.followed_by(second), apart=True, truth=None)

    @property
    def sensor_of_each(self) -> Array | None:
        """Where each point (N, 3) was seen from, if that is known."""
        return None if self.sensor is None else np.broadcast_to(self.sensor, self.points.shape)
