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
    loaded = loaded_by([name for name in MODULES if not name.startswith("geometry.clouds")])
    assert "geometry" in loaded
    assert loaded - set(sys.stdlib_module_names) <= {"geometry", "numpy"}


def test_only_point_clouds_need_scipy() -> None:
    loaded = loaded_by([name for name in MODULES if name.startswith("geometry.clouds")])
    assert {"geometry", "scipy"} <= loaded
    assert not loaded & {"viser", "fastapi", "trimesh", "sims", "app"}


def loaded_by(modules: list[str]) -> set[str]:
    program = REPORT.format(modules=", ".join(modules))
    run = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(run.stdout.split())


def test_every_module_says_what_it_is_for() -> None:
    assert len(MODULES) >= 15
    for name in MODULES:
        assert len((importlib.import_module(name).__doc__ or "").strip()) > 20, name
