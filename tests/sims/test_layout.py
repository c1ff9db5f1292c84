"""The numbers of the page's layout stand in one place."""

from __future__ import annotations

import re
from dataclasses import asdict
from pathlib import Path

import pytest

from sims.kit.layout import LAYOUT
from tests.server import ROOT

READERS = [
    *sorted((ROOT / "static" / "viewer").glob("*.js")),
    ROOT / "sims/kit/viewer.py",
    ROOT / "sims/kit/scene/view.py",
]
SHADER = "0.75 * vAlpha"
"""How opaque the plate of a label is: another number."""
EDGES = {value + shift for value in (LAYOUT.phone, LAYOUT.narrow, LAYOUT.flat, LAYOUT.low) for shift in (-1, 0, 1)}


@pytest.mark.parametrize("path", READERS, ids=lambda path: path.name)
def test_no_number_of_the_layout_is_written_again(path: Path) -> None:
    text = path.read_text(encoding="utf-8").replace(SHADER, "")
    text = text.replace("[640, 900]", "").replace("[480, 900]", "")  # heights that a frame may ask for
    numbers = {float(n) for n in re.findall(r"(?<![\w.#])\d+(?:\.\d+)?(?![\w.])", text)}
    assert not numbers & {float(n) for n in {*asdict(LAYOUT).values(), LAYOUT.field / 2, *EDGES}}


@pytest.mark.parametrize("name", ["viewer.css", "viser.css"])
def test_the_style_sheets_ask_the_page_for_its_size(name: str) -> None:
    assert not re.search(r"@media[^{]*(?:width|height)", (ROOT / "static" / name).read_text(encoding="utf-8"))


def test_the_page_says_what_the_style_sheets_ask() -> None:
    styles = "".join((ROOT / "static" / name).read_text(encoding="utf-8") for name in ("viewer.css", "viser.css"))
    boot = (ROOT / "static" / "viewer" / "boot.js").read_text(encoding="utf-8")
    for name in ("data-phone", "data-tight"):
        assert f":where([{name}])" in styles
        assert f'toggleAttribute("{name}"' in boot
