"""The short codes of classes, and the keys that lead them: a class's code is a hash of its teacher's key.

So a teacher's page brings its class back after a restart, and nothing has to be stored. The hash is slow, because a
code is short: to find another key of one code takes a core about two years, and a class lasts for hours.
"""

from __future__ import annotations

import hashlib
import re

LETTERS = "23456789abcdefghjkmnpqrstuvwxyz"
"""Those that nobody mistakes for another."""
LENGTH = 6


def code_of(key: str) -> str:
    """The code of the class that a key leads. Takes a tenth of a second."""
    digest = hashlib.scrypt(key.encode(), salt=b"sim3 class", n=2**14, r=8, p=1, dklen=16)
    number, letters = int.from_bytes(digest), ""
    for _ in range(LENGTH):
        number, k = divmod(number, len(LETTERS))
        letters += LETTERS[k]
    return letters


def is_code(text: str) -> bool:
    """Whether some key could lead a class of that code."""
    return re.fullmatch(f"[{LETTERS}]{{{LENGTH}}}", text) is not None


def is_key(text: str) -> bool:
    """Whether it is what a key looks like."""
    return re.fullmatch(r"[\w-]{22}", text, re.ASCII) is not None
