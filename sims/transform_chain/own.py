"""An arm of one's own: a table of Denavit and Hartenberg, or a robot's description in URDF."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from sims.kit.spelling import clipped, typed
from sims.transform_chain.actions import with_arm
from sims.transform_chain.params import MOST, ChainParams
from sims.transform_chain.urdf import Row, rows_of

EXAMPLE = """a      alpha  d     theta  joint
0.425  0      0.3   0      r
0.375  180    0     0      r
0      0      0.12  0      p"""
ORDER = ("a", "alpha", "d", "theta", "joint")
NAMES = {
    "a": "a", "r": "a", "α": "alpha", "alpha": "alpha", "d": "d", "θ": "theta", "theta": "theta", "joint": "joint",
    "type": "joint", "kind": "joint", "i": "number", "link": "number", "#": "number",
}  # fmt: skip
"""What a column is, by the word in a table's head."""
HEAD = re.compile(r"\s*[(\[]\s*(mm|cm|m|rad|deg|°)\s*[)\]]", re.IGNORECASE)
"""The unit of a column, in a table's head."""
CHANGES = re.compile(r"(?:q|θ|theta|d)_?\d*\*?(?P<by>[+-].+)?|\*", re.IGNORECASE)
"""What stands in a table for what the joint changes, with what is added to it."""
KINDS = {"r": "r", "revolute": "r", "p": "p", "prismatic": "p", "f": "f", "fixed": "f"}


def read(text: str) -> list[dict[str, Any]]:
    """The rows that a text describes: metres, degrees, and what each joint does. Raises ValueError in words."""
    rows = rows_of(text) if text.lstrip("\ufeff \t\r\n").startswith("<") else table(text)
    if not 1 <= len(rows) <= MOST:
        raise ValueError(f"This arm has {len(rows)} links; here it can have 1 to {MOST}.")
    return [row._asdict() for row in rows]


def changes(p: ChainParams, rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The arm of these rows, all its turning joints at angle 0."""
    column = {name: tuple(row[name] for row in rows) for name in ORDER}
    return with_arm(
        p, axes="z" * len(rows), lengths=column["a"], angles=(0.0,) * len(rows), twists=column["alpha"],
        offsets=column["d"], starts=column["theta"], joints="".join(column["joint"]),
    )  # fmt: skip


def table(text: str) -> list[Row]:
    """Rows of Denavit and Hartenberg: a, α, d, θ and r or p in each line, or what the first line says."""
    columns: Sequence[tuple[str, str]] = [(name, "") for name in ORDER]
    rows: list[Row] = []
    for number, line in enumerate(text.splitlines(), start=1):
        cells = _cells(line)
        if not any(re.search(r"\w|\*", cell) for cell in cells):
            continue
        if not rows and _is_head(cells[0]):
            columns = [(NAMES.get(_word(cell), "number"), cell.partition(":")[2]) for cell in cells]
            continue
        rows.append(_row(number, cells, columns))
    if not rows:
        raise ValueError("There are no rows in it: each line has the four numbers a, α, d, θ of a link.")
    return rows


def _cells(line: str) -> list[str]:
    """The cells of a line, with blanks, bars or semicolons between them, or commas; units of a head as in `a:mm`."""
    line = HEAD.sub(r":\1", line)
    cells = [cell.strip(",[]()") for cell in re.split(r"[\s|;]+", line) if cell.strip(",[]()")]
    return cells if len(cells) > 3 or "," not in line else [cell.strip(" []()") for cell in line.split(",")]


def _word(cell: str) -> str:
    return cell.partition(":")[0].partition("_")[0].lower()


def _is_head(cell: str) -> bool:
    return _word(cell) in NAMES


def _row(number: int, cells: Sequence[str], columns: Sequence[tuple[str, str]]) -> Row:
    named = {name: (cell, unit) for (name, unit), cell in zip(columns, cells, strict=False)}
    if len(cells) > len(columns) or not {*ORDER[:4]} <= named.keys():
        raise ValueError(f"Line {number} has {len(cells)} cells: a, α, d, θ are wanted, and r or p if you like.")
    slides = CHANGES.fullmatch(named["d"][0]) is not None
    word, _ = named.get("joint", ("p" if slides else "r", ""))
    if (kind := KINDS.get(word.lower())) is None:
        raise ValueError(f"Line {number}: a joint is r (it turns) or p (it slides), not “{clipped(word, 20)}”.")
    a, alpha, d, theta = (_number(number, name, *named[name]) for name in ORDER[:4])
    return Row(a, alpha, d, theta, kind)


def _number(number: int, name: str, cell: str, unit: str) -> float:
    changed = CHANGES.fullmatch(cell) if name in ("d", "theta") else None
    text = (changed["by"] or "0") if changed else cell
    own = "°" if name in ("alpha", "theta") else "m"
    given = unit if re.fullmatch(r"[-+−\d.,e]+", text, re.IGNORECASE) else ""
    try:
        return typed(text.removeprefix("+") + given, own)
    except ValueError:
        raise ValueError(f"Line {number}: {name} is “{clipped(cell, 20)}”, and no number.") from None
