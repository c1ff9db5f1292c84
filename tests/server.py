"""The server as a process of its own, and sessions in this process with simulated browsers on them.

with Server(SIM3_MAX_SESSIONS="3") as server:       # the real thing, for HTTP and websockets
    httpx.get(server.url + "/healthz")

with Rig(sim, params) as rig:                       # no sockets: what viser sends goes into a SceneModel
    rig.browser.move("yaw", 45)
    rig.settle()
    rig.browser.model.world_pose("/turn1")
"""

from __future__ import annotations

import asyncio
import functools
import itertools
import logging
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Coroutine
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TypeVar
from urllib.error import URLError
from urllib.request import ProxyHandler, build_opener

import viser

from app.rooms.registry import Sessions
from app.sockets.commands import Commands
from app.sockets.viser_messages import decoder
from sims.kit.fields import Numbers, Slider
from sims.kit.params import Params
from sims.kit.scene.view import FIELD
from sims.kit.sim import Sim
from sims.kit.spelling import spell
from sims.kit.viewer import Viewer
from sims.kit.viser_internals import ViserHost, Wire
from tests.column import ColumnModel
from tests.frames import SceneModel, encode_message

ROOT = Path(__file__).resolve().parent.parent
PATIENCE = 60.0
"""Seconds after which a test gives up on something that should take a fraction of one."""
COMPLAINT = re.compile(r"Traceback|never retrieved|never awaited|Exception|Warning|^(ERROR|CRITICAL)\b", re.M)
T = TypeVar("T")
DIRECT = build_opener(ProxyHandler({}))
"""Opens addresses without a proxy, whatever the environment says."""


def free_port() -> int:
    """A port that nothing listens on."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def wait_for(happened: Callable[[], T], what: str, patience: float = PATIENCE) -> T:
    """Wait until `happened` answers something true; what it answered.

    It is asked more and more seldom: who waits for a server to start would else take a good part of its time.
    """
    begin = time.monotonic()
    while True:
        if answer := happened():
            return answer
        waited = time.monotonic() - begin
        if waited > patience:
            raise AssertionError(f"waited {patience:g} s in vain for {what}")
        time.sleep(min(0.005 + 0.03 * waited, 0.1))


class Server:
    """`python -m app` on a free port of this machine; settings as keyword arguments (`SIM3_…="…"`)."""

    def __init__(self, *arguments: str, **settings: str) -> None:
        self.port = free_port()
        self._arguments = arguments or ("-m", "app")
        self._settings = settings
        self._log = tempfile.TemporaryFile("ab+")  # noqa: SIM115 — open as long as the server is
        self._process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: Any) -> None:
        self.stop()
        complaints, log = self.complaints(), self.log()
        self._log.close()
        if kind is None and complaints:
            raise AssertionError(f"the server complained of {complaints}:\n{log}")

    @property
    def origin(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    @property
    def url(self) -> str:
        """Address of the launcher, without the slash at its end."""
        return self.origin + self._settings.get("SIM3_ROOT_PATH", "")

    @property
    def pid(self) -> int:
        assert self._process is not None, "the server isn't running"
        return self._process.pid

    def start(self) -> None:
        """Start, and wait until /healthz answers."""
        inherited = {k: v for k, v in os.environ.items() if not k.startswith("SIM3_")}
        own = {"SIM3_HOST": "127.0.0.1", "SIM3_PORT": str(self.port), "PYTHONUNBUFFERED": "1"}
        self._process = subprocess.Popen(
            [sys.executable, *self._arguments],
            cwd=ROOT,
            env={**inherited, **own, **self._settings},
            stdin=subprocess.DEVNULL,
            stdout=self._log,
            stderr=subprocess.STDOUT,
        )
        try:
            wait_for(self._answers, "the server to answer /healthz", 3 * PATIENCE)
        except BaseException:
            self.kill()
            raise AssertionError(f"the server didn't start:\n{self.log()}") from None

    def stop(self) -> None:
        """End it as an administrator would, and wait until it is gone."""
        if self._process is not None and self._process.poll() is None:
            self._process.send_signal(signal.SIGTERM)
            try:
                self._process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                self.kill()
                raise AssertionError(f"the server didn't end when told to:\n{self.log()}") from None

    def send_end(self) -> None:
        """Tell it to end, and don't wait."""
        assert self._process is not None
        self._process.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        """End it as a crash would: at once, without a word to anybody."""
        if self._process is not None:
            self._process.kill()
            self._process.wait(PATIENCE)

    def restart(self, *, hard: bool = True) -> None:
        """End it and start it again on the same port."""
        (self.kill if hard else self.stop)()
        self.start()

    def log(self) -> str:
        """All that it printed so far, on both outputs."""
        size = os.fstat(self._log.fileno()).st_size
        return os.pread(self._log.fileno(), size, 0).decode(errors="replace")

    def complaints(self) -> list[str]:
        """Lines of the log that tell of something unhandled."""
        return [line for line in self.log().splitlines() if COMPLAINT.search(line)]

    def memory(self) -> float:
        """Resident memory in megabytes."""
        asked = ["ps", "-o", "rss=", "-p", str(self.pid)]
        return int(subprocess.run(asked, capture_output=True, text=True, check=True).stdout) / 1024

    def _answers(self) -> bool:
        assert self._process is not None
        if self._process.poll() is not None:
            raise AssertionError("it ended")
        try:
            with DIRECT.open(f"{self.url}/healthz", timeout=2) as answer:
                return bool(answer.status == 200)
        except (URLError, OSError):
            return False


class Host:
    """The viser host that the rigs of a test run share, and what went wrong on its loop."""

    def __init__(self) -> None:
        self.viser = ViserHost()
        self.problems: list[str] = []
        self.viser.loop.call_soon_threadsafe(self.viser.loop.set_exception_handler, self._failed)
        self.viser.server.on_client_connect(self._connected)

    def call(self, work: Callable[[], T]) -> T:
        """Run something on viser's event loop, where sessions live."""

        async def run() -> T:
            return work()

        return self.wait(run())

    def wait(self, work: Coroutine[Any, Any, T]) -> T:
        """Run a coroutine on viser's event loop."""
        return asyncio.run_coroutine_threadsafe(work, self.viser.loop).result(PATIENCE)

    def _failed(self, _: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        self.problems.append(f"{context['message']}: {context.get('exception')!r}")

    async def _connected(self, client: viser.ClientHandle) -> None:
        self.viser.wire_of(client).context(client)


@functools.cache
def shared_host() -> Host:
    """The one host of this process."""
    return Host()


class Browser:
    """A simulated browser on a session: viser's client without pictures, and the column beside it."""

    def __init__(self, host: Host, session: Any, *, dark: bool = False, watching: bool = False) -> None:
        self.model = SceneModel()
        self.column = ColumnModel()
        self.told: list[dict[str, Any]] = []
        """Messages on the channel."""
        self.sent = 0
        self._host = host
        self._session = session
        self._labels = itertools.count()
        arrived = threading.Event()
        clients: list[viser.ClientHandle] = []

        def connected(client: viser.ClientHandle) -> None:
            clients.append(client)
            arrived.set()

        self.wire = Wire(self._receive, connected)
        self._serving = asyncio.run_coroutine_threadsafe(host.viser.connect(self.wire), host.viser.loop)
        self.send(camera_message())
        assert arrived.wait(PATIENCE), "viser didn't take the connection"
        self.client = clients[0]
        self.commands = Commands(session, self._hear)
        self.viewer = host.call(lambda: self._show(dark, watching))

    def _show(self, dark: bool, watching: bool) -> Viewer:
        session = self._session
        viewer = Viewer(session.sim, self.client, self.commands, dark=dark, watching=watching)
        session.join(viewer)
        session.listen(self._hear)
        return viewer

    def _hear(self, message: dict[str, Any]) -> None:
        self.told.append(message)
        self.column.take(message)

    async def _receive(self, frame: bytes) -> None:
        self.model.feed(frame)

    def send(self, message: dict[str, Any]) -> None:
        """Send a message as viser's client would, through the check that the bridge makes."""
        data = encode_message(message)
        checked = decoder.decode(data)
        self.sent += 1

        self._host.call(lambda: self.wire.feed(data, checked.value_of))

    def settle(self) -> None:
        """Wait until everything that viser has to send has arrived."""
        mark = f"{next(self._labels)}"

        def ask() -> None:
            self.client.gui.set_panel_label(mark)
            self.client.flush()

        self._host.call(ask)
        latest = self.model.latest
        wait_for(lambda: latest.get("SetGuiPanelLabelMessage", {}).get("label") == mark, "what viser has to send")

    def move(self, name: str, value: Any) -> None:
        """Set an input by its name: a slider is moved, into anything else is typed, or chosen."""
        kind = self._session.params.kinds.get(name.partition(".")[0])
        if isinstance(kind, Slider | Numbers) or name in [dial.handle for dial in self._session.sim.dials]:
            self._host.call(lambda: self.commands.slide(name, value))
            return
        text = "" if value is None else spell(tuple(value) if isinstance(value, list) else value)
        self._host.call(lambda: self.commands.enter(name, text))

    def press(self, action: str) -> None:
        """Press a button, by its action's name."""
        self._host.call(lambda: self.commands.act(action))

    @property
    def refused(self) -> list[str]:
        """What the page was told to be wrong."""
        return [message["message"] for message in self.told if message["type"] == "error"]

    def snapshot(self) -> dict[str, Any]:
        """Everything that is seen."""
        return {**self.model.snapshot(), **self.column.snapshot()}

    def drag(
        self, name: str, *places: tuple[float, float, float], modifier: str | None = None,
        taken: tuple[float, float, float] | None = None,
    ) -> None:  # fmt: skip
        """Take a node at its middle, or at a place in the world, lead it through places, and let go."""
        grabbed = tuple(self.model.world_pose(name)[:3, 3].tolist()) if taken is None else taken
        path = [("start", grabbed), *(("update", place) for place in places), ("end", places[-1])]
        for phase, place in path:
            self.send(
                {
                    "type": "SceneNodeDragMessage",
                    "phase": phase,
                    "name": name,
                    "instance_index": None,
                    "start_position": grabbed,
                    "start_screen_pos": (0.5, 0.5),
                    "end_position": place,
                    "end_screen_pos": (0.5, 0.5),
                    "button": "left",
                    "modifier": modifier,
                    "owner": self.model.node(name).owner,
                }
            )

    def click(self, name: str) -> None:
        """Click on a node."""
        self.send(
            {
                "type": "SceneNodeClickMessage",
                "name": name,
                "instance_index": None,
                "ray_origin": (0.0, 0.0, 5.0),
                "ray_direction": (0.0, 0.0, -1.0),
                "screen_pos": (0.5, 0.5),
                "modifier": None,
                "owner": self.model.node(name).owner,
            }
        )

    def leave(self) -> None:
        """Close the page."""
        self._host.call(lambda: self._session.leave(viewer=self.viewer, listener=self._hear))
        self._host.call(self.wire.hang_up)
        self._serving.result(PATIENCE)


class Rig:
    """A session of a sim with one browser on it (and more, with `join`)."""

    def __init__(self, sim: Sim[Any, Any], params: Params | None = None, **page: bool) -> None:
        self.host = shared_host()
        self._log = _Recorder()
        logging.getLogger("sim3").addHandler(self._log)
        self._sessions = Sessions(8)
        start = sim.params() if params is None else params
        self.session = self.host.call(lambda: self._sessions.open(sim, "room", start))
        self.browsers: list[Browser] = []
        self.browser = self.join(**page)

    @property
    def model(self) -> SceneModel:
        """What the first browser shows."""
        return self.browser.model

    @property
    def column(self) -> ColumnModel:
        """What the first browser shows beside the scene."""
        return self.browser.column

    def join(self, *, dark: bool = False, watching: bool = False) -> Browser:
        """Another browser looks at the session, and shows its newest state."""
        browser = Browser(self.host, self.session, dark=dark, watching=watching)
        self.browsers.append(browser)
        self.settle()
        return browser

    def change(self, **changes: Any) -> None:
        """Change the state as a control would."""
        self.host.call(lambda: self.session.change(changes))

    def show(self, params: Params) -> None:
        """Change the whole state, and wait until everybody sees it."""
        self.host.call(lambda: self.session.change(params.__dict__, live=False))
        self.settle()

    def settle(self) -> None:
        """Wait until the session has drawn its newest state and every browser shows it."""
        self.host.wait(self._drawn())
        for browser in self.browsers:
            browser.settle()

    async def _drawn(self) -> None:
        for _ in range(20):  # turns of the loop: what browsers sent goes through viser's tasks first
            await asyncio.sleep(0)
        await asyncio.wait_for(self.session.settled(), PATIENCE)

    def close(self) -> None:
        """Everybody leaves."""
        for browser in self.browsers:
            browser.leave()
        self.host.wait(self._sessions.close())
        logging.getLogger("sim3").removeHandler(self._log)

    def problems(self) -> list[str]:
        """What went wrong unseen: errors logged, tasks that failed, updates of things that don't exist."""
        strays = [stray for browser in self.browsers for stray in browser.model.strays]
        return [*self._log.said, *self.host.problems, *strays]

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
        if kind is None and (problems := self.problems()):
            raise AssertionError("went wrong unseen: " + "; ".join(problems))


class _Recorder(logging.Handler):
    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.said: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.said.append(logging.Formatter().format(record))


def camera_message(position: tuple[float, float, float] = (3.0, -3.0, 2.0)) -> dict[str, Any]:
    """What viser's client sends first, and whenever the view moves."""
    return {
        "type": "ViewerCameraMessage",
        "wxyz": (1.0, 0.0, 0.0, 0.0),
        "position": position,
        "fov": FIELD,
        "near": 0.01,
        "far": 1000.0,
        "image_height": 600,
        "image_width": 700,
        "look_at": (0.0, 0.0, 0.0),
        "up_direction": (0.0, 0.0, 1.0),
    }
