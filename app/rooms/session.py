"""Sessions (rooms): one Params, any number of viewers, one writer.

Everything here runs on viser's event loop, so there are no locks. An update makes the newest Params; `Drawing` solves
and draws them.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from inspect import isgeneratorfunction
from itertools import chain
from typing import Any

from pydantic import ValidationError

from app import metrics
from app.rooms.audience import Audience
from app.rooms.drawing import Drawing
from app.rooms.highlight import Highlight
from app.rooms.looking_up import LookingUp
from app.rooms.memory import NoRoom
from app.rooms.motion import Motion, gliding
from app.rooms.solver import Solver
from app.rooms.telling import Listener, Message, Telling
from app.trouble import Unknown, error_message
from geometry import GeometryError
from sims.kit.challenge import checked
from sims.kit.entered import entered, number, row
from sims.kit.fields import Numbers, Slider
from sims.kit.params import Params, by_hand
from sims.kit.sim import Dial, Library, Sim, Step, jsonable
from sims.kit.viewer import Viewer

log = logging.getLogger("sim3")
SOLVED_WITHIN = 20.0
"""Seconds that a page which wants the solution waits for that of the newest state."""


class Session:
    """One running sim."""

    def __init__(
        self, sim: Sim[Any, Any], room: str, params: Params, solver: Solver, library: Library | None = None
    ) -> None:
        self.sim = sim
        self.room = room
        self.params = self.initial = params
        self.version = 0
        self.waiting = False
        """Only people who watch have come so far."""
        self.left_at = self.touched_at = time.monotonic()
        self.visited = False
        """Somebody has looked at it."""
        self.opener = ""
        """The neighbourhood of the address from which it was opened, if that is known."""
        self.library = library
        self.given = () if library is None else (library,)
        """What the sim's functions need besides the parameters."""
        self.uploads: dict[str, int] = {}
        """Bytes of files that people uploaded, by what the library knows them as; they stay while they are shown."""
        self._solver = solver
        self._told: tuple[tuple[Params, Any], ...] = ()
        """The last two states that were told, with their solutions."""
        self._near: dict[str, Any] = {}
        """How near the last of them is to each challenge."""
        self.telling = Telling(self.state)
        self.audience = Audience()
        turn = asyncio.Lock()  # of what is worked out for this session: one thing at a time
        self.drawing = Drawing(
            sim, params, self.given, solver, turn, self.telling, lambda: (self.params, self.version), self._not_solved
        )
        self.motion = Motion(self._following, lambda: self.params, self._show, self.drawing.say, self._failed)
        self._highlight = Highlight(self.telling)
        self._looking_up = LookingUp(solver, turn, self._failed)
        if sim.heavy:
            self.drawing.soon()

    @property
    def solution(self) -> Any:
        """The solution of the newest state that is solved; None before there is one."""
        return self.drawing.solution

    def begin(self, params: Params, opened: Params) -> None:
        """Somebody with control comes, and brings the room's state and the one that a reset leads back to."""
        self.waiting = False
        self.initial = opened
        self._set(params)

    # ---- changes

    def change(self, changes: Mapping[str, Any], *, live: bool = True) -> None:
        """Take changes from a control (kept within bounds) or, not live, from a link or message (refused if bad).

        Raises pydantic's ValidationError for values that are refused; the state stays.
        """
        self.motion.stop()
        self.drawing.soon()  # also where nothing changes: a control that was moved too far goes back
        if live:
            self._set(self.sim.offers(self.params, self.solution, *self.given).moved(changes))
        else:
            self._set(self.params.changed(changes))

    def glide(self, changes: Mapping[str, Any], seconds: float) -> None:
        """Take changes as from a link, and go there within some seconds; at once where motion is reduced.

        Numbers glide; words, switches, and lists of another length are set at the start. Raises ValidationError.
        """
        target = self.params.changed(changes)
        self.motion.stop()
        self.drawing.soon()
        if self.motion.reduced:
            self._set(target)
            return
        ends = gliding(self.params, target)
        self._set(target.moved({name: getattr(self.params, name) for name in ends}))
        self.motion.begin(iter([Step(ends, seconds), Step(dict(target.__dict__), 0.0)]))

    def slide(self, name: str, value: float) -> None:
        """Take what a slider is moved to: of a parameter, or as `angles.2` of one of its entries."""
        if (dial := self._dial(name)) is not None:
            self.drag(name, (min(max(value, dial.low), dial.high),), exact=True)
            return
        field, dot, part = name.partition(".")
        kind = self.params.kinds.get(field)
        sliders = [each for each in self.params.visible if isinstance(self.params.kinds[each], Slider | Numbers)]
        if field not in sliders or isinstance(kind, Slider) == bool(dot) or (dot and not part.isdecimal()):
            raise Unknown("slider", name, sliders)
        self.change({name: round(value) if isinstance(kind, Slider) and kind.whole else float(value)})

    def enter(self, name: str, text: str) -> None:
        """Take what was typed into a box, or chosen. Raises NotMeant where that says nothing that can be taken."""
        if name.startswith("/"):
            self._enter_place(name, text)
            return
        if (dial := self._dial(name)) is not None:
            self.drag(name, (number(text, (dial.low, dial.high), dial.unit),), exact=True)
            return
        try:
            changes = entered(self.sim.offers(self.params, self.solution, *self.given), name, text)
        except LookupError:
            raise Unknown("control, or nothing in it,", f"{name}: {text}", self.params.kinds) from None
        before = self.params
        self.change(changes)
        self._ease(before)

    def _ease(self, before: Params) -> None:
        """Let it be seen how the state comes from the one before, where the sim shows that."""
        if self.sim.eases is None or self.motion.reduced:
            return
        steps = self.sim.eases(before, self.params)
        if (first := next(steps, None)) is not None:
            self._set(self.params.moved(first.changes))
            self.motion.begin(chain([first], steps))

    def _dial(self, name: str) -> Dial[Any, Any] | None:
        return next((dial for dial in self.sim.dials if dial.handle == name), None)

    def _enter_place(self, name: str, text: str) -> None:
        """The same for a box, `/grip.2`, of where a node of the scene is; or for all three, `/grip`."""
        handle, _, k = name.partition(".")
        typed = next((each for each in self.sim.typed if each.handle == handle), None)
        place = None if typed is None or self.solution is None else typed.place(self.params, self.solution)
        if typed is None or place is None or k not in ("", "0", "1", "2"):
            raise Unknown("place", name, [each.handle for each in self.sim.typed])
        ranges = list(zip(typed.low, typed.high, strict=True))
        if k:
            at = number(text, ranges[int(k)], typed.unit)
            self.drag(handle, (*place[: int(k)], at, *place[int(k) + 1 :]), exact=True)
        else:
            self.drag(handle, row(text, ranges, typed.unit), exact=True)

    def drag(self, name: str, place: tuple[float, ...], *, exact: bool = False) -> None:
        """Take the place where a handle was dragged to, in the scene (metres) or a picture (pixels).

        Unless it is `exact`, as a slider's and what was typed is, it leads to numbers as fine as a hand can mean.
        """
        take = self.change if exact else lambda changes: self.change(by_hand(changes))
        self._hold("handle", self.sim.handles, name, place, take)

    def click(self, name: str, ray: tuple[float, ...]) -> None:
        """Take a click on a node of the scene: the origin and direction of its ray."""
        self._hold("node to click", self.sim.clicks, name, ray, self.change)

    def _hold(
        self, kind: str, known: Mapping[str, Callable[..., Mapping[str, Any]]], name: str, place: tuple[float, ...],
        take: Callable[[Mapping[str, Any]], None],
    ) -> None:  # fmt: skip
        if (held := known.get(name)) is None:
            raise Unknown(kind, name, known)
        self._find(lambda: held(self.params, place, *self.given), take, "place")

    def select(self, name: str) -> None:
        """Select what is linked under a name; nothing happens where that can't be selected."""
        with suppress(ValidationError):
            selected = self.params.changed({self.sim.selects: name})
            self.motion.stop()
            self._set(selected)

    def act(self, name: str) -> None:
        """Press a button: reset, or one of the sim's actions."""
        self.motion.stop()
        if name == "reset":
            self._set(self.initial)
            return
        action = next((a for a in self.sim.actions if name in a.names), None)
        if action is None:
            raise Unknown("action", name, ["reset", *(a.name for a in self.sim.actions)])
        if isgeneratorfunction(action.run):  # a motion, whose steps are found as it goes
            self.motion.begin(action.run(self.params, *self.given))
        else:
            self._find(lambda: action.run(self.params, *self.given), self._take)

    def _take(self, result: Mapping[str, Any] | Iterator[Step]) -> None:
        """Take what an action leads to."""
        if isinstance(result, Mapping):
            self._set(self.params.changed(result))
        else:
            self.motion.begin(result)

    def _find(self, find: Callable[[], Any], take: Callable[[Any], None], kind: str = "") -> None:
        if self.sim.heavy:
            self._looking_up.ask(find, take, kind)
        else:
            take(find())

    def upload(self, known_as: str, size: int, changes: Mapping[str, Any]) -> None:
        """Show a file of some bytes that the library has taken; those that it takes the place of are forgotten."""
        self.uploads[known_as] = size
        self.motion.stop()
        self._set(self.params.moved(changes))
        shown = self.params.__dict__.values()
        for name in [name for name in self.uploads if name not in shown]:
            self.forget(name)

    def take(self, found: Any) -> None:
        """Take what was found in a text of somebody's own. Raises ValueError in words, or pydantic's."""
        assert self.sim.paste is not None
        self.change(self.sim.paste.changes(self.params, found), live=False)

    def forget(self, known_as: str) -> None:
        """Have the library forget an uploaded file."""
        self.uploads.pop(known_as, None)
        if self.library is not None:
            self.library.remove(known_as)

    def cancel(self) -> None:
        """Give up the work that the pool does: back to the state that is drawn."""
        if (work := self.drawing.work) is not None:
            self.motion.stop()
            work.cancelled = True
            self._set(self.drawing.before)
            self.drawing.soon()

    def _set(self, params: Params) -> None:
        if params == self.params:
            return
        self.params = params
        self.version += 1
        self.drawing.soon()

    # ---- motion

    async def _following(self, steps: Iterator[Step]) -> Step | None:
        """The next step of a motion, found in the pool where that may take long."""
        return await self._solver.run(next, steps, None) if self.sim.heavy else next(steps, None)

    async def _show(self, changes: Mapping[str, Any]) -> None:
        self._set(self.params.moved(changes))
        if self.sim.heavy:  # what takes long is seen before the motion goes on
            await self.drawing.drawn()

    # ---- what goes wrong

    def _failed(self, error: Exception, params: Params | None = None) -> None:
        self.telling.tell(error_message(self.sim, error, state=params or self.params))

    def _not_solved(self, params: Params, error: Exception) -> None:
        """A state has no solution: the one before stays."""
        if not isinstance(error, GeometryError | NoRoom):
            metrics.FAILURES.labels(self.sim.slug, "solve").inc()
        self._failed(error, params)
        if self.params is params:
            self.params = self.drawing.solved

    # ---- those who look

    def hover(self, name: str, by: Listener | None = None) -> None:
        """Highlight for everybody what somebody hovers over in a picture or table; an empty name is nothing."""
        self._highlight.show(name, self.drawing.viewers, by)

    def pass_over(self, ray: tuple[float, ...] | None, by: Listener) -> None:
        """Show everybody what is under a pointer: the origin and direction of its ray, or None where it has left.

        The channel of whose it is hears when that is done.
        """
        under, params = self.sim.under, self.params

        def show(found: object) -> None:
            if by not in self.telling.listeners:  # it has left meanwhile, and takes nothing away again
                return
            if self.drawing.solved is params:
                self._highlight.under(found, self.drawing.viewers, by)
            by({"type": "over"})

        if under is not None:
            self._find(lambda: None if ray is None else under(params, ray, *self.given), show, "pointer")

    def join(self, viewer: Viewer) -> None:
        """Add a viewer and show it the present state."""
        self.visited = True
        self.touch()
        self.drawing.join(viewer)

    def listen(self, listener: Listener) -> None:
        """Add a channel, and tell it what to show."""
        self.visited = True
        self.touch()
        listener(self.drawing.everything())
        self.telling.listeners.add(listener)

    def leave(self, viewer: Viewer | None = None, listener: Listener | None = None) -> None:
        """Forget a viewer or a channel."""
        if viewer is not None:
            self.drawing.viewers.discard(viewer)
        if listener is not None:
            self.telling.listeners.discard(listener)
            self._highlight.left(listener, self.drawing.viewers)
        if not self.occupied:
            self.left_at = time.monotonic()
            if self.motion.task is not None:
                self.motion.stop()
                self._set(self.params.moved({}))  # what a motion alone sets isn't left half way

    def touch(self) -> None:
        """Somebody does something here."""
        self.touched_at = time.monotonic()

    @property
    def occupied(self) -> bool:
        """Somebody looks at it."""
        return bool(self.drawing.viewers or self.telling.listeners)

    def state(self) -> Message:
        """The state message for pages."""
        return self._state(self.params)

    async def solved_state(self) -> Message:
        """The same with the solution, once the newest state is solved; both are of the state that is solved."""
        await self.drawing.drawn(SOLVED_WITHIN)
        solution = None if self.solution is None else jsonable(self.solution)
        return {**self._state(self.drawing.solved), "solution": solution}

    def _state(self, params: Params) -> Message:
        words = self.drawing.words
        if not words and self.solution is not None:
            words = self.sim.describe(self.drawing.solved, self.solution)
        message = {
            "type": "state", "version": self.version, "params": params.model_dump(mode="json"),
            "query": params.query(), "text": words,
        }  # fmt: skip
        if self.sim.challenges and self.solution is not None:
            message["challenges"] = self._checked()
        return message

    def _checked(self) -> dict[str, Any]:
        """How near the state that is solved is to each challenge, coming from the one that was told before."""
        params, solution = self.drawing.solved, self.solution
        if not self._told or self._told[-1][0] != params:
            self._told = (*self._told[-1:], (params, solution))
            before = self._told[0] if len(self._told) > 1 else None
            self._near = self._near_to(params, solution, before)
        return self._near

    def _near_to(self, params: Params, solution: Any, before: tuple[Params, Any] | None) -> dict[str, Any]:
        """The same of one state. A check that fails keeps no state from its pages."""
        try:
            return checked(self.sim.challenges, params, solution, before)
        except Exception:
            metrics.FAILURES.labels(self.sim.slug, "check").inc()
            log.exception("checking the challenges of %s failed in the state %s", self.sim.slug, params.query())
            return {}

    # ---- its tasks

    def _tasks(self) -> list[asyncio.Task[None]]:
        return [task for task in (self._looking_up.task, self.drawing.task) if task is not None]

    async def settled(self) -> None:
        """Wait until nothing is looked up and the newest state is drawn. A motion goes on meanwhile."""
        while tasks := self._tasks():
            await asyncio.wait(tasks)

    async def rested(self) -> None:
        """Wait until no motion runs, and all is settled."""
        await self.settled()
        while (moving := self.motion.task) is not None:
            await asyncio.wait([moving])
        await self.settled()

    def end(self) -> list[asyncio.Task[None]]:
        """Give back what the session keeps elsewhere, and give up its work; what still has to end is returned."""
        for name in [*self.uploads]:
            self.forget(name)
        self._solver.memory.free(self.drawing)
        self.motion.stop()
        self.telling.end()
        self.audience.end()
        working = self._tasks()
        for task in working:
            task.cancel()
        return working
