"""What the controls offer that the parameters alone don't say: it depends on the files, and on what was worked out."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any

from sims.kit.offers import Offers
from sims.kit.params import with_entries
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files.meaning import letters_of
from sims.point_cloud.layers import whole
from sims.point_cloud.library import NO_FILES, NOTHING, Library
from sims.point_cloud.params import LONGEST, MOST_COLUMNS, REACH, CloudParams
from sims.point_cloud.solution import CloudSolution

FILES = ("file", "second")
MEANS_NOTHING = {"register": ("method", "shift", "turn"), "outliers": ("deviations",)}
"""Parameters that mean something in one process alone."""


class CloudOffers(Offers[CloudParams]):
    """What a state offers after what was last worked out, on a server with those files."""

    def __init__(self, params: CloudParams, solution: CloudSolution | None = None, library: Library = NO_FILES) -> None:
        super().__init__(params)
        self._library = library
        self._file = params.file if params.dataset == "file" else None
        self._cloud = library.known(self._file, params.choice)
        """The file's, as far as it has been read."""
        self._guess = guess(params, library)
        course = solution and solution.registration
        self._last = course.steps if course and params.process == "register" else None

    def form(self) -> tuple[Any, ...]:
        return *super().form(), self.params.voxel_size > 0.0, self._last, self._cloud, self._guess

    def idle(self) -> Collection[str]:
        """What means nothing without a process, without two scans, without voxels or without a file."""
        p = self.params
        idle = {name for process, names in MEANS_NOTHING.items() if p.process != process for name in names}
        if p.process == "none" or (p.process == "register" and not self._two):
            idle |= {"step", "play"}
        if p.process == "register" and self._two:
            idle |= {"color"}
        if p.process in ("none", "outliers"):
            idle |= {"distance"}
        if p.process != "none":
            idle |= {"grow", "show_original"}
        if p.voxel_size == 0.0:
            idle |= {"show_original"}
        if not p.measure:
            idle |= {"other"}
        if p.dataset != "file":
            idle |= {"units", "columns", "second"}
        return idle

    @property
    def _two(self) -> bool:
        """Whether there are two scans to register."""
        return self.params.dataset == "two-scans" or (self.params.dataset == "file" and self.params.second is not None)

    def options(self, name: str) -> Mapping[Any, str]:
        return self._library.offered(getattr(self.params, name)) if name in FILES else super().options(name)

    def bounds(self, name: str) -> tuple[float, float]:
        if name == "step" and self._last is not None:
            return 0, max(self._last, self.params.step, 1)
        if name in REACH and self.params.dataset == "file":
            return 0.0, max(self._reach(name), getattr(self.params, name))
        return super().bounds(name)

    def increment(self, name: str) -> float:
        """As many steps for a file of any size."""
        return self._reach(name) / 200.0 if name in REACH and self.params.dataset == "file" else super().increment(name)

    def _reach(self, name: str) -> float:
        """The greatest length that a slider offers: a round one, about a tenth of the cloud's size."""
        if not len(self._cloud):
            return REACH[name]
        wanted = 0.2 * whole(self._cloud).radius * REACH[name]
        power = 10.0 ** math.floor(math.log10(wanted))
        return min(next(k * power for k in (1.0, 2.0, 5.0, 10.0) if k * power >= wanted * 0.999), LONGEST)

    def entries(self, name: str) -> Any:
        """The columns' dropdowns say what is guessed where nothing is chosen."""
        if name != "columns":
            return super().entries(name)
        return self.params.columns + self._guessed[len(self.params.columns) :]

    @property
    def _guessed(self) -> str:
        return letters_of(self._guess.roles[:MOST_COLUMNS])

    def entry_label(self, name: str, k: int) -> str:
        names = self._guess.columns if name == "columns" else ()
        label = super().entry_label(name, k)
        return f"{label}: {names[k][:24]}" if k < len(names) and names[k] else label

    def moved(self, changes: Mapping[str, Any]) -> CloudParams:
        now = self._exchanged(changes)
        if "step" in now and self._last is not None:
            now["step"] = min(now["step"], self._last)
        return super().moved(now)

    def _exchanged(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """A column that becomes what another one was gives that one its own role, so that no two are the same."""
        before, now = self.entries("columns"), with_entries(changes, self.entries)
        columns = now.get("columns")
        if columns is None or "columns" in changes:
            return now
        for old, new in zip(before, columns, strict=True):
            if old != new and new != "-":
                at = before.index(new) if new in before else -1
                columns = "".join(old if k == at else letter for k, letter in enumerate(columns))
        return {**now, "columns": "" if columns == self._guessed else columns}


def guess(p: CloudParams, library: Library = NO_FILES) -> Cloud:
    """The file's cloud with columns and units as guessed, as far as it has been read."""
    return library.known(p.file) if p.dataset == "file" else NOTHING
