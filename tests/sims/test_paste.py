"""A text of a person's own: what is found in it, in a child with limits, and what is said where nothing is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import pytest

from sims.kit.column import pasted
from sims.kit.fields import Slider
from sims.kit.params import Params
from sims.kit.paste import Paste
from tests.sims.markup import bad_attributes, mistakes
from tests.sims.strange_reader import forever, sizes


class SizeParams(Params):
    """A size."""

    size: Annotated[float, Slider(0, 100, step=1, title="Size")] = 1
    """How large"""


def largest(_: SizeParams, found: Any) -> Mapping[str, Any]:
    return {"size": max(found["sizes"])}


PASTE = Paste("Own data", "Sizes", "Any <numbers>", "1, 2", sizes, largest, (".txt",))


def test_what_is_found_comes_back_plain() -> None:
    assert PASTE.found("π is 3, \u0000 and “14”") == {"sizes": [3, 14]}


def test_what_is_wrong_is_said_in_the_readers_words() -> None:
    with pytest.raises(ValueError, match=r"^There is no number in it\.$"):
        PASTE.found("nothing")


def test_a_reader_that_never_ends_is_ended() -> None:
    with pytest.raises(ValueError, match="can't be read within"):
        Paste("", "", "", "", forever, largest).found("x")


def test_the_box_is_well_formed_and_named() -> None:
    html = pasted(PASTE)
    assert not mistakes(html)
    assert not bad_attributes(html)
    assert '<label for="paste">Sizes</label>' in html
    assert "Any &lt;numbers&gt;." in html
    assert 'accept=".txt"' in html
    assert "From a file" not in pasted(Paste("", "", "", "", sizes, largest))
