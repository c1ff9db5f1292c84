"""uvicorn's side of a websocket, with an answer to what its peer may do below the level of messages."""

from __future__ import annotations

from http import HTTPStatus

from uvicorn._types import ASGISendEvent
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.frames import Frame
from websockets.http11 import Request

LARGEST = 64 * 1024
"""Bytes of a message, which are kept until its last fragment has come."""
FRAGMENTS = 64
"""Pieces in which one message may come: empty ones would else be kept for ever."""


class Websocket(WebSocketsSansIOProtocol):
    """Breaks off with a peer that keeps the server's memory busy: unread answers, endless messages."""

    def data_received(self, data: bytes) -> None:
        """A request comes whole from uvicorn; where it can't be read (a POST), websockets would wait for another."""
        super().data_received(data)
        if not self.handshake_initiated:
            self.transport.abort()

    def handle_connect(self, event: Request) -> None:
        """websockets fails on names of its own headers that aren't ASCII, with a traceback in the log."""
        own = [value for name, value in event.headers.raw_items() if name.lower().startswith("sec-websocket-")]
        if all(value.isascii() for value in own):
            super().handle_connect(event)
            return
        self.handshake_initiated = self.handshake_complete = self.close_sent = True
        self.conn.send_response(self.conn.reject(HTTPStatus.BAD_REQUEST, "Sec-WebSocket headers are ASCII.\n"))
        self.transport.write(b"".join(self.conn.data_to_send()))
        self.transport.close()

    def handle_ping(self) -> None:
        """Each ping is answered; somebody who doesn't read the answers gets no more of them."""
        super().handle_ping()
        if not self.writable.is_set():
            self.transport.abort()

    def handle_cont(self, event: Frame) -> None:
        if len(self.frames) >= FRAGMENTS:
            self.transport.abort()
        else:
            super().handle_cont(event)

    def send_receive_event_to_app(self) -> None:
        """Text that isn't UTF-8 goes on as bytes, which the application refuses and counts."""
        try:
            if self.curr_msg_data_type == "text":
                b"".join(self.frames).decode()
        except UnicodeDecodeError:
            self.curr_msg_data_type = "bytes"
        super().send_receive_event_to_app()

    def keepalive_timeout(self) -> None:
        """A peer that is silent may not read either: what it was sent would wait for ever to be delivered."""
        super().keepalive_timeout()
        self.transport.abort()

    async def send(self, message: ASGISendEvent) -> None:
        await super().send(message)
        if message["type"] == "websocket.close":
            self.loop.call_later(self.close_timeout, self.transport.abort)
