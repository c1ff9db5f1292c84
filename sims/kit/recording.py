"""A scene that nobody looks at, kept frame by frame: each value that a viewer would be sent, once.

A frame says of every node that is there which values it has, so a page can go from any frame to any other one.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterable, Mapping
from itertools import pairwise
from typing import Any

from sims.kit.outbox import Change, Message, Outbox, body

UNUSED = ("ThemeConfigurationMessage", "ScenePointerEnableMessage")
HELD = ("SetSceneNodeDragBindingsMessage", "SetSceneNodeClickBindingsMessage")
"""Messages about what a hand may do: nothing is held in a recording."""
UPDATE = "SceneNodeUpdateMessage"
FIRST: Mapping[str, Mapping[str, Any]] = {
    "SetSceneNodeVisibilityMessage": {"visible": True},
    "SetPositionMessage": {"position": (0.0, 0.0, 0.0)},
    "SetOrientationMessage": {"wxyz": (1.0, 0.0, 0.0, 0.0)},
}
"""What a node begins with that wasn't told of it."""
Key = tuple[str, str]
"""Name of a node (none for what all share) and what of it; nothing for the node itself."""


class Recorder(Outbox):
    """Keeps what waits until it is asked for."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        super().__init__(_nowhere, loop)

    def flush(self) -> None:
        """Nobody is there to be sent anything."""

    def _ring(self) -> None:
        """Nor later."""

    def taken(self) -> list[Change | Message]:
        """What waits, in the order in which it last changed; it no longer waits."""
        waiting, self._waiting = self._waiting, {}
        return list(waiting.values())


async def _nowhere(_: bytes) -> None:
    raise AssertionError("a recorder sends nothing")


class Recording:
    """The frames so far. Equal values, and equal arrays within them, are kept once."""

    def __init__(self) -> None:
        self.arrays: list[bytes] = []
        self.size = 0
        """Bytes of all arrays."""
        self._found: dict[bytes, int] = {}
        self._values: dict[str, int] = {}
        self._keys: dict[Key, int] = {}
        self._now: dict[int, int] = {}
        self._frames: list[dict[int, int]] = []
        self._props: dict[str, Mapping[str, Any]] = {}
        self._began: dict[tuple[int, int], int] = {}
        """By node, as it was made, and key: the value before the first that was told."""

    def add(self, messages: Iterable[Change | Message]) -> None:
        """End a frame: what it differs by from the one before."""
        for message in messages:
            arrays: list[memoryview] = []
            self._take(self._kept(body(message, arrays), arrays))
        self._frames.append(dict(self._now))

    def _take(self, told: dict[str, Any]) -> None:
        kind, name = told["type"], told.get("name", "")
        if kind in UNUSED or kind in HELD or kind.startswith("Gui"):
            return
        if kind == "RemoveSceneNodeMessage" or "props" in told:  # made anew, it has nothing of the one before
            self._now = {key: value for key, value in self._now.items() if key not in self._of(name)}
        if "props" in told:
            self._props[name] = told["props"]
            self._set((name, ""), told)
        elif kind == UPDATE:
            for what, value in told["updates"].items():
                self._change(
                    (name, what), {**told, "updates": {what: value}}, {"updates": {what: self._prop(name, what)}}
                )
        elif kind != "RemoveSceneNodeMessage":
            self._change((name, kind), told, FIRST.get(kind, {}))

    def _change(self, key: Key, told: dict[str, Any], first: Mapping[str, Any]) -> None:
        """Set something of a node; what it was before is known from then on."""
        made = self._now.get(self._keys.get((key[0], ""), -1))
        at = self._set(key, told)
        if made is not None and first:
            self._began.setdefault((made, at), self._value({**told, **first}))

    def _set(self, key: Key, told: dict[str, Any]) -> int:
        at = self._keys.setdefault(key, len(self._keys))
        self._now[at] = self._value(told)
        return at

    def _prop(self, name: str, what: str) -> Any:
        return self._props.get(name, {}).get(what)

    def _of(self, name: str) -> set[int]:
        return {at for (node, _), at in self._keys.items() if node == name}

    def _value(self, told: dict[str, Any]) -> int:
        return self._values.setdefault(json.dumps(told, allow_nan=False), len(self._values))

    def _kept(self, value: Any, arrays: list[memoryview]) -> Any:
        """A value with its arrays, and bytes, replaced by where they are kept."""
        if isinstance(value, dict):
            if "__binary_index" in value:
                return {"array@": self._array(bytes(arrays[value["__binary_index"]])), "dtype": value["dtype"]}
            return {name: self._kept(each, arrays) for name, each in value.items()}
        if isinstance(value, (list, tuple)):
            return [self._kept(each, arrays) for each in value]
        if isinstance(value, (bytes, memoryview)):
            return {"array@": self._array(bytes(value)), "dtype": "|u1"}
        return value

    def _array(self, data: bytes) -> int:
        if data not in self._found:
            self._found[data] = len(self.arrays)
            self.arrays.append(data)
            self.size += len(data)
        return self._found[data]

    def told(self, name: str, what: str = "") -> dict[str, Any]:
        """What a node, or something of it, was last told."""
        values = list(self._values)
        told: dict[str, Any] = json.loads(values[self._now[self._keys[name, what]]])
        return told

    def json(self) -> dict[str, Any]:
        """All but the arrays: keys, values, and by frames, key after key, what differs (−1: it isn't there)."""
        began: dict[int, list[tuple[int, int]]] = {}
        for (made, at), value in self._began.items():
            began.setdefault(made, []).append((at, value))
        whole = [self._whole(frame, began) for frame in self._frames]
        return {
            "keys": list(self._keys),
            "values": [json.loads(value) for value in self._values],
            "frames": [_differing(before, after) for before, after in pairwise([{}, *whole])],
        }

    def _whole(self, frame: dict[int, int], began: Mapping[int, Iterable[tuple[int, int]]]) -> dict[int, int]:
        """A frame with what each of its nodes had before it was first told otherwise."""
        made = [frame[at] for (_, what), at in self._keys.items() if not what and at in frame]
        return {**{at: value for node in made for at, value in began.get(node, ())}, **frame}


def _differing(before: Mapping[int, int], after: Mapping[int, int]) -> list[int]:
    changed = {at: value for at, value in after.items() if before.get(at) != value}
    changed |= {at: -1 for at in before if at not in after}
    return [number for pair in changed.items() for number in pair]
