"""The same mathematics as a script that a learner can run anywhere, with the numbers of a state.

A sim's `script_numpy.py` and `script_library.py` are such scripts, at the defaults. Where they set a parameter of the
sim, its value is replaced by the state's, and nothing else is.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from app.settings import ROOT
from sims.kit.params import Params
from sims.kit.sim import Sim

LANGUAGES = ("numpy", "library")
LIBRARIES = {"cv2": "OpenCV", "scipy": "SciPy"}
"""What the library of a script is called, by the module that it imports."""


class Place(NamedTuple):
    """Where a script sets a parameter: from and to which letter, and whether to a number with a point."""

    name: str
    start: int
    end: int
    real: bool


class Script(NamedTuple):
    """A script as it stands in its file."""

    title: str
    """What its library is called."""
    text: str
    places: tuple[Place, ...]


def script(sim: Sim[Any, Any], language: str) -> Script | None:
    """A sim's script, if it has one."""
    names = frozenset(sim.params.model_fields)
    return _read(ROOT / "sims" / sim.slug.replace("-", "_") / f"script_{language}.py", names)


@cache
def _read(path: Path, names: frozenset[str]) -> Script | None:
    if not path.is_file():
        return None
    text = path.read_text("utf-8")
    tree = ast.parse(text)
    imported = {name for node in ast.walk(tree) for name in _imported(node)}
    title = next((title for module, title in LIBRARIES.items() if module in imported), "NumPy")
    return Script(title, text, tuple(_places(names, text, tree)))


def _imported(node: ast.AST) -> list[str]:
    names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
    return [name.partition(".")[0] for name in [*names, getattr(node, "module", None) or ""]]


def _places(names: frozenset[str], text: str, tree: ast.Module) -> list[Place]:
    starts = [0]
    for line in text.encode().splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    found = []
    for node in tree.body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if name in names and _is_set(value):
                start = starts[value.lineno - 1] + value.col_offset
                end = starts[(value.end_lineno or 0) - 1] + (value.end_col_offset or 0)
                found.append(Place(name, start, end, isinstance(getattr(value, "value", None), float)))
    return found


def _is_set(value: ast.expr) -> bool:
    """Whether it is spelled out, and not worked out."""
    return not any(isinstance(node, ast.Name | ast.Call) for node in ast.walk(value))


def of_state(found: Script, params: Params) -> str:
    """A script with the numbers of a state."""
    data, written, before = found.text.encode(), b"", 0
    for each in found.places:
        value = getattr(params, each.name)
        written += data[before : each.start] + _literal(float(value) if each.real else value).encode()
        before = each.end
    return (written + data[before:]).decode()


def _literal(value: Any) -> str:
    """A value as Python spells it, with the quotes of the rest of the script."""
    plain = isinstance(value, str) and '"' not in value and repr(value) == f"'{value}'"
    return f'"{value}"' if plain else repr(value)


def notebook(text: str, title: str, link: str) -> str:
    """A script as a Jupyter notebook, under a heading and a link to the state."""
    import nbformat  # takes long to load, and is needed seldom
    from nbformat import v4

    doc, _, code = text.removeprefix('"""').partition('"""')
    parts = re.split(r"\n{2,}(?=# )", code.strip())
    cells = [v4.new_markdown_cell(f"# {title}\n\n{doc.strip()}\n\n[The sim in this state]({link})", id="about")]
    cells += [v4.new_code_cell(part.strip(), id=f"code-{k}") for k, part in enumerate(parts, 1)]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    made = v4.new_notebook(cells=cells, metadata=kernel)
    nbformat.validate(made)
    return str(nbformat.writes(made)) + "\n"
