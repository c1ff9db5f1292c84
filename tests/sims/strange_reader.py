"""Functions that a child process runs for the tests: each reads a file in another wrong way."""

from __future__ import annotations

import os
import re
import sys
import time
from os import _exit
from typing import Any

import numpy as np


class Panic(BaseException):
    """What Rust's libraries raise: not an Exception."""


def reads(name: str, data: bytes, *, times: int = 1) -> dict[str, Any]:
    """What works: all kinds of values."""
    sys.stdout.write("said in between\n" * 10_000)
    sys.stdout.flush()
    os.write(1, b"by native code\n" * 10_000)
    os.write(2, b"by native code\n" * 10_000)
    return {
        "name": name, "size": len(data) * times, "nothing": None, "nested": {"units": ["m"]},
        "pid": os.getpid(), "nan": float("nan"),
        "points": np.arange(12.0).reshape(4, 3)[:, ::-1], "big endian": np.array([1, 2], ">u2"),
        "flags": np.array([True, False]), "empty": np.empty((0, 3), np.float32), "scalar": np.array(3),
    }  # fmt: skip


def refuses(name: str, data: bytes) -> dict[str, Any]:
    raise ValueError(f"“{name}” has no points.")


def panics(name: str, data: bytes) -> dict[str, Any]:
    raise Panic(data.decode())


def errs(name: str, data: bytes) -> dict[str, Any]:
    raise KeyError(data.decode())


def recurses(name: str, data: bytes) -> dict[str, Any]:
    return recurses(name, data)


def aborts(name: str, data: bytes) -> dict[str, Any]:
    os.abort()


def leaves(name: str, data: bytes) -> dict[str, Any]:
    _exit(0)


def waits(name: str, data: bytes) -> dict[str, Any]:
    time.sleep(1_000)
    return {}


def hoards(name: str, data: bytes) -> dict[str, Any]:
    return {"zeros": np.ones(int(data))[:1]}


def repeats(name: str, data: bytes) -> dict[str, Any]:
    """A large answer of little memory: one number many times, which becomes an array only when it is sent."""
    return {"zeros": np.zeros(int(data), np.uint8)}


def objects(name: str, data: bytes) -> dict[str, Any]:
    return {"objects": np.array([{}, None])}


def wide(name: str, data: bytes) -> dict[str, Any]:
    return {"complex": np.array([1j])}


def chats(name: str, data: bytes) -> dict[str, Any]:
    return {"words": "x" * 2_000_000}


def forges(name: str, data: bytes) -> dict[str, Any]:
    """Writes to every pipe it has, as code that has gone wild might."""
    for number in range(3, 20):
        try:
            os.write(number, data)
        except OSError:
            continue
    return {}


def sizes(text: str) -> Any:
    """All the numbers of a text."""
    found = re.findall(r"\d+", text)
    if not found:
        raise ValueError("There is no number in it.")
    return {"sizes": tuple(map(int, found))}


def forever(text: str) -> Any:
    while True:
        text += text
