"""Settings from the environment: defaults, bounds, and a clear message when one is wrong."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from app.settings import ROOT, Settings, load


@pytest.fixture(autouse=True)
def _bare_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [n for n in os.environ if n.startswith("SIM3_")]:
        monkeypatch.delenv(name)


def test_defaults_are_those_of_the_contract() -> None:
    settings = load()
    assert (settings.host, settings.port, settings.root_path) == ("127.0.0.1", 8000, "")
    assert settings.frame_ancestors == "*"
    assert settings.max_sessions >= 100


@pytest.mark.parametrize(
    ("name", "text", "field", "value"),
    [
        ("SIM3_HOST", "0.0.0.0", "host", "0.0.0.0"),
        ("SIM3_PORT", "9000", "port", 9000),
        ("SIM3_PORT", "0", "port", 0),
        ("SIM3_PORT", "", "port", 8000),
        ("SIM3_ROOT_PATH", "/maths/sim3", "root_path", "/maths/sim3"),
        ("SIM3_ROOT_PATH", "/sim3/", "root_path", "/sim3"),
        ("SIM3_ROOT_PATH", "/", "root_path", ""),
        ("SIM3_FRAME_ANCESTORS", "'self' https://school.example", "frame_ancestors", "'self' https://school.example"),
        ("SIM3_MAX_SESSIONS", "3", "max_sessions", 3),
        ("SIM3_MAX_UPLOAD", "20", "max_upload", 20),
    ],
)  # fmt: skip
def test_environment_is_read(monkeypatch: pytest.MonkeyPatch, name: str, text: str, field: str, value: object) -> None:
    monkeypatch.setenv(name, text)
    assert getattr(load(), field) == value


WRONG = [
    ("SIM3_PORT", "http"),
    ("SIM3_PORT", "-1"),
    ("SIM3_PORT", "65536"),
    ("SIM3_ROOT_PATH", "sim3"),
    ("SIM3_MAX_SESSIONS", "0"),
    ("SIM3_MAX_SESSIONS", "1.5"),
    ("SIM3_MAX_UPLOAD", "0"),
    ("SIM3_CLOUD_DIR", "/no/such/folder"),
    ("SIM3_FRAME_ANCESTORS", "https://a.example; script-src *"),
    ("SIM3_FRAME_ANCESTORS", "https://a.example\r\nx-evil: 1"),
    ("SIM3_ORIGINS", "https://a.example,https://b.example"),
]


@pytest.mark.parametrize(("name", "text"), WRONG)
def test_wrong_setting_is_named(monkeypatch: pytest.MonkeyPatch, name: str, text: str) -> None:
    monkeypatch.setenv(name, text)
    with pytest.raises(SystemExit) as ended:
        load()
    message = str(ended.value)
    assert name in message
    assert repr(text) in message
    assert "Traceback" not in message


def test_all_that_is_wrong_is_named_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SIM3_PORT", "http")
    monkeypatch.setenv("SIM3_ROOT_PATH", "sim3")
    with pytest.raises(SystemExit, match=r"(?s)SIM3_PORT.*SIM3_ROOT_PATH"):
        load()


def test_every_setting_is_described() -> None:
    assert all(field.description for field in Settings.model_fields.values())


def test_program_ends_with_the_message_and_without_a_traceback() -> None:
    environment = {**os.environ, "SIM3_PORT": "many"}
    ended = subprocess.run(
        [sys.executable, "-m", "app"], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=60
    )
    assert ended.returncode == 1
    assert "SIM3_PORT='many'" in ended.stderr
    assert "Traceback" not in ended.stderr + ended.stdout
