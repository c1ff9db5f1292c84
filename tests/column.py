"""What a page was told to show beside the scene: its parts, and what each input shows."""

from __future__ import annotations

from typing import Any

Message = dict[str, Any]


class ColumnModel:
    """Keeps to what static/viewer/parts.js does with each message."""

    def __init__(self) -> None:
        self.version = -1
        self.parts: dict[str, str] = {}
        self.values: dict[str, Any] = {}
        self.messages = 0

    def take(self, message: Message) -> None:
        """Take a message of the channel."""
        if message["type"] != "show":
            return
        self.messages += 1
        self.version = message["version"]
        self.values.update(message["values"])
        self.parts.update(message["parts"])
        panes = self.parts.get("panes", "")
        self.parts = {k: v for k, v in self.parts.items() if not k.startswith("pane:") or f'"{k}"' in panes}

    def html(self, kind: str) -> str:
        """All parts of a kind, as `read`, `pane` or `control`."""
        return "\n".join(html for name, html in self.parts.items() if name.partition(":")[0] == kind)

    def vector(self, name: str) -> list[Any]:
        """What the boxes of a vector, or the inputs of a list, show."""
        entries = [key for key, value in self.values.items() if key.rpartition(".")[0] == name and value is not None]
        return [self.values[f"{name}.{k}"] for k in range(len(entries))]

    def snapshot(self) -> dict[str, Any]:
        """Everything that is shown."""
        shown = {f"input {name}": value for name, value in self.values.items() if value is not None}
        return {**{f"part {name}": html for name, html in self.parts.items()}, **shown}
