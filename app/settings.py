"""Settings from the environment (SIM3_…), validated at start."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Literal

from pydantic import Field, ValidationError, field_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

from app.sockets import origins

ROOT = Path(__file__).resolve().parent.parent


class Settings(BaseSettings):
    """Everything an administrator can set; each name is SIM3_ plus the field in capitals."""

    model_config = SettingsConfigDict(env_prefix="SIM3_", env_ignore_empty=True)

    host: str = Field("127.0.0.1", description="address to listen on")
    port: int = Field(8000, ge=0, le=65535, description="port to listen on")
    root_path: str = Field("", description="path prefix behind a proxy, as in /sim3")
    frame_ancestors: str = Field("*", description="sites that may embed the sims beside our own pages, as in CSP")
    cloud_dir: Path | None = Field(None, description="folder whose files sims that take files offer to everybody")
    lesson_dir: Path | None = Field(None, description="folder whose lessons (.md) stand on the launcher's second shelf")
    max_upload: int = Field(100, ge=1, le=2000, description="megabytes that a file of a learner may have")
    max_memory: int = Field(1500, ge=50, description="megabytes that the solutions of point clouds may take in all")
    max_sessions: int = Field(500, ge=1, le=100_000, description="sessions open at once")
    max_sessions_per_address: int = Field(200, ge=1, le=100_000, description="of these, from one network address")
    max_openings: int = Field(180, ge=1, le=100_000, description="sessions that one address may open within a minute")
    idle_minutes: float = Field(120, gt=0, description="minutes without input after which a session is put away")
    class_hours: float = Field(3, gt=0, le=24, description="hours after which a class ends by itself")
    drain_seconds: float = Field(
        0, ge=0, le=8, description="seconds between SIGTERM, from which /readyz says 503, and the end"
    )
    log: Literal["text", "json"] = Field("text", description="how lines of the log are written")
    origins: str = Field("", description="further origins, separated by spaces, whose pages may open a websocket")
    forwarded_allow_ips: str = Field(
        "127.0.0.1", validation_alias="FORWARDED_ALLOW_IPS",
        description="addresses of proxies, separated by commas, whose X-Forwarded-… headers are believed; * is any",
    )  # fmt: skip

    @field_validator("root_path")
    @classmethod
    def _prefix(cls, value: str) -> str:
        value = value.rstrip("/")
        if value and not value.startswith("/"):
            raise ValueError("must start with a slash, as in /sim3")
        return value

    @field_validator("cloud_dir", "lesson_dir")
    @classmethod
    def _folder(cls, value: Path | None) -> Path | None:
        if value is not None and not value.is_dir():
            raise ValueError("must be a folder that is there")
        return value

    @field_validator("frame_ancestors", "origins")
    @classmethod
    def _one_line(cls, value: str) -> str:
        if any(c in value for c in ";,\r\n"):
            raise ValueError("must be a list separated by spaces, without semicolons, commas or line breaks")
        return value

    @field_validator("origins")
    @classmethod
    def _are_origins(cls, value: str) -> str:
        for text in value.split():
            try:
                origins.parse(text)
            except ValueError:
                raise ValueError(f"{text[:80]!r} is no origin such as https://school.example, without a path") from None
        return value

    @field_validator("frame_ancestors")
    @classmethod
    def _with_our_own(cls, value: str) -> str:
        """Our lesson pages have the sims in frames too."""
        sources = [source for source in value.split() if source.lower() not in ("'self'", "'none'")]
        return value if "*" in sources else " ".join(["'self'", *sources])


def load() -> Settings:
    """Settings from the environment; ends the program with a clear message if one is wrong."""
    try:
        return Settings()
    except ValidationError as error:
        lines = [
            f"  SIM3_{str(e['loc'][0]).upper()}={os.environ.get('SIM3_' + str(e['loc'][0]).upper(), '')!r}: {e['msg']}"
            for e in error.errors()
        ]
        raise SystemExit("Sim3 can't start, a setting is wrong:\n" + "\n".join(lines)) from None
