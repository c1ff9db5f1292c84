"""What teachers paste to show a sim: for each place, where it goes and the text. Every such text is made here."""

from __future__ import annotations

import json
from html import escape
from typing import NamedTuple

ALLOW = "fullscreen; clipboard-write"
"""What a sim asks of the frame that it is in."""
HEIGHT = 600
"""Pixels, where nobody says another height: controls and scene have room."""


class Snippet(NamedTuple):
    """A text to be pasted."""

    name: str
    title: str
    """The place that it is for."""
    how: str
    """What to do with it there."""
    text: str


def iframe(address: str, title: str, width: int | str = "100%", height: int = HEIGHT) -> str:
    """The frame of a sim, as HTML on one line: Markdown takes it for one block."""
    return (
        f'<iframe src="{escape(address)}" title="{escape(title)}" width="{width}" height="{height}" '
        f'style="border: 0" allow="{ALLOW}" allowfullscreen loading="lazy"></iframe>'
    )


def snippets(address: str, title: str, height: int = HEIGHT) -> list[Snippet]:
    """The forms of an address, the plainest first."""
    frame = iframe(address, title, height=height)
    return [Snippet(name, place, how, text) for name, (place, how, text) in {
        "html": ("Any web page (HTML)", "Put it where the sim is to be.", frame),
        "moodle": ("Moodle", "In the editor open Tools, then Source code, and paste it there.", f"<div>{frame}</div>"),
        "canvas": (
            "Canvas", "In the editor choose Insert, then Embed, and paste it there; or use the HTML view (</>).", frame,
        ),
        "mkdocs": (
            "MkDocs", "Paste it into the page’s Markdown, with an empty line before and after.", f"<div>{frame}</div>",
        ),
        "jupyter-book": (
            "Jupyter Book 1, Sphinx with MyST", "Paste it into a page in MyST Markdown, or into a Markdown cell.",
            f"```{{raw}} html\n{frame}\n```",
        ),
        "myst": (
            "Jupyter Book 2, MyST", "Paste it into a page in Markdown. Its height follows the width.",
            f":::{{iframe}} {address}\n:width: 100%\n:::",
        ),
        "quarto": ("Quarto", "Paste it into the document, for output as HTML.", f"```{{=html}}\n{frame}\n```"),
        "notebook": (
            "Notebook cell (Jupyter, Colab)", "Paste it into a code cell and run it.", _cell(address, title, height),
        ),
    }.items()]  # fmt: skip


def _cell(address: str, title: str, height: int) -> str:
    """IPython makes a frame of it, and puts the extras into that as they are."""
    extras = json.dumps([f'title="{escape(title)}"', f'allow="{ALLOW}"'], ensure_ascii=False)
    return (
        "from IPython.display import IFrame\n\n"
        f'IFrame({json.dumps(address)}, width="100%", height={height}, extras={extras})'
    )
