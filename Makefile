# Every target sets up what it needs in .venv. Needed beforehand: make, and Python 3.11 or newer.

SIM3_HOST ?= 127.0.0.1
SIM3_PORT ?= 8000
export SIM3_HOST SIM3_PORT
# Servers and readers of files that tests start would else translate every module anew.
unexport PYTHONDONTWRITEBYTECODE

UV_VERSION := 0.13.9
VENV := .venv
BIN := $(VENV)/bin/python
BENCH := $(VENV)/bench
# What the benchmarks compare with, as pyproject.toml says.
COMPARED = $(shell $(BIN) -c 'import tomllib; p = tomllib.load(open("pyproject.toml", "rb"))["project"]; \
	print(*(repr(r) for r in p["optional-dependencies"]["bench"]))')
INSTALL := -m pip install --quiet --disable-pip-version-check --require-hashes

# The first interpreter that runs, is new enough and can make virtual environments. PYTHON=… names another.
PYTHON ?= $(shell for python in python3.13 python3.12 python3.11 python3 python; do \
	if $$python -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; \
	then echo $$python; break; fi; done)

.PHONY: help run test fuzz check bench shots lock clean
.DELETE_ON_ERROR:

help:
	@echo "make run     serve the sims at http://$(SIM3_HOST):$(SIM3_PORT)/"
	@echo "make test    run all tests, those in a browser too (ARGS='-k name' for some)"
	@echo "make fuzz    try the properties with other examples than make test does (ARGS='-k name' for some)"
	@echo "make check   lint (Python, JavaScript, CSS, templates), format, types, import direction"
	@echo "make bench   measure speed, beside Open3D where that can be installed"
	@echo "make shots   take screenshots"
	@echo "make lock    choose dependency versions anew"
	@echo "make clean   remove what the targets made"

run: $(VENV)/run.stamp
	@echo "Starting Sim3 on $(SIM3_HOST), port $(SIM3_PORT)"
	@$(BIN) -m app

test: $(VENV)/test.stamp
	@$(BIN) -m tests.browser --ensure
	@$(BIN) -m tests.proxies
	@echo "Running the tests, those in a browser last"
	@$(BIN) -m pytest --numprocesses auto --maxprocesses 4 $(ARGS)

fuzz: $(VENV)/test.stamp
	@echo "Looking for examples that break a property"
	@SIM3_EXAMPLES=fuzz $(BIN) -m pytest -m "not e2e" --numprocesses auto tests/geometry tests/sims $(ARGS)

check: $(VENV)/test.stamp
	@echo "Checking lint, format, types, import direction and the rooms of the sims"
	@$(BIN) -m ruff check
	@$(BIN) -m ruff format --check
	@$(BIN) -m mypy
	@$(VENV)/bin/oxlint --deny-warnings static
	@$(BIN) -m djlint --quiet --lint app/templates
	@$(BIN) -m pytest --quiet tests/test_imports.py tests/test_style_sheets.py tests/test_words.py \
		tests/sims/test_rooms.py

bench: $(BENCH)/bench.stamp
	@$(BENCH)/bin/python -m tests.browser --ensure
	@echo "Running the benchmarks"
	@$(BENCH)/bin/python -m benchmarks $(ARGS)

shots: $(VENV)/test.stamp
	@$(BIN) -m tests.browser --ensure
	@echo "Taking screenshots"
	@$(BIN) -m tests.shots $(ARGS)

$(BIN):
	@test -n "$(PYTHON)" || { \
		echo "Sim3 needs Python 3.11 or newer with its venv module, and found none on PATH."; \
		echo "Debian, Ubuntu: apt-get install python3 python3-venv. Elsewhere: python.org/downloads."; \
		echo "If it has another name: make PYTHON=/path/to/python3.12 …"; exit 1; } >&2
	@echo "Making $(VENV) with $(PYTHON)"
	@$(PYTHON) -m venv --clear $(VENV)

$(VENV)/run.stamp: requirements.lock $(BIN)
	@echo "Installing what the application needs"
	@$(BIN) $(INSTALL) -r requirements.lock
	@touch $@

$(VENV)/test.stamp: requirements-test.lock $(BIN)
	@echo "Installing what the application, its tests and checks need"
	@$(BIN) $(INSTALL) -r requirements-test.lock
	@touch $@ $(VENV)/run.stamp

# Open3D comes with packages that would break the tests, and not for every Python and machine: the benchmarks have an
# environment of their own, and run without it too.
$(BENCH)/bench.stamp: requirements-test.lock pyproject.toml $(BIN)
	@echo "Making $(BENCH), with Open3D to compare with"
	@$(BIN) -m venv --clear $(BENCH)
	@$(BENCH)/bin/python $(INSTALL) -r requirements-test.lock
	@$(BENCH)/bin/python -m pip install --quiet --disable-pip-version-check --only-binary :all: $(COMPARED) || \
		echo "Open3D could not be installed (it is not there for every Python and machine): not compared with it." >&2
	@touch $@

# The tests run on the versions that are deployed: their lock is constrained by the first one.
COMPILE = $(VENV)/lock/bin/python -m uv pip compile --quiet --universal --python-version 3.11 \
	--fork-strategy fewest --generate-hashes --no-annotate --no-emit-index-url --no-emit-find-links \
	--upgrade --custom-compile-command "make lock" pyproject.toml

lock: | $(BIN)
	@echo "Choosing dependency versions from pyproject.toml"
	@$(BIN) -m venv --clear $(VENV)/lock
	@$(VENV)/lock/bin/python -m pip install --quiet --disable-pip-version-check uv==$(UV_VERSION)
	@$(COMPILE) --output-file requirements.lock
	@$(COMPILE) --extra test --extra dev --constraints requirements.lock --output-file requirements-test.lock

clean:
	@echo "Removing $(VENV), caches and results"
	@rm -rf $(VENV) .hypothesis .mypy_cache .pytest_cache .ruff_cache build dist *.egg-info test-results
	@find geometry sims app tests benchmarks -name __pycache__ -type d -prune -exec rm -rf {} +
