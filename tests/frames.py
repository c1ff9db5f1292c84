"""What a browser received from viser: its websocket frames as messages, and the scene that they make.

    model = SceneModel()
    page.on("websocket", lambda ws: ws.on("framereceived", model.feed))

`SceneModel` keeps to what viser's client does with each message (client/src/MessageHandler.tsx and
SceneTreeState.ts), also where that surprises: a node that is made again under its old name keeps the pose and
visibility that it had.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import msgspec
import numpy as np
import numpy.typing as npt
import zstandard

from sims.kit.viewer import VERSION

Array = npt.NDArray[np.float64]
Message = dict[str, Any]
HEADER = 16
IDENTITY = (1.0, 0.0, 0.0, 0.0)
ORIGIN = (0.0, 0.0, 0.0)
# How many numbers make one entry of an array property; viser sends arrays flat.
ENTRY = {"points": (2, 3), "vertices": (3,), "faces": (3,)}


def decode_frame(data: bytes) -> list[Message]:
    """The messages of one binary frame from the server; arrays become NumPy arrays, flat as they came."""
    raw = int.from_bytes(data[:8], "little")
    packed = int.from_bytes(data[8:HEADER], "little")
    unpacked = zstandard.ZstdDecompressor().decompress(data[HEADER : HEADER + packed], max_output_size=raw)
    if len(unpacked) != raw:
        raise ValueError(f"the frame says {raw} bytes of messages and holds {len(unpacked)}")
    content = msgspec.msgpack.decode(unpacked)
    buffers = list(_buffers(data, HEADER + packed, content.get("binaryBufferLengths") or ()))
    return [_with_arrays(message, buffers) for message in content["messages"]]


def encode_frame(messages: Iterable[Message]) -> bytes:
    """A frame as viser's server makes it; the inverse of `decode_frame`, for messages without arrays."""
    content = {"messages": list(messages), "timestampSec": 0.0, "binaryBufferLengths": []}
    inner = msgspec.msgpack.encode(content)
    packed = zstandard.ZstdCompressor(level=1).compress(inner)
    return len(inner).to_bytes(8, "little") + len(packed).to_bytes(8, "little") + packed


def encode_message(message: Mapping[str, Any]) -> bytes:
    """What viser's client sends for a message: plain msgpack, one message a frame."""
    return msgspec.msgpack.encode(message)


def decode_message(data: bytes) -> Message:
    """What viser's client sent."""
    message: Message = msgspec.msgpack.decode(data)
    return message


def _buffers(data: bytes, start: int, lengths: Iterable[int]) -> Iterator[bytes]:
    for length in lengths:
        start += -start % 8
        if start + length > len(data):
            raise ValueError(f"a frame of {len(data)} bytes names a buffer that ends at {start + length}")
        yield data[start : start + length]
        start += length


def _with_arrays(value: Any, buffers: list[bytes]) -> Any:
    if isinstance(value, list):
        return [_with_arrays(v, buffers) for v in value]
    if not isinstance(value, dict):
        return value
    if "__binary_index" in value and "dtype" in value:
        return np.frombuffer(buffers[value["__binary_index"]], dtype=value["dtype"])
    return {k: _with_arrays(v, buffers) for k, v in value.items()}


@dataclass
class SceneNode:
    """One scope's node of a name."""

    name: str
    kind: str
    """The type of the message that made it, as in LineSegmentsMessage."""
    owner: str
    virtual: bool
    props: dict[str, Any]
    wxyz: tuple[float, ...] = IDENTITY
    position: tuple[float, ...] = ORIGIN
    visible: bool = True
    drags: tuple[tuple[str, str | None], ...] = ()
    clicks: tuple[tuple[str, str | None], ...] = ()

    @property
    def rank(self) -> tuple[bool, bool]:
        """Where several scopes have a node of a name, the greatest is shown."""
        return not self.virtual, self.owner != ""

    @property
    def pose(self) -> Array:
        """Pose in the parent, 4×4. As in three.js the quaternion is taken as it is, unit or not."""
        w, x, y, z = self.wxyz
        a, b, c = self.position
        rows = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), a],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), b],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), c],
            [0, 0, 0, 1],
        ]
        return np.array(rows, dtype=float)

    def array(self, prop: str) -> npt.NDArray[Any]:
        """An array property, with one entry a row where its shape is known."""
        flat = np.asarray(self.props[prop])
        shape = (3,) if self.kind == "PointCloudMessage" else ENTRY.get(prop, ())
        return flat.reshape(-1, *shape) if shape else flat


class SceneModel:
    """The scene of one browser, from the frames that it received."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget everything, as the client does when it connects anew."""
        self.latest: dict[str, Message] = {}
        """The last message of each type that isn't about a node."""
        self.strays: list[str] = []
        """Updates of nodes that don't exist; the client drops most of them silently."""
        self.frames = self.messages = self.bytes = 0
        self._variants: dict[str, dict[str, SceneNode]] = {}

    def feed(self, frame: bytes | str) -> None:
        """Apply one frame."""
        if isinstance(frame, str):
            raise TypeError(f"viser sends binary frames only, not {frame[:60]!r}")
        self.frames += 1
        self.bytes += len(frame)
        for message in decode_frame(frame):
            self.apply(message)

    def apply(self, message: Message) -> None:
        """Apply one message."""
        self.messages += 1
        kind = message["type"]
        if kind in _HANDLERS:
            _HANDLERS[kind](self, message)
        elif "props" in message and "name" in message:
            self._create(message)
        else:
            self.latest[kind] = message

    # ---- the scene

    @property
    def names(self) -> list[str]:
        """Names of all nodes that somebody made on purpose (not the anchors that viser adds between)."""
        return sorted(name for name in self._variants if not self.node(name).virtual)

    def __contains__(self, name: str) -> bool:
        return name in self._variants

    def node(self, name: str) -> SceneNode:
        """The node that is shown under a name."""
        if name not in self._variants:
            raise KeyError(f"no node {name!r}; there are {', '.join(self.names)}")
        variants = self._variants[name].values()
        return next(iter(variants)) if len(variants) == 1 else max(variants, key=lambda node: node.rank)

    def world_pose(self, name: str) -> Array:
        """Pose of a node in the world, 4×4: the product of the poses of its ancestors and its own."""
        pose = np.eye(4)
        for ancestor in _lineage(name):
            if ancestor in self._variants:
                pose = pose @ self.node(ancestor).pose
        self.node(name)
        return pose

    def visible(self, name: str) -> bool:
        """Whether a node is shown: it and all its ancestors are."""
        self.node(name)
        return all(self.node(a).visible for a in _lineage(name) if a in self._variants)

    def points(self, name: str) -> Array:
        """What a node is drawn through, in the world: pieces (n, 2, 3) of lines and arrows, else (n, 3)."""
        node = self.node(name)
        prop = "points" if "points" in node.props else "vertices"
        pose = self.world_pose(name)
        own = node.array(prop).astype(float) * np.asarray(node.props.get("scale", 1.0), dtype=float)
        placed: Array = own @ pose[:3, :3].T + pose[:3, 3]
        return placed

    def labels(self, *, shown_only: bool = True) -> dict[str, str]:
        """Text of each label by its node's name."""
        found = {name: self.node(name) for name in self._variants}
        return {
            name: str(node.props["text"])
            for name, node in sorted(found.items())
            if node.kind == "LabelMessage" and (self.visible(name) or not shown_only)
        }

    def draggable(self) -> list[str]:
        """Names of the nodes that answer to a drag."""
        return sorted(name for name in self._variants if self.node(name).drags)

    # ---- comparing

    def snapshot(self) -> dict[str, Any]:
        """Everything that is seen, without what differs between connections (owners, ids, order numbers)."""
        return {f"scene {name}": self._seen(name) for name in self.names if self.visible(name) and name != VERSION}

    @property
    def version(self) -> int:
        """Which version of the state is drawn; -1 before any."""
        return round(self.node(VERSION).position[0]) if VERSION in self else -1

    def _seen(self, name: str) -> dict[str, Any]:
        node = self.node(name)
        props = node.props
        if "scale" in props:  # one number, or one an axis
            props = {**props, "scale": np.broadcast_to(np.asarray(props["scale"], dtype=float), 3)}
        bound = {"drags": node.drags, "clicks": node.clicks}
        return {"kind": node.kind, "pose": self.world_pose(name), "props": props, **bound}

    # ---- how each message is applied

    def _create(self, message: Message) -> None:
        variants = self._variants.setdefault(message["name"], {})
        owner, virtual = message.get("owner", ""), message.get("virtual", False)
        props = dict(message["props"])
        if (old := variants.get(owner)) is None:
            variants[owner] = SceneNode(message["name"], message["type"], owner, virtual, props)
        else:
            old.kind, old.virtual, old.props = message["type"], virtual, props

    def _variant(self, message: Message) -> SceneNode | None:
        node = self._variants.get(message["name"], {}).get(message.get("owner", ""))
        if node is None and message["name"] != "":
            self.strays.append(f"{message['type']} for {message['name']}")
        return node

    def _orient(self, message: Message) -> None:
        if (node := self._variant(message)) is not None:
            node.wxyz = tuple(message["wxyz"])

    def _place(self, message: Message) -> None:
        if (node := self._variant(message)) is not None:
            node.position = tuple(message["position"])

    def _show(self, message: Message) -> None:
        if (node := self._variant(message)) is not None:
            node.visible = message["visible"]

    def _update(self, message: Message) -> None:
        if (node := self._variant(message)) is not None:
            node.props.update(message["updates"])

    def _bind_drag(self, message: Message) -> None:
        if (node := self._variant(message)) is not None:
            node.drags = _bindings(message)

    def _bind_click(self, message: Message) -> None:
        if (node := self._variant(message)) is not None:
            node.clicks = _bindings(message)

    def _remove(self, message: Message) -> None:
        name, owner = message["name"], message.get("owner", "")
        for other in [n for n in self._variants if n == name or n.startswith(f"{name}/")]:
            self._variants[other].pop(owner, None)
            if not self._variants[other]:
                del self._variants[other]


_HANDLERS = {
    "SetOrientationMessage": SceneModel._orient,
    "SetPositionMessage": SceneModel._place,
    "SetSceneNodeVisibilityMessage": SceneModel._show,
    "SceneNodeUpdateMessage": SceneModel._update,
    "SetSceneNodeDragBindingsMessage": SceneModel._bind_drag,
    "SetSceneNodeClickBindingsMessage": SceneModel._bind_click,
    "RemoveSceneNodeMessage": SceneModel._remove,
}


def _bindings(message: Message) -> tuple[tuple[str, str | None], ...]:
    return tuple((b["button"], b["modifier"]) for b in message["bindings"])


def _lineage(name: str) -> Iterator[str]:
    """A node's ancestors, outermost first, and itself; the root is the world."""
    parts = name.split("/")[1:]
    for k in range(1, len(parts) + 1):
        yield "/" + "/".join(parts[:k])


def differences(a: Mapping[str, Any], b: Mapping[str, Any], *, within: float = 0.0) -> list[str]:
    """What differs between two snapshots, in words; numbers may differ by `within`."""
    return list(_differences("", a, b, within))


def _differences(where: str, a: Any, b: Any, within: float) -> Iterator[str]:
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        for key in a if a.keys() == b.keys() else sorted({*a, *b}, key=str):
            if key not in a or key not in b:
                yield f"{where}{key}: only in the {'first' if key in a else 'second'}"
            else:
                yield from _differences(f"{where}{key}: ", a[key], b[key], within)
    elif a is b or _same(a, b):
        return
    elif isinstance(a, np.ndarray) or isinstance(b, np.ndarray) or _numbers(a, b):
        p, q = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
        if p.shape != q.shape:
            yield f"{where}{p.shape} and {q.shape}"
        elif p.size and not (gap := float(np.max(np.abs(p - q)))) <= within:
            yield f"{where}differ by {gap:g}" + (f": {a!r} and {b!r}" if p.size <= 4 else "")
    elif a != b:
        yield f"{where}{a!r} and {b!r}"


def _same(a: Any, b: Any) -> bool:
    """Whether two numbers, lists or arrays are surely the same, found out quickly; NaN is never."""
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return np.array_equal(a, b)
    if isinstance(a, list | tuple) and isinstance(b, list | tuple):
        return len(a) == len(b) and all(x == y for x, y in zip(a, b, strict=True))
    return not isinstance(a, np.ndarray) and not isinstance(b, np.ndarray) and bool(a == b)


def _numbers(a: Any, b: Any) -> bool:
    """Both are numbers, or lists of numbers."""
    if isinstance(a, list | tuple) and isinstance(b, list | tuple):
        return all(_number(v) for v in (*a, *b))
    return _number(a) and _number(b)


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
