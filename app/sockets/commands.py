"""What one page tells its session, and the one place where that can go wrong without harm."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from app.rooms.session import Session
from app.trouble import Unknown, error_message, refused
from app.values import shown, strict
from sims.kit.entered import NotMeant
from sims.kit.refusals import Complaint
from sims.kit.types import Vector

LONGEST_GLIDE = 60.0
"""Seconds."""
T = TypeVar("T")
Answer = Callable[[dict[str, Any]], None]


class Commands:
    """Does to a session what one page says. What can't be done is told to that page, and the session goes on."""

    def __init__(self, session: Session, answer: Answer) -> None:
        self._session = session
        self._answer = answer

    def attempt(self, command: Callable[..., T], *arguments: Any) -> T | None:
        """What something answers that may fail, be it by a value that nobody has foreseen; then None."""
        try:
            return command(*arguments)
        except Exception as error:
            given = next((a for a in arguments if isinstance(a, Mapping)), None)
            self._answer(error_message(self._session.sim, error, given))
            return None

    def set(self, params: Mapping[str, Any], seconds: float | None) -> None:
        """Take parameters from the page around the sim, at once or within some seconds; bad ones are refused."""
        if seconds is not None and not 0.0 < seconds <= LONGEST_GLIDE:
            allowed = f"a number above 0, at most {LONGEST_GLIDE:g}"
            self._answer(refused("", Complaint("seconds", shown(seconds), allowed)))
            return
        self.attempt(self._set, params, seconds)

    def _set(self, params: Mapping[str, Any], seconds: float | None) -> None:
        session = self._session
        state = strict(session.sim.params, params, session.params.__dict__).__dict__
        changes = {name: state[name] for name in params}
        if seconds is None:
            session.change(changes, live=False)
        else:
            session.glide(changes, seconds)

    def slide(self, name: str, value: float) -> None:
        """Take what a slider is moved to."""
        self._control(name, self._session.slide, name, value)

    def enter(self, name: str, text: str) -> None:
        """Take what was typed or chosen; what can't be taken is said beside its control."""
        self._control(name, self._session.enter, name, text)

    def _control(self, name: str, take: Callable[..., None], *given: Any) -> None:
        try:
            take(*given)
        except NotMeant as error:
            self._answer({**refused(str(error)), "control": name})
        except Exception as error:
            self._answer({**error_message(self._session.sim, error, beside=True), "control": name})

    def drag(self, name: str, place: tuple[float, ...]) -> None:
        """Take the place where a handle was dragged to."""
        self.attempt(self._session.drag, name, place)

    def click(self, name: str, ray: tuple[float, ...]) -> None:
        """Take a click on a node of the scene: the origin and direction of its ray."""
        self.attempt(self._session.click, name, ray)

    def pass_over(self, ray: tuple[float, ...] | None) -> None:
        """Show what is under the pointer; the page hears when that is done, and says where it is by then."""
        self.attempt(self._session.pass_over, ray, self._answer)

    def hold(self, name: str, pixel: tuple[float, float]) -> None:
        """Take the place where a handle in a picture was dragged to; those of the scene have names with a slash."""
        self.attempt(self._hold, name, pixel)

    def _hold(self, name: str, pixel: tuple[float, float]) -> None:
        if name.startswith("/"):
            pictured = [known for known in self._session.sim.handles if not known.startswith("/")]
            raise Unknown("handle in a picture", name, pictured)
        self._session.drag(name, pixel)

    def act(self, name: str) -> None:
        """Press a button."""
        self.attempt(self._session.act, name)

    def home(self, position: Vector, look_at: Vector, radius: float, *, moved: bool = True) -> None:
        """Tell the page from where the scene is looked at by itself from now on, and whether its camera is there."""
        view = [*map(float, position), *map(float, look_at)]
        self._answer({"type": "home", "view": view, "radius": float(radius), "moved": moved})

    def select(self, name: str) -> None:
        """Select what is linked under a name."""
        self.attempt(self._session.select, name)
