"""What somebody hovers over, or has under a pointer in the scene, is shown to everybody in the room."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable

from app.rooms.telling import Listener, Telling
from sims.kit.viewer import Viewer

log = logging.getLogger("sim3")


class Highlight:
    """Tells scenes and pages; `by` is the channel of who hovers, whose page has highlighted its own pictures."""

    def __init__(self, telling: Telling) -> None:
        self._telling = telling
        self._by: Listener | None = None
        self._over: Listener | None = None
        """Whose pointer what is shown under a pointer is under."""

    def show(self, name: str, viewers: Iterable[Viewer], by: Listener | None) -> None:
        """Highlight what is linked under a name; an empty name is nothing."""
        self._by = by if name else None
        self._each(viewers, lambda viewer: viewer.highlight(name))
        self._telling.tell({"type": "point", "name": name}, but=by)

    def under(self, found: object, viewers: Iterable[Viewer], by: Listener | None) -> None:
        """Show what is under a pointer, or nothing for None, until the next drawing."""
        self._over = by if found is not None else None
        self._each(viewers, lambda viewer: viewer.under(found))

    def left(self, listener: Listener, viewers: Iterable[Viewer]) -> None:
        """Who hovered has left."""
        if listener == self._by:
            self.show("", viewers, None)
        if listener == self._over:
            self.under(None, viewers, None)

    def _each(self, viewers: Iterable[Viewer], show: Callable[[Viewer], None]) -> None:
        """Show something to each viewer; one that fails is no reason for the others not to see it."""
        for viewer in list(viewers):
            try:
                show(viewer)
            except Exception:
                log.exception("highlighting in %s failed for a viewer", viewer.sim.slug)
