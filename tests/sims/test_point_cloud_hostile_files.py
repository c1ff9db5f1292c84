"""Files that were broken on purpose, of every format: each gives a cloud or words, and the next one is read."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from sims.kit.child import ChildFailed, ChildRefusal, Limits
from sims.point_cloud import library
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.library import Library
from tests.sims.test_point_cloud_files import FILES, LARGEST, POINTS

EACH, OF_LAZ = 155, 50
"""Broken files of each kind; fewer of the one whose library aborts over many, for a new child takes a second."""
Mutation = Callable[[random.Random, bytearray], None]


def flipped(rng: random.Random, data: bytearray) -> None:
    for _ in range(rng.choice((1, 1, 3, 20))):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)


def a_number_in_the_header(rng: random.Random, data: bytearray) -> None:
    """A whole number of some size, at a place near the start or the end: where headers and tables are."""
    size = rng.choice((1, 2, 4, 8))
    near = rng.randrange(min(len(data), 400))
    number = rng.choice((0, 1, 2 ** (8 * size) - 1, 2 ** (8 * size - 1), rng.randrange(2 ** (8 * size))))
    at = near if rng.random() < 0.8 else max(len(data) - 1 - near, 0)
    data[at : at + size] = number.to_bytes(size, "little")


def cut(rng: random.Random, data: bytearray) -> None:
    del data[rng.randrange(len(data)) :]


def a_piece_gone(rng: random.Random, data: bytearray) -> None:
    at = rng.randrange(len(data))
    del data[at : at + rng.randrange(1, 200)]


def a_piece_twice(rng: random.Random, data: bytearray) -> None:
    at = rng.randrange(len(data))
    piece = bytes(data[at : at + rng.randrange(1, 100)])
    data[at:at] = piece * rng.choice((1, 1, 50))


def other_words(rng: random.Random, data: bytearray) -> None:
    words = (
        b"nan",
        b"-1",
        b"1e999",
        b"99999999999999999999",
        b"\n",
        b"\0",
        b"\xff\xfe",
        b"list",
        b"x y z",
        b"#",
        b'"',
        b",",
    )
    for _ in range(rng.choice((1, 1, 5))):
        at = rng.randrange(len(data))
        data[at : at + rng.choice((0, 1, 4))] = rng.choice(words)


MUTATIONS: tuple[Mutation, ...] = (flipped, a_number_in_the_header, cut, a_piece_gone, a_piece_twice, other_words)


def broken_files() -> list[tuple[str, bytes]]:
    """Their names and bytes, always the same."""
    rng = random.Random(9)
    files = []
    for kind, (name, make, _, _) in FILES.items():
        good = make()
        for number in range(OF_LAZ if kind == "LAZ" else EACH):
            data = bytearray(good)
            for mutate in rng.sample(MUTATIONS, rng.choice((1, 1, 2))):
                if data:
                    mutate(rng, data)
            files.append((f"{number} {name}", bytes(data)))
    return files


def brought(name: str, data: bytes) -> Cloud:
    clouds = Library(largest=LARGEST)
    known_as, _ = clouds.add(name, data)
    return clouds.find(known_as)


def outcome(file: tuple[str, bytes]) -> str:
    name, data = file
    try:
        cloud = brought(name, data)
    except (ChildRefusal, ChildFailed) as error:
        words = str(error)
        assert words[:1].isupper(), (name, words)
        return error.reason if isinstance(error, ChildFailed) else "refused"
    count = len(cloud)
    assert count > 0
    assert cloud.points.shape == (count, 3)
    assert np.isfinite(cloud.points).all()
    for each in (cloud.colors, cloud.intensity):
        assert each is None or len(each) == count
    return "read"


def test_two_thousand_broken_files_give_clouds_or_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(library, "limits", lambda *_: Limits(memory=500_000_000, seconds=5.0))
    files = broken_files()
    assert len(files) >= 2_000
    with ThreadPoolExecutor(4) as bringers:
        outcomes = Counter(bringers.map(outcome, files))
    assert outcomes["read"] > 100, outcomes
    assert outcomes["refused"] > 500, outcomes
    assert not {"output", "start", "end"} & outcomes.keys(), outcomes
    for name, make, _, _ in FILES.values():
        cloud = brought(name, make())
        np.testing.assert_allclose(cloud.points, POINTS, rtol=0, atol=2e-6)
