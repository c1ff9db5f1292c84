"""The proxies that tests put in front of the server: nginx and HAProxy, as they are installed.

`python -m tests.proxies` installs what is missing, where it can.
"""

from __future__ import annotations

import os
import shutil
import sys

from tests.browser import debian_commands, run_all

PACKAGES = {"nginx": "nginx-light", "haproxy": "haproxy"}


def find(name: str) -> str | None:
    """Path of a proxy's executable."""
    return shutil.which(name) or shutil.which(name, path="/usr/sbin:/usr/local/sbin:/opt/homebrew/bin")


def main() -> None:
    if missing := [package for name, package in PACKAGES.items() if not find(name)]:
        run_all(debian_commands(*missing))
    missing = [name for name in PACKAGES if not find(name)]
    if missing and os.environ.get("CI"):
        sys.exit(f"The tests need {' and '.join(missing)}, and could not install them.")
    if missing:
        print(f"{' and '.join(missing)} not found: the tests of proxies are left out. Install them to run all.")
    else:
        print("The tests use nginx and HAProxy")


if __name__ == "__main__":
    main()
