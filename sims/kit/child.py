"""Strangers' files are read in a process of their own, with limits on memory, time and what it gives back.

A file comes from anybody, and the libraries that read it are native code: a wrong one of 500 bytes may abort the
process, hold Python's lock for seconds, or ask for more memory than there is. So a child does it, which is started
once and reused. What it gives back is checked and plain: arrays of numbers, and what JSON holds. Whatever way it
dies costs the one file, and the next one is read by the next child.

read("package.module:function", name, data, limits=Limits(…), …)    # function(name, data, …) -> values by name

What runs in the child stands in `child_process`.
"""

from __future__ import annotations

import io
import itertools
import logging
import math
import os
import signal
import subprocess
import sys
import threading
from collections import Counter
from collections.abc import Callable, Mapping
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor, wait
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from sims.kit import child_process
from sims.kit.child_process import bytes_of, receive, send
from sims.kit.progress import goes_on

log = logging.getLogger("sim3")
AT_ONCE = 2
"""Children: while one is busy with a slow file, for up to its whole time limit, the other one reads the others'."""
ALONE = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS")
"""Environment variables that keep libraries from starting threads of their own, which would take memory and cores."""
KEPT = ("PATH", "LD_LIBRARY_PATH", "SYSTEMROOT", "TMPDIR", "TEMP", "TMP")
"""What else the child knows of the server's environment."""
STARTS = 60.0
"""Seconds that a child may take to start, on a busy machine."""
WAITS = 0.1
"""Seconds between two looks whether somebody still waits for a file."""
_LONGEST_WORDS = 1_000
_MOST_AXES = 4
_KINDS = {np.dtype(kind).str for kind in "?bBhHiIqQefd"}

Values = dict[str, Any]
"""By name, arrays of truth values, integers or floats, and what JSON holds."""


@dataclass(frozen=True)
class Limits:
    """What reading a file may take: bytes of memory beyond those of the file, seconds, and bytes of the answer."""

    memory: int = 1_000_000_000
    seconds: float = 20.0
    output: int = 200_000_000


class ChildRefusal(ValueError):
    """What the function said of the file: the words of the ValueError that it raised."""


class ChildFailed(ValueError):
    """The file couldn't be read for another reason, in words for whoever uploaded it."""

    def __init__(self, reason: str, words: str) -> None:
        super().__init__(words)
        self.reason = reason


failures: Counter[str] = Counter()
"""How many files failed, by reason: a key of `WORDS`."""
WORDS = {
    "crash": "It can't be read: the program that reads files broke off over it. It is probably damaged.",
    "memory": "It can't be read within {memory:,.0f} MB of memory: it is too large, or damaged.",
    "time": "It can't be read within {seconds:,.0f} s: it is too large, or damaged.",
    "output": "It can't be read: what is in it takes more than {output:,.0f} MB.",
    "start": "It can't be read just now: the server could not start the program that reads files. Try again later.",
    "end": "It can't be read any more: the server is about to end.",
}


@dataclass(frozen=True)
class Job:
    """What is asked of a child. `data` are the bytes of the file, or where they are."""

    function: str
    name: str
    data: bytes | Path
    limits: Limits
    arguments: Mapping[str, Any]


def read(
    function: str, name: str, data: bytes | Path, *, limits: Limits | None = None, **arguments: Any
) -> Values:  # fmt: skip
    """Return what "package.module:function" makes of a file's name, its bytes and some plain arguments, in a child.

    Raises ChildRefusal where the function raises ValueError, ChildFailed where it or the child fails otherwise, and
    `Superseded` when the session that asks no longer waits. OSError where a path can't be read.
    """
    return result(begin(function, name, data, limits=limits, **arguments))


def begin(
    function: str, name: str, data: bytes | Path, *, limits: Limits | None = None, **arguments: Any
) -> Future[Values]:  # fmt: skip
    """Begin with what `read` does, for several to wait for; see `result`."""
    return _children.submit(Job(function, name, data, limits or Limits(), arguments))


def result(future: Future[Values]) -> Values:
    """Wait for what was begun, as long as the session that asks wants it. Raises what `read` does."""
    while not future.done():
        goes_on()
        wait([future], WAITS)
    try:
        return future.result()
    except CancelledError:
        raise _failed("end", Limits()) from None


def stop() -> None:
    """End all children, and what they do. The next file starts one again."""
    _children.stop()


def _failed(reason: str, limits: Limits) -> ChildFailed:
    in_words = {"memory": limits.memory / 1e6, "seconds": limits.seconds, "output": limits.output / 1e6}
    return ChildFailed(reason, WORDS[reason].format(**in_words))


class _Trouble(Exception):
    """A file wasn't read: why, in a word for the count and some for the log. A `sound` child can read the next."""

    def __init__(self, reason: str, detail: str, *, sound: bool = False) -> None:
        super().__init__(detail)
        self.reason = reason
        self.sound = sound


class _Child:
    """One process, and the pipes to it. Starts when made, with what `module` needs; raises _Trouble if it doesn't."""

    def __init__(self, module: str) -> None:
        self._late = False
        self._jobs = itertools.count(1)
        path = [entry or os.getcwd() for entry in sys.path]
        environment = {name: os.environ[name] for name in KEPT if name in os.environ} | dict.fromkeys(ALONE, "1")
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-IB", child_process.__file__, module, *path],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment,
                creationflags=getattr(subprocess, "BELOW_NORMAL_PRIORITY_CLASS", 0),
            )  # fmt: skip
        except OSError as error:
            raise _Trouble("start", str(error)) from None
        assert isinstance(self._process.stdin, io.BufferedWriter)
        assert isinstance(self._process.stdout, io.BufferedReader)
        self._to, self._from = self._process.stdin, self._process.stdout
        try:
            self._within(STARTS, lambda: self._answer(0, Limits()))
        except _Trouble as trouble:
            self.forget()
            raise _Trouble("start", str(trouble)) from None

    @property
    def lives(self) -> bool:
        return self._process.poll() is None

    def end(self) -> None:
        """Kill it: its pipes end, and with them what waits for them."""
        self._process.kill()

    def forget(self) -> None:
        """End it, and close the pipes."""
        self.end()
        self._process.wait()
        for pipe in (self._to, self._from):
            with suppress(OSError):  # what was still to be written
                pipe.close()

    def run(self, job: Job, data: bytes) -> Values:
        """What the child answers. Raises ChildRefusal or _Trouble."""
        number = next(self._jobs)
        head = {
            "job": number, "function": job.function, "name": job.name, "size": len(data),
            "arguments": dict(job.arguments), "memory": job.limits.memory, "seconds": job.limits.seconds,
        }  # fmt: skip

        def conversation() -> Values:
            send(self._to, head, data)
            return self._answer(number, job.limits)

        return self._within(job.limits.seconds, conversation)

    def _within(self, seconds: float, conversation: Callable[[], Values]) -> Values:
        timer = threading.Timer(seconds, self._too_late)
        timer.daemon = True
        timer.start()
        try:
            return conversation()
        except (OSError, EOFError):
            raise self._death() from None
        finally:
            timer.cancel()

    def _too_late(self) -> None:
        self._late = True
        self.end()

    def _death(self) -> _Trouble:
        self.end()
        code = self._process.wait()
        alarm = sys.platform != "win32" and code == -signal.SIGALRM
        return _Trouble("time", "too slow") if self._late or alarm else _Trouble("crash", f"it ended with {code}")

    def _answer(self, number: int, limits: Limits) -> Values:
        try:
            head = receive(self._from)
            if head["job"] != number:
                raise ValueError("another job's answer")
            if "refusal" in head:
                raise ChildRefusal(str(head["refusal"])[:_LONGEST_WORDS])
            if "failure" in head:
                memory = head["memory"] is True
                raise _Trouble("memory" if memory else "crash", str(head["failure"])[:200], sound=not memory)
            values: Values = dict(head["values"])
            arrays = {str(name): _described(*described) for name, described in head["arrays"].items()}
        except ChildRefusal:
            raise
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
            raise _Trouble("crash", f"no answer of a child: {type(error).__name__}") from None
        if sum(dtype.itemsize * math.prod(shape) for dtype, shape in arrays.values()) > limits.output:
            raise _Trouble("output", "too large an answer")
        return values | {name: _array(self._from, *described) for name, described in arrays.items()}


class _Children:
    """As many children as there is work for, but few; each job takes an idle one, or starts one."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._pool: ThreadPoolExecutor | None = None
        self._all: set[_Child] = set()
        self._idle: list[_Child] = []

    def submit(self, job: Job) -> Future[Values]:
        with self._lock:
            if self._pool is None:
                self._pool = ThreadPoolExecutor(AT_ONCE, thread_name_prefix="child")
            return self._pool.submit(self._run, job, self._pool)

    def stop(self) -> None:
        with self._lock:
            pool, self._pool = self._pool, None
            if pool is not None:
                pool.shutdown(wait=False, cancel_futures=True)
            for child in self._all.difference(self._idle):
                child.end()  # and the thread that waits for it forgets it
            idle, self._idle = self._idle, []
        for child in idle:
            self._forget(child)

    def _run(self, job: Job, pool: ThreadPoolExecutor) -> Values:
        data = job.data.read_bytes() if isinstance(job.data, Path) else job.data
        child = None
        sound = False
        try:
            child = self._one(job.function.partition(":")[0])
            if self._pool is not pool:  # ended while the child started
                raise _Trouble("end", "")
            values = child.run(job, data)
            sound = True
        except ChildRefusal:
            sound = True
            raise
        except _Trouble as trouble:
            sound = trouble.sound
            if self._pool is not pool:
                raise _failed("end", job.limits) from None
            failures[trouble.reason] += 1
            log.warning("a child could not read the file %.80r (%s): %s", job.name, trouble.reason, trouble)
            raise _failed(trouble.reason, job.limits) from None
        finally:
            if child is not None:
                self._back(child, pool, sound)
        return values

    def _one(self, module: str) -> _Child:
        """An idle child that lives, or a new one. Raises _Trouble."""
        while True:
            with self._lock:
                if not self._idle:
                    break
                child = self._idle.pop()
            if child.lives:
                return child
            self._forget(child)
        child = _Child(module)
        with self._lock:
            self._all.add(child)
        return child

    def _back(self, child: _Child, pool: ThreadPoolExecutor, sound: bool) -> None:
        with self._lock:
            if sound and self._pool is pool:
                self._idle.append(child)
                return
        self._forget(child)

    def _forget(self, child: _Child) -> None:
        with self._lock:
            self._all.discard(child)
        child.forget()


_children = _Children()


def _described(kind: str, shape: list[int]) -> tuple[np.dtype[Any], tuple[int, ...]]:
    """Type and shape of an array that is announced. Raises ValueError or TypeError for what no child may send."""
    if kind not in _KINDS or len(shape) > _MOST_AXES or not all(type(n) is int and 0 <= n < 2**40 for n in shape):
        raise ValueError("not an array")
    return np.dtype(kind), tuple(shape)


def _array(pipe: io.BufferedReader, dtype: np.dtype[Any], shape: tuple[int, ...]) -> npt.NDArray[Any]:
    array = np.empty(shape, dtype)
    if pipe.readinto(bytes_of(array)) < array.nbytes:
        raise EOFError
    return array
