"""Lessons: those of the sims load, each kind of mistake is said with its line, and no file stops the server."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any

import httpx
import pytest
from markupsafe import Markup

from app.lessons.concepts import CONCEPTS
from app.lessons.errors import LessonError
from app.lessons.html import Writer
from app.lessons.lesson import Lesson, begun, load
from app.lessons.shelf import Shelf, place
from app.lessons.state import read
from app.routes.rendering import by_section
from app.settings import ROOT
from sims import SIMS, by_slug
from sims.kit.sim import Library, Sim
from tests.app.conftest import Local

AnySim = Sim[Any, Any]
EPIPOLAR = "left=-0.4,0.9,0.9&right=0.5,-0.8,1.2&left_pan=-8&right_pan=8"
ASTRAY = "dataset=two-scans&process=register&turn=180&step=40"
HEAD = "---\ntitle: Three rings\nsummary: What they do.\nsim: gimbal-lock\n---\n"
CHECK = "::: check\nWhich?\n\n- [{a}] One{why}\n- [{b}] Two\n  Because.\n{end}"


def given(sim: AnySim) -> tuple[Library, ...]:
    """As a server without files of its own has them."""
    return () if sim.files is None else (sim.files.library(None, 1),)


@pytest.fixture
def written(tmp_path: Path) -> Callable[..., Lesson]:
    """Loads a lesson that is written under a head."""

    def loaded(body: str, head: str = HEAD, sims: tuple[AnySim, ...] = SIMS) -> Lesson:
        path = tmp_path / "ours.md"
        path.write_text(head + body, encoding="utf-8")
        return load(path, "ours", sims, given)

    return loaded


@pytest.fixture(scope="module")
def shelf() -> Shelf:
    return Shelf(SIMS, given)


# ---- the lessons of the sims


@pytest.mark.parametrize("sim", SIMS, ids=lambda sim: sim.slug)
def test_every_sim_has_a_lesson_that_loads(shelf: Shelf, sim: AnySim) -> None:
    lesson = shelf.of_sim(sim)
    assert lesson is not None
    assert lesson.steps
    assert all(step.words for step in lesson.steps), "the strip in a frame has nothing to say"
    html = "".join(section.html for section in lesson.sections)
    assert html.count("<form") == html.count('<form method="dialog"'), "an answer given early leads away from the page"


def test_each_concept_is_learnt_in_one_place(shelf: Shelf) -> None:
    lessons = [lesson for sim in SIMS if (lesson := shelf.of_sim(sim)) is not None]
    learnt = Counter(concept for lesson in lessons for concept in lesson.concepts)
    assert learnt == dict.fromkeys(CONCEPTS, 1)
    assert shelf.concepts == {concept: lesson.sim.slug for lesson in lessons for concept in lesson.concepts}


SAID = [
    ("camera", "", "subject.height", "{:.0f} pixels tall"),
    ("camera", "", "subject.depth", "house is {:.1f} m away"),
    ("camera", "", "t.2", "$t$ is (0, 1.2, {:.0f})"),
    ("coordinate-frames", "convention=ros&to=ros&point=0.6,0.3,0.8&show_rule=0", "distance", "ball is {:.2f} m away"),
    ("epipolar", EPIPOLAR + "&candidate=400,300", "solution.candidate.distance", "pulled {:.0f} px off the line"),
    ("gimbal-lock", "pitch=45", "singular_values.2", "45° | {:.3f} |"),
    ("gimbal-lock", "pitch=80", "singular_values.2", "80° | {:.3f} |"),
    ("triangulation", "", "disparity", "At a depth of 4 m the disparity is {:.0f} px"),
    ("triangulation", "", "depth_sigma", "At 4 m it is {:.3f} m"),
    ("point-cloud", "voxel_size=0.05", "points_out", "{:,} points are left"),
    ("point-cloud", "dataset=statue", "dimensions.2", "statue is {:.2f} m tall"),
    ("point-cloud", ASTRAY, "registration.rmse", "pairs are only {:.0f} mm apart"),
]


@pytest.mark.parametrize(("slug", "query", "path", "words"), SAID)
def test_what_a_text_says_of_a_state_is_so(slug: str, query: str, path: str, words: str) -> None:
    """Numbers that must not move with the sim, as those that a question begins with."""
    sim = by_slug(slug)
    assert sim is not None
    value = abs(read(sim, query, given(sim)).value(path)) * (1000 if "mm" in words else 1)
    assert words.format(value) in place(sim).read_text("utf-8")


# ---- what is wrong: the body, the line below the head where that is, what was found, and what is allowed

MISTAKES: dict[str, tuple[str, int, str, str]] = {
    "unknown parameter": ("## [A](?colour=red)\n", 1, "the state ?colour=red", "colour"),
    "state out of bounds": ("\n## [A](?pitch=999)\n", 2, "the state ?pitch=999", "for pitch: "),
    "state that is no query": ("## [A](pitch)\n", 1, "the state pitch", "?pitch=90&yaw=30"),
    "view that is none": ("## [A](?view=1,2)\n", 1, "the state ?view=1,2", "six numbers"),
    "no such value": ("One\ntwo {value:speed}.\n", 2, "{value:speed}", "pitch, "),
    "no such value in a step": ("## [A](?)\n\nOne {value:speed}.\n", 3, "{value:speed}", "pitch, "),
    "formula of a step that breaks": ("## [A](?)\n\nOne $\\nonsense x$.\n", 3, "\\nonsense", "LaTeX"),
    "index too large": ("\n{value:R.3.0}\n", 2, "{value:R.3.0}", "0 to 2"),
    "more than a number": ("{value:R}\n", 1, "{value:R}", "one of its 3 entries"),
    "too many digits": ("{value:pitch:12}\n", 1, "{value:pitch:12}", "0 to 9 digits"),
    "nothing to drag": ("* a\n* b\n* {drag:show_ghost}\n", 3, "{drag:show_ghost}", "yaw, pitch, roll"),
    "unknown challenge": ("::: challenge win\n:::\n", 1, "::: challenge win", "same-orientation"),
    "challenge twice": ("::: challenge both-ends\n:::\n" * 2, 3, "::: challenge both-ends", "each challenge once"),
    "unknown concept": ("{concept:magic}\n", 1, "{concept:magic}", "gimbal-lock"),
    "concept twice": ("{concept:se3}\n\n{concept:se3}\n", 3, "{concept:se3}", "each concept once"),
    "unknown command": ("a\n$\\nonsense x$\n", 2, "\\nonsense", "LaTeX"),
    "fraction with one part": ("$\\frac{1}$\n", 1, "1 of 2 parts", "LaTeX"),
    "half a formula": ("$$\n\\left( x\n$$\n", 1, "\\left(", "LaTeX"),
    "style in a formula": ("$\\style{color:red}{x}$\n", 1, "style", "LaTeX"),
    "value in a formula": ("$x = {value:speed}$\n", 1, "{value:speed}", "pitch, "),
    "drag in a formula": ("$x = {drag:pitch}$\n", 1, "{drag:pitch}", "{value:…}"),
    "point to nothing": ("$\\point{wing}{x}$\n", 1, "\\point{wing}", "pitch"),
    "point to half a name": ("$\\point{yaw\" onclick=\"}{x}$\n", 1, "\\point{yaw", "pitch"),
    "no such box": ("::: quiz\nWhat?\n:::\n", 1, "::: quiz", "::: check"),
    "box open at the end": ("a\n\n::: teacher\nb\n", 3, "::: teacher isn't closed before the end", ":::"),
    "box open before a heading": (
        "::: teacher\n\n## [A](?)\n\n:::\n", 1, "isn't closed before the heading in line 8", ":::",
    ),
    "box open before another": (
        "::: teacher\n\n::: challenge both-ends\n:::\n", 1, "::: challenge both-ends in line 8", ":::",
    ),
    "heading by accident": ("a\n\nWhich?\n---\nb\n", 3, "above a line of ---", "an empty line"),
    "title in the text": ("# Big\n", 1, "a heading with one #", "## and ###"),
    "no right choice": (
        CHECK.format(a=" ", b=" ", why="\n  So.", end="\n---\nSo.\n:::\n"), 1, "::: check", "exactly one",
    ),
    "two right choices": (
        CHECK.format(a="x", b="x", why="\n  So.", end="\n---\nSo.\n:::\n"), 1, "::: check", "exactly one",
    ),
    "no reason": (
        CHECK.format(a="x", b=" ", why="", end="\n---\nSo.\n:::\n"), 1, "without a reason", "below each choice",
    ),
    "no worked answer": (
        CHECK.format(a="x", b=" ", why="\n  So.", end=":::\n"), 1, "without its answer", "worked answer",
    ),
    "empty check": ("::: check\n:::\n", 1, ", an empty box", "a question"),
    "empty prediction": ("::: predict dof at ?\n:::\n", 1, ", an empty box", "a question"),
    "prediction of nothing": ("::: predict\nWhat?\n\n---\nSo.\n:::\n", 1, "::: predict", "within 0.5 at ?state"),
    "prediction of an unknown": ("::: predict speed at ?\nWhat?\n\n---\nSo.\n:::\n", 1, "speed", "pitch, "),
    "prediction in no state": (
        "::: predict dof at ?pitch=x\nWhat?\n\n---\nSo.\n:::\n", 1, "the state ?pitch=x", "pitch",
    ),
    "prediction without why": ("::: predict dof at ?\nWhat?\n\n- `3` a\n- `2` b\n:::\n", 1, "without its why", "---"),
    "no choice fits": (
        "::: predict dof at ?\nWhat?\n\n- `1` a\n- `2` b\n\n---\nSo.\n:::\n", 1, "no choice is right", "3",
    ),
    "two choices fit": (
        "::: predict dof at ?\nWhat?\n\n- `3` a\n- `3` b\n\n---\nSo.\n:::\n", 1, "2 choices are right", "3",
    ),
    "change of what is no number": (
        "::: predict lost_axis from ? to ?pitch=90\nWhat?\n\n- `same` a\n- `larger` b\n\n---\nSo.\n:::\n",
        1, "lost_axis", "a number in both states",
    ),
    "number to type that is none": (
        "::: predict lost_axis within 1 at ?\nWhat?\n\n---\nSo.\n:::\n", 1, "lost_axis", "a number",
    ),
    "number to set that follows": (
        "::: predict lost_axis set within 1 at ?\nWhat?\n\n---\nSo.\n:::\n", 1, "lost_axis", "a number",
    ),
    "link to a script": ("a [b](javascript:alert(1))\n", 1, "a link to javascript:alert(1)", "https://…"),
    "link to data": ("a <data:text/html,x>\n", 1, "a link to data:", "https://…"),
    "link to nowhere": ("a\nb [b](/nowhere)\n", 2, "a link to /nowhere", "/sims/…"),
    "link to no sim": ("[b](/sims/cube)\n", 1, "a link to /sims/cube", "quaternion"),
    "link to no state of a sim": ("[b](/sims/quaternion?angle=999)\n", 1, "angle=999", "for angle: "),
    "link to no concept": ("[b](/concepts/magic)\n", 1, "a link to /concepts/magic", "gimbal-lock"),
    "link to no part": ("## [A](?)\n\n[b](#c)\n", 3, "a link to #c", "#a"),
    "link to a state that isn't one": ("[b](?pitch=999)\n", 1, "the state ?pitch=999", "for pitch: "),
    "word in a link": ("[b](/lessons/ours?{value:lost_axis})\n", 1, "{value:lost_axis}", "a number"),
}  # fmt: skip


@pytest.mark.parametrize("kind", MISTAKES)
def test_a_mistake_is_said_with_its_line(written: Callable[..., Lesson], kind: str) -> None:
    body, line, found, allowed = MISTAKES[kind]
    with pytest.raises(LessonError) as raised:
        written(body)
    (wrong,) = raised.value.mistakes
    assert wrong.line == line + HEAD.count("\n")
    assert found in wrong.found
    assert allowed in wrong.allowed
    assert f"ours.md:{wrong.line}: " in str(raised.value)


HEADS = {
    "empty file": ("", 1, "no title", "title, summary, sim, minutes"),
    "no head": ("Hello\n", 1, "no title", "between two lines of ---"),
    "head that doesn't end": ("---\ntitle: A\n", 1, "no title", "between two lines of ---"),
    "empty title": ("---\ntitle:\nsummary: B\nsim: camera\n---\n", 2, "no title", "title"),
    "strange word": ("---\ntitle: A\nsummary: B\nsim: camera\nauthor: C\n---\n", 5, "author at the head", "title, "),
    "no pair": ("---\ntitle: A\nsummary: B\nsim: camera\nhello\n---\n", 5, "hello", "a name, a colon and a text"),
    "name twice": ("---\ntitle: A\nsummary: B\nsim: camera\ntitle: C\n---\n", 5, "title: C", "each name once"),
    "no such sim": ("---\ntitle: A\nsummary: B\nsim: cube\n---\n", 4, "sim: cube", "gimbal-lock"),
    "no sim": ("---\ntitle: A\nsummary: B\n---\n", 1, "no sim", "gimbal-lock"),
    "minutes in words": (
        "---\ntitle: A\nsummary: B\nsim: camera\nminutes: ten\n---\n", 5, "minutes: ten", "whole number",
    ),
    "minutes in other digits": (
        "---\ntitle: A\nsummary: B\nsim: camera\nminutes: ²\n---\n", 5, "minutes: ²", "whole number",
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", HEADS)
def test_a_mistake_at_the_head_is_said_with_its_line(written: Callable[..., Lesson], kind: str) -> None:
    head, line, found, allowed = HEADS[kind]
    with pytest.raises(LessonError) as raised:
        written("", head)
    said = [wrong for wrong in raised.value.mistakes if found in wrong.found and allowed in wrong.allowed]
    assert [wrong.line for wrong in said] == [line]


def test_all_mistakes_of_a_file_are_said_at_once(written: Callable[..., Lesson]) -> None:
    with pytest.raises(LessonError) as raised:
        written("{value:a}\n\n## [A](?pitch=x)\n\n::: quiz\n")
    assert [wrong.line for wrong in raised.value.mistakes] == [6, 8, 10]


def test_a_state_that_makes_a_sim_fail_is_a_mistake(written: Callable[..., Lesson]) -> None:
    sim = by_slug("gimbal-lock")
    assert sim is not None

    def solve(params: Any) -> Any:
        if params.pitch == 13:
            raise ZeroDivisionError
        return sim.solve(params)

    with pytest.raises(LessonError, match=r"ours\.md:7: .*\?pitch=13.*ZeroDivisionError"):
        written("\n## [A](?pitch=13)\n", sims=(replace(sim, solve=solve),))


# ---- the page of a lesson needn't wait for its end


def test_each_section_is_written_when_it_is_asked_for(tmp_path: Path) -> None:
    sim, solved = by_slug("gimbal-lock"), list[float]()
    assert sim is not None

    def solve(params: Any) -> Any:
        solved.append(params.pitch)
        return sim.solve(params)

    path = tmp_path / "ours.md"
    path.write_text(HEAD + "Before.\n\n## [A](?pitch=10)\n\n## [B](?pitch=20)\n\n{value:speed}\n")
    lesson = begun(path, "ours", (replace(sim, solve=solve),), given)
    assert (lesson.queries, lesson.begins.link) == (["?pitch=10", "?pitch=20"], "pitch=10")
    sections = lesson.each()
    assert [next(sections).id for _ in range(2)] == ["start", "a"]
    assert solved == [10]
    for _ in range(2):  # who comes later is told too
        with pytest.raises(LessonError, match=r"ours\.md:12: \{value:speed\}"):
            lesson.finished()
    assert solved == [10, 20], "each state is solved once"


def test_loading_ahead_ends_with_the_section_at_which_the_server_ends() -> None:
    sim, solved = by_slug("gimbal-lock"), list[float]()
    assert sim is not None

    def solve(params: Any) -> Any:
        if params.pitch:
            solved.append(params.pitch)
            lessons.close()
        return sim.solve(params)

    lessons = Shelf((replace(sim, solve=solve), *(each for each in SIMS if each is not sim)), given)
    for piece in lessons.loading():
        piece()
    assert solved == [30], "the second step of the first lesson"


def test_a_page_is_sent_section_by_section() -> None:
    pulled = list[int]()

    def pieces() -> Iterator[str]:
        for k, piece in enumerate(["<p>", "&", "</p></section>", "<section>b</section>", "end"]):
            pulled.append(k)
            yield Markup(piece)

    parts = by_section(pieces())
    assert (next(parts), pulled) == ("<p>&</p></section>", [0, 1, 2])
    assert [*parts] == ["<section>b</section>", "end"]


# ---- what a teacher writes is text


def test_markup_and_scripts_are_shown_as_text(written: Callable[..., Lesson]) -> None:
    evil = "<script>alert(1)</script>"
    body = (
        f"{evil}\n\n## {evil}\n\n- {evil} <img src=x onerror=alert(1)> ![a](https://x.example/a.png)\n\n"
        f'$\\text{{{evil}}}$ $\\text{{&lt;script&gt;}}$ `{evil}` {{concept:se3:{evil}}} [a](https://x.example/"onclick=")\n\n'
        f"::: check\n{evil}\n\n- [x] {evil}\n  {evil}\n- [ ] b\n  c\n\n---\n{evil}\n:::\n\n"
        f"::: challenge both-ends\n{evil}\n:::\n\n::: teacher\n{evil}\n:::\n"
    )
    lesson = written(body, HEAD.replace("Three rings", evil))
    html = "".join(section.html for section in lesson.sections) + lesson.teacher
    assert unescape(html).count(evil) >= 9
    assert not re.search(r"<(script|img)|<[^>]* on\w+=", html)


# ---- what the page gets


def test_text_becomes_what_the_page_works_with(written: Callable[..., Lesson]) -> None:
    lesson = written(
        "Before.\n\n## [First](?pitch=30&view=1,2,3,0,0,0)\n\nNow $\\theta$ is {value:pitch}, not {drag:yaw}. More.\n\n"
        "$$\\point{pitch}{\\theta} = {value:conditioning:2}$$\n\n::: challenge both-ends\n:::\n\n"
        "[On](/sims/quaternion?angle={value:pitch}) [back](#first) [there](?pitch=90)\n\n## Last\n\nEnd.\n"
    )
    (step,) = lesson.steps
    assert (step.id, step.title, step.challenges) == ("first", "First", ("both-ends",))
    assert step.words == "Now θ is 30°, not 0°."
    assert step.state.link == "pitch=30&view=1,2,3,0,0,0"
    (data,) = lesson.data()
    assert (data["query"], data["view"], data["params"]["pitch"]) == ("pitch=30", [1, 2, 3, 0, 0, 0], 30)
    assert [section.id for section in lesson.sections] == ["start", "first", "last"]
    html = lesson.sections[1].html
    assert '<span data-value="pitch" data-boxed data-unit="°">30°</span>' in html
    assert '<mn data-value="conditioning" data-digits="2">0.87</mn>' in html
    assert 'data-point="pitch"' in html
    assert 'href="../sims/quaternion?angle=30" data-href="../sims/quaternion?angle={value:pitch}"' in html
    asked = re.search(r'data-set="([^"]*)"', html)
    assert asked is not None
    assert json.loads(unescape(asked[1]))["params"]["pitch"] == 90


def test_no_line_ends_between_a_formula_and_its_comma(written: Callable[..., Lesson]) -> None:
    (section,) = written("Some $a$, then ($b$) and $c$ too.\n\n$$d$$,\n").sections
    held = re.findall(r'<span class="together">(.*?)</span>', section.html)
    assert [re.sub("<.*?>", "", each) for each in held] == ["a,", "(b)"]


@pytest.mark.parametrize(
    ("info", "choices", "answer", "said"),
    [
        ("dof at ?pitch=90", "- `3`\n- `2` two\n", 2, ""),
        ("dof from ? to ?pitch=90", "- `smaller` less\n- `same` as before\n", "smaller", ""),
        ("conditioning within 0.05 at ?pitch=60", "", 0.5, "0.500"),
        ("conditioning within 3 at ?pitch=60", "", 0.5, "0.5"),
        ("pitch set within 2 at ?pitch=45", "", 45, "45°"),
    ],
)
def test_the_answer_of_a_prediction_is_worked_out(
    written: Callable[..., Lesson], info: str, choices: str, answer: float | str, said: str
) -> None:
    lesson = written(f"::: predict {info}\nWhat?\n\n{choices}\n---\nSo.\n:::\n")
    asked = re.search(r'data-predict="([^"]*)"', lesson.sections[0].html)
    assert asked is not None
    data = json.loads(unescape(asked[1]))
    assert data["answer"] == (pytest.approx(answer) if isinstance(answer, float) else answer)
    assert data["said"] == said


def test_numbers_of_an_answer_are_those_of_the_state_that_was_asked_for(written: Callable[..., Lesson]) -> None:
    asked = "::: predict dof from ? to ?pitch=90\nNow {value:pitch}.\n\n- `smaller` less\n- `same` as before\n\n---\n"
    (section,) = written(asked + "Then {value:pitch}, $\\theta = {value:dof}$.\n:::\n\n{value:pitch}\n").sections
    before, why, after = re.split(r'<div class="why">|</form>', section.html)
    assert ">0°</span>" in before
    assert ">0°</span>" in after
    assert "Then <span>90°</span>" in why
    assert "<mn>2</mn>" in why
    assert "data-value" not in why


# ---- the folder of a school

FILES: dict[str, bytes] = {
    "empty.md": b"",
    "long.md": b"a\n" * 5_000_000,
    "binary.md": bytes(range(256)) * 10,
    "zero.md": HEAD.encode() + b"a\0b",
    "latin.md": HEAD.encode() + "Übung".encode("latin-1"),
    "deep.md": HEAD.encode() + b"> " * 5000 + b"a\n",
    "lists.md": HEAD.encode() + b"".join(b"  " * k + b"- a\n" for k in range(400)),
    "braces.md": HEAD.encode() + b"$" + b"{" * 5000 + b"$",
    "stars.md": HEAD.encode() + b"*a_ " * 20_000 + b"\n{value:a}\n",
    "brackets.md": HEAD.encode() + b"[" * 20_000 + b"\n{value:a}\n",
    "Our Robot.md": HEAD.encode() + b"Fine otherwise.\n",
}


def test_no_file_stops_the_server(tmp_path: Path) -> None:
    for name, data in FILES.items():
        (tmp_path / name).write_bytes(data)
    (tmp_path / "ours.md").write_text(HEAD + "Hello.\n")
    (tmp_path / "folder.md").mkdir()
    (tmp_path / "gone.md").symlink_to(tmp_path / "nowhere.md")
    shelf = Shelf(SIMS, given, tmp_path)
    assert "ours" in shelf.own
    assert {*FILES, "folder.md", "gone.md"} - {*shelf.broken} <= {"deep.md", "lists.md"}, "Markdown has its own limits"
    assert all(error.mistakes for error in shelf.broken.values())


def test_a_lesson_of_the_folder_has_its_page(tmp_path: Path) -> None:
    (tmp_path / "our-robot.md").write_text(HEAD + "## [Look](?pitch=30)\n\nHello, {value:pitch}.\n")
    (tmp_path / "broken.md").write_text(HEAD + "{value:nothing}\n")
    with Local(lesson_dir=tmp_path) as local:
        page = local.http.get("/lessons/our-robot").text
        assert "Hello, <span data-value" in page
        assert "/sims/gimbal-lock/embed?pitch=30" in page
        assert local.http.get("/lessons/broken").status_code == 404
        assert local.http.get("/lessons/none").status_code == 404


# ---- the services


def test_the_catalogue_lists_steps_and_challenges(http: httpx.Client, shelf: Shelf) -> None:
    sim = by_slug("gimbal-lock")
    assert sim is not None
    told = http.get("/api/sims/gimbal-lock").json()
    lesson = shelf.of_sim(sim)
    assert lesson is not None
    assert told["steps"] == [{"id": s.id, "title": s.title, "query": s.state.link} for s in lesson.steps]
    assert told["challenges"] == [{"id": c.id, "title": c.title, "goal": c.goal} for c in sim.challenges]
    for step in told["steps"]:
        assert http.get(f"/sims/gimbal-lock/embed?{step['query']}").status_code == 200


def test_check_says_how_near_a_state_is(http: httpx.Client) -> None:
    place = "/api/sims/gimbal-lock/check"
    solved = http.post(place, json={"pitch": 48.59}).json()["challenges"]["half-reach"]
    assert (solved["solved"], solved["progress"]) == (True, 1.0)
    near = http.post(place, json={"pitch": 45}).json()["challenges"]["half-reach"]
    assert near["solved"] is False
    assert 0 < near["progress"] < 1
    assert near["words"]
    assert http.post(place, json={"pitch": 999}).status_code == 422
    assert http.post("/api/sims/cube/check", json={}).status_code == 404


def test_a_link_may_ask_for_the_lesson_or_a_challenge_in_the_frame(http: httpx.Client) -> None:
    def data(query: str) -> dict[str, Any]:
        page = http.get(f"/sims/gimbal-lock/embed?{query}").text
        found = re.search(r'<script id="sim3" type="application/json">(.*?)</script>', page)
        assert found is not None
        told: dict[str, Any] = json.loads(found[1])
        return told

    assert [step["id"] for step in data("lesson=1")["steps"]]
    assert data("")["steps"] == []
    assert data("challenge=both-ends")["challenges"]
    assert http.get("/sims/gimbal-lock/embed?lesson=2").status_code == 422
    page = http.get("/sims/gimbal-lock/embed?challenge=win").text
    assert http.get("/sims/gimbal-lock/embed?challenge=win").status_code == 422
    assert "both-ends" in page


# ---- how lessons are written is documented

DOCS = (ROOT / "docs" / "lessons.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```markdown\n(.*?)^```$", DOCS, re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda text: text.partition("\n")[0][:40])
def test_an_example_of_the_documentation_loads(written: Callable[..., Lesson], example: str) -> None:
    whole = example.startswith("---\n")
    assert written("" if whole else "\n" + example, example if whole else HEAD).sections


MESSAGES = re.findall(r"^\| `(.+?)` \| `(.+?)` \| ", DOCS, re.MULTILINE)


@pytest.mark.parametrize(("body", "says"), MESSAGES, ids=lambda text: text[:30])
def test_a_mistake_of_the_documentation_is_said_as_there(written: Callable[..., Lesson], body: str, says: str) -> None:
    with pytest.raises(LessonError) as raised:
        written(body.replace("⏎", "\n") + "\n")
    assert raised.value.mistakes[0].found.startswith(says)


def test_the_documentation_has_examples_and_messages() -> None:
    assert len(EXAMPLES) > 8
    assert len(MESSAGES) > 15


def test_a_fault_of_ours_is_no_end_of_a_lesson(monkeypatch: pytest.MonkeyPatch) -> None:
    sim = by_slug("gimbal-lock")
    assert sim is not None
    lesson = Shelf(SIMS, given).begun(sim)
    assert lesson is not None
    monkeypatch.setattr(Writer, "_said_of", lambda *_: 1 / 0)
    for _ in range(2):
        with pytest.raises(ZeroDivisionError):
            lesson.finished()
