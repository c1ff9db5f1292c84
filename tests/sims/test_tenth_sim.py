"""docs/tenth-sim.md, followed word for word: the tests that go through the registry find the new sim and pass."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SLUG = "spherical-coordinates"
STEPS = re.findall(
    r"^```python\n# (sims/\S+)\n(.*?)^```$", (ROOT / "docs/tenth-sim.md").read_text(encoding="utf-8"), re.S | re.M
)


def test_a_tenth_sim_takes_these_steps_and_nothing_else(tmp_path: Path) -> None:
    for name in ("geometry", "sims", "app", "tests", "static"):
        # with what is compiled already, but for what somebody is about to write
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("*.pyc.*"))
    for name in ("pyproject.toml", "README.md"):
        shutil.copy(ROOT / name, tmp_path / name)
    for path, text in STEPS:
        place = tmp_path / path
        place.parent.mkdir(exist_ok=True)
        if place.exists():  # the registry, of which the page shows the line to add
            registry = place.read_text(encoding="utf-8")
            (line,) = text.strip().splitlines()
            name = line.rpartition(" ")[2]
            registry = registry.replace("\nSIMS:", f"\n{line}\n\nSIMS:").replace(
                "    POINT_CLOUD,\n", f"    POINT_CLOUD,\n    {name},\n"
            )
            place.write_text(registry, encoding="utf-8")
        else:
            place.write_text(text, encoding="utf-8")
    ended = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", SLUG, "tests/sims/test_registry.py",
         "tests/sims/test_rooms.py", "tests/app/test_api.py"],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(tmp_path)}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ended.returncode == 0, ended.stdout[-4000:] + ended.stderr[-2000:]
    assert int(re.findall(r"(\d+) passed", ended.stdout)[-1]) > 50
