"""Keys, and the rooms that they control: who has the key of a room controls it, who knows the room's name watches."""

from __future__ import annotations

import hashlib
import re
import secrets


def new_key() -> str:
    """A fresh unguessable key; whoever has it controls the session."""
    return secrets.token_urlsafe(16)


def room_of(key: str) -> str:
    """The room that a key controls."""
    return hashlib.sha256(key.encode()).hexdigest()[:20]


def is_room(name: str) -> bool:
    """Whether some key could control a room of that name."""
    return re.fullmatch("[0-9a-f]{20}", name) is not None
