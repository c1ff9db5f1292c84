"""A restart behind HAProxy: nobody loses a state, a room is in one process, and so is a class, which comes back."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from typing import Any, TypeVar, cast

import httpx
import pytest
from websockets.exceptions import ConnectionClosed, InvalidHandshake

from tests.app.page import SLUG, closed
from tests.app.test_classes import Learner, Socket, Teacher
from tests.dragger import Dragger
from tests.proxies import find
from tests.replicas import Replicas
from tests.server import PATIENCE, wait_for

Seat = TypeVar("Seat", bound=Socket)
LEARNERS = 6


@pytest.fixture(scope="module")
def replicas(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Replicas]:
    if not find("haproxy"):
        pytest.skip("HAProxy is not installed")
    with Replicas(tmp_path_factory.mktemp("balancer"), 2, SIM3_MAX_SESSIONS_PER_ADDRESS=f"{LEARNERS}") as replicas:
        yield replicas


async def _drag_through(replicas: Replicas, learners: list[Dragger]) -> None:
    """Restart a server while all drag, until the last value of each is shown."""
    staying = [asyncio.create_task(each.stay()) for each in learners]
    dragging = [asyncio.create_task(each.drag(1.0)) for each in learners]
    try:
        await asyncio.gather(*dragging)
        dragging = [asyncio.create_task(each.drag(3.0)) for each in learners]
        rooms = replicas.rooms()
        busiest = replicas.servers[rooms.index(max(rooms))]
        await asyncio.to_thread(busiest.restart, hard=False)
        await asyncio.gather(*dragging)
    finally:
        for task in staying:
            task.cancel()
        await asyncio.gather(*staying, return_exceptions=True)


def test_a_restart_behind_a_balancer_costs_nobody_a_state(replicas: Replicas) -> None:
    learners = [Dragger(replicas.url) for _ in range(LEARNERS)]
    asyncio.run(_drag_through(replicas, learners))
    assert all(each.shown == each.value for each in learners)
    assert sum(each.connections for each in learners) > LEARNERS, "somebody had to come back"
    assert sum(replicas.rooms()) == LEARNERS, "a room is in one process"


def classes(replicas: Replicas) -> list[int]:
    """How many classes each server has."""
    answers = [httpx.get(f"{s.origin}/metrics", trust_env=False, timeout=PATIENCE).text for s in replicas.servers]
    return [int(float(text.split("\nsim3_classes ")[1].split()[0])) for text in answers]


def test_a_class_behind_a_balancer_outlives_the_restart_of_its_process(replicas: Replicas) -> None:
    http = httpx.Client(base_url=replicas.url, trust_env=False, timeout=PATIENCE)
    opened = http.post("/class", data={"page": f"sims/{SLUG}", "state": "yaw=45"})
    assert opened.headers["location"].startswith("/class/")
    assert [http.get(opened.headers["location"]).status_code for _ in range(4)] == [200] * 4
    http.close()

    with ExitStack() as stack:

        def sit(kind: Callable[..., Seat], *args: Any, **more: Any) -> Seat:
            """Come in as a page does, which tries again until it is let in."""
            found: list[Any] = []

            def come() -> bool:
                with suppress(ConnectionClosed, InvalidHandshake, OSError):
                    found.append(stack.enter_context(kind(replicas, *args, **more)))
                return bool(found)

            wait_for(come, "a place in the class")
            return cast("Seat", found[0])

        def work(teacher: Teacher, learners: list[Learner]) -> list[str]:
            """The animals of all, once the teacher sees how far each is."""
            for k, each in enumerate(learners):
                each.at(yaw=k)
                each.tell({"type": "guess", "box": 0, "value": k % 2})
            grid = teacher.hear("grid", lambda grid: sum(row["here"] for row in grid["learners"]) == LEARNERS
                                and len(grid["guesses"].get("0", ())) == LEARNERS)  # fmt: skip
            return [row["animal"] for row in grid["learners"]]

        teacher = sit(Teacher, query="yaw=45")
        learners = [sit(Learner, teacher.code) for _ in range(LEARNERS)]
        teacher.tell({"type": "show", "params": {"yaw": 70}})
        teacher.tell({"type": "look", "eyes": True})
        animals = work(teacher, learners)
        assert sorted(classes(replicas)) == [0, 1], "all met in one process"

        replicas.servers[classes(replicas).index(1)].restart(hard=False)
        for each in (teacher, *learners):
            closed(each.socket)
        with pytest.raises(ConnectionClosed):
            Learner(replicas, teacher.code)
        known = {"ends": teacher.welcome["ends"], "eyes": True, "params": {"yaw": 70}}
        teacher = sit(Teacher, key=teacher.key, query="yaw=45", **known)
        learners = [sit(Learner, teacher.code, me=each.me, animal=each.animal) for each in learners]
        assert teacher.welcome["ends"] == known["ends"]
        assert all(each.welcome["eyes"] and each.welcome["params"]["yaw"] == 70 for each in learners)
        assert work(teacher, learners) == animals
        assert sorted(classes(replicas)) == [0, 1]


def test_each_address_has_its_places_behind_the_balancer_too(replicas: Replicas) -> None:
    """Also where a proxy that is trusted stands before the balancer."""

    def ask(address: str) -> int:
        page = f"{replicas.url}/sims/euler-angles/embed"
        return httpx.get(page, headers={"x-forwarded-for": address}, trust_env=False, timeout=PATIENCE).status_code

    before = replicas.rooms()

    def taken() -> bool:
        for _ in range(LEARNERS):
            ask("192.0.2.1")
        return all(now == then + LEARNERS for now, then in zip(replicas.rooms(), before, strict=True))

    wait_for(taken, "all places of an address to be taken, on each server")
    assert ask("198.51.100.7, 192.0.2.1") == 503
    assert ask("192.0.2.2") == 200
