"""The browser that the tests drive: an installed Chromium, or Playwright's own.

`python -m tests.browser` says which one it is; with `--ensure` it installs one where there is none.
"""

from __future__ import annotations

import argparse
import functools
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TypedDict

NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
"""The first is Chromium without windows, which takes a fifth less of the machine."""

WEBGL_WITHOUT_GPU = ("--enable-unsafe-swiftshader",)
FOR_TESTS = (
    # the same pixels on every machine, whatever GPU it has; and where WebGL is drawn in software, the page around it is
    # put together in less time so
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--disable-gpu-compositing",
)
COARSE = 0.35
"""Scale of a page for tests that look at no pixel: an eighth of them, which take most of the time without a GPU."""
QUIET = (
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-domain-reliability",
    "--disable-extensions",
    "--disable-sync",
    "--metrics-recording-only",
    "--no-default-browser-check",
    "--no-first-run",
)

WHAT_TO_DO = f"""\
The browser tests need Chromium or Google Chrome, and none was found or could be installed.
Do one of these, then run the command again:
  Debian, Ubuntu:      apt-get install chromium
  Fedora:              dnf install chromium
  macOS:               brew install --cask google-chrome
  any, over internet:  {Path(sys.executable)} -m playwright install --with-deps chromium
  installed elsewhere: set SIM3_BROWSER to the path of its executable
"""

# In a process of its own: Playwright's sync API can't be started twice in one.
ASK_PLAYWRIGHT = """\
from playwright.sync_api import sync_playwright
with sync_playwright() as playwright:
    print(playwright.chromium.executable_path)
"""


class LaunchOptions(TypedDict):
    """Arguments of Playwright's `chromium.launch`."""

    executable_path: str
    args: list[str]


class BrowserMissing(RuntimeError):
    """No browser for the tests; the message says what to install."""


@functools.cache
def find_browser(*, windows: bool = False) -> str | None:
    """Path of the executable: `SIM3_BROWSER`, one on PATH (rather with windows, or without), or Playwright's own."""
    if named := os.environ.get("SIM3_BROWSER"):
        found = shutil.which(named)
        if found is None or not _starts(found):
            raise BrowserMissing(f"SIM3_BROWSER is {named!r}, which is no program that starts")
        return found
    names = (*NAMES[1:], NAMES[0]) if windows else NAMES
    installed = (path for name in names if (path := shutil.which(name)) and _starts(path))
    return next(installed, None) or _playwrights_own()


def launch_options(*more: str, windows: bool = False) -> LaunchOptions:
    """How to launch the browser: also as root, without a GPU, and without traffic of its own.

    What a frame takes is measured in one that has `windows` where it is installed: without them, frames go nowhere.
    """
    browser = find_browser(windows=windows)
    if browser is None:
        raise BrowserMissing(WHAT_TO_DO)
    # Chromium's sandbox refuses to run as root.
    sandbox = ["--no-sandbox"] if _is_root() else []
    return {"executable_path": browser, "args": [*sandbox, *WEBGL_WITHOUT_GPU, *QUIET, *more]}


def ensure_browser() -> str:
    """Find a browser, or install one: Playwright's, else one of Debian's packages when root."""
    attempts = (
        ([sys.executable, "-m", "playwright", "install", "chromium"],),
        debian_commands("chromium-headless-shell"),
        debian_commands("chromium"),
    )
    for commands in attempts:
        if browser := find_browser():
            return browser
        run_all(commands)
        find_browser.cache_clear()
    if browser := find_browser():
        return browser
    raise BrowserMissing(WHAT_TO_DO)


def _playwrights_own() -> str | None:
    asked = subprocess.run([sys.executable, "-c", ASK_PLAYWRIGHT], capture_output=True, text=True, check=False)
    path = asked.stdout.strip()
    return path if Path(path).is_file() and _starts(path) else None


def _starts(path: str) -> bool:
    """Whether it runs at all: Ubuntu's package is a stub without snap, a download may lack libraries."""
    try:
        asked = subprocess.run([path, "--version"], capture_output=True, timeout=60, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return asked.returncode == 0


def debian_commands(*packages: str) -> tuple[list[str], ...]:
    """What installs packages of Debian's, where that can be done."""
    if not (_is_root() and shutil.which("apt-get")):
        return ()
    return ["apt-get", "update"], ["apt-get", "install", "-y", *packages]


def run_all(commands: tuple[list[str], ...]) -> None:
    """Run commands until one fails; what they print goes to standard error."""
    environment = os.environ | {"DEBIAN_FRONTEND": "noninteractive"}
    for command in commands:
        print("tests:", *command, file=sys.stderr, flush=True)
        done = subprocess.run(
            command, env=environment, stdin=subprocess.DEVNULL, stdout=sys.stderr.fileno(), check=False
        )
        if done.returncode != 0:
            return


def _is_root() -> bool:
    return hasattr(os, "geteuid") and os.geteuid() == 0


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.browser", description=__doc__)
    parser.add_argument("--ensure", action="store_true", help="install a browser where there is none")
    try:
        browser = ensure_browser() if parser.parse_args().ensure else find_browser()
    except BrowserMissing as missing:
        sys.exit(str(missing))
    if browser is None:
        sys.exit(WHAT_TO_DO)
    print(f"The tests use {browser}")


if __name__ == "__main__":
    main()
