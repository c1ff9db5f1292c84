"""Every sim of the registry, at its defaults, its bounds, its choices and its named states."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any
from urllib.parse import parse_qsl

import numpy as np
import numpy.typing as npt
import pytest
from pydantic import ValidationError

from geometry import GeometryError
from sims import SIMS, by_slug
from sims.kit import pane, readout
from sims.kit.column import Column
from sims.kit.controls import key
from sims.kit.fields import Choice, Letters, Numbers, Opened, OptionalNumber, Slider, Switch, Text, Vector
from sims.kit.params import Params
from sims.kit.scene.view import FIELD
from sims.kit.sim import Sim, jsonable
from tests.frames import SceneModel, differences
from tests.per_sim import per_sim
from tests.server import Browser, Rig
from tests.sims.cases import ALL, FEW, FEW_NAMES, NAMES, solved
from tests.sims.contract import contract_of
from tests.sims.markup import bad_attributes, bad_numbers, mistakes, without_code, words, xml

AnySim = Sim[Any, Any]
Array = npt.NDArray[np.float64]
MOST_LABELS = 7
MODELS: dict[str, type[Params]] = {sim.slug: sim.params for sim in SIMS}
NUMERIC = {slug: model.numeric for slug, model in MODELS.items()}
each_sim = pytest.mark.parametrize("sim", SIMS, ids=lambda sim: sim.slug)
each_state = per_sim(("sim", "name", "params"), ALL, NAMES)
TYPED = [case for case in ALL if case[0].typed or case[0].dials]
few_states = per_sim(("sim", "name", "params"), FEW, FEW_NAMES)


def few_of(sim: AnySim) -> list[Params]:
    """The states of a sim that aren't bounds."""
    return [params for each, _, params in FEW if each is sim]


COLUMNS: dict[Params, tuple[dict[str, str], dict[str, Any], str]] = {}


def column_of(sim: AnySim, params: Params) -> tuple[dict[str, str], dict[str, Any], str]:
    """Parts, what inputs show, and markup of a column made for a state alone, once for all tests of a process."""
    if params not in COLUMNS:
        fresh, solution = Column(sim), solved(sim, params)
        COLUMNS[params] = *fresh.of(params, solution), fresh.html(params, solution)
    return COLUMNS[params]


def remembering(sim: AnySim) -> AnySim:
    """The sim, which solves no state twice: that a state has one solution is a test of its own."""
    return replace(sim, solve=lambda params, *_: solved(sim, params))


class Rigs(dict[str, Rig]):
    """A session by each sim's slug, begun when it is asked for."""

    def __missing__(self, slug: str) -> Rig:
        sim = by_slug(slug)
        assert sim is not None
        return self.setdefault(slug, Rig(remembering(sim)))


@pytest.fixture(scope="module")
def rigs() -> Iterator[dict[str, Rig]]:
    """A session of each sim with one browser, which the tests lead from state to state."""
    made = Rigs()
    yield made
    for rig in made.values():
        rig.close()
        assert not rig.problems()


def parse(sim: AnySim, query: str) -> Params:
    params: Params = sim.params.from_query(parse_qsl(query, keep_blank_values=True))
    return params


# ---- parameters and links


@each_sim
def test_parameters_keep_the_names_of_the_contract(sim: AnySim) -> None:
    known = {*sim.params.model_fields, *(f.alias for f in sim.params.model_fields.values() if f.alias)}
    assert set(contract_of(sim).parameters.split()) <= known


@each_sim
def test_golden_link_keeps_its_meaning(sim: AnySim) -> None:
    contract = contract_of(sim)
    link, meaning = contract.link, contract.state
    params = parse(sim, link)
    assert {**params.model_dump(mode="json"), **meaning} == params.model_dump(mode="json")


@each_state
def test_link_of_a_state_leads_back_to_it(sim: AnySim, name: str, params: Params) -> None:
    assert parse(sim, params.query()) == params
    assert sim.params.model_validate(params.model_dump(mode="json")) == params
    assert sim.params.model_validate_json(params.model_dump_json()) == params


@each_sim
def test_defaults_are_left_out_of_the_link(sim: AnySim) -> None:
    opened = parse(sim, "")
    assert opened == sim.params(**sim.params.opening)
    assert opened.query() == ""
    assert len(sim.params().query_items()) == bool(sim.params.opening), "the state of the defaults has a link too"


@each_sim
def test_every_parameter_is_described_for_people(sim: AnySim) -> None:
    for name, field in sim.params.model_fields.items():
        assert sim.params.kinds[name].title, name
        assert field.description, name
        assert field.description[0].isupper(), name
        assert not field.description.endswith("."), name
        if isinstance(kind := sim.params.kinds[name], Choice):
            assert all(word == word.lower() for word in kind.words), name


@each_sim
def test_schema_says_bounds_and_words(sim: AnySim) -> None:
    properties = sim.params.model_json_schema()["properties"]
    for name in NUMERIC[sim.slug]:
        low, high = NUMERIC[sim.slug][name].bounds
        told = json.dumps(properties[name])
        assert f"{low}" in told, name
        assert f"{high}" in told, name
    for name, kind in sim.params.kinds.items():
        if isinstance(kind, Choice):
            told = properties[name]
            assert list(kind.words) in [kind.get("enum") for kind in (told, *told.get("anyOf", ()))]


@each_sim
def test_slug_finds_the_sim(sim: AnySim) -> None:
    assert by_slug(sim.slug) is sim
    assert by_slug(sim.slug.upper()) is None


# ---- the mathematics as others get it


@each_state
def test_solution_is_finite_json_with_the_fields_of_the_contract(sim: AnySim, name: str, params: Params) -> None:
    solution = jsonable(solved(sim, params))
    assert set(contract_of(sim).solution.split()) <= set(solution)
    text = json.dumps(solution, allow_nan=False)
    assert "-0.0," not in text, "a negative zero goes out"


@each_state
def test_solving_is_a_function_of_the_parameters(sim: AnySim, name: str, params: Params) -> None:
    assert jsonable(sim.solve(params.model_copy())) == jsonable(solved(sim, params))


@each_state
def test_numbers_beside_the_scene_are_for_people(sim: AnySim, name: str, params: Params) -> None:
    html = readout.render(sim.readouts(params, solved(sim, params)))
    assert not bad_numbers(words(without_code(html)))
    assert not bad_attributes(html)
    assert not mistakes(html)


@each_state
def test_pictures_are_well_formed(sim: AnySim, name: str, params: Params) -> None:
    solution = solved(sim, params)
    shown = sim.panes(params, solution) if sim.panes else ()
    assert len({p.name for p in shown}) == len(shown)
    html = "".join(pane.content(p) for p in shown)
    assert not bad_numbers(words(html))
    assert not bad_attributes(html)
    assert not mistakes(html)
    handles = {e.get("data-handle") for e in xml(html).iter() if e.get("data-handle")}
    assert handles <= set(sim.handles), "a handle that the session doesn't know"


@each_state
def test_a_sentence_describes_the_state(sim: AnySim, name: str, params: Params) -> None:
    sentence = sim.describe(params, solved(sim, params))
    assert sentence.endswith(".")
    assert sentence[0].isupper() or sentence[0].isdigit()
    assert "  " not in sentence
    assert len(sentence) <= 300
    assert not bad_numbers(sentence)


# ---- what browsers see


@each_state
def test_every_state_draws(rigs: dict[str, Rig], sim: AnySim, name: str, params: Params) -> None:
    """What comes is what `Column` makes of the state, whose markup `test_the_column_is_whole` checks."""
    rig = rigs[sim.slug]
    rig.show(params)
    model = rig.model
    assert rig.session.params == params
    assert not rig.problems()
    assert rig.column.version == model.version == rig.session.version
    parts, own, _ = column_of(sim, params)
    assert rig.column.parts == parts
    assert {each: rig.column.values[each] for each in own} == own
    named = [text for text in model.labels().values() if len(text.strip("′'")) > 1]
    assert len(named) <= MOST_LABELS, named
    assert not [bad for text in named for bad in bad_numbers(text)]
    for node in map(model.node, filter(model.visible, model.names)):  # those that it is nested in are visible too
        assert np.isfinite(node.pose).all(), node.name
        for prop in {"points", "vertices", "scale"} & node.props.keys():
            assert np.isfinite(node.props[prop]).all(), (node.name, prop)


LETTER, EDGE, LINE = 7.3, 7.0, 19.0
"""Pixels of a label: about so wide a letter, and so much round it; its height."""


@each_sim
@pytest.mark.parametrize("size", [(385, 600), (850, 800)], ids=["beside", "large"])
def test_labels_are_in_sight_and_touch_none_as_a_sim_opens(
    rigs: dict[str, Rig], sim: AnySim, size: tuple[int, int]
) -> None:
    """The scene of a page of 700×600 pixels, and of one of 1280×800."""
    rig = rigs[sim.slug]
    rig.show(parse(sim, ""))
    view = sim.home(rig.session.params, rig.session.solution)
    middle, away = np.array(view.look_at), np.subtract(view.position, view.look_at)
    half = math.tan(0.5 * FIELD) * min(1.0, size[0] / size[1])
    eye = middle + away * (view.radius / math.sin(math.atan(half)) / np.linalg.norm(away))
    boxes = {name: box(rig.model, name, text, eye, middle, size) for name, text in rig.model.labels().items() if text}
    for name, (left, top, right, bottom) in boxes.items():
        assert min(left, top, size[0] - right, size[1] - bottom) >= 0, f"{name} is cut off"
        for other, (x, y, u, v) in boxes.items():
            apart = other >= name or min(right, u) - max(left, x) < 5 or min(bottom, v) - max(top, y) < 5
            assert apart, f"{name} and {other} touch"


def box(model: SceneModel, name: str, text: str, eye: Array, middle: Array, size: tuple[int, int]) -> list[float]:
    """Left, top, right and bottom of a label on the screen, in pixels."""
    forward = (middle - eye) / np.linalg.norm(middle - eye)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    place = model.world_pose(name)[:3, 3] - eye
    scale = 0.5 * size[1] / math.tan(0.5 * FIELD) / (place @ forward)
    u, v = 0.5 * size[0] + scale * (place @ right), 0.5 * size[1] + scale * (place @ np.cross(forward, right))
    wide, high = LETTER * len(text) + EDGE, LINE
    upright, _, level = model.node(name).props["anchor"].partition("-")
    x = u - wide * {"left": 0.0, "center": 0.5, "right": 1.0}[level]
    y = v - high * {"top": 0.0, "center": 0.5, "bottom": 1.0}[upright]
    return [float(each) for each in (x, y, x + wide, y + high)]


@each_sim
def test_scene_depends_on_the_state_alone(sim: AnySim) -> None:
    """Who saw other states before shows what was shown with others before these, and what one shows who has just come.

    One walk leads from each state to the next, another through them from the last, and back to the defaults after each.
    """
    start, few = sim.params(), few_of(sim)
    with Rig(remembering(sim)) as rig:
        seen = []
        for params in few:
            rig.show(params)
            seen.append(kept(rig.browser))
        for k, params in reversed([*enumerate(few)]):
            rig.show(params)
            assert not differences(seen[k], rig.browser.snapshot(), within=1e-12)
            latest = rig.join() if k % 3 == 0 else None
            if latest is not None:
                assert not differences(seen[k], latest.snapshot(), within=1e-12)
            rig.show(start)
            assert not differences(seen[0], rig.browser.snapshot(), within=1e-12)
            if latest is not None:
                assert not differences(rig.browser.snapshot(), latest.snapshot(), within=0.0)
                rig.browsers.remove(latest)
                latest.leave()


def kept(browser: Browser) -> dict[str, Any]:
    """What a browser shows now, which stays as it is when the browser is shown something else."""
    return {k: {**v, "props": dict(v["props"])} if isinstance(v, dict) else v for k, v in browser.snapshot().items()}


@each_sim
def test_the_dark_theme_changes_looks_alone(sim: AnySim) -> None:
    with Rig(sim) as rig:
        dark = rig.join(dark=True).model
        assert dark.names == rig.model.names
        for name in dark.names:
            assert np.array_equal(dark.world_pose(name), rig.model.world_pose(name)), name


# ---- the column


@each_state
def test_the_column_is_whole(sim: AnySim, name: str, params: Params) -> None:
    """Every part that a state has is on the page that begins with it, and the markup is sound."""
    parts, _, html = column_of(sim, params)
    assert not [bad for bad in bad_attributes(html) if not bad.startswith(("option", "button"))]  # which say "none"
    page = xml(html)
    places = [e.get("data-part") for e in page.iter() if e.get("data-part")]
    assert len(set(places)) == len(places)
    assert {*parts} <= {*places}
    idents = [e.get("id") for e in page.iter() if e.get("id")]
    assert len(set(idents)) == len(idents)
    assert {*readout.folded(sim.readouts(params, solved(sim, params)))} <= {"", *sim.folds}, (
        "a fold that isn't declared"
    )


@each_state
def test_controls_are_arranged_without_loss(sim: AnySim, name: str, params: Params) -> None:
    assert sorted(params.arranged) == sorted(params.visible)
    assert {params.about(each)[0].isupper() and not params.about(each).endswith(".") for each in params.visible} == {
        True
    }
    page = xml(Column(sim).html(params, None))
    stand = [e.get("data-part", "").removeprefix("control:") for e in page.iter() if e.get("data-part")]
    assert (
        Column(sim).of(params, None).parts["arranged"].split()
        == [n for n in stand if n in params.visible][: len([n for n in params.visible if not params.kinds[n].group])]
    )


@each_state
def test_a_caption_is_one_short_thought(sim: AnySim, name: str, params: Params) -> None:
    caption = sim.caption(params, solved(sim, params))
    assert caption.endswith(".")
    assert caption[0].isupper() or caption.startswith("q ")
    assert len(caption) <= 120
    assert not bad_numbers(caption)


@each_sim
def test_few_controls_are_seen_at_first(sim: AnySim) -> None:
    first = [name for name, kind in sim.params.kinds.items() if not kind.hidden and not kind.group]
    assert 1 <= len(first) + len(sim.typed) + len(sim.dials) <= 6
    assert len([action for action in sim.actions if not action.group]) <= 5


@each_sim
def test_every_control_says_what_it_is(sim: AnySim) -> None:
    page = xml(Column(sim).html(sim.params(), None))
    for name in [n for n, kind in sim.params.kinds.items() if not kind.hidden]:
        assert sim.params.model_fields[name].description
    labelled = {e.get("for") for e in page.iter("label")}
    for node in (*page.iter("input"), *page.iter("select")):
        inside_label = node.get("type") in ("checkbox", "radio", "file")
        assert inside_label or node.get("id") in labelled or node.get("aria-label"), node.attrib


@each_sim
def test_only_some_controls_can_be_asked_for(sim: AnySim) -> None:
    wanted = next(name for name, kind in sim.params.kinds.items() if not kind.hidden)
    page = xml(Column(sim).html(sim.params(), None, [wanted, wanted]))
    assert [e.get("data-part") for e in page.iter() if e.get("data-part")].count(f"control:{wanted}") == 1
    shown = {str(e.get("data-control")).partition(".")[0] for e in page.iter() if e.get("data-control")}
    assert shown == {wanted}
    assert {e.get("data-act") for e in page.iter("button") if e.get("data-act")} == {"reset"}


TINY = (5e-324, 1e-200, 1e-155)
"""The least number there is, one whose square is zero, and one whose square has lost most of its digits."""


@each_sim
def test_numbers_that_are_almost_zero_are_no_trouble(sim: AnySim) -> None:
    """Each number of the defaults is each of three; in the named states one of them, another in the next state."""
    for k, base in enumerate(({}, *(() if sim.heavy else sim.states.values()))):
        start = sim.params().changed(base)
        for j, name in enumerate(NUMERIC[sim.slug]):
            for one in spoiled(getattr(start, name), [TINY[(j + k) % 3]] if base else TINY):
                with suppress(ValidationError, GeometryError):  # refused in words
                    params = start.changed({name: one})
                    solution = sim.solve(params)
                    assert readout.render(sim.readouts(params, solution))
                    assert sim.panes is None or sim.panes(params, solution) is not None


def spoiled(value: Any, tiny: Sequence[float]) -> list[Any]:
    """What is given instead of a number, and of each entry of several in turn; whole numbers are left as they are."""
    if isinstance(value, tuple):
        return [(*value[:k], one, *value[k + 1 :]) for one in tiny for k in range(len(value))]
    return [*tiny] if isinstance(value, float) else []


# ---- what hands do


def field_cases() -> list[tuple[AnySim, str]]:
    return [
        (sim, name)
        for sim in SIMS
        for name, kind in sim.params.kinds.items()
        if not kind.hidden and not isinstance(kind, LISTS)
    ]


DROPDOWNS = (Choice, OptionalNumber, Text)
LISTS = (Numbers, Letters)
"""Kinds of fields that have a control for each entry."""


def entry_cases() -> list[tuple[AnySim, str]]:
    kinds = [(sim, name, kind) for sim in SIMS for name, kind in sim.params.kinds.items()]
    return [(sim, name) for sim, name, kind in kinds if isinstance(kind, LISTS) and not kind.hidden]


def each(cases: list[tuple[AnySim, str]]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize(("sim", "name"), cases, ids=[f"{sim.slug}: {name}" for sim, name in cases])


each_control = each(field_cases())
each_list = each(entry_cases())
each_number = each(
    [
        (sim, name)
        for sim, name in field_cases()
        if name in NUMERIC[sim.slug] and not isinstance(NUMERIC[sim.slug][name], OptionalNumber)
    ]
)


def inputs(rig: Rig, name: str) -> Any:
    """What the inputs of a parameter show."""
    return rig.column.vector(name) if isinstance(rig.session.params.kinds[name], Vector) else rig.column.values[name]


def shown(params: Params, name: str) -> Any:
    """What the inputs of a parameter should show."""
    value = getattr(params, name)
    if isinstance(params.kinds[name], DROPDOWNS):
        return key(value)
    return list(value) if isinstance(value, tuple) else value


@each_control
def test_control_sets_its_parameter(rigs: dict[str, Rig], sim: AnySim, name: str) -> None:
    rig = rigs[sim.slug]
    rig.show(sim.params())
    kind = sim.params.kinds[name]
    start = getattr(rig.session.params, name)
    aims: list[Any]
    if isinstance(kind, DROPDOWNS):
        aims = [*(value for value in sim.offers(rig.session.params).options(name) if value != start), start]
    elif isinstance(kind, Switch):
        aims = [not start]
    else:
        low, high = rig.session.params.bounds(name)
        step = NUMERIC[sim.slug][name].step
        aims = [low, high, high - step]
        if isinstance(kind, Vector):
            ranges = rig.session.params.ranges(name)
            aims = list(zip(*((low, high, high - step) for low, high in ranges), strict=True))
    for aim in aims:
        rig.browser.move(name, aim)
        rig.settle()
        assert getattr(rig.session.params, name) == pytest.approx(aim)
        wanted = shown(rig.session.params, name)
        assert inputs(rig, name) == (pytest.approx(wanted) if wanted is not None else None)
    if isinstance(kind, Vector):
        rig.browser.move(f"{name}.1", ranges[1][0])
        rig.settle()
        assert getattr(rig.session.params, name) == pytest.approx((*aims[-1][:1], ranges[1][0], *aims[-1][2:]))
    assert not rig.browser.refused


@each_number
def test_a_slider_stops_at_its_end_and_a_box_refuses_what_is_beyond(
    rigs: dict[str, Rig], sim: AnySim, name: str
) -> None:
    rig = rigs[sim.slug]
    rig.show(sim.params())
    start = getattr(rig.session.params, name)
    low, high = rig.session.params.bounds(name)
    kind = NUMERIC[sim.slug][name]
    for beyond, bound in ((low - 1000, low), (high + 1000, high)):
        if isinstance(kind, Slider):
            rig.browser.move(name, beyond)
            rig.settle()
            assert getattr(rig.session.params, name) == bound
            assert inputs(rig, name) == bound
        else:
            rig.browser.move(name, [beyond for _ in start] if isinstance(kind, Vector) else beyond)
            rig.settle()
            assert getattr(rig.session.params, name) == start
            said = [message for message in rig.browser.told if message["type"] == "error"][-1]
            assert said["control"] == name
            assert "number from" in said["message"]
            rig.browser.told.clear()


@few_states
def test_every_control_stands_where_the_state_is(rigs: dict[str, Rig], sim: AnySim, name: str, params: Params) -> None:
    rig = rigs[sim.slug]
    rig.show(params)
    for name in [n for s, n in field_cases() if s is sim]:
        if isinstance(params.kinds[name], Opened):  # what it doesn't say may follow from the others
            continue
        wanted = shown(params, name)
        assert inputs(rig, name) == (pytest.approx(wanted) if wanted is not None else None), name
        if isinstance(params.kinds[name], Slider):
            control = next(xml(rig.column.parts[f"control:{name}"]).iter("input"))
            bounds = sim.offers(params, rig.session.solution).bounds(name)
            assert (float(control.get("min", "")), float(control.get("max", ""))) == bounds
    for name in [n for s, n in entry_cases() if s is sim]:
        controls = xml(rig.column.parts[f"control:{name}"]).iter()
        entries = sim.offers(params).entries(name)
        assert [each for e in controls if (each := e.get("data-control"))] == [
            f"{name}.{k}" for k, entry in enumerate(entries) if entry is not None
        ]
        value = getattr(params, name)
        for k, (entry, one) in enumerate(zip(entries, value, strict=bool(value))):
            assert entry in (None, one)
            assert rig.column.values.get(f"{name}.{k}") == entry


@each_list
def test_each_entry_of_a_list_has_a_control_that_sets_it_alone(rigs: dict[str, Rig], sim: AnySim, name: str) -> None:
    rig = rigs[sim.slug]
    kind = sim.params.kinds[name]
    assert isinstance(kind, LISTS)
    letters = list(kind.labels) if isinstance(kind, Letters) else None
    params = few_of(sim)[-1]
    rig.show(params)
    start = getattr(params, name)
    if not start:
        return
    last = len(start) - 1
    for aim in letters or params.bounds(name):
        rig.browser.move(f"{name}.{last}", aim)
        rig.settle()
        assert getattr(rig.session.params, name) == (start[:last] + (aim if letters else (aim,)))
    if not letters:
        rig.browser.move(f"{name}.{last}", params.bounds(name)[1] + 1000)
        rig.settle()
        assert getattr(rig.session.params, name)[last] == params.bounds(name)[1]
        assert rig.column.values[f"{name}.{last}"] == params.bounds(name)[1]


@each_sim
def test_every_action_ends_in_a_state(sim: AnySim) -> None:
    with Rig(sim) as rig:
        rig.session.motion.reduced = True
        for action in sim.actions:
            rig.show(sim.params())
            result = action.run(sim.params())
            changes = [result] if hasattr(result, "keys") else [step.changes for step in result]
            assert changes
            state = sim.params()
            for change in changes:
                state = state.changed(change)
            rig.browser.press(action.name)
            rig.settle()
            assert not rig.problems()


@each_sim
def test_reset_returns_to_the_first_state(sim: AnySim) -> None:
    """To the state in which the session began, which isn't that of the defaults."""
    _, other, params, *_ = few_of(sim)
    with Rig(sim, params) as rig:
        before = kept(rig.browser)
        rig.show(other)
        rig.browser.press("reset")
        rig.settle()
        assert rig.session.params == params
        assert not differences(before, rig.browser.snapshot(), within=1e-12)


@each_sim
def test_what_can_be_dragged_is_known_and_moves(sim: AnySim) -> None:
    with Rig(sim) as rig:
        for name in rig.model.draggable():
            before = rig.session.params
            body = name not in sim.handles  # moved wherever it is taken
            x, y, z = (0.5, 0.4, 0.6) if body else rig.model.world_pose(name)[:3, 3].tolist()
            rig.browser.drag(name, (x + 0.05, y + 0.02, z + 0.03), taken=(x, y, z))
            rig.settle()
            assert rig.session.params != before, f"{name} can be dragged and nothing happens"


@each_sim
def test_what_is_dragged_can_be_typed(sim: AnySim) -> None:
    with Rig(sim) as rig:
        for typed in sim.typed:
            assert typed.handle in sim.handles
            place = typed.place(rig.session.params, rig.session.solution)
            assert place is not None
            assert rig.column.vector(typed.handle) == pytest.approx([*place])
            aim = [v + step for v, step in zip(place, (-0.05, -0.1, 0.05), strict=True)]
            rig.browser.move(typed.handle, aim)
            rig.settle()
            place = typed.place(rig.session.params, rig.session.solution)
            assert place == pytest.approx(aim, abs=1e-6)
            assert rig.column.vector(typed.handle) == pytest.approx(aim, abs=1e-6)
            rig.browser.move(f"{typed.handle}.2", aim[2] - 0.02)
            rig.settle()
            assert rig.column.values[f"{typed.handle}.2"] == pytest.approx(aim[2] - 0.02, abs=1e-6)


@each_sim
def test_a_dial_sets_what_it_shows_within_its_ends_and_is_typed_exactly(sim: AnySim) -> None:
    starts = [sim.params(), *(params for each, _, params in ALL if each is sim)]
    with Rig(sim) as rig:
        for dial in sim.dials:
            rig.show(next(params for params in starts if dial.value(params, sim.solve(params)) is not None))
            for aim, kept in ((dial.low - 1.0, dial.low), (0.5 * (dial.low + dial.high), None), (1e9, dial.high)):
                rig.browser.move(dial.handle, aim)
                rig.settle()
                shown = rig.column.values[dial.handle]
                assert shown == dial.value(rig.session.params, rig.session.solution)
                assert shown == pytest.approx(aim if kept is None else kept)
            rig.host.call(lambda name=dial.handle, low=dial.low: rig.session.enter(name, f"{low + 0.25}"))  # type: ignore[misc]
            rig.settle()
            assert rig.column.values[dial.handle] == pytest.approx(dial.low + 0.25)


@per_sim(("sim", "name", "params"), TYPED, [f"{sim.slug}: {name}" for sim, name, _ in TYPED])
def test_what_can_be_typed_is_shown_where_it_exists(
    rigs: dict[str, Rig], sim: AnySim, name: str, params: Params
) -> None:
    rig = rigs[sim.slug]
    rig.show(params)
    for typed in sim.typed:
        place = typed.place(params, rig.session.solution)
        assert bool(rig.column.parts[f"control:{typed.handle}"]) == (place is not None)
        if place is not None:
            assert rig.column.vector(typed.handle) == pytest.approx([*place])
    for dial in sim.dials:
        value = dial.value(params, rig.session.solution)
        assert bool(rig.column.parts[f"control:{dial.handle}"]) == (value is not None)
        assert rig.column.values[dial.handle] == value
