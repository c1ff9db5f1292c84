"""What a sim is: its parameters, its mathematics, its scene, and the words around them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from sims.kit.challenge import Challenge
from sims.kit.offers import Offers
from sims.kit.pane import Pane
from sims.kit.params import Params
from sims.kit.paste import Paste
from sims.kit.readout import Readout
from sims.kit.scene.stage import Stage
from sims.kit.view import View

DRAWN: Mapping[str, Any] = {"drawn": True}
"""Metadata of a Solution's field that the scene alone needs: too large to go out."""
P = TypeVar("P", bound=Params)
S = TypeVar("S")
P_in = TypeVar("P_in", bound=Params, contravariant=True)
S_in = TypeVar("S_in", contravariant=True)


class Scene(Protocol[P_in, S_in]):
    """Viser nodes, built once for one viewer; `draw` assigns what follows from the state.

    One whose things are linked with pictures and tables also has `highlight(name)`: it highlights what somebody hovers
    over, or nothing for a name that it doesn't know. It is told again after each `draw`.
    One of a sim that says what is under the pointer has `under(found)`: it shows that, or nothing for None.
    """

    def __init__(self, stage: Stage) -> None: ...

    def draw(self, params: P_in, solution: S_in) -> None: ...


@dataclass(frozen=True)
class Step:
    """One leg of a motion: numbers glide to `changes` within `seconds`; the rest is set at its start."""

    changes: Mapping[str, Any]
    seconds: float
    even: bool = False
    """At one speed: for the legs of a path that isn't straight, which is eased as a whole."""
    words: str = ""
    """What is to be seen in this leg, in a sentence: the caption while it plays."""


@dataclass(frozen=True)
class Action:
    """A button: from a state to the next one, or to a motion that ends in one."""

    name: str
    label: str
    hint: str
    run: Callable[..., Mapping[str, Any] | Iterator[Step]]
    group: str = ""
    """Fold in which it stands, closed at first; of those in none, the first one is what people do first."""
    aliases: tuple[str, ...] = ()
    """Names that it had before: course pages may know it by them."""

    @property
    def names(self) -> tuple[str, ...]:
        """Its name, and those that it had before."""
        return self.name, *self.aliases


@dataclass(frozen=True)
class Typed(Generic[P, S]):
    """The same as dragging a node of the scene, by number: three boxes that tell `handle` a place in metres.

    They show the place that `place` finds, and hide where there is none. They are not state: what the handle sets is.
    """

    handle: str
    title: str
    description: str
    low: tuple[float, float, float]
    high: tuple[float, float, float]
    place: Callable[[P, S], tuple[float, float, float] | None]
    step: float = 0.01
    unit: str = "m"


@dataclass(frozen=True)
class Dial(Generic[P, S]):
    """A slider for a number that follows from the state; `handle` is told the number, as the only one of its place.

    It shows what `value` finds, and hides where there is none. It is not state: what the handle sets is.
    """

    handle: str
    title: str
    description: str
    low: float
    high: float
    value: Callable[[P, S], float | None]
    step: float
    unit: str = ""


class Library(Protocol):
    """The files that a server's sessions can show."""

    def add(self, name: str, data: bytes) -> tuple[str, Mapping[str, Any]]:
        """Take a learner's file; return what it is known as, and the changes of the state that show it.

        Runs beside the event loop. Raises ValueError in words for the learner.
        """

    def remove(self, known_as: str) -> None:
        """Forget a learner's file."""


@dataclass(frozen=True)
class Files:
    """Files that a learner may upload.

    The sim's `solve`, `offers`, actions, handles and downloads, and the `preview`, get the server's library of them as
    their last argument.
    """

    group: str
    """Fold of the controls in which a file is uploaded."""
    endings: tuple[str, ...]
    library: Callable[[Path | None, int], Library]
    """Makes a server's library, of the administrator's folder and the largest number of bytes that a file may have."""
    previewed: str = ""
    """The parameter above whose controls the `preview` stands: what a file holds, or None."""
    preview: Callable[..., Readout | None] = lambda *_: None


@dataclass(frozen=True)
class Objective:
    """What a learner can do afterwards, with its level in Bloom's taxonomy."""

    text: str
    level: str


@dataclass(frozen=True, kw_only=True)
class Sim(Generic[P, S]):
    """One entry of the registry."""

    slug: str
    title: str
    summary: str
    concepts: tuple[str, ...]
    objectives: tuple[Objective, ...]
    params: type[P]
    solve: Callable[..., S]
    """From the parameters to their solution."""
    scene: type[Scene[P, S]]
    caption: Callable[[P, S], str]
    """In one sentence: what to do now, or what to see."""
    readouts: Callable[[P, S], Iterable[Readout]]
    describe: Callable[[P, S], str]
    """In one sentence, for people who can't see the scene: what is there."""
    view: View
    actions: Sequence[Action] = ()
    folds: Sequence[str] = ()
    """Titles of the folds that read-outs stand in, in the order of the page; groups of controls alone come after."""
    view_of: Callable[[P], View] | None = None
    """The first view of a state, where it isn't always `view`."""
    seen: Callable[[P, S], Iterable[npt.ArrayLike]] | None = None
    """Places in the world that must be in sight: where a state moves them out of the view, it steps back."""
    panes: Callable[[P, S], Sequence[Pane]] | None = None
    selects: str = "selected"
    """The parameter that a click on what is linked across scene, pictures and tables sets."""
    offers: Callable[..., Offers[P]] = Offers
    """What the controls offer, of parameters and the last solution (None before there is one)."""
    handles: Mapping[str, Callable[..., Mapping[str, Any]]] = field(default_factory=dict)
    """What dragging a node or a mark in a picture changes: of parameters and the place, in metres or pixels."""
    clicks: Mapping[str, Callable[..., Mapping[str, Any]]] = field(default_factory=dict)
    """What a click into the scene changes, by the names that the scene gave to `Stage.rays`: of parameters and ray."""
    under: Callable[..., object] | None = None
    """What is under a pointer that passes over the scene: of parameters and its ray; None is nothing.

    It is no state: the scene shows it until the next drawing.
    """
    eases: Callable[[P, P], Iterator[Step]] | None = None
    """What is seen of a change when somebody chose or typed something, unless motion is reduced.

    From the state before and the one that it leads to, which the last step must restore; the first is taken at once.
    """
    typed: Sequence[Typed[P, S]] = ()
    dials: Sequence[Dial[P, S]] = ()
    """They stand before the other controls."""
    challenges: Sequence[Challenge[P, S]] = ()
    states: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    files: Files | None = None
    paste: Paste[P] | None = None
    """Text of a person's own that becomes a state."""
    downloads: Mapping[str, Callable[..., bytes]] = field(default_factory=dict)
    """Files that can be had of a state, by name."""
    heavy: bool = False
    """Solving can take over 5 ms: it runs in the pool, beside the event loop, as do actions and handles."""
    ahead: Sequence[Callable[[], object]] = ()
    """Work that somebody will need soon: done one after the other when the sim was first opened on a server."""

    def home(self, params: P, solution: S | None) -> View:
        """From where a state is looked at by itself."""
        view = self.view if self.view_of is None else self.view_of(params)
        return view if self.seen is None or solution is None else view.holding(self.seen(params, solution))


@dataclass(frozen=True)
class Contract:
    """What other people's pages rely on. A name may be added; one that stands here may not go or change.

    Names of parameters and of the solution's fields, with blanks between, and one link as it stands in course pages
    with the state (without what is at its default) that it has always meant. A renamed parameter keeps its old name as
    an alias.
    """

    parameters: str
    solution: str
    link: str
    state: Mapping[str, Any]


def jsonable(value: Any) -> Any:
    """A Solution as JSON: arrays as nested lists by rows; what doesn't exist (NaN, infinite) as null."""
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: jsonable(getattr(value, f.name)) for f in fields(value) if not f.metadata.get("drawn")}
    if isinstance(value, float):
        return value + 0.0 if math.isfinite(value) else None
    if isinstance(value, np.ndarray):
        return _listed(value)
    if isinstance(value, Mapping):
        return {str(k): jsonable(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [jsonable(v) for v in value]
    if isinstance(value, np.generic):
        return jsonable(value.item())
    return value


def _listed(array: np.ndarray[Any, Any]) -> Any:
    """Whole arrays at once: number by number takes ten times as long."""
    if array.dtype.kind != "f":
        return array.tolist()
    finite, numbers = np.isfinite(array), array + 0.0
    if not finite.all():
        numbers = numbers.astype(object)
        numbers[~finite] = None
    return numbers.tolist()
