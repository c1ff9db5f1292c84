"""A class without a browser: the websockets of its teacher and of forty learners."""

from __future__ import annotations

import json
import re
import secrets
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from typing import Any, Protocol, Self

import httpx
import pytest

from app.classes import live, registry
from app.classes.codes import LETTERS, code_of, is_code
from app.rooms.keys import new_key
from sims import by_slug
from tests.app.conftest import Local
from tests.app.page import SLUG, closed, connect
from tests.server import PATIENCE, wait_for

ALONE = f"sims/{SLUG}/embed"


class Socket:
    """A page of a class, as far as its websocket goes."""

    def __init__(self, address: str, first: Mapping[str, Any], origin: str | None = None) -> None:
        self.socket = connect(f"{address}/socket", viser=False, origin=origin)
        self.tell(first)

    def tell(self, message: Mapping[str, Any]) -> None:
        self.socket.send(json.dumps(message))

    def hear(self, kind: str, fits: Callable[[dict[str, Any]], bool] = lambda message: True) -> dict[str, Any]:
        """The next message of a kind that fits."""
        while True:
            message: dict[str, Any] = json.loads(self.socket.recv(timeout=PATIENCE))
            if message["type"] == kind and fits(message):
                return message

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()


class Serves(Protocol):
    """Where a class is to be."""

    @property
    def url(self) -> str: ...


class Teacher(Socket):
    """Opens a class with a key of their own, or brings one back."""

    def __init__(self, local: Serves, *, key: str = "", page: str = ALONE, query: str = "", **more: Any) -> None:
        self.key = key or new_key()
        self.code = code_of(self.key)
        first = {"type": "open", "page": page, "query": query, **more}
        super().__init__(f"{local.url}/class/{self.code}/{self.key}", first)
        self.welcome = self.hear("class")

    def sees(self, animal: str, **known: Any) -> dict[str, Any]:
        """Wait for a grid in which a learner stands like that."""
        grid = self.hear("grid", lambda grid: any(known.items() <= row.items() for row in grid["learners"]
                                                  if row["animal"] == animal))  # fmt: skip
        return next(row for row in grid["learners"] if row["animal"] == animal)


class Learner(Socket):
    """Joins a class."""

    def __init__(self, local: Serves, code: str, *, me: str = "", animal: str = "") -> None:
        self.me = me or secrets.token_hex(8)
        super().__init__(f"{local.url}/class/{code}", {"type": "join", "me": self.me, "animal": animal})
        self.welcome = self.hear("class")
        self.animal = self.welcome["animal"]

    def at(self, **params: Any) -> None:
        self.tell({"type": "at", "params": params})


@pytest.fixture(autouse=True)
def _at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(live, "GRID_INTERVAL", 0.0)


@pytest.fixture
def teacher(local: Local) -> Iterator[Teacher]:
    with Teacher(local, query="yaw=45") as teacher:
        yield teacher
        teacher.tell({"type": "end"})
        closed(teacher.socket)


# ---- codes


def test_a_code_is_short_and_of_letters_that_nobody_mistakes() -> None:
    codes = {code_of(new_key()) for _ in range(3)}
    assert len(codes) == 3
    assert all(is_code(code) and len(code) == 6 for code in codes)
    assert not {*"01ilo"} & {*LETTERS}


# ---- a class of forty


def test_a_class_of_forty(local: Local, teacher: Teacher) -> None:
    with ExitStack() as stack:
        learners = [stack.enter_context(Learner(local, teacher.code)) for _ in range(40)]
        assert len({each.animal for each in learners}) == 40
        assert {each.welcome["address"] for each in learners} == {f"{ALONE}?yaw=45"}
        for k, each in enumerate(learners):
            each.at(yaw=k)
            each.tell({"type": "guess", "box": 0, "value": k % 4})
        grid = teacher.hear("grid", lambda grid: len(grid["guesses"].get("0", [])) == 40
                            and sum(row["progress"] >= 0 for row in grid["learners"]) == 40)  # fmt: skip
        assert [grid["guesses"]["0"].count(choice) for choice in range(4)] == [10] * 4
        assert all(row["here"] for row in grid["learners"])
        teacher.tell({"type": "show", "params": {"yaw": 70}})
        teacher.tell({"type": "look", "eyes": True})
        for each in learners:
            assert each.hear("eyes")["params"]["yaw"] == 70
        teacher.tell({"type": "look", "eyes": False})
        for each in learners:
            assert not each.hear("eyes", lambda message: not message["on"])["on"]


def test_the_teacher_sees_how_near_a_learner_is_and_that_once_solved_is_solved(local: Local) -> None:
    known = by_slug(SLUG)
    assert known is not None
    challenge = next(each for each in known.challenges if not each.path)
    with Teacher(local, query=f"challenge={challenge.id}") as teacher, Learner(local, teacher.code) as learner:
        near = known.params().changed(challenge.misses[0]).model_dump(mode="json")
        learner.at(**near)
        row = teacher.sees(learner.animal, solved=0, of=1)
        while not row["words"]:
            row = teacher.sees(learner.animal, solved=0)
        assert row["progress"] < 1
        learner.at(**known.params().changed(challenge.solves).model_dump(mode="json"))
        assert teacher.sees(learner.animal, solved=1)["progress"] == 1
        learner.at()
        learner.tell({"type": "guess", "box": 1, "value": 0})
        assert teacher.sees(learner.animal, solved=1)["progress"] == 1
        teacher.tell({"type": "end"})


def test_a_learners_state_is_shown_after_a_yes_and_only_then(local: Local, teacher: Teacher) -> None:
    with Learner(local, teacher.code) as one, Learner(local, teacher.code) as other:
        one.tell({"type": "answer", "params": {"yaw": 1}})  # nobody has asked
        teacher.tell({"type": "ask", "animal": other.animal})
        other.hear("ask")
        teacher.sees(other.animal, asked="asked")
        other.tell({"type": "answer"})
        assert teacher.sees(other.animal, asked="no")
        teacher.tell({"type": "ask", "animal": other.animal})
        other.hear("ask")
        other.tell({"type": "answer", "params": {"yaw": 12}})
        lent = teacher.hear("lent")
        assert (lent["animal"], lent["params"]["yaw"]) == (other.animal, 12)


# ---- who comes back


def test_a_page_that_breaks_off_goes_on_as_the_same_animal(local: Local, teacher: Teacher) -> None:
    with Learner(local, teacher.code) as learner:
        learner.tell({"type": "guess", "box": 0, "value": 1})
        teacher.sees(learner.animal, here=True)
    teacher.sees(learner.animal, here=False)
    with Learner(local, teacher.code, me=learner.me) as again:
        assert again.animal == learner.animal
        assert teacher.sees(learner.animal, here=True)
        again.tell({"type": "guess", "box": 0, "value": 2})
        assert teacher.hear("grid")["guesses"] == {"0": [1]}, "the first prediction counts"


def test_a_teacher_brings_a_class_back_after_a_restart(local: Local) -> None:
    with Teacher(local) as teacher:
        ends = teacher.welcome["ends"]
    with Local() as other:
        early = connect(f"{other.url}/class/{teacher.code}/socket", viser=False)
        early.send(json.dumps({"type": "join", "me": "a" * 16}))
        assert closed(early) == 4404
        shown = {"eyes": True, "params": {"yaw": 5}, "ends": ends}
        with Teacher(other, key=teacher.key, **shown) as back, Learner(other, back.code, animal="Otter") as learner:
            assert back.welcome["ends"] == ends
            assert learner.animal == "Otter"
            assert learner.welcome["eyes"]
            assert learner.welcome["params"]["yaw"] == 5


def test_the_teachers_page_finds_the_class_as_it_stands(local: Local, teacher: Teacher) -> None:
    teacher.tell({"type": "show", "params": {"yaw": 70}})
    teacher.tell({"type": "look", "eyes": True})
    teacher.hear("grid", lambda grid: grid["eyes"])
    with Teacher(local, key=teacher.key) as second:
        assert second.welcome["eyes"]
        assert second.welcome["params"]["yaw"] == 70


# ---- the end


def test_a_class_is_over_when_its_teacher_says_so(local: Local) -> None:
    with Teacher(local) as teacher, Learner(local, teacher.code) as learner:
        teacher.tell({"type": "end"})
        learner.hear("end")
        assert closed(teacher.socket) == 4410
        learner.at(yaw=1)
        assert closed(learner.socket) == 4410
        wait_for(lambda: local.services.classes.find(teacher.code) is None, "the class to be gone")


def test_a_class_is_over_after_its_hours() -> None:
    with Local(class_hours=0.0001) as local, Teacher(local) as teacher, Learner(local, teacher.code) as learner:
        learner.hear("end")
        teacher.hear("end")
        assert not local.services.classes


# ---- limits


def test_no_other_key_leads_a_class(local: Local, teacher: Teacher) -> None:
    for key in (new_key(), teacher.key[::-1]):
        stranger = connect(f"{local.url}/class/{teacher.code}/{key}/socket", viser=False)
        stranger.send(json.dumps({"type": "open", "page": ALONE}))
        assert closed(stranger) == 4403
    never_opened = connect(f"{local.url}/class/{teacher.code[::-1]}/{new_key()}/socket", viser=False)
    never_opened.send(json.dumps({"type": "open", "page": ALONE}))
    assert closed(never_opened) == 4403


@pytest.mark.parametrize("page", ["", "sims/none/embed", "lessons/none", "../x", "https://elsewhere.example/"])
def test_a_class_is_about_pages_of_this_server_only(local: Local, page: str) -> None:
    key = new_key()
    socket = connect(f"{local.url}/class/{code_of(key)}/{key}/socket", viser=False)
    socket.send(json.dumps({"type": "open", "page": page}))
    assert closed(socket) == 4403


def test_a_learner_hears_of_nobody_else_and_may_say_nothing_of_the_teachers(local: Local, teacher: Teacher) -> None:
    before = local.refusals["class"]
    with Learner(local, teacher.code) as hostile, Learner(local, teacher.code) as other:
        nonsense: list[Any] = [
            {"type": "show", "params": {"yaw": 1}}, {"type": "look", "eyes": True}, {"type": "end"},
            {"type": "ask", "animal": other.animal}, {"type": "guess", "box": -1, "value": 0}, {"type": "at"}, [],
        ]  # fmt: skip
        for words in nonsense:
            hostile.socket.send(json.dumps(words))
        local.refused("class", before + 6)
        before_states = local.refusals["class state"]
        hostile.at(yaw="north")
        hostile.at(colour=1)
        local.refused("class state", before_states + 1)
        teacher.tell({"type": "look", "eyes": True})
        told = hostile.hear("eyes")
        assert {*told} == {"type", "on", "params"}
        assert not {teacher.key, other.me, other.animal} & {*re.findall(r"[\w-]+", json.dumps([told, hostile.welcome]))}


def test_a_full_class_says_so_and_forgets_who_has_left_first(
    local: Local, teacher: Teacher, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live, "MOST_LEARNERS", 2)
    with Learner(local, teacher.code) as first, Learner(local, teacher.code):
        third = Socket(f"{local.url}/class/{teacher.code}", {"type": "join", "me": "c" * 16})
        assert "as many as one may" in third.hear("full")["words"]
        assert closed(third.socket) == 1013
        first.socket.close()
        teacher.sees(first.animal, here=False)
        with Learner(local, teacher.code, me="c" * 16):
            pass


def test_there_are_so_many_classes_and_no_more(local: Local, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "MOST_CLASSES", 1)
    with Teacher(local) as teacher:
        key = new_key()
        second = Socket(f"{local.url}/class/{code_of(key)}/{key}", {"type": "open", "page": ALONE})
        assert "as many classes" in second.hear("full")["words"]
    wait_for(lambda: not (found := local.services.classes.find(teacher.code)) or not found.occupied, "it to be empty")
    with Teacher(local) as third:
        third.tell({"type": "end"})
        assert closed(third.socket) == 4410


def test_pages_of_other_sites_open_no_websocket_of_a_class(local: Local, teacher: Teacher) -> None:
    elsewhere = connect(f"{local.url}/class/{teacher.code}/socket", viser=False, origin="https://elsewhere.example")
    assert closed(elsewhere) == 4403


# ---- the pages


def test_a_teacher_opens_a_class_by_a_form(http: httpx.Client) -> None:
    form = http.get(f"/class?sim={SLUG}&yaw=45").text
    assert 'value="yaw=45"' in form
    said = {"page": ALONE, "begun": f"sims/{SLUG}", "state": "yaw=45", "challenge": ""}
    answer = http.post("/class", data=said)
    assert answer.status_code == 303
    assert answer.headers["cache-control"] == "no-store"
    place = answer.headers["location"]
    found = re.fullmatch(r"/class/(\w{6})/([\w-]{22})/\?page=(.*)&yaw=45", place)
    assert found, place
    assert code_of(found[2]) == found[1]
    page = http.get(place)
    assert page.headers["cache-control"] == "no-store"
    assert f"/class/{found[1]}" in page.text
    assert found[2] not in http.get(f"/class/{found[1]}").text
    assert "set-cookie" not in {*answer.headers, *page.headers}


def test_the_state_of_another_sim_is_left_out(http: httpx.Client) -> None:
    said = {"page": "sims/gimbal-lock", "begun": f"sims/{SLUG}", "state": "yaw=45"}
    assert "yaw" not in http.post("/class", data=said).headers["location"]


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ({"page": "sims/none"}, "Choose a lesson or a sim"),
        ({"page": ALONE, "challenge": "none"}, "challenge: received none"),
        ({"page": ALONE, "begun": f"sims/{SLUG}", "state": "yaw=north"}, "yaw: received north"),
    ],
)
def test_what_can_be_no_class_is_said(http: httpx.Client, said: dict[str, str], words: str) -> None:
    answer = http.post("/class", data=said)
    assert answer.status_code == 422
    assert words in answer.text


def test_a_code_is_found_however_it_is_written(http: httpx.Client) -> None:
    assert http.get("/class/ABC234").headers["location"] == "/class/abc234"
    assert http.get("/class?code=ABC234").headers["location"] == "/class/abc234"
    assert http.get("/class/abc234").status_code == 200
    assert http.get("/class/abc").status_code == 404
    assert "six letters" in http.get("/class?code=x").text
