"""The launcher as a course, the administrator's own lessons, the concepts, and what the server says of itself."""

from __future__ import annotations

import html
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from app.lessons.concepts import CONCEPTS, MEANINGS
from app.settings import ROOT
from tests.app.conftest import Local

GOOD = """---
title: Our robot <b>
summary: Where the wrist locks.
sim: gimbal-lock
minutes: 15
---

## [Start](?pitch=0)

Turn the middle ring.
"""
FILES = {
    "our-robot.md": GOOD,
    "broken.md": GOOD.replace("?pitch=0", "?pitch=900"),
    "Strange name.md": GOOD,
    "notes.txt": "no lesson",
}


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """A server with a folder of lessons: a good one, a broken one, and one with a name that no address can have."""
    folder: Path = tmp_path_factory.mktemp("lessons")
    for name, text in FILES.items():
        (folder / name).write_text(text, encoding="utf-8")
    with Local(lesson_dir=folder) as local:
        yield local.http


def test_own_lessons_stand_on_the_second_shelf_and_open(own: httpx.Client) -> None:
    page = own.get("/").text
    shelf = page.partition('id="own"')[2].partition("</section>")[0]
    assert re.findall(r'href="/lessons/([^"]*)"', shelf) == ["our-robot"]
    for words in ("Our robot &lt;b&gt;", "Where the wrist locks.", "15 min", "With Gimbal lock", "thumbs/gimbal-lock"):
        assert words in shelf
    assert "Turn the middle ring." in own.get("/lessons/our-robot").text


def test_a_file_that_is_no_lesson_is_listed_with_what_is_wrong(own: httpx.Client) -> None:
    shelf = html.unescape(own.get("/").text)
    assert "broken.md isn’t shown: 1 mistake" in shelf
    assert "Line 8: the state ?pitch=900. Allowed: for pitch: a number from -180 to 180." in shelf
    assert "Strange name.md isn’t shown" in shelf
    assert "small letters, digits and hyphens" in shelf
    assert "notes.txt" not in shelf
    assert own.get("/lessons/broken").status_code == 404


def test_without_a_folder_there_is_no_second_shelf(http: httpx.Client) -> None:
    assert "Lessons of this server" not in http.get("/").text


def test_every_concept_has_its_sentence_and_its_place(http: httpx.Client) -> None:
    assert list(MEANINGS) == list(CONCEPTS)
    assert len(CONCEPTS) == 17
    page = html.unescape(http.get("/concepts").text)
    launcher = html.unescape(http.get("/").text)
    for slug, title in CONCEPTS.items():
        assert f'<div id="{slug}">' in page
        assert MEANINGS[slug] in page
        assert f">{title}<" in launcher
    assert "Learnt in Gimbal lock." in page
    assert http.get("/concepts/gimbal-lock").headers["location"] == "/sims/gimbal-lock#concept-gimbal-lock"
    assert http.get("/concepts/nothing").status_code == 404


def test_about_says_which_version_it_is_and_every_page_leads_there(http: httpx.Client) -> None:
    about = http.get("/about").text
    version = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["version"]
    assert f"This is version {version}." in about
    for address in ("/", "/sims/camera", "/concepts", "/docs", "/sims/camera/text", "/nothing", "/sims/camera/embed"):
        answer = http.get(address)
        assert 'href="/about"' in answer.text, address
        assert "set-cookie" not in answer.headers


def test_our_scripts_store_nothing() -> None:
    for path in {*(ROOT / "static").rglob("*.js")} - {ROOT / "static" / "check.js"}:  # that one tries what is allowed
        assert not re.search(r"localStorage|sessionStorage|indexedDB|document\.cookie", path.read_text("utf-8")), path
