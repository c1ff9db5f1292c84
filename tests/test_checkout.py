"""The checkout itself: what runs is declared, and what else is installed doesn't matter to the tests."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

from tests.test_imports import OWN, ROOT, imports_of, said, sources


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def declared() -> set[str]:
    """Distributions that pyproject.toml declares for what runs."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return {normal(re.split(r"[^\w.-]", requirement)[0]) for requirement in project["dependencies"]}


def imported() -> dict[str, str]:
    """Other people's packages that what runs imports, and where."""
    found: dict[str, str] = {}
    for path in sources("geometry", "sims", "app"):
        for line, name in imports_of(path):
            top = name.split(".")[0]
            if top not in OWN and top not in sys.stdlib_module_names:
                found.setdefault(top, f"{path.relative_to(ROOT)}:{line}")
    return found


def test_what_is_imported_when_the_sims_run_is_declared() -> None:
    known, allowed, found = packages_distributions(), declared(), imported()
    assert "numpy" in found
    for name, place in found.items():
        if "/script_" in place:  # runs where a learner has its libraries
            continue
        assert {normal(d) for d in known.get(name, [name])} & allowed, f"{place} imports {name}, which isn't declared"


def test_the_image_holds_what_the_server_reads() -> None:
    """`ROOT / "name"` in what runs is a file or folder of the checkout; .dockerignore says which are in the image."""
    held = {line[1:] for line in (ROOT / ".dockerignore").read_text("utf-8").splitlines() if line.startswith("!")}
    read = {
        name: f"{path.relative_to(ROOT)}:{line}"
        for path in sources("geometry", "sims", "app")
        for line, name in said(path).at_root
    }
    assert "pyproject.toml" in read
    assert {*read} <= held, f"not in the image: {[f'{name} ({read[name]})' for name in {*read} - held]}"


def test_a_foreign_plugin_of_pytest_does_not_hurt(tmp_path: Path) -> None:
    foreign = tmp_path / "foreign-1.0.dist-info"
    foreign.mkdir()
    (foreign / "METADATA").write_text("Metadata-Version: 2.1\nName: foreign\nVersion: 1.0\n")
    (foreign / "entry_points.txt").write_text("[pytest11]\nforeign = foreign_plugin\n")
    (tmp_path / "foreign_plugin.py").write_text("import warnings\nwarnings.warn('old', DeprecationWarning)\n")
    asked = [sys.executable, "-m", "pytest", "-q", "--collect-only", "--noconftest", "tests/test_style_sheets.py"]
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    ended = subprocess.run(asked, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stdout + ended.stderr
