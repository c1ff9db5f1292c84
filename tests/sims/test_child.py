"""The child process: whatever a file does to it, its bringer reads words, and the next file is read."""

from __future__ import annotations

import logging
import os
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sims.kit import child
from sims.kit.child import ChildFailed, ChildRefusal, Limits
from sims.kit.progress import Superseded, Work, at_work
from tests.server import ROOT, wait_for

READER = "tests.sims.strange_reader"
NAME = "a “strange”\nfile.bin"


@pytest.fixture(scope="module", autouse=True)
def _children_are_its_own() -> Iterator[None]:
    """Those of these tests know nothing of the sims, whose readers would be loaded in the time of a file."""
    child.stop()
    yield
    child.stop()


def read(function: str, data: bytes | Path = b"secret", limits: Limits | None = None, **arguments: Any) -> child.Values:
    return child.read(f"{READER}:{function}", NAME, data, limits=limits, **arguments)


def alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return Path(f"/proc/{pid}/stat").read_text().rsplit(")")[1].split()[0] != "Z"


def test_what_was_read_comes_back_plain_whatever_is_printed(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"12345")
    for data in (b"12345", tmp_path / "file"):
        found = read("reads", data, times=2)
        assert (found["name"], found["size"], found["nothing"], found["nested"]) == (NAME, 10, None, {"units": ["m"]})
        assert np.isnan(found["nan"])
        np.testing.assert_array_equal(found["points"], np.arange(12.0).reshape(4, 3)[:, ::-1])
        np.testing.assert_array_equal(found["big endian"], [1, 2])
        assert found["big endian"].dtype == np.uint16
        assert found["flags"].dtype == np.bool_
        assert found["empty"].shape == (0, 3)
        assert found["scalar"] == 3
        found["points"][0] = 1.0  # it is the caller's own


def test_a_child_is_used_again_also_after_a_refusal() -> None:
    first = read("reads")["pid"]
    assert first != os.getpid()
    with pytest.raises(ChildRefusal, match=r"“a “strange”\nfile.bin” has no points\."):
        read("refuses")
    assert read("reads")["pid"] == first


@pytest.mark.parametrize(
    ("function", "data", "limits", "reason", "goes_on"),
    [
        ("aborts", b"secret", Limits(), "crash", False),
        ("leaves", b"secret", Limits(), "crash", False),
        ("panics", b"secret", Limits(), "crash", True),
        ("errs", b"secret", Limits(), "crash", True),
        ("recurses", b"secret", Limits(), "crash", True),
        ("no_such_function", b"secret", Limits(), "crash", True),
        ("objects", b"secret", Limits(), "crash", True),
        ("wide", b"secret", Limits(), "crash", False),
        ("forges", b"secret" * 9, Limits(), "crash", False),
        ("waits", b"secret", Limits(seconds=0.2), "time", False),
        ("repeats", b"1000001", Limits(output=1_000_000), "output", False),
        ("chats", b"secret", Limits(), "crash", False),
        pytest.param(
            "hoards", b"40000000", Limits(memory=100_000_000), "memory", False,
            marks=pytest.mark.skipif(sys.platform != "linux", reason="memory isn't limited there"),
        ),
    ],
)  # fmt: skip
def test_however_it_fails_there_are_words_a_count_and_a_line_and_the_next_file_is_read(
    function: str, data: bytes, limits: Limits, reason: str, goes_on: bool, caplog: pytest.LogCaptureFixture
) -> None:
    before, counted = read("reads")["pid"], child.failures[reason]
    with caplog.at_level(logging.INFO), pytest.raises(ChildFailed) as failed:
        read(function, data, limits)
    assert failed.value.reason == reason
    words = str(failed.value)
    assert words.startswith("It can't be read")
    assert words.endswith(".")
    assert child.failures[reason] == counted + 1
    (line,) = caplog.records
    assert reason in line.getMessage()
    assert repr(NAME) in line.getMessage()
    assert "secret" not in line.getMessage(), "what is in a file stays out of the log"
    assert (read("reads")["pid"] == before) is goes_on


@pytest.mark.skipif(sys.platform != "linux", reason="memory isn't limited there")
def test_the_limit_of_memory_is_each_files_own() -> None:
    """It isn't what files before have left, and it is lifted for the next."""
    for _ in range(3):
        assert read("hoards", b"20000000", Limits(memory=200_000_000))["zeros"].shape == (1,)
    assert read("hoards", b"40000000", Limits(memory=400_000_000))["zeros"].shape == (1,)


def test_a_file_that_isnt_there_is_an_error_of_the_server(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read("reads", tmp_path / "gone")


def test_a_slow_file_holds_up_nobody_else() -> None:
    slow = child.begin(f"{READER}:waits", "slow", b"", limits=Limits(seconds=60.0))
    with ThreadPoolExecutor(8) as many:
        pids = {found["pid"] for found in many.map(lambda _: read("reads"), range(20))}
    assert len(pids) == 1, "the other child reads them all"
    assert not slow.done()
    child.stop()
    with pytest.raises(ChildFailed, match="about to end"):
        child.result(slow)


def test_who_no_longer_waits_is_let_go_while_others_go_on_waiting() -> None:
    slow: Future[child.Values] = child.begin(f"{READER}:waits", "slow", b"", limits=Limits(seconds=60.0))
    token = at_work.set(Work(lambda: False))
    try:
        with pytest.raises(Superseded):
            child.result(slow)
    finally:
        at_work.reset(token)
    assert not slow.done()
    child.stop()
    with pytest.raises(ChildFailed):
        child.result(slow)


def test_stopping_ends_the_children_and_the_next_file_starts_one() -> None:
    before = read("reads")["pid"]
    waiting = [child.begin(f"{READER}:waits", "slow", b"", limits=Limits(seconds=60.0)) for _ in range(5)]
    child.stop()
    for future in waiting:
        with pytest.raises(ChildFailed) as failed:
            child.result(future)
        assert failed.value.reason == "end"
    assert not alive(before)
    assert read("reads")["pid"] != before


def test_a_child_that_died_meanwhile_is_replaced() -> None:
    before = read("reads")["pid"]
    os.kill(before, 9)
    wait_for(lambda: not alive(before), "the child to die")
    assert read("reads")["pid"] != before


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_a_killed_server_leaves_no_child_behind() -> None:
    code = (
        "import sys, time; from sims.kit import child\n"
        f"print(child.read('{READER}:reads', 'a', b'')['pid'], flush=True); time.sleep(1000)"
    )
    with subprocess.Popen([sys.executable, "-c", code], cwd=ROOT, stdout=subprocess.PIPE) as server:
        assert server.stdout is not None
        pid = int(server.stdout.readline())
        assert alive(pid)
        server.kill()
    wait_for(lambda: not alive(pid), "the child to end")


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_a_child_gives_way_leaves_no_core_and_knows_nothing_of_the_server(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SIM3_SECRET", "secret")
    child.stop()
    with (ROOT / "pyproject.toml").open() as opened:
        os.set_inheritable(opened.fileno(), True)
        pid = read("reads")["pid"]
        files = {os.readlink(entry) for entry in Path(f"/proc/{pid}/fd").iterdir()}
    assert os.getpriority(os.PRIO_PROCESS, pid) >= min(os.getpriority(os.PRIO_PROCESS, os.getpid()) + 10, 19)
    assert "Max core file size        0" in Path(f"/proc/{pid}/limits").read_text()
    assert b"SIM3_SECRET" not in Path(f"/proc/{pid}/environ").read_bytes()
    assert not any("pyproject" in file for file in files)
    assert len(list(Path(f"/proc/{pid}/task").iterdir())) == 1, "no threads of libraries"


def test_a_child_that_cant_start_is_said_and_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    child.stop()
    before = child.failures["start"]
    with monkeypatch.context() as without:
        without.setattr(sys, "executable", "/no/such/python")
        with pytest.raises(ChildFailed, match="could not start"):
            read("reads")
        without.setattr(sys, "executable", "/bin/false")
        with pytest.raises(ChildFailed, match="could not start"):
            read("reads")
    assert child.failures["start"] == before + 2
    assert read("reads")["size"] == 6
