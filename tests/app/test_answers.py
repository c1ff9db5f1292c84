"""Long answers: each address in its turn, within bounds, and no longer than somebody waits."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

import httpx
import pytest

from app.routes import answers
from app.routes.answers import Answers, Busy, Gone
from sims.kit.progress import Superseded, goes_on
from tests.app.conftest import Local
from tests.server import PATIENCE, wait_for

BIG = {"dataset": "two-scans", "process": "register"}


class Gate:
    """Work that goes on until it is let go; what began and what was given up is remembered."""

    def __init__(self) -> None:
        self.open = threading.Event()
        self.began: list[str] = []
        self.given_up: list[str] = []

    def work(self, name: str) -> Callable[[], str]:
        def find() -> str:
            self.began.append(name)
            try:
                while not self.open.wait(0.005):
                    goes_on()
            except Superseded:
                self.given_up.append(name)
                raise
            return name

        return find


async def never() -> None:
    await asyncio.Event().wait()


def run(test: Callable[[Answers, Gate], Coroutine[Any, Any, None]]) -> None:
    made, gate = Answers(), Gate()
    try:
        asyncio.run(asyncio.wait_for(test(made, gate), PATIENCE))
    finally:
        gate.open.set()
        made.close()


async def begun(gate: Gate, count: int) -> None:
    while len(gate.began) < count:
        await asyncio.sleep(0.002)


def ask(made: Answers, gate: Gate, address: str, name: str) -> asyncio.Task[str]:
    return asyncio.create_task(made.find(address, gate.work(name), never()))


def test_addresses_take_turns() -> None:
    async def test(made: Answers, gate: Gate) -> None:
        many = [ask(made, gate, "school", f"school {k}") for k in range(4)]
        await begun(gate, 1)
        few = [ask(made, gate, "home", "home 0"), ask(made, gate, "home", "home 1"), ask(made, gate, "cafe", "cafe 0")]
        await asyncio.sleep(0)
        gate.open.set()
        assert await asyncio.gather(*many, *few) == [*(f"school {k}" for k in range(4)), "home 0", "home 1", "cafe 0"]
        assert gate.began == ["school 0", "school 1", "home 0", "cafe 0", "school 2", "home 1", "school 3"]

    run(test)


def test_what_one_address_and_what_all_may_ask_for_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(answers, "EACH", 3)
    monkeypatch.setattr(answers, "ALL", 5)

    async def refused(made: Answers, gate: Gate, address: str) -> int:
        with pytest.raises(Busy) as caught:
            await made.find(address, gate.work("too much"), never())
        assert "answers" in str(caught.value)
        return caught.value.status

    async def test(made: Answers, gate: Gate) -> None:
        asked = [ask(made, gate, "a", "a") for _ in range(3)]
        await begun(gate, 1)
        assert await refused(made, gate, "a") == 429
        asked += [ask(made, gate, "b", "b") for _ in range(2)]
        await asyncio.sleep(0)
        assert await refused(made, gate, "c") == 503
        gate.open.set()
        await asyncio.gather(*asked)
        assert "too much" not in gate.began
        assert await made.find("a", gate.work("again"), never()) == "again"

    run(test)


@pytest.mark.parametrize("waiting", [False, True], ids=["at work", "in the queue"])
def test_nothing_is_worked_out_for_who_has_gone(waiting: bool) -> None:
    async def test(made: Answers, gate: Gate) -> None:
        leaves = asyncio.Event()

        async def gone() -> None:
            await leaves.wait()

        before = [ask(made, gate, "a", "before")] if waiting else []
        await begun(gate, len(before))
        asked = asyncio.create_task(made.find("a", gate.work("mine"), gone()))
        after = ask(made, gate, "a", "after")
        await begun(gate, 1)
        leaves.set()
        with pytest.raises(Gone):
            await asked
        if not waiting:
            await begun(gate, 2)
            assert gate.given_up == ["mine"]
        gate.open.set()
        assert await after == "after"
        await asyncio.gather(*before)
        assert ("mine" in gate.began) is not waiting

    run(test)


def test_an_answer_that_takes_too_long_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(answers, "LONGEST", 0.05)

    async def test(made: Answers, gate: Gate) -> None:
        with pytest.raises(Busy) as caught:
            await made.find("a", gate.work("endless"), never())
        assert caught.value.status == 503
        assert "longer" in str(caught.value)
        while not gate.given_up:
            await asyncio.sleep(0.002)
        gate.open.set()
        assert await made.find("a", gate.work("next"), never()) == "next"

    run(test)


def test_what_fails_does_not_hold_up_the_next() -> None:
    async def test(made: Answers, gate: Gate) -> None:
        with pytest.raises(ZeroDivisionError):
            await made.find("a", lambda: 1 / 0, never())
        gate.open.set()
        assert await made.find("a", gate.work("next"), never()) == "next"

    run(test)


# ---- over HTTP


@pytest.fixture
def busy(local: Local, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[], Any]]:
    """A point cloud that is worked out until the test is over."""
    gate = Gate()
    with held(local, gate, monkeypatch):
        yield lambda: gate


@contextmanager
def held(local: Local, gate: Gate, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    made: Answers = local.services.answers
    find = made.find
    monkeypatch.setattr(made, "find", lambda address, _, gone: find(address, gate.work(address), gone))
    yield
    gate.open.set()


def test_a_light_answer_waits_for_no_heavy_one(local: Local, busy: Callable[[], Gate]) -> None:
    with ThreadPoolExecutor(3) as pool, httpx.Client(base_url=local.url, trust_env=False, timeout=PATIENCE) as http:
        heavy = [pool.submit(http.post, "/api/sims/point-cloud/solve", json=BIG) for _ in range(3)]
        wait_for(lambda: busy().began, "the first one to begin")
        for sim in ("camera", "quaternion"):
            assert http.post(f"/api/sims/{sim}/solve").status_code == 200
        assert not any(one.done() for one in heavy)
        busy().open.set()
        assert {one.result().status_code for one in heavy} == {200}


def test_who_asks_for_too_much_is_told_when_to_try_again(
    local: Local, busy: Callable[[], Gate], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answers, "EACH", 1)
    with ThreadPoolExecutor(1) as pool, httpx.Client(base_url=local.url, trust_env=False, timeout=PATIENCE) as http:
        first = pool.submit(http.post, "/api/sims/point-cloud/solve")
        wait_for(lambda: busy().began, "the first one to begin")
        refused = http.post("/api/sims/point-cloud/solve", headers={"origin": "https://x.example"})
        assert refused.status_code == 429
        assert int(refused.headers["retry-after"]) > 0
        assert refused.headers["access-control-allow-origin"] == "*"
        assert "address" in refused.json()["detail"]
        busy().open.set()
        assert first.result().status_code == 200


def test_a_caller_that_hangs_up_frees_the_worker(local: Local, busy: Callable[[], Gate]) -> None:
    with pytest.raises(httpx.ReadTimeout):
        httpx.post(f"{local.url}/api/sims/point-cloud/solve", json=BIG, timeout=0.2, trust_env=False)
    wait_for(lambda: busy().given_up, "the work to be given up")
    busy().open.set()
    assert local.http.post("/api/sims/point-cloud/solve").status_code == 200
