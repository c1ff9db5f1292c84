"""viser's controls of a sim's parameters: one for each kind of field, made from what the kind says."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, Protocol

import viser

from sims.kit import fields
from sims.kit.entries import Entries
from sims.kit.offers import Offers
from sims.kit.params import Params
from sims.kit.sim import Typed
from sims.kit.viser_internals import set_property, set_value

OTHER = "another"
"""What a list of presets shows for a value that isn't one of them."""
Change = Callable[[Mapping[str, Any]], None]
AnyOffers = Offers[Any]
Listen = Callable[[Any, Callable[[Any], None]], None]
"""Told of a handle, and of what takes the values that a page sets it to."""


class Control(Protocol):
    """What shows a parameter, and is told of each state."""

    def draw(self, offers: AnyOffers) -> None: ...

    def reword(self, offers: AnyOffers) -> None:
        """Adapt label, bounds and what is offered, before a value that needs them is drawn."""


def controls(
    gui: viser.GuiApi,
    offers: AnyOffers,
    name: str,
    *,
    disabled: bool,
    listen: Listen,
    change: Change,
) -> Iterator[Control]:
    """Make the controls of a parameter; what a page sets them to is told to `change`."""
    shared = {"hint": type(offers.params).model_fields[name].description, "disabled": disabled}
    kind = offers.params.kinds[name]
    if isinstance(kind, fields.Numbers | fields.Letters):
        yield Entries(gui, offers, name, shared, listen, change)
        return
    control = _control(gui, offers, name, kind, shared)
    listen(control.handle, lambda shown: change({name: control.value(shown)}))
    yield control
    if isinstance(kind, fields.Vector) and kind.presets:
        presets = kind.presets
        label = f"{kind.title}: preset"
        handle = gui.add_dropdown(label, (*presets, OTHER), hint="Values to choose from", disabled=disabled)
        listen(handle, lambda shown: change({name: presets[shown]} if shown in presets else {}))
        yield Preset(name, handle, {value: word for word, value in presets.items()})


def _control(gui: viser.GuiApi, offers: AnyOffers, name: str, kind: fields.Kind, shared: Any) -> Single:
    label, value = worded(offers, name), getattr(offers.params, name)
    match kind:
        case fields.Switch():
            return Single(name, gui.add_checkbox(label, value, **shared), label)
        case fields.Vector():
            least, greatest = zip(*kind.each, strict=True)
            add: Any = gui.add_vector2 if len(kind.each) == 2 else gui.add_vector3
            return Single(name, add(label, value, min=least, max=greatest, step=kind.step, **shared), label)
        case fields.Slider():
            return Slider.made(gui, offers, name, label, shared)
        case fields.NumberBox():
            return NumberBox.made(gui, offers, name, label, shared)
        case _:
            return Dropdown.made(gui, offers, name, label, shared)


@dataclass
class Single:
    """A control of one field."""

    name: str
    handle: Any
    label: str

    def draw(self, offers: AnyOffers) -> None:
        set_value(self.handle, self.shown(getattr(offers.params, self.name)))

    def shown(self, value: Any) -> Any:
        """What the control says for a value."""
        return value

    def value(self, shown: Any) -> Any:
        """What the learner set. Raises LookupError for what isn't offered."""
        return shown

    def reword(self, offers: AnyOffers) -> None:
        if (label := worded(offers, self.name)) != self.label:
            self.label = self.handle.label = label


@dataclass
class Slider(Single):
    """Its bounds and steps may change with the state."""

    bounds: tuple[float, float]
    increment: float

    @classmethod
    def made(cls, gui: viser.GuiApi, offers: AnyOffers, name: str, label: str, shared: Any) -> Slider:
        bounds, increment = offers.bounds(name), offers.increment(name)
        handle = gui.add_slider(label, *bounds, increment, getattr(offers.params, name), **shared)
        return cls(name, handle, label, bounds, increment)

    def reword(self, offers: AnyOffers) -> None:
        if (bounds := offers.bounds(self.name)) != self.bounds:
            self.bounds = bounds
            self.handle.min, self.handle.max = bounds
        if (increment := offers.increment(self.name)) != self.increment:
            self.increment = self.handle.step = increment
            self.handle.precision = decimals(increment)
        super().reword(offers)


@dataclass
class NumberBox(Single):
    """A number that may be absent has a box in which one step below the least value stands for that."""

    absent: float | None

    @classmethod
    def made(cls, gui: viser.GuiApi, offers: AnyOffers, name: str, label: str, shared: Any) -> NumberBox:
        (low, high), step = offers.bounds(name), offers.increment(name)
        absent: float | None = None
        if type(offers.params).model_fields[name].default is None:
            low = absent = low - step
        value = getattr(offers.params, name)
        add: Any = gui.add_number  # its type wants the numbers all whole, or none
        handle = add(label, absent if value is None else value, min=low, max=high, step=step, **shared)
        return cls(name, handle, label, absent)

    def shown(self, value: Any) -> Any:
        return self.absent if value is None else value

    def value(self, shown: Any) -> Any:
        return None if self.absent is not None and shown == self.absent else shown


@dataclass
class Dropdown(Single):
    """Offers what the state's `options` say."""

    offered: Mapping[Any, str]

    @classmethod
    def made(cls, gui: viser.GuiApi, offers: AnyOffers, name: str, label: str, shared: Any) -> Dropdown:
        offered = offers.options(name)
        value = offered[getattr(offers.params, name)]
        return cls(
            name, gui.add_dropdown(label, tuple(offered.values()), initial_value=value, **shared), label, offered
        )

    def shown(self, value: Any) -> Any:
        return self.offered[value]

    def value(self, shown: Any) -> Any:
        return {words: value for value, words in self.offered.items()}[shown]

    def reword(self, offers: AnyOffers) -> None:
        if (offered := offers.options(self.name)) != self.offered:
            self.offered = offered
            set_property(self.handle, "options", tuple(offered.values()))
        super().reword(offers)


@dataclass
class Preset:
    """A dropdown beside another control, with names for some of its values."""

    name: str
    handle: Any
    words: Mapping[Any, str]

    def draw(self, offers: AnyOffers) -> None:
        set_value(self.handle, self.words.get(getattr(offers.params, self.name), OTHER))

    def reword(self, offers: AnyOffers) -> None:
        """Its words don't depend on the state."""


@dataclass
class TypedPlace:
    """Three numbers that set what dragging a node sets; hidden while there is no such place."""

    typed: Typed[Any, Any]
    handle: Any
    visible: bool = True

    def draw(self, params: Params, solution: Any) -> None:
        place = self.typed.place(params, solution)
        set_value(self.handle, place or (0.0, 0.0, 0.0))
        if self.visible != (place is not None):
            self.visible = self.handle.visible = place is not None


def worded(offers: AnyOffers, name: str) -> str:
    """The label of a control, with its unit."""
    kind = offers.params.kinds[name]
    unit = kind.unit if isinstance(kind, fields.Numeric) else ""
    return f"{offers.label(name)} ({unit})" if unit else offers.label(name)


def decimals(increment: float) -> int:
    """How many decimals a slider of such steps needs."""
    return min(max(-int(Decimal(f"{increment:.3g}").normalize().as_tuple().exponent), 0), 9)
