"""What is taken home is what a viewer would be sent, frame by frame."""

from __future__ import annotations

import gzip
import json
from typing import Any

import numpy as np
import pytest

from sims import SIMS
from sims.kit import taken
from sims.kit.sim import Sim
from sims.kit.sweep import sweepable
from sims.kit.taken import Taken, TooLarge
from tests.frames import SceneModel
from tests.server import Rig, shared_host

AnySim = Sim[Any, Any]
LIGHT = [sim for sim in SIMS if not sim.heavy]


class Film:
    """A packed recording, read as static/home/film.js reads it."""

    def __init__(self, packed: bytes) -> None:
        data = gzip.decompress(packed)
        length = int.from_bytes(data[:8], "little")
        self.told = json.loads(data[8 : 8 + length])
        at, self._arrays = 8 + length + -length % 8, []
        for size in self.told["lengths"]:
            self._arrays.append(data[at : at + size])
            at += size + -size % 8

    def model(self, frame: int) -> SceneModel:
        """A scene that shows one frame."""
        table: dict[int, int] = {}
        for changes in self.told["frames"][: frame + 1]:
            table |= zip(changes[::2], changes[1::2], strict=True)
        model = SceneModel()
        for key in range(len(self.told["keys"])):
            if table.get(key, -1) >= 0:
                model.apply(self._whole(self.told["values"][table[key]]))
        return model

    def words(self, frame: int) -> dict[str, str]:
        return {
            name: self.told["texts"][k] for name, k in zip(self.told["parts"], self.told["said"][frame], strict=True)
        }

    def _whole(self, value: Any) -> Any:
        if isinstance(value, list):
            return [self._whole(each) for each in value]
        if not isinstance(value, dict):
            return value
        if "array@" in value:
            return np.frombuffer(self._arrays[value["array@"]], value["dtype"])
        return {name: self._whole(each) for name, each in value.items()}


def seen(model: SceneModel) -> dict[str, Any]:
    """What is seen of a scene; nothing of a recording can be held."""
    return {name: {**node, "drags": (), "clicks": ()} for name, node in model.snapshot().items()}


@pytest.mark.parametrize("sim", LIGHT, ids=lambda sim: sim.slug)
def test_each_frame_is_what_a_viewer_of_its_state_sees(sim: AnySim) -> None:
    first = sim.params.from_query(())
    swept = next(sweepable(first))
    states = [swept.state(first, value) for value in swept.values(swept.low, swept.high, 4)]
    found = Taken(shared_host().viser, sim, states, (), dark=False)
    film = Film(found.packed())
    with Rig(sim, states[0]) as rig:
        for frame in (0, len(states) - 1):
            rig.show(states[frame])
            there, wanted = seen(film.model(frame)), seen(rig.model)
            assert there.keys() == wanted.keys()
            for name, node in wanted.items():
                np.testing.assert_equal(there[name], node, err_msg=f"{name} in frame {frame}")
    solution = sim.solve(states[-1])
    assert film.words(len(states) - 1)["about"].replace("&#x27;", "'") == sim.describe(states[-1], solution)
    assert film.words(0) != film.words(len(states) - 1)


def test_what_would_be_too_large_ends_early(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(taken, "LARGEST", 1000)
    sim = LIGHT[0]
    with pytest.raises(TooLarge):
        Taken(shared_host().viser, sim, [sim.params()], (), dark=False)
