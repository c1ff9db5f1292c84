"""viser's client as files: whole, and with what its own page would have set up."""

from __future__ import annotations

import random
import re

import pytest

from sims.kit import viser_client
from sims.kit.viser_client import DIGITS, decoded, files
from tests.server import ROOT


def encoded(data: bytes) -> str:
    """The packing that `decoded` undoes, written the other way round and slowly."""
    text = ""
    for at in range(0, len(data), 4):
        group = data[at : at + 4]
        value, digits = int.from_bytes(group, "big"), ""
        for _ in range(len(group) + 1):
            value, digit = divmod(value, 88)
            digits = DIGITS[digit] + digits
        text += digits
    return text


@pytest.mark.parametrize("length", [0, 1, 2, 3, 4, 5, 8, 1023])
def test_decoding_gives_back_what_was_packed(length: int) -> None:
    for data in (random.Random(length).randbytes(length), b"\xff" * length, b"\0" * length):
        assert decoded(encoded(data)) == data


def test_files_are_what_their_names_say() -> None:
    style, code = files()["client.css"].decode("utf-8"), files()["client.js"].decode("utf-8")
    assert style.count("{") == style.count("}") > 500
    assert "mantine" in style
    assert "__viserZstdWasm" in code
    assert "<" not in style[:10]
    assert code.rstrip().endswith((";", "}"))


def test_loader_sets_up_what_the_code_expects_and_then_loads_it() -> None:
    loader = files()["loader.js"].decode("utf-8")
    assert loader.startswith("(async()=>{")
    assert loader.index("globalThis.__viserZstdWasm=") < loader.index('import("./client.js")')
    assert loader.endswith("})();")


DOM = "".join((ROOT / "static" / "viewer" / name).read_text() for name in ("viser_dom.js", "frames.js"))
STYLES = (ROOT / "static" / "viser.css").read_text()
NAMES = sorted(
    {*re.findall(r"mantine-([A-Z]\w+)-\w+", DOM + STYLES), *re.findall(r"data-dock-\w+", DOM + STYLES)}
    | {*re.findall(r"^    (\w+): [`\w]", DOM, re.MULTILINE), *re.findall(r"mutable(?:, \"|\.)(\w+)", DOM)}
    | {"__viserMutable", "canvas", "setDpr", "nodePoseData", "ViewerCameraMessage", "look_at", "CAMERA"} - {"CAMERA"}
)
"""Names of the client's components, icons and regions, and of what it reads from the address."""


@pytest.mark.parametrize("words", ["vec4(0.0, 0.0, 0.0, a)", "vec4(1.0, 1.0, 1.0, 0.85 * vAlpha)"])
def test_what_the_dark_theme_changes_in_labels_is_there(words: str) -> None:
    assert files()["client.js"].decode("utf-8").count(words) == 1
    assert words in DOM


def test_the_one_photograph_in_the_client_is_the_map_that_is_left() -> None:
    assert files()["client.js"].decode("utf-8").count("data:image/jpeg") == 1
    assert 'MAP = "data:image/jpeg"' in DOM


@pytest.mark.parametrize("name", [*NAMES, "Viser", "hasFocus"])
def test_what_the_companion_knows_of_the_client_is_there(name: str) -> None:
    assert name in DOM + STYLES
    assert name in files()["client.js"].decode("utf-8")


def test_nobody_else_knows_the_clients_markup() -> None:
    assert {"Paper", "Notifications", "data-dock-root", "websocket", "initialCameraFov", "requestRender"} <= {*NAMES}
    for path in (ROOT / "static").rglob("*.[cj]s*"):
        if path.name not in ("viser_dom.js", "viser.css"):
            assert not re.search(r"mantine|tabler|data-dock|shaderSource|__viser", path.read_text()), path.name


def test_a_page_of_another_make_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(viser_client, "PACKED", re.compile("never there"))
    with pytest.raises(RuntimeError, match="viser_client"):
        files.__wrapped__()
