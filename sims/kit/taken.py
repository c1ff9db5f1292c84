"""A sim as it is taken home: its scene and its column, frame by frame, packed for a page that asks no server."""

from __future__ import annotations

import gzip
import json
import re
from collections.abc import Sequence
from html import escape
from typing import Any

import msgspec
import viser
import zstandard

from sims.kit import pane, readout
from sims.kit.params import Params
from sims.kit.progress import goes_on
from sims.kit.recording import Recorder, Recording
from sims.kit.sim import Library, Sim
from sims.kit.types import Vector
from sims.kit.viewer import VERSION, Viewer
from sims.kit.viser_internals import ViserHost

LARGEST = 24_000_000
"""Bytes of a scene's arrays, which are packed to about a third."""
Parts = dict[str, str]
"""The HTML of each part of the column."""


class TooLarge(Exception):
    """It would be too large a file."""


class Nobody:
    """Whom a recorded scene tells what a hand does: no hand is there."""

    def select(self, name: str) -> None: ...

    def drag(self, name: str, place: tuple[float, ...]) -> None: ...

    def click(self, name: str, ray: tuple[float, ...]) -> None: ...

    def home(self, position: Vector, look_at: Vector, radius: float, *, moved: bool = True) -> None: ...


class Taken:
    """The frames of some states; the first of their solutions stays. Raises GeometryError, and `TooLarge`."""

    def __init__(
        self, host: ViserHost, sim: Sim[Any, Any], states: Sequence[Params], given: tuple[Library, ...], *, dark: bool
    ) -> None:
        self.parts: list[Parts] = []
        """By frames."""
        self.solution: Any = None
        self.recording = Recording()
        recorder = Recorder(host.loop)
        viewer = Viewer(sim, host.alone(recorder), Nobody(), dark=dark, watching=True)
        for k, params in enumerate(states):
            goes_on(k / len(states))
            solution = sim.solve(params, *given)
            viewer.draw(params, solution, k)
            self.recording.add(recorder.taken())
            if self.recording.size > LARGEST:
                raise TooLarge
            self.parts.append(_parts(sim, params, solution))
            self.solution = solution if k == 0 else self.solution

    @property
    def recorded(self) -> list[str]:
        """Names of all parts that some frame has."""
        return list(dict.fromkeys(name for parts in self.parts for name in parts))

    def packed(self) -> bytes:
        """For static/home/film.js: the length of the JSON, the JSON, and the arrays, each at a multiple of 8."""
        texts: dict[str, int] = {}
        said = [[texts.setdefault(parts.get(name, ""), len(texts)) for name in self.recorded] for parts in self.parts]
        arrays = self.recording.arrays
        told = {
            **self.recording.json(), "parts": self.recorded, "texts": list(texts), "said": said,
            "lengths": [*map(len, arrays)],
        }  # fmt: skip
        head = json.dumps(told, allow_nan=False).encode()
        pieces = [len(head).to_bytes(8, "little"), *map(_filled, [head, *arrays])]
        return gzip.compress(b"".join(pieces), 6)

    def marker(self) -> bytes:
        """A recording of viser's own, in which nothing is but the node that says which frame is shown: none yet."""
        told = [self.recording.told(VERSION), {**self.recording.told(VERSION, MOVED), "position": (-1.0, 0.0, 0.0)}]
        packed = msgspec.msgpack.encode(
            {
                "durationSeconds": 0.0,
                "messages": [(0.0, message) for message in told],
                "viserVersion": viser.__version__,
            }
        )
        inner = len(packed).to_bytes(8, "little") + packed
        return len(inner).to_bytes(8, "little") + zstandard.ZstdCompressor().compress(inner)


MOVED = "SetPositionMessage"


def _filled(data: bytes) -> bytes:
    return data + bytes(-len(data) % 8)


def _parts(sim: Sim[Any, Any], params: Params, solution: Any) -> Parts:
    panes = sim.panes(params, solution) if sim.panes is not None else ()
    read = readout.folded(sim.readouts(params, solution))
    return {
        "caption": escape(sim.caption(params, solution)),
        "about": escape(sim.describe(params, solution)),
        **{f"read:{title}": _idle(readout.still(those)) for title, those in read.items()},
        **{f"pane:{each.name}": _picture(each) for each in panes},
    }  # fmt: skip


def _picture(each: pane.Pane) -> str:
    title = f"<b>{pane.safe(each.title)}<span> {escape(each.note)}</span></b>"
    return f"<figcaption>{title}</figcaption>{pane.still(each)}"


def _idle(html: str) -> str:
    """Read-outs without the buttons in them."""
    return re.sub(r"<button[^>]*>(.*?)</button>", r"\1", re.sub(r'<button[^>]*class="s3-copy".*?</button>', "", html))
