"""viser's browser client, taken out of the one page that it ships as.

That page carries its code as 800 kB of text, which every visit unpacks again before anything can be painted. As files
of their own, the code and its style sheet are kept by the browser, compiled once, and loaded beside the still picture.
"""

from __future__ import annotations

import functools
import hashlib
import re
from pathlib import Path

import numpy as np
import viser
import zstandard

PAGE = Path(viser.__file__).parent / "client" / "build" / "index.html"
# The page's script: what it carries, the sizes of style and code in it, and the statements around the unpacking.
PACKED = re.compile(
    r'<script data-p="(?P<packed>[^"]*)" data-ss="(?P<style>\d+)" data-cs="(?P<code>\d+)">'
    r"(?P<before>.*?await init\(\);).*?</script>",
    re.DOTALL,
)
DIGITS = "!#$%()*+,-./0123456789:;=?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_abcdefghijklmnopqrstuvwxyz{|}~"


@functools.cache
def files() -> dict[str, bytes]:
    """The client as `loader.js` (a classic script to put at the end of the page), `client.js` and `client.css`.

    The loader publishes the decompressor that the client's own code expects, and then imports that code.
    """
    found = PACKED.search(PAGE.read_text(encoding="utf-8"))
    if found is None:
        raise RuntimeError(f"{PAGE} isn't built as viser {viser.__version__} was; see sims/kit/viser_client.py")
    style, code = int(found["style"]), int(found["code"])
    unpacked = zstandard.ZstdDecompressor().decompress(decoded(found["packed"]), max_output_size=style + code)
    loader = f'{found["before"]}await import("./client.js");}})();'
    return {"loader.js": loader.encode(), "client.css": unpacked[:style], "client.js": unpacked[style:]}


@functools.cache
def held() -> str:
    """The client's own script with what it carries, as data of a page that starts it when all else is ready."""
    found = PACKED.search(PAGE.read_text(encoding="utf-8"))
    assert found is not None
    return found[0].replace("<script ", '<script type="text/plain" id="client" ', 1)


@functools.cache
def fingerprint() -> str:
    """Changes when any of the files does."""
    return hashlib.sha256(b"".join(files().values())).hexdigest()[:10]


def decoded(text: str) -> bytes:
    """Bytes from digits of base 88: five digits for four bytes; the last group has a digit more than bytes."""
    values = np.full(128, 88, np.uint64)
    values[[ord(digit) for digit in DIGITS]] = np.arange(88)
    digits = values[np.frombuffer(text.encode("ascii"), np.uint8)]
    whole, rest = digits[: len(digits) // 5 * 5].reshape(-1, 5), digits[len(digits) // 5 * 5 :]
    weights = 88 ** np.arange(4, -1, -1, dtype=np.uint64)
    last = functools.reduce(lambda value, digit: value * 88 + int(digit), rest, 0)
    return bytes((whole @ weights).astype(">u4").tobytes()) + last.to_bytes(max(len(rest) - 1, 0), "big")
