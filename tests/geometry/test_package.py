"""The package stands alone."""

import importlib
import pkgutil
import subprocess
import sys
from pathlib import Path

import geometry

ROOT = Path(geometry.__file__).resolve().parent.parent
MODULES = [module.name for module in pkgutil.walk_packages(geometry.__path__, "geometry.")]

REPORT = """
import sys, numpy
before = set(sys.modules)
import {modules}
print(*{{name.partition(".")[0] for name in set(sys.modules) - before}})
"""


def test_imports_nothing_but_numpy_and_the_standard_library() -> None:
    program = REPORT.format(modules=", ".join(MODULES))
    run = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    loaded = set(run.stdout.split())
    assert "geometry" in loaded
    assert loaded - set(sys.stdlib_module_names) <= {"geometry", "numpy"}


def test_every_module_says_what_it_is_for() -> None:
    assert len(MODULES) >= 15
    for name in MODULES:
        assert len((importlib.import_module(name).__doc__ or "").strip()) > 20, name
