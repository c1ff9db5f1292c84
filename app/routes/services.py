"""What the routes work with, made once for a server."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from app.classes.registry import Classes
from app.lessons.shelf import Shelf
from app.rooms.registry import Sessions
from app.routes.answers import Answers
from app.routes.coming import Coming
from app.sockets.bridge import Bridge
from app.sockets.classes import ClassSockets
from sims.kit.viser_internals import ViserHost


@dataclass
class Services:
    """Kept as `app.state.services`."""

    sessions: Sessions
    bridge: Bridge
    lessons: Shelf
    answers: Answers
    coming: Coming
    classes: Classes
    class_sockets: ClassSockets
    largest: int
    """Bytes that a file may have."""
    host: ViserHost


def _services(connection: HTTPConnection) -> Services:
    services: Services = connection.app.state.services
    return services


Given = Annotated[Services, Depends(_services)]
"""The type of a route's argument that is the server's services."""
