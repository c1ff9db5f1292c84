"""What the pages of a session show beside the scene: each is told everything once, and then what differs."""

from __future__ import annotations

from html import escape
from typing import Any

from app.rooms.telling import Message
from sims.kit.column import PANES, Column, Parts
from sims.kit.params import Params


class Showing:
    """Remembers what all pages have been told."""

    def __init__(self, column: Column) -> None:
        self._column = column
        self._parts: Parts = {}
        self._values: dict[str, Any] = {}

    def everything(self, params: Params, solution: Any, version: int, words: str) -> Message:
        """All of a state, for a page that comes; those that are there have it already."""
        self.news(params, solution, version, words)
        return _message(version, self._values, self._parts)

    def news(self, params: Params, solution: Any, version: int, words: str) -> Message:
        """What differs from what was told last; `words`, where there are any, stand in place of the caption.

        The version says to which drawing of the scene it belongs.
        """
        parts, values = self._column.of(params, solution)
        if words:
            parts["caption"] = f'<span class="s3-told">{escape(words)}</span>'
        new_parts = {name: html for name, html in parts.items() if self._parts.get(name) != html}
        if PANES in new_parts:  # other frames, which are to be filled
            new_parts |= {name: html for name, html in parts.items() if name.startswith("pane:")}
        new_values = {name: v for name, v in values.items() if name not in self._values or self._values[name] != v}
        gone = dict.fromkeys(self._values.keys() - values.keys())  # entries of a list that has become shorter
        self._parts, self._values = parts, values
        return _message(version, {**new_values, **gone}, new_parts)


def _message(version: int, values: dict[str, Any], parts: Parts) -> Message:
    return {"type": "show", "version": version, "values": values, "parts": parts}


def merged(older: Message, newer: Message) -> Message:
    """Two messages of what to show as one."""
    both = {name: {**older[name], **newer[name]} for name in ("values", "parts")}
    return {**newer, **both}
