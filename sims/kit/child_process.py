"""The child in which strangers' files are read: a program of its own, that `child` starts and speaks with.

This file is run by its path: it imports nothing of ours before the module that it is to read with, and what that needs.
The pipe carries, both ways, the length of a head, the head as JSON, and bytes behind it.
"""

from __future__ import annotations

import importlib
import json
import math
import os
import signal
import struct
import sys
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

GIVES_WAY = 10
"""Steps of niceness, as the server's own workers."""
_LENGTH = struct.Struct("<I")
_LONGEST_HEAD = 1_000_000


def send(pipe: IO[bytes], head: Mapping[str, Any], *pieces: bytes | memoryview) -> None:
    """Write a head, and what comes behind it."""
    text = json.dumps(head).encode()
    pipe.write(_LENGTH.pack(len(text)) + text)
    for piece in pieces:
        pipe.write(piece)
    pipe.flush()


def receive(pipe: IO[bytes]) -> Any:
    """A head. Raises EOFError where the pipe ends, ValueError or RecursionError where it isn't one."""
    (length,) = _LENGTH.unpack(exactly(pipe, _LENGTH.size))
    if length > _LONGEST_HEAD:
        raise ValueError("too long a head")
    return json.loads(exactly(pipe, length))


def exactly(pipe: IO[bytes], size: int) -> bytes:
    """So many bytes. Raises EOFError where the pipe ends."""
    data = pipe.read(size)
    if len(data) < size:
        raise EOFError
    return data


def bytes_of(array: npt.NDArray[Any]) -> memoryview:
    """What an array in one piece holds, to be read or written."""
    return array.reshape(-1).view(np.uint8).data


def serve(module: str) -> None:
    """Answer until the server ends; most of what is asked for stands in `module`.

    What anything prints goes nowhere: the pipe is this function's alone.
    """
    asked, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDWR)
    os.dup2(nothing, 0)
    os.dup2(2, 1)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # of a terminal: the server ends its children itself
    _give_way()
    with suppress(Exception):  # which is said when it is asked for
        importlib.import_module(module)  # now: it takes longer than many a file may
    send(answers, {"job": 0, "values": {}, "arrays": {}})
    os.dup2(nothing, 1)
    os.dup2(nothing, 2)
    with suppress(EOFError, BrokenPipeError):
        while True:
            asks = receive(asked)
            _answer(answers, asks, exactly(asked, asks["size"]))


def _give_way() -> None:
    """Let the server go first; and when the machine's memory ends, let it be the child that is killed."""
    if sys.platform != "win32":
        import resource

        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, 0, os.getpriority(os.PRIO_PROCESS, os.getppid()) + GIVES_WAY)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text("1000")


def _answer(answers: IO[bytes], asks: Mapping[str, Any], data: bytes) -> None:
    head: dict[str, Any] = {"job": asks["job"]}
    pieces: list[memoryview] = []
    try:
        module, _, name = asks["function"].partition(":")
        function = getattr(importlib.import_module(module), name)
        with _limited(asks["memory"], asks["seconds"]):
            try:
                values = function(asks["name"], data, **asks["arguments"])
            except ValueError as error:
                head["refusal"] = str(error)
            else:
                arrays = {key: _plain(value) for key, value in values.items() if isinstance(value, np.ndarray)}
                others = {key: value for key, value in values.items() if key not in arrays}
                json.dumps(others)
                head |= {"values": others, "arrays": {key: (a.dtype.str, a.shape) for key, a in arrays.items()}}
                pieces = [bytes_of(array) for array in arrays.values()]
    except BaseException as error:  # also what Rust calls a panic
        head |= {"failure": _where(error), "memory": isinstance(error, MemoryError)}
    send(answers, head, *pieces)


@contextmanager
def _limited(memory: int, seconds: float) -> Iterator[None]:
    """Within it this process takes no more memory than so many bytes above what it has, and ends when it is late.

    The server ends it a second before that, if the server still lives. Where a system has no such limits, its time is
    all that is bounded.
    """
    if sys.platform == "win32":
        yield
        return
    import resource

    _, most = resource.getrlimit(resource.RLIMIT_AS)
    with suppress(OSError, ValueError):  # of systems that don't say, or don't limit
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        allowed = pages * resource.getpagesize() + memory
        resource.setrlimit(
            resource.RLIMIT_AS, (allowed if most == resource.RLIM_INFINITY else min(allowed, most), most)
        )
    signal.alarm(math.ceil(seconds) + 1)
    try:
        yield
    finally:
        signal.alarm(0)
        with suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_AS, (most, most))


def _plain(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """In one piece, and in this machine's order of bytes."""
    return np.ascontiguousarray(array, array.dtype.newbyteorder("="))


def _where(error: BaseException) -> str:
    """What it was and where, for the log: without its words, which may be the file's."""
    frames = traceback.extract_tb(error.__traceback__)
    return f"{type(error).__name__} in {Path(frames[-1].filename).name}, line {frames[-1].lineno}"


if __name__ == "__main__":
    sys.path[:] = sys.argv[2:]
    serve(sys.argv[1])
