"""A course page of another site, with a sim in a frame; it keeps what the sim says to it."""

from __future__ import annotations

import threading
from html import escape
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import TracebackType
from typing import Any, Self

from tests.e2e.learner import COURSE, Learner
from tests.frames import Message

PAGE = """<!doctype html><html lang="en"><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1"><title>Week 3: rotations</title>
<link rel="icon" href="data:,">
<script>
  const heard = [];
  addEventListener("message", (event) => heard.push({{ ...event.data, from: event.origin }}));
  const say = (message) => document.querySelector("iframe").contentWindow.postMessage(message, "*");
</script>
<h1>Week 3: rotations</h1>
{before}<iframe title="A sim" width="700" height="600" style="border: 0" src="{address}" {attributes}></iframe>{after}</html>"""


class CourseSite:
    """A little site on a port of its own; browsers reach it by another host name than the sims."""

    def __init__(self) -> None:
        self.page = ""
        site = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                body = site.page.encode()
                self.send_response(200)
                self.send_header("content-type", "text/html")
                self.send_header("content-length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *_: Any) -> None:
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    @property
    def url(self) -> str:
        return f"http://{COURSE}:{self._server.server_port}/"

    def show(self, learner: Learner, path: str, attributes: str = "", *, before: str = "", after: str = "") -> None:
        """Open the course page with a sim of the learner's server in its frame, amid some more of the page."""
        address = escape(f"{learner.url}/sims/{path}")
        self.page = PAGE.format(address=address, attributes=attributes, before=before, after=after)
        learner.page.goto(self.url)


def heard(learner: Learner, kind: str) -> list[Message]:
    """What the course page heard of a kind so far."""
    messages: list[Message] = learner.page.evaluate("heard")
    return [message for message in messages if message.get("type") == kind]


def say(learner: Learner, message: Any) -> None:
    """The course page speaks to the sim."""
    learner.page.evaluate("(message) => say(message)", message)
