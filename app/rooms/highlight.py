"""What somebody hovers over is highlighted for everybody in the room."""

from __future__ import annotations

import logging
from collections.abc import Iterable

from app.rooms.telling import Listener, Telling
from sims.kit.viewer import Viewer

log = logging.getLogger("sim3")


class Highlight:
    """Tells scenes and pages; `by` is the channel of who hovers, whose page has highlighted its own pictures."""

    def __init__(self, telling: Telling) -> None:
        self._telling = telling
        self._by: Listener | None = None

    def show(self, name: str, viewers: Iterable[Viewer], by: Listener | None) -> None:
        """Highlight what is linked under a name; an empty name is nothing."""
        self._by = by if name else None
        for viewer in list(viewers):
            try:
                viewer.highlight(name)
            except Exception:
                log.exception("highlighting in %s failed for a viewer", viewer.sim.slug)
        self._telling.tell({"type": "point", "name": name}, but=by)

    def left(self, listener: Listener, viewers: Iterable[Viewer]) -> None:
        """Who hovered has left."""
        if listener is self._by:
            self.show("", viewers, None)
