"""The controls of a sim's parameters, as HTML: one for each kind of field, made from what the kind says.

Each input has a name: that of its parameter, or, where a parameter has several inputs, with what it is of: `point.2`
is the third number, `axis:preset` what chooses one of its presets. `values` says what each input shows.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import Any

from sims.kit import fields
from sims.kit.offers import Offers
from sims.kit.spelling import shown_number, spell

OTHER = "another"
"""What a list of presets shows for a value that isn't one of them."""
SHORT = 34
"""Letters that the words of a choice may have together to stand side by side."""
LETTERS = {2: "uv", 3: "xyz", 4: "wxyz"}
AnyOffers = Offers[Any]
Shown = float | str | bool | None


def key(value: Any) -> str:
    """A value that is chosen, as the page tells it; absent is empty."""
    return "" if value is None else spell(value)


def unit_of(kind: fields.Kind) -> str:
    """The unit of a kind's numbers."""
    return kind.unit if isinstance(kind, fields.Numeric) else ""


def letters(kind: fields.Vector) -> Sequence[str]:
    """What each number of a vector is called."""
    return LETTERS.get(len(kind.each)) or [str(k + 1) for k in range(len(kind.each))]


def values(offers: AnyOffers) -> dict[str, Shown]:
    """What each input shows in a state."""
    found: dict[str, Shown] = {}
    params = offers.params
    for name in params.visible:
        value = getattr(params, name)
        match kind := params.kinds[name]:
            case fields.Vector():
                for k, entry in enumerate(value or ()):
                    found[f"{name}.{k}"] = entry
                if kind.presets:
                    found[f"{name}:preset"] = next((w for w, v in kind.presets.items() if v == value), "")
            case fields.Numbers() | fields.Letters():
                found |= {f"{name}.{k}": entry for k, entry in enumerate(offers.entries(name)) if entry is not None}
            case fields.Switch() | fields.Slider() | fields.NumberBox():
                found[name] = value
            case _:
                found[name] = key(value)
    return found


def html(offers: AnyOffers, name: str, *, filled: bool = True) -> str:
    """The controls of a parameter, which show its value where they are `filled`."""
    kind = offers.params.kinds[name]
    value = getattr(offers.params, name) if filled else None
    about = offers.about(name)
    label = offers.label(name)
    match kind:
        case fields.Switch():
            return switch(name, label, bool(value), about)
        case fields.Vector():
            return _vector(name, kind, label, value, about)
        case fields.Numbers():
            return "".join(_entries(offers, name, kind, filled, about))
        case fields.Letters():
            return "".join(_letters(offers, name, kind, filled, about))
        case fields.Slider():
            default = type(offers.params).model_fields[name].default
            inside = slider(
                name, label, value, offers.bounds(name), offers.increment(name), kind.unit, default,
                offers.params.regions().get(name, ()),
            )  # fmt: skip
            return control(name, label, inside, about, kind="s3-line", target=f"s-{name}")
        case fields.Opened():
            return ""  # the folds are its control
        case fields.NumberBox():
            inside = box(name, label, value, kind.unit, offers.increment(name), steps=True)
            return control(name, label, inside, about, kind="s3-one", target=f"b-{name}")
    return _choice(offers, name, label, key(value) if filled else None, about)


def control(name: str, label: str, inside: str, about: str, *, kind: str = "", target: str = "") -> str:
    """A control with its label, and what it means."""
    ident = ident_of(name)
    words = (
        f'<label for="{ident_of(target)}">{_worded(label)}</label>'
        if target
        else f'<span class="s3-name" id="n-{ident}">{_worded(label)}</span>'
    )
    ask, why = asked(ident, label, about)
    group = "" if target else f' role="group" aria-labelledby="n-{ident}"'
    return _framed(name, kind, f'<div class="s3-label">{words}{ask}</div>{inside}{why}', group)


def _framed(name: str, kind: str, inside: str, more: str = "") -> str:
    """What a control stands in, with room for what is wrong with what somebody entered; `more` are attributes."""
    return (
        f'<div class="s3-control {kind}" data-control="{escape(name)}" data-link="{escape(name)}"{more}>'
        f'{inside}<p class="s3-wrong" role="alert" hidden=""></p></div>'
    )


def asked(ident: str, label: str, about: str) -> tuple[str, str]:
    """A button that asks what something is, and the answer, which is hidden at first."""
    if not about:
        return "", ""
    ask = (
        f'<button type="button" class="s3-ask" aria-expanded="false" aria-controls="w-{ident}"'
        f' aria-label="About {escape(label)}">?</button>'
    )
    return ask, f'<p class="s3-why" id="w-{ident}" hidden="">{escape(about)}.</p>'


def ident_of(name: str) -> str:
    """What stands for a name in an identifier of the page."""
    return name.replace("/", "-").replace(".", "-").replace(":", "-")


def slider(
    name: str, label: str, value: float | None, bounds: tuple[float, float], step: float, unit: str,
    default: Any = None,
    regions: Sequence[tuple[float, float]] = (),
) -> str:  # fmt: skip
    """A slider with its number; `regions` are marked on its track."""
    low, high = bounds
    span = (high - low) or 1.0
    marks = "".join(
        f'<i class="s3-region" style="left:{100 * (a - low) / span:.3f}%;width:{100 * (b - a) / span:.3f}%"></i>'
        for a, b in regions
    )
    home = f' data-default="{default!r}"' if isinstance(default, int | float) else ""
    at = "" if value is None else f' value="{value!r}"'
    return (
        f'<div class="s3-slide"><span class="s3-track">{marks}<input type="range" id="s-{ident_of(name)}"'
        f' data-slide="{escape(name)}" min="{low!r}" max="{high!r}" step="any" data-step="{step!r}"{home}{at}/></span>'
        f"{box(name, label, value, unit, step)}</div>"
    )


def box(name: str, label: str, value: float | None, unit: str, step: float, *, steps: bool = False) -> str:
    """A number that is typed; with `steps`, buttons beside it go one step down or up."""
    says = f"{label}, number" + (f" in {unit}" if unit else "")
    text = "" if value is None else shown_number(value)
    buttons = [
        f'<button type="button" data-nudge="{sign}" aria-label="{words} {escape(label)}">{shown}</button>'
        for sign, words, shown in ((-1, "One less:", "−"), (1, "One more:", "+"))
    ] if steps else ["", ""]  # fmt: skip
    return (
        f'<span class="s3-box">{buttons[0]}<input type="text" id="b-{ident_of(name)}" data-box="{escape(name)}"'
        f' data-step="{step!r}" aria-label="{escape(says)}" value="{text}" placeholder="–"'
        ' autocomplete="off" spellcheck="false"/>'
        + (f'<span class="s3-unit">{escape(unit)}</span>' if unit else "")
        + f"{buttons[1]}</span>"
    )


def switch(name: str, label: str, value: bool, about: str) -> str:
    """On or off."""
    ident = ident_of(name)
    ask, why = asked(ident, label, about)
    on = ' checked=""' if value else ""
    box = f'<input type="checkbox" role="switch" data-switch="{escape(name)}"{on}/>'
    words = f'<div class="s3-label"><label>{box} {_worded(label)}</label>{ask}</div>{why}'
    return _framed(name, "s3-switch", words)


def select(name: str, label: str, options: Mapping[str, str], chosen: str | None) -> str:
    """One of several words, as a list that opens."""
    inside = "".join(
        f'<option value="{escape(value)}"{_if(value == chosen, "selected")}>{escape(words)}</option>'
        for value, words in options.items()
    )
    ident = ident_of(name)
    return f'<select id="s-{ident}" data-choice="{escape(name)}" aria-label="{escape(label)}">{inside}</select>'


def radios(name: str, options: Mapping[str, str], chosen: str | None) -> str:
    """One of a few short words, side by side."""
    inside = "".join(
        f'<label><input type="radio" name="{escape(name)}" data-choice="{escape(name)}" value="{escape(value)}"'
        f"{_if(value == chosen, 'checked')}/><span>{escape(words)}</span></label>"
        for value, words in options.items()
    )
    return f'<div class="s3-radios">{inside}</div>'


def vector(
    name: str, label: str, entries: Sequence[str], values: Sequence[float | None], unit: str, step: float
) -> str:
    """Several numbers that belong together, each with its letter."""
    boxes = "".join(
        f'<span class="s3-entry s3-letter-{escape(letter)}"><i aria-hidden="true">{escape(letter)}</i>'
        f"{box(f'{name}.{k}', f'{label}, {letter}', value, '', step)}</span>"
        for k, (letter, value) in enumerate(zip(entries, values, strict=True))
    )
    return f'<div class="s3-vector" data-vector="{escape(name)}">{boxes}' + (
        f'<span class="s3-unit">{escape(unit)}</span></div>' if unit else "</div>"
    )


def _vector(name: str, kind: fields.Vector, label: str, value: Any, about: str) -> str:
    inside = vector(name, label, letters(kind), value or (None,) * len(kind.each), kind.unit, kind.step)
    if kind.presets:
        chosen = next((words for words, preset in kind.presets.items() if preset == value), "")
        inside += select(f"{name}:preset", f"{label}: preset", {"": OTHER, **{w: w for w in kind.presets}}, chosen)
    return control(name, label, inside, about, kind="s3-line")


def _choice(offers: AnyOffers, name: str, label: str, chosen: str | None, about: str) -> str:
    options = {key(value): words for value, words in offers.options(name).items()}
    if 1 < len(options) <= 3 and sum(map(len, options.values())) <= SHORT:
        return control(name, label, radios(name, options, chosen), about, kind="s3-few")
    return control(name, label, select(name, label, options, chosen), about, kind="s3-one", target=f"s-{name}")


def _entries(offers: AnyOffers, name: str, kind: fields.Numbers, filled: bool, about: str) -> Iterator[str]:
    defaults = type(offers.params).model_fields[name].default
    for k, value in enumerate(offers.entries(name)):
        if value is None:
            continue
        entry, label = f"{name}.{k}", offers.entry_label(name, k)
        default = defaults[k] if k < len(defaults) else None
        at = value if filled else None
        inside = slider(entry, label, at, offers.bounds(name), offers.increment(name), kind.unit, default)
        yield control(entry, label, inside, "" if k else about, kind="s3-line", target=f"s-{entry}")


def _letters(offers: AnyOffers, name: str, kind: fields.Letters, filled: bool, about: str) -> Iterator[str]:
    for k, value in enumerate(offers.entries(name)):
        entry, label = f"{name}.{k}", offers.entry_label(name, k)
        inside = select(entry, label, kind.labels, value if filled else None)
        yield control(entry, label, inside, "" if k else about, kind="s3-one", target=f"s-{entry}")


def _if(so: bool, attribute: str) -> str:
    """An attribute that is there or not."""
    return f' {attribute}=""' if so else ""


def _worded(label: str) -> str:
    """A label, with the symbol in it as in a formula."""
    words = [f"<var>{escape(word)}</var>" if _is_symbol(word) else escape(word) for word in label.split(" ")]
    return " ".join(words)


def _is_symbol(word: str) -> bool:
    return word in {"fx", "fy", "cx", "cy"} or (len(word) == 1 and (word.islower() or "α" <= word <= "ω"))
