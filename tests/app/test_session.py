"""Sessions: one state, coalesced drawing, motions, and rooms that come and go."""

from __future__ import annotations

import asyncio
import dataclasses
import logging
import os
import sys
import threading
import time
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from types import SimpleNamespace
from typing import Annotated, Any

import numpy as np
import pytest
from pydantic import ValidationError

from app.rooms import drawing, motion, registry, telling
from app.rooms.keys import new_key, room_of
from app.rooms.looking_up import MOST, LookingUp
from app.rooms.places import Full
from app.rooms.registry import Sessions
from app.rooms.session import Session
from app.rooms.solver import Solver as Pool
from app.rooms.solver import workers
from app.routes.links import controls
from app.sockets.commands import Commands
from sims import by_slug
from sims.kit.challenge import Challenge, Progress
from sims.kit.fields import NumberBox, OptionalNumber, Slider, Vector
from sims.kit.params import Params
from sims.kit.progress import Superseded, begins, goes_on
from sims.kit.sim import Action, Sim, Step
from tests.app.toys import IMPOSSIBLE, Solver, ToyParams, toy
from tests.server import PATIENCE


class Eye:
    """A viewer that remembers what it was shown."""

    def __init__(self, *, broken: bool = False) -> None:
        self.seen: list[tuple[float, float]] = []
        self.broken = broken

    def draw(self, params: Any, solution: Any, version: int) -> None:
        if self.broken:
            raise RuntimeError("a viewer broke")
        self.seen.append((getattr(params, "size", 0.0), getattr(solution, "double", 0.0)))


def viewer() -> Any:
    return Eye()


def stumbling(error: type[Exception]) -> Sim[Any, Any]:
    """The toy with buttons and a handle that fail, and a state that can't be drawn."""

    def fails(*_: Any) -> Any:
        raise error("nobody has foreseen this")

    def later(_: ToyParams) -> Iterator[Step]:
        yield Step({"size": 2.0}, 0.0)
        fails()

    sim, _ = toy()
    buttons = [("stumble", fails), ("stumble at once", lambda p: map(fails, [p])), ("stumble later", later)]
    actions = [Action(name, name, name, run) for name, run in buttons]

    def solve(params: ToyParams) -> Any:
        return fails() if params.size == 77.0 else sim.solve(params)

    return dataclasses.replace(sim, solve=solve, actions=actions, handles={"/grip": fails})


class Room:
    """A session of the toy with a viewer and a listener."""

    def __init__(
        self,
        seconds: float = 0.0,
        *,
        heavy: bool = False,
        start: Params | None = None,
        sim: Sim[Any, Any] | None = None,
    ) -> None:
        made, self.solver = toy(seconds, heavy=heavy)
        self.sessions = Sessions(10)
        self.session = self.sessions.open(sim or made, "room", start or ToyParams())
        self.told: list[dict[str, Any]] = []
        self.eye = viewer()
        self.session.join(self.eye)
        self.session.listen(self.told.append)

    async def drawn(self) -> None:
        """Wait until nothing is left to draw."""
        await self.session.settled()

    async def moved(self) -> None:
        """Wait until the motion has ended, and before that until it is known which it is."""
        await self.session.rested()

    @property
    def errors(self) -> list[str]:
        return [m["message"] for m in self.told if m["type"] == "error"]


def run(test: Callable[[], Coroutine[Any, Any, None]]) -> None:
    asyncio.run(asyncio.wait_for(test(), 20))


# ---- drawing


def test_a_viewer_sees_the_state_at_once() -> None:
    async def test() -> None:
        room = Room(start=ToyParams(size=4))
        assert room.eye.seen == [(4.0, 8.0)]

    run(test)


def test_many_changes_in_one_turn_of_the_loop_are_one_drawing() -> None:
    async def test() -> None:
        room = Room()
        room.solver.solved.clear()
        for k in range(100):
            room.session.change({"size": float(k)})
        await room.drawn()
        assert room.solver.solved == [99.0]
        assert room.eye.seen[1:] == [(99.0, 198.0)]

    run(test)


def test_changes_while_a_solve_runs_replace_each_other() -> None:
    async def test() -> None:
        room = Room(0.05, heavy=True)
        room.solver.solved.clear()
        for k in range(1, 21):
            room.session.change({"size": float(k)})
            await asyncio.sleep(0.01)
        await room.drawn()
        assert len(room.solver.solved) < 10
        assert room.solver.solved == sorted(room.solver.solved)
        assert room.eye.seen[-1] == (20.0, 40.0)
        assert all(double == 2 * size for size, double in room.eye.seen)

    run(test)


def test_a_heavy_solve_does_not_hold_up_the_loop() -> None:
    async def test() -> None:
        goes_on = threading.Event()
        sim, solver = toy(heavy=True)

        def solve(params: ToyParams) -> Any:
            if params.size == 7.0:
                goes_on.wait(10)  # for good, if the loop is held up: then nobody lets it go on
            return solver(params)

        room = Room(sim=dataclasses.replace(sim, solve=solve))
        await room.drawn()
        room.session.change({"size": 7})
        await asyncio.sleep(0.01)
        assert room.eye.seen == [(1.0, 2.0)]
        late: Any = Eye()
        room.session.join(late)
        assert late.seen == [(1.0, 2.0)], "who joins meanwhile sees the last state that is solved"
        assert room.session.state()["text"] == "Size 1, double 2."
        goes_on.set()
        await room.drawn()
        assert room.eye.seen[-1] == late.seen[-1] == (7.0, 14.0)

    run(test)


def test_what_is_changed_while_drawing_is_drawn_too() -> None:
    async def test() -> None:
        room = Room()

        class Echo(Eye):
            def draw(self, params: Any, solution: Any, version: int) -> None:
                super().draw(params, solution, version)
                if params.size < 5:
                    room.session.change({"size": params.size + 1})

        echo: Any = Echo()
        room.session.join(echo)
        await room.drawn()
        assert echo.seen[-1] == room.eye.seen[-1] == (5.0, 10.0)

    run(test)


def test_a_control_beyond_its_bounds_is_drawn_back() -> None:
    async def test() -> None:
        room = Room(start=ToyParams(size=100))
        room.session.change({"size": 1e6})
        await room.drawn()
        assert room.session.version == 0
        assert room.eye.seen == [(100.0, 200.0)] * 2

    run(test)


def test_all_viewers_of_a_room_see_each_change() -> None:
    async def test() -> None:
        room = Room()
        others: list[Any] = [Eye() for _ in range(3)]
        for other in others:
            room.session.join(other)
        room.session.change({"size": 8})
        await room.drawn()
        assert all(eye.seen[-1] == (8.0, 16.0) for eye in (room.eye, *others))
        room.session.leave(viewer=others[0])
        room.session.change({"size": 9})
        await room.drawn()
        assert others[0].seen[-1] == (8.0, 16.0)
        assert others[1].seen[-1] == (9.0, 18.0)

    run(test)


def test_a_viewer_that_breaks_takes_nobody_along(caplog: pytest.LogCaptureFixture) -> None:
    async def test() -> None:
        room = Room()
        eyes: list[Any] = [room.eye, *(Eye() for _ in range(4))]
        broken: Any = Eye()
        for eye in (*eyes[1:], broken):
            room.session.join(eye)
        broken.broken = True
        room.session.change({"size": 3})
        await room.drawn()
        assert all(eye.seen[-1] == (3.0, 6.0) for eye in eyes)
        room.session.change({"size": 4})
        await room.drawn()
        assert all(eye.seen[-1] == (4.0, 8.0) for eye in eyes)

    with caplog.at_level(logging.CRITICAL, "sim3"):
        run(test)


# ---- what can't be


@pytest.mark.parametrize("heavy", [False, True])
def test_without_a_solution_the_last_good_state_stays_and_the_page_is_told(heavy: bool) -> None:
    async def test() -> None:
        room = Room(heavy=heavy)
        room.session.change({"size": 4})
        await room.drawn()
        room.session.change({"size": IMPOSSIBLE})
        await room.drawn()
        assert room.errors == ["size is 13.0; allowed: anything but 13"]
        assert room.session.params == ToyParams(size=4)
        assert room.eye.seen[-1] == (4.0, 8.0), "the control goes back too"
        assert room.session.state()["query"] == "size=4"
        assert room.session.state()["text"] == "Size 4, double 8."
        room.session.change({"size": 5})
        await room.drawn()
        assert room.eye.seen[-1] == (5.0, 10.0)

    run(test)


def test_what_comes_after_an_impossible_state_is_not_lost() -> None:
    async def test() -> None:
        room = Room(0.05, heavy=True)
        room.session.change({"size": IMPOSSIBLE})
        await asyncio.sleep(0.01)
        room.session.change({"size": 6})
        await room.drawn()
        assert room.session.params == ToyParams(size=6)
        assert room.eye.seen[-1] == (6.0, 12.0)

    run(test)


@pytest.mark.parametrize("changes", [{"size": 101}, {"size": "x"}, {"size": float("nan")}, {"kind": "green"}, {"x": 1}])
def test_a_message_with_bad_values_is_refused_whole(changes: dict[str, Any]) -> None:
    async def test() -> None:
        room = Room()
        with pytest.raises(ValidationError):
            room.session.change({"kind": "blue", **changes}, live=False)
        await room.drawn()
        assert room.session.params == ToyParams()

    run(test)


def test_unknown_names_are_refused() -> None:
    async def test() -> None:
        room = Room()
        with pytest.raises(KeyError):
            room.session.act("explode")
        with pytest.raises(KeyError):
            room.session.drag("/nothing", (0.0, 0.0, 0.0))
        with pytest.raises(ValidationError):
            room.session.act("burst")
        assert room.session.params == ToyParams()

    run(test)


# ---- actions and motions


def test_dragging_a_handle_is_kept_within_bounds() -> None:
    async def test() -> None:
        room = Room()
        room.session.drag("/grip", (7.5, 0.0, 0.0))
        assert room.session.params == ToyParams(size=7.5)
        room.session.drag("/grip", (-7.5, 0.0, 0.0))
        assert room.session.params == ToyParams(size=0)

    run(test)


def test_what_a_hand_leads_to_is_short_in_a_link_and_what_was_typed_is_exact() -> None:
    async def test() -> None:
        room = Room()
        room.session.drag("/grip", (7.123456789012345, 0.0, 0.0))
        assert room.session.params == ToyParams(size=7.123456789)
        room.session.drag("/grip", (7.123456789012345, 0.0, 0.0), exact=True)
        assert room.session.params == ToyParams(size=7.123456789012345)

    run(test)


def test_a_button_leads_to_the_next_state() -> None:
    async def test() -> None:
        room = Room()
        room.session.act("paint")
        assert room.session.params == ToyParams(kind="blue")

    run(test)


def test_a_button_is_known_by_the_name_that_it_had_before() -> None:
    async def test() -> None:
        room = Room()
        room.session.act("dye")
        assert room.session.params == ToyParams(kind="blue")
        assert "dye" in controls(room.session.sim), "links that show this button alone"

    run(test)


def test_reset_leads_back_to_the_state_of_the_link() -> None:
    async def test() -> None:
        start = ToyParams(size=42, kind="blue")
        room = Room(start=start)
        room.session.change({"size": 3})
        room.session.act("paint")
        room.session.act("reset")
        await room.drawn()
        assert room.session.params == start
        assert room.eye.seen[-1] == (42.0, 84.0)

    run(test)


def test_a_motion_glides_to_each_of_its_steps() -> None:
    async def test() -> None:
        room = Room()
        room.session.act("grow")
        await room.moved()
        await room.drawn()
        sizes = [size for size, _ in room.eye.seen]
        assert sizes[1] == 0.0
        assert sizes[1:] == sorted(sizes[1:])
        assert min(abs(size - 50.0) for size in sizes) < 1e-3
        assert sizes[-1] == room.session.params.model_dump()["size"] == 100.0
        assert len(sizes) > 6

    run(test)


@pytest.mark.parametrize(
    "touch",
    [
        lambda s: s.change({"size": 77}),
        lambda s: s.change({"size": 77}, live=False),
        lambda s: s.drag("/grip", (77.0, 0.0, 0.0)),
        lambda s: (s.act("reset"), s.change({"size": 77})),
    ],
    ids=["control", "message", "drag", "button"],
)
def test_a_motion_stops_at_a_touch(touch: Callable[[Session], object]) -> None:
    async def test() -> None:
        room = Room()
        room.session.act("grow")
        await asyncio.sleep(0.1)
        touch(room.session)
        await asyncio.sleep(0.1)
        assert room.session.params.model_dump()["size"] == 77.0
        await room.drawn()
        assert room.eye.seen[-1] == (77.0, 154.0)

    run(test)


def test_a_motion_started_again_begins_anew() -> None:
    async def test() -> None:
        room = Room()
        room.session.act("grow")
        await asyncio.sleep(0.2)
        room.session.act("grow")
        await asyncio.sleep(0.02)
        assert room.session.params.model_dump()["size"] < 25.0
        await room.moved()
        assert room.session.params == ToyParams(size=100)

    run(test)


def test_reduced_motion_steps_instead(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(motion, "PAUSE", 0.02)

    async def test() -> None:
        room = Room()
        room.session.motion.reduced = True
        room.session.act("grow")
        await room.moved()
        await room.drawn()
        assert [size for size, _ in room.eye.seen[1:]] == [0.0, 50.0, 100.0]

    run(test)


@pytest.mark.parametrize("reduced", [False, True])
def test_a_motion_says_what_is_to_be_seen(reduced: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(motion, "PAUSE", 0.02)

    async def test() -> None:
        room = Room()
        heard: list[dict[str, Any]] = []
        room.session.motion.reduced = reduced
        room.session.listen(heard.append)
        room.session.act("explain")
        await room.moved()
        await room.drawn()
        captions = [m["parts"]["caption"] for m in heard if m["type"] == "show" and "caption" in m["parts"]]
        told = [f'<span class="s3-told">{words}</span>' for words in ("It grows.", "Now it &lt;rests&gt;.")]
        assert captions == ["Make it grow.", *told, "Make it grow."]

    run(test)


def test_what_a_motion_says_ends_with_it() -> None:
    async def test() -> None:
        room = Room()
        heard: list[dict[str, Any]] = []
        room.session.listen(heard.append)
        room.session.act("explain")
        await asyncio.sleep(0.05)
        assert room.session.state()["text"] == "It grows."
        room.session.change({"size": 3})
        await room.drawn()
        assert heard[-1]["parts"]["caption"] == "Make it grow."
        assert room.session.state()["text"] == "Size 3, double 6."

    run(test)


def slowly(before: ToyParams, after: ToyParams) -> Iterator[Step]:
    if before.kind != after.kind:
        yield Step({"size": before.size}, 0.0, words="Another colour.")
        yield Step({"size": after.size + 10.0}, 0.2)
        yield Step({"size": after.size}, 0.0)


def easing() -> Sim[Any, Any]:
    return dataclasses.replace(toy()[0], eases=slowly)


def test_what_is_chosen_is_seen_to_come_about() -> None:
    async def test() -> None:
        room = Room(sim=easing(), start=ToyParams(size=20))
        room.session.enter("size", "40")
        assert room.session.motion.task is None, "nothing to be seen"
        room.session.enter("kind", "blue")
        assert room.session.params == ToyParams(size=40, kind="blue")
        await room.moved()
        await room.drawn()
        assert max(size for size, _ in room.eye.seen) > 40.0
        assert room.session.params == ToyParams(size=40, kind="blue")

    run(test)


def test_nothing_is_eased_for_links_and_where_motion_is_reduced() -> None:
    async def test() -> None:
        room = Room(sim=easing())
        room.session.change({"kind": "blue"}, live=False)
        assert room.session.motion.task is None
        room.session.motion.reduced = True
        room.session.enter("kind", "red")
        assert room.session.params == ToyParams()
        assert room.session.motion.task is None

    run(test)


def test_a_motion_ends_when_nobody_looks() -> None:
    async def test() -> None:
        room = Room()
        room.session.act("grow")
        await asyncio.sleep(0.05)
        room.session.leave(viewer=room.eye)
        room.session.leave(listener=room.told.append)
        size = room.session.params.model_dump()["size"]
        await asyncio.sleep(0.1)
        assert room.session.params.model_dump()["size"] == size
        assert not room.session.occupied

    run(test)


def test_axes_that_turn_as_everybody_leaves_are_where_they_turned_to() -> None:
    """As when a page is loaded anew meanwhile: nobody would turn them on."""
    sim = by_slug("coordinate-frames")
    assert sim is not None

    async def test() -> None:
        room = Room(sim=sim, start=sim.params())
        await room.drawn()
        room.session.enter("convention", "unreal")
        await asyncio.sleep(0.05)
        assert room.session.params.model_dump()["turn"] is not None
        room.session.leave(viewer=room.eye)
        room.session.leave(listener=room.told.append)
        assert room.session.params == sim.params().moved({"convention": "unreal"})

    run(test)


@pytest.mark.parametrize(
    ("a", "b", "half"),
    [
        (0.0, 10.0, 5.0),
        ((0.0, 2.0), (1.0, 4.0), (0.5, 3.0)),
        ("x", "y", "y"),
        (True, False, False),
        ((1.0,), (1.0, 2.0), (1.0, 2.0)),
    ],
)
def test_numbers_glide_and_words_jump(a: Any, b: Any, half: Any) -> None:
    assert motion.between(a, b, 0.5) == half


def test_easing_starts_and_stops_gently() -> None:
    assert [motion.eased(f) for f in (0.0, 0.5, 1.0)] == [0.0, 0.5, 1.0]
    assert motion.eased(0.1) < 0.1
    assert motion.eased(0.9) > 0.9


def test_an_even_leg_keeps_one_speed(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 0.0

    async def sleep(seconds: float) -> None:
        nonlocal now
        now += seconds

    clock = SimpleNamespace(get_running_loop=lambda: SimpleNamespace(time=lambda: now), sleep=sleep)
    monkeypatch.setattr(motion, "asyncio", clock)

    async def sizes(even: bool) -> list[float]:
        async def leg() -> AsyncIterator[Step]:
            yield Step({"size": 100.0}, 1.0, even=even)

        return [changes["size"] async for changes in motion.play(leg(), ToyParams, reduced=False)]

    start = ToyParams().size
    speeds = np.diff([start, *asyncio.run(sizes(even=True))[1:-1]])
    np.testing.assert_allclose(speeds, (100.0 - start) * motion.FRAME, rtol=1e-9)
    assert np.ptp(np.diff(asyncio.run(sizes(even=False)))) > 1.0


# ---- gliding to a state


def sim_room(slug: str, **start: Any) -> Room:
    """A room of one of the nine sims."""
    sim = by_slug(slug)
    assert sim is not None
    return Room(sim=sim, start=sim.params(**start))


def test_numbers_glide_and_all_else_is_set_at_the_start() -> None:
    async def test() -> None:
        room = Room(start=ToyParams(size=10))
        room.session.glide({"size": 90, "kind": "blue"}, 0.3)
        assert room.session.params == ToyParams(size=10, kind="blue")
        await room.moved()
        await room.drawn()
        sizes = [size for size, _ in room.eye.seen]
        assert sizes == sorted(sizes)
        assert len(set(sizes)) > 4
        assert room.session.params == ToyParams(size=90, kind="blue")

    run(test)


def test_a_glide_is_validated_before_it_begins() -> None:
    async def test() -> None:
        room = Room()
        room.session.act("grow")
        with pytest.raises(ValidationError):
            room.session.glide({"kind": "blue", "size": 1000}, 0.3)
        assert room.session.params == ToyParams()
        assert room.session.motion.task is not None, "what moved before goes on"

    run(test)


def test_a_glide_is_a_jump_where_motion_is_reduced() -> None:
    async def test() -> None:
        room = Room()
        room.session.motion.reduced = True
        room.session.glide({"size": 90}, 5.0)
        assert room.session.params == ToyParams(size=90)
        assert room.session.motion.task is None

    run(test)


@pytest.mark.parametrize(
    ("slug", "start", "changes"),
    [
        ("camera", {"linked": True}, {"fx": 1200.0}),
        ("coordinate-frames", {}, {"convention": "ros"}),
        ("euler-angles", {"pitch": -45}, {"order": "zxz", "pitch": 120}),
        ("transform-chain", {}, {"angles": (1.0,), "lengths": (2.0,), "axes": "x"}),
        ("transform-chain", {"pull": (9.0, 0.0, 0.0)}, {"angles": (5.0, 5.0, 5.0), "swap": 2}),
        ("triangulation", {}, {"seed": 77, "noise": 2.0}),
        ("epipolar", {}, {"points": 12, "pick": "left:100,100"}),
    ],
    ids=lambda v: v if isinstance(v, str) else "",
)
def test_a_glide_ends_where_a_jump_would(slug: str, start: dict[str, Any], changes: dict[str, Any]) -> None:
    async def test() -> None:
        room = sim_room(slug, **start)
        target = room.session.params.changed(changes)
        room.session.glide(changes, 0.2)
        await room.moved()
        assert room.session.params == target
        assert not room.errors

    run(test)


def test_whole_numbers_with_a_slider_go_in_steps_and_names_jump() -> None:
    start, target = ToyNumbers(), ToyNumbers(amount=10, name=10, maybe=5, vector=(1.0, 1.0))
    assert motion.gliding(start, target) == {"amount": 10, "vector": (1.0, 1.0)}
    assert [motion.between(0, 10, f) for f in (0.0, 0.26, 1.0)] == [0, 3, 10]


class ToyNumbers(Params):
    amount: Annotated[int, Slider(0, 10, step=1, title="Amount")] = 0
    name: Annotated[int, NumberBox(0, 10, step=1, title="Name")] = 0
    maybe: Annotated[int | None, OptionalNumber(1, 9, title="Maybe", words="{0}")] = None
    vector: Annotated[tuple[float, float], Vector(-1, 1, step=0.1, title="Vector")] = (0.0, 0.0)


# ---- what can't be foreseen


def test_what_goes_wrong_while_drawing_costs_the_step_alone(caplog: pytest.LogCaptureFixture) -> None:
    async def test() -> None:
        room = Room()
        room.solver.broken = True
        room.session.change({"size": 5})
        await room.drawn()
        assert room.session.params == ToyParams()
        assert "log" in room.errors[-1]
        room.solver.broken = False
        room.session.change({"size": 6})
        await room.drawn()
        assert room.eye.seen[-1] == (6.0, 12.0)

    with caplog.at_level(logging.ERROR, "sim3"):
        run(test)
    (line,) = caplog.records
    assert "ZeroDivisionError" in line.getMessage()
    assert line.exc_info is None


def test_a_state_that_cannot_be_drawn_is_told_and_the_session_goes_on(caplog: pytest.LogCaptureFixture) -> None:
    async def test() -> None:
        room = Room()
        room.eye.broken = True
        room.session.change({"size": 5})
        await room.drawn()
        assert "can’t be drawn" in room.errors[-1]
        room.eye.broken = False
        room.session.change({"size": 6})
        await room.drawn()
        assert room.eye.seen[-1] == (6.0, 12.0)
        assert len(room.errors) == 1

    with caplog.at_level(logging.ERROR, "sim3"):
        run(test)
    assert "size=5" in caplog.text


def test_a_challenge_whose_check_fails_keeps_no_state_from_its_pages(caplog: pytest.LogCaptureFixture) -> None:
    def near(params: ToyParams, _: Any) -> Progress:
        return Progress(1.0 / (params.size - 5.0), "nearer")

    async def test() -> None:
        challenge: Challenge[Any, Any] = Challenge(
            id="five", title="Five", goal="Not five.", near=near, solves={"size": 6}, misses=()
        )
        room = Room(sim=dataclasses.replace(toy()[0], challenges=(challenge,)))
        room.session.change({"size": 6})
        await room.drawn()
        assert room.session.state()["challenges"]["five"]["solved"]
        room.session.change({"size": 5})
        await room.drawn()
        for _ in range(2):
            assert room.session.state()["params"]["size"] == 5
            assert room.session.state()["challenges"] == {}

    with caplog.at_level(logging.ERROR, "sim3"):
        run(test)
    (line,) = caplog.records
    assert "size=5" in line.getMessage()


@pytest.mark.parametrize("what", ["drag", "action", "motion", "late motion", "change"])
@pytest.mark.parametrize("error", [KeyError, IndexError, OverflowError, ZeroDivisionError, TypeError, RecursionError])
def test_what_a_sim_stumbles_over_is_told_and_the_session_goes_on(
    what: str, error: type[Exception], caplog: pytest.LogCaptureFixture
) -> None:
    async def test() -> None:
        room = Room(sim=stumbling(error))
        commands = Commands(room.session, room.told.append)
        {
            "drag": lambda: commands.drag("/grip", (1.0,)),
            "action": lambda: commands.act("stumble"),
            "motion": lambda: commands.act("stumble at once"),
            "late motion": lambda: commands.act("stumble later"),
            "change": lambda: commands.slide("size", 77.0),
        }[what]()
        await room.moved()
        await room.drawn()
        assert len(room.errors) == 1
        commands.slide("size", 3.0)
        await room.drawn()
        assert room.eye.seen[-1] == (3.0, 6.0)

    with caplog.at_level(logging.ERROR, "sim3"):
        run(test)
    assert all(record.exc_info is None for record in caplog.records)


@pytest.mark.parametrize(
    ("command", "errors"),
    [
        (
            lambda c: c.set({"size": 101, "kind": 5}, None),
            [("size", "101", "a number from 0 to 100"), ("kind", "5", "one of: red, blue")],
        ),
        (lambda c: c.set({"size": "5"}, None), [("size", '"5"', "a number from 0 to 100")]),
        (lambda c: c.set({"size": True}, 1.0), [("size", "true", "a number from 0 to 100")]),
        (lambda c: c.set({"colour": 1}, None), [("colour", "1", "one of: size, kind")]),
        (lambda c: c.set({"size": 5}, 0.0), [("seconds", "0.0", "a number above 0, at most 60")]),
        (lambda c: c.set({"size": 5}, 61), [("seconds", "61", "a number above 0, at most 60")]),
        (lambda c: c.act("explode"), [("name", '"explode"', "one of: reset, grow, explain, paint, burst")]),
        (lambda c: c.drag("/x", (0.0,)), [("name", '"/x"', "one of: /grip")]),
        (lambda c: c.act("burst"), [("size", "1000.0", "a number from 0 to 100")]),
        (lambda c: c.set({"size": IMPOSSIBLE}, None), [("size", "13.0", "anything but 13")]),
    ],
)
def test_errors_name_parameter_received_and_allowed(
    command: Callable[[Commands], None], errors: list[tuple[str, str, str]]
) -> None:
    async def test() -> None:
        room = Room()
        command(Commands(room.session, room.told.append))
        await room.drawn()
        (message,) = [m for m in room.told if m["type"] == "error"]
        assert [(e["parameter"], e["received"], e["allowed"]) for e in message["errors"]] == errors
        assert all(part in message["message"] for part in errors[0][:1])
        assert room.session.params == ToyParams()

    run(test)


# ---- what the page is told


def test_the_solution_comes_with_the_state_that_it_is_of() -> None:
    async def test() -> None:
        room = Room(0.05, heavy=True)
        room.session.change({"size": 8})
        told = await room.session.solved_state()
        assert (told["params"], told["query"]) == ({"size": 8.0, "kind": "red"}, "size=8")
        assert told["solution"] == {"double": 16.0}

    run(test)


def test_a_state_without_solution_says_so() -> None:
    async def test() -> None:
        room = Room(0.01, heavy=True, start=ToyParams(size=IMPOSSIBLE))
        assert (await room.session.solved_state())["solution"] is None

    run(test)


def test_state_message_holds_parameters_query_and_words() -> None:
    async def test() -> None:
        room = Room(start=ToyParams(size=2))
        assert room.session.state() == {
            "type": "state",
            "version": 0,
            "params": {"size": 2.0, "kind": "red"},
            "query": "size=2",
            "text": "Size 2, double 4.",
        }

    run(test)


def test_pages_are_told_the_last_state_and_not_each_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(telling, "STATE_INTERVAL", 0.05)

    async def test() -> None:
        room = Room()
        for k in range(1, 31):
            room.session.change({"size": float(k)})
            await asyncio.sleep(0.005)
        await asyncio.sleep(0.15)
        told = [m["params"]["size"] for m in room.told if m["type"] == "state"]
        assert 1 < len(told) < 20
        assert told[-1] == 30.0
        versions = [m["version"] for m in room.told if m["type"] == "state"]
        assert versions == sorted(versions)

    run(test)


# ---- rooms


def test_rooms_do_not_see_each_other() -> None:
    async def test() -> None:
        sim, _ = toy()
        sessions = Sessions(10)
        first, second = (sessions.open(sim, room, ToyParams()) for room in ("a", "b"))
        first.change({"size": 9})
        assert second.params == ToyParams()
        assert sessions.find(sim, "a") is first
        assert sessions.open(sim, "b", ToyParams(size=5)) is second
        assert len(sessions) == 2
        await asyncio.sleep(0)

    run(test)


def test_no_more_rooms_than_the_limit() -> None:
    async def test() -> None:
        sim, _ = toy()
        sessions = Sessions(2)
        eyes = {room: viewer() for room in ("a", "b")}
        for room, eye in eyes.items():
            sessions.open(sim, room, ToyParams()).join(eye)
        with pytest.raises(Full):
            sessions.open(sim, "c", ToyParams())
        known = sessions.find(sim, "a")
        assert known is not None
        assert sessions.open(sim, "a", ToyParams()) is known
        known.leave(viewer=eyes["a"])
        with pytest.raises(Full):
            sessions.open(sim, "c", ToyParams())  # its page may be loading anew
        known.left_at -= registry.UNVISITED - 1.0
        sessions.open(sim, "c", ToyParams())
        assert sessions.find(sim, "a") is None, "the one that nobody looks at makes place"
        assert sessions.find(sim, "b") is not None
        assert len(sessions) == 2

    run(test)


def test_of_rooms_that_nobody_visits_the_one_left_longest_makes_place() -> None:
    sim, _ = toy()
    sessions = Sessions(3)
    for age, room in enumerate(("new", "old", "older")):
        sessions.open(sim, room, ToyParams()).left_at -= registry.UNVISITED - 4.0 + age
    sessions.open(sim, "next", ToyParams())
    assert [room for room in ("new", "old", "older", "next") if sessions.find(sim, room)] == ["new", "old", "next"]


def test_rooms_that_nobody_visits_are_swept(monkeypatch: pytest.MonkeyPatch) -> None:
    async def test() -> None:
        sim, _ = toy()
        sessions = Sessions(2)
        visited, left = (sessions.open(sim, room, ToyParams()) for room in ("visited", "left"))
        eye: Any = Eye()
        visited.join(eye)
        sessions.sweep()
        assert len(sessions) == 2, "they are kept for a while"
        monkeypatch.setattr(registry, "UNVISITED", 0.0)
        left.left_at -= 1
        sessions.open(sim, "new", ToyParams())
        assert sessions.find(sim, "left") is None, "a room that nobody visits makes place"
        assert sessions.find(sim, "visited") is visited
        visited.leave(viewer=eye)
        visited.left_at -= 1
        sessions.sweep()
        assert sessions.find(sim, "visited") is None

    run(test)


def test_a_state_without_a_solution_opens_no_room() -> None:
    sim, solver = toy()
    sessions = Sessions(2)
    with pytest.raises(ValueError, match="anything but 13"):
        sessions.open(sim, "a", ToyParams(size=IMPOSSIBLE))
    assert isinstance(solver, Solver)
    assert len(sessions) == 0


def test_keys_cannot_be_guessed_and_make_their_rooms() -> None:
    keys = {new_key() for _ in range(1000)}
    assert len(keys) == len({room_of(key) for key in keys}) == 1000
    assert all(len(key) >= 22 for key in keys)
    key = keys.pop()
    assert room_of(key) == room_of(key)
    assert key not in room_of(key)
    assert room_of(key).isalnum()


# ---- what takes long


def test_a_heavy_sim_is_solved_beside_the_loop_from_the_first_state_on() -> None:
    async def test() -> None:
        room = Room(0.05, heavy=True, start=ToyParams(size=4))
        assert room.session.solution is None
        assert room.eye.seen == []
        assert room.session.state()["text"] == ""
        await room.drawn()
        assert room.eye.seen == [(4.0, 8.0)]
        assert "double 8" in room.session.state()["text"]

    run(test)


def test_a_heavy_sim_that_cannot_be_solved_at_first_can_be_later() -> None:
    async def test() -> None:
        room = Room(heavy=True, start=ToyParams(size=IMPOSSIBLE))
        await room.drawn()
        assert room.session.solution is None
        room.session.change({"size": 2.0})
        await room.drawn()
        assert room.eye.seen == [(2.0, 4.0)]

    run(test)


def test_long_work_ends_when_a_newer_state_waits() -> None:
    async def test() -> None:
        room = Room(heavy=True)
        await room.drawn()
        begun, ended = asyncio.Event(), []
        loop = asyncio.get_running_loop()

        def solve(params: ToyParams) -> Any:
            try:
                while params.size == 5.0:
                    loop.call_soon_threadsafe(begun.set)
                    goes_on()
                    time.sleep(0.001)
            except Superseded:
                ended.append(params.size)
                raise
            return SimpleNamespace(double=2.0 * params.size)

        room.session.drawing.sim = dataclasses.replace(room.session.sim, solve=solve)
        room.session.change({"size": 5.0})
        await begun.wait()
        room.session.change({"size": 6.0})
        await room.drawn()
        assert ended == [5.0]
        assert room.eye.seen[-1] == (6.0, 12.0)
        assert (5.0, 10.0) not in room.eye.seen

    run(test)


def test_what_a_handle_of_a_heavy_sim_means_is_found_beside_the_loop() -> None:
    async def test() -> None:
        room = Room(heavy=True)
        await room.drawn()
        room.session.drag("/grip", (7.0, 0.0, 0.0))
        assert room.session.params != ToyParams(size=7)
        await room.drawn()
        assert room.eye.seen[-1] == (7.0, 14.0)

    run(test)


def test_every_press_of_a_heavy_sims_button_counts() -> None:
    async def test() -> None:
        room = Room(heavy=True)
        await room.drawn()
        more = Action("more", "More", "", lambda p: {"size": p.size + 1.0})
        room.session.sim = dataclasses.replace(room.session.sim, actions=(*room.session.sim.actions, more))
        for _ in range(3):
            room.session.act("more")
        await room.drawn()
        assert room.session.params == ToyParams(size=4)

    run(test)


def test_a_motion_of_a_heavy_sim_begins_at_once_and_a_touch_ends_it() -> None:
    async def test() -> None:
        room = Room(0.1, heavy=True)
        room.session.act("grow")  # while the first state is worked out
        assert room.session.motion.task is not None
        room.session.change({"size": 7})
        await room.moved()
        assert room.session.params == ToyParams(size=7)

    run(test)


def test_of_a_flood_of_places_only_the_last_is_looked_for() -> None:
    async def test() -> None:
        room = Room(heavy=True)
        await room.drawn()
        asked: list[float] = []

        def handle(params: ToyParams, place: tuple[float, ...]) -> dict[str, float]:
            asked.append(place[0])
            time.sleep(0.02)
            return {"size": place[0]}

        room.session.sim = dataclasses.replace(room.session.sim, handles={"/grip": handle})
        room.session.drag("/grip", (1.0, 0.0, 0.0))
        while not asked:
            await asyncio.sleep(0)
        for size in (2.0, 3.0, 4.0):
            room.session.drag("/grip", (size, 0.0, 0.0))
        await room.drawn()
        assert asked == [1.0, 4.0]
        assert room.eye.seen[-1] == (4.0, 8.0)

    run(test)


class Slow:
    """Solves at once, but for a size of 5: of that half is done, and the rest never ends."""

    def __init__(self, room: Room) -> None:
        self.ended: list[float] = []
        self.deaf = False
        """It doesn't ask whether it is still wanted."""
        self.let_go = threading.Event()
        room.session.drawing.sim = dataclasses.replace(room.session.sim, solve=self)

    def __call__(self, params: ToyParams) -> Any:
        if params.size == 5.0:
            begins("Counting")
            self._work()
            self.ended.append(params.size)
        return SimpleNamespace(double=2.0 * params.size)

    def _work(self) -> None:
        while not self.let_go.wait(0.001):
            if not self.deaf:
                goes_on(0.5)


async def told(room: Room, kind: str) -> dict[str, Any]:
    """The next message of a kind."""
    room.told.clear()
    while not (found := [message for message in room.told if message["type"] == kind]):
        await asyncio.sleep(0.005)
    return found[0]


def test_pages_are_told_how_far_long_work_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drawing, "LONG", 0.02)
    monkeypatch.setattr(drawing, "REPORTED_EVERY", 0.01)

    async def test() -> None:
        room = Room(heavy=True)
        await room.drawn()
        slow = Slow(room)
        room.session.change({"size": 5.0})
        assert await told(room, "work") == {"type": "work", "text": "Counting", "done": 0.5, "cancel": True}
        slow.let_go.set()
        await room.drawn()
        await asyncio.sleep(0)
        assert [m["text"] for m in room.told if m["type"] == "work"][-1] == ""
        assert room.eye.seen[-1] == (5.0, 10.0)

    run(test)


def test_quick_work_is_not_worth_a_word() -> None:
    async def test() -> None:
        room = Room(0.02, heavy=True)
        for size in range(20):
            room.session.change({"size": float(size)})
            await room.drawn()
        assert not [message for message in room.told if message["type"] == "work"]

    run(test)


@pytest.mark.parametrize("deaf", [False, True])
def test_long_work_can_be_cancelled(monkeypatch: pytest.MonkeyPatch, deaf: bool) -> None:
    monkeypatch.setattr(drawing, "LONG", 0.02)
    monkeypatch.setattr(drawing, "REPORTED_EVERY", 0.01)

    async def test() -> None:
        room = Room(heavy=True, start=ToyParams(size=3))
        await room.drawn()
        slow = Slow(room)
        slow.deaf = deaf
        room.session.change({"size": 5.0})
        assert (await told(room, "work"))["cancel"]
        room.session.cancel()
        assert room.session.params == ToyParams(size=3)
        if deaf:
            slow.let_go.set()
        await room.drawn()
        assert room.eye.seen[-1] == (3.0, 6.0)
        assert (5.0, 10.0) not in room.eye.seen
        assert slow.ended == ([5.0] if deaf else [])
        room.session.cancel()
        await room.drawn()
        assert room.session.params == ToyParams(size=3), "there was nothing to cancel"

    run(test)


def test_a_sim_that_opens_with_long_work_opens_without_it_when_cancelled() -> None:
    async def test() -> None:
        room = Room(heavy=True, start=ToyParams(size=5))
        Slow(room)
        while room.session.drawing.work is None:
            await asyncio.sleep(0.001)
        room.session.cancel()
        await room.drawn()
        assert room.eye.seen == [(1.0, 2.0)]

    run(test)


def test_a_motion_of_a_heavy_sim_waits_until_each_state_is_drawn() -> None:
    async def test() -> None:
        room = Room(0.15, heavy=True)
        await room.drawn()
        room.session.act("grow")
        await room.moved()
        await room.drawn()
        sizes = [size for size, _ in room.eye.seen]
        assert sizes[1] == 0.0, "the first state of the motion was skipped"
        assert sizes[-1] == 100.0
        assert room.solver.solved == sizes

    run(test)


def test_work_ahead_is_done_once_after_the_first_drawing() -> None:
    async def test() -> None:
        sim, solver = toy(heavy=True)
        done: list[int] = []
        pieces = [lambda k=k: done.append(k + len(solver.solved)) for k in (0, 10)]
        sim = dataclasses.replace(sim, ahead=pieces)
        sessions = Sessions(10)
        for name in ("one", "two"):
            sessions.open(sim, name, ToyParams())
        while len(done) < 2:
            await asyncio.sleep(0.001)
        await asyncio.sleep(0.02)
        sessions.open(sim, "three", ToyParams())
        await asyncio.sleep(0.02)
        assert len(done) == 2
        assert done[0] > 0
        assert done[1] > 10
        await sessions.close()

    run(test)


def test_work_ahead_ends_with_the_server() -> None:
    """What is closed is waited for: it ends at its next state."""
    begun, ended = threading.Event(), threading.Event()

    def piece() -> None:
        begun.set()
        with suppress(Superseded):
            while True:
                goes_on()
                time.sleep(0.001)
        ended.set()

    async def test() -> None:
        sessions = Sessions(10)
        sessions.work_ahead("pieces", [piece])
        assert await asyncio.to_thread(begun.wait, PATIENCE)
        await sessions.close()
        assert await asyncio.to_thread(ended.wait, PATIENCE)

    run(test)


def test_what_works_beside_the_loop_gives_way_to_it() -> None:
    """On Linux, where each thread has a niceness of its own; threads that it begins have the same."""

    def niceness() -> int:
        return os.getpriority(os.PRIO_PROCESS, threading.get_native_id())

    def inside() -> tuple[int, int]:
        with ThreadPoolExecutor(1) as further:
            return niceness(), further.submit(niceness).result()

    own = niceness()
    with workers("test", 1) as pool:
        assert pool.submit(inside).result() == ((min(own + 10, 19),) * 2 if sys.platform == "linux" else (own, own))
    assert niceness() == own


def test_nobody_waits_for_those_who_take_long() -> None:
    """Three rooms solve for long, which is more than may do so at once; another is soon served all the same."""

    async def test() -> None:
        sessions = Sessions(8)
        quick, solver = toy(heavy=True)
        served = threading.Event()
        slow = dataclasses.replace(quick, solve=lambda p: served.wait(15) and solver(p))
        for room in "abc":
            sessions.open(slow, room, slow.params())
        await asyncio.sleep(0.1)
        other = sessions.open(quick, "d", quick.params())
        while other.solution is None:
            await asyncio.sleep(0.02)
        assert len(solver.solved) == 1, "those who take long are still at it"
        served.set()
        await sessions.close()

    asyncio.run(asyncio.wait_for(test(), 20))


def test_a_session_has_one_thing_worked_out_at_a_time() -> None:
    async def test() -> None:
        at_once, most = 0, 0

        def slowly(*_: Any) -> dict[str, Any]:
            nonlocal at_once, most
            at_once += 1
            most = max(most, at_once)
            time.sleep(0.2)
            at_once -= 1
            return {}

        sim, _ = toy(heavy=True)
        sim = dataclasses.replace(sim, solve=slowly, handles={"/grip": slowly}, describe=lambda p, s: "")
        sessions = Sessions(8)
        room = sessions.open(sim, "a", sim.params())
        room.drag("/grip", (1.0, 2.0, 3.0))
        room.change({"size": 5.0})
        await asyncio.sleep(0.1)
        await room.settled()
        assert most == 1
        await sessions.close()

    asyncio.run(asyncio.wait_for(test(), 20))


def test_what_is_under_a_pointer_goes_with_it_and_fails_for_one_viewer_alone() -> None:
    class Looks(Eye):
        sim = SimpleNamespace(slug="toy")

        def under(self, found: object) -> None:
            if self.broken:
                raise RuntimeError("a viewer broke")
            shown.append(found)

    shown: list[object] = []

    async def test() -> None:
        sim, _ = toy(heavy=True)
        room = Room(sim=dataclasses.replace(sim, under=lambda p, ray: ray))
        session, other = room.session, [Looks(broken=True) for _ in range(5)]
        gone: list[dict[str, Any]] = []
        session.listen(gone.append)
        await room.drawn()
        for eye in [*other, Looks()]:
            session.drawing.viewers.add(eye)  # type: ignore[arg-type]
        session.drawing.viewers.discard(room.eye)
        session.pass_over((1.0,), gone.append)
        await room.drawn()
        assert shown == [(1.0,)]
        assert gone[-1] == {"type": "over"}
        session.pass_over((2.0,), gone.append)
        session.leave(listener=gone.append)
        await room.drawn()
        assert shown == [(1.0,), None], "it leaves nothing behind, also of what was still being found out"
        assert not room.errors

    run(test)


def test_a_drag_and_a_pointer_at_once_take_the_place_of_no_press() -> None:
    taken: list[str] = []

    async def test() -> None:
        pool = Pool()
        looking_up = LookingUp(pool, asyncio.Lock(), lambda error: taken.append(repr(error)))
        drag_and_pointer = [(kind, f"{kind} {k}") for k in range(40) for kind in ("place", "pointer")]
        for kind, name in [("place", "click"), ("", "press"), ("", "press"), *drag_and_pointer]:
            looking_up.ask(lambda name=name: name, taken.append, kind)  # type: ignore[misc]
        assert looking_up.task is not None
        await looking_up.task
        assert taken == ["click", "press", "press", "place 39", "pointer 39"]
        taken.clear()
        for k in range(MOST + 2):  # only presses take the place of presses
            for kind in ("", "place", "pointer"):
                looking_up.ask(lambda name=f"{kind}{k}": name, taken.append, kind)  # type: ignore[misc]
        await looking_up.task
        pool.close()

    run(test)
    assert [name for name in taken if name.isdecimal()] == [f"{k}" for k in range(2, MOST + 2)]
