"""A learner at a browser: hands on the real controls, and everything that the page sent and received.

learner.slide("yaw", 60)
learner.sees(yaw=60)          # the channel's state, the API's solution, the address, the read-outs agree
learner.scene.world_pose("/turn1")
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar
from urllib.parse import urlsplit

import httpx
import numpy as np
import numpy.typing as npt
from playwright.sync_api import (
    BrowserContext,
    ConsoleMessage,
    Frame,
    Locator,
    Page,
    Request,
    WebSocket,
)  # fmt: skip
from websockets.sync.client import ClientConnection

from sims import by_slug
from sims.kit.params import Params
from sims.kit.readout import figure
from tests.app.page import connect
from tests.column import ColumnModel
from tests.frames import ORIGIN, Message, SceneModel, SceneNode, decode_message, encode_message
from tests.server import camera_message

T = TypeVar("T")
PATIENCE = 60.0
"""Seconds after which a test gives up: software rendering on a busy machine is slow, and waiting costs nothing."""
OPTIONS = ("view", "controls", "theme", "only")
PAINTED, UNPAINTED = "//127.0.0.1:", "//localhost:"
"""By the second name `tests.prompt` gives nobody viser's client."""
COURSE = "course.localhost"
"""Another site on this machine, whose pages have sims in frames."""
THUMB = 16.0
"""Pixels that a slider's thumb takes of its track."""
STEPS = 4
"""Places on the way of a pulling hand; a painted scene draws a frame for each."""
# What viser's client makes the browser say: at each start, at each drag in the scene, and, without a GPU, where there
# are nodes to click.
VISERS_OWN_WORDS = (
    "THREE.Clock: This module has been deprecated",
    "Unable to preventDefault inside passive event listener invocation",
    "KHR_parallel_shader_compile extension not supported",
    "GPU stall due to ReadPixels",
)

FOLDED = (
    "ancestor::details[not(@open)]/summary | ancestor::*[@id='more'][@hidden]/preceding-sibling::button[@aria-controls]"
)
"""What unfolds that in which something is."""
# Of each formula in the read-outs: what stands before the equals sign, and the numbers after it.
FORMULAS = """() => [...document.querySelectorAll(".s3-column math")].map(formula => [
    formula.textContent.split("=")[0], ...[...formula.querySelectorAll("mn")].map(n => n.textContent)])"""


INPUTS = {"slider": "slide", "textbox": "box", "combobox": "choice", "checkbox": "switch"}
"""What marks an input of each role."""
LIT = """() => [...document.querySelectorAll(".s3-highlighted")].map((node) => [node.tagName.toLowerCase(), node.dataset.link])"""


class Witness:
    """What must not happen on any page of a browser: errors, warnings, requests to other hosts."""

    def __init__(self, context: BrowserContext) -> None:
        self.hosts = {"127.0.0.1", "localhost", COURSE}
        self.begin()
        context.on("console", self._said)
        context.on("weberror", lambda error: self._failed(f"{error.error}"))
        context.on("request", self._asked)

    def begin(self) -> None:
        """Nothing is known, and nothing is expected."""
        self.complaints: list[str] = []
        self.expected: tuple[str, ...] = VISERS_OWN_WORDS
        self.failures: tuple[str, ...] = ()
        """Words of exceptions that a test provokes."""

    def expect(self, *words: str) -> None:
        """From now on a page may complain in these words, because the test provokes it."""
        self.expected += words

    def _failed(self, text: str) -> None:
        if not any(words in text for words in self.failures):
            self.complaints.append(f"exception: {text}")

    def _said(self, message: ConsoleMessage) -> None:
        text = message.text
        if message.type in ("error", "warning") and not any(words in text for words in self.expected):
            self.complaints.append(f"console {message.type}: {text[:400]} ({message.location['url'][:200]})")

    def _asked(self, request: Request) -> None:
        parts = urlsplit(request.url)
        if parts.scheme in ("http", "https", "ws", "wss") and parts.hostname not in self.hosts:
            self.complaints.append(f"request to another host: {request.url[:200]}")


class Sockets:
    """What a page's two websockets carried; viser's begins a new scene each time it connects."""

    def __init__(self, page: Page) -> None:
        self.scene = SceneModel()
        self.column = ColumnModel()
        self.camera: Message = {}
        self.sent: list[Message] = []
        self.told: list[Message] = []
        """Messages on the channel, from the server."""
        self.connected = 0
        self._stand_in: ClientConnection | None = None
        page.on("websocket", self._opened)

    def draw(self, address: str) -> None:
        """Receive the scene in the page's place; it must not have opened viser's websocket itself."""
        self.scene = SceneModel()
        self._stand_in = connect(address, viser=True, unread=None)
        self._stand_in.send(encode_message(camera_message()))

    def forget(self) -> None:
        """Another page is opened: what the one before it showed is past. A browser closes its own websockets."""
        self.column, self.camera = ColumnModel(), {}
        self.told.clear()
        self.sent.clear()
        if self._stand_in is not None:
            self._stand_in.close()
            self._stand_in = None

    def hear(self) -> None:
        """Take what came for the page that is drawn in its place."""
        with suppress(TimeoutError):
            while self._stand_in is not None:
                self.scene.feed(self._stand_in.recv(timeout=0))

    @property
    def state(self) -> Message:
        """The newest state that the server told."""
        return self.states[-1]

    @property
    def states(self) -> list[Message]:
        """Every state that the server told."""
        return [message for message in self.told if message["type"] == "state"]

    def _opened(self, socket: WebSocket) -> None:
        if "/class/" in socket.url:
            return
        if "/channel" in socket.url:
            self.column = ColumnModel()
            socket.on("framereceived", self._heard)
            return
        self.connected += 1
        self.scene = scene = SceneModel()
        socket.on("framereceived", scene.feed)
        socket.on("framesent", self._sent)

    def _heard(self, data: bytes | str) -> None:
        message = json.loads(data)
        self.told.append(message)
        self.column.take(message)

    def _sent(self, data: bytes | str) -> None:
        assert isinstance(data, bytes)
        message = decode_message(data)
        self.sent.append(message)
        if message["type"] == "ViewerCameraMessage":
            self.camera = message


class Learner:
    """One person at one page that shows one sim, in the page itself or in a frame."""

    def __init__(self, page: Page, witness: Witness, url: str) -> None:
        self.page = page
        self.witness = witness
        self.painted = True
        """Whether viser's client paints the scene."""
        self.sockets = Sockets(page)
        self.frame: Frame = page.main_frame
        self._url = url
        self.addresses: list[str] = []
        """Every address that the page and its frames had."""
        page.on("framenavigated", lambda frame: self.addresses.append(frame.url))
        page.set_default_timeout(PATIENCE * 1000)

    # ---- coming and going

    @property
    def url(self) -> str:
        """Address of the launcher, without the slash at its end, by the name under which the scene is painted or not."""
        return self._url if self.painted else self._url.replace(PAINTED, UNPAINTED)

    def open(self, path: str) -> None:
        """Open a sim's address and wait until it is live."""
        self.painted = True
        self._go(path.replace(UNPAINTED, PAINTED))
        self.wait_live()

    def open_column(self, path: str) -> None:
        """Open a sim's address without viser's client, which takes most of the time.

        The column beside the scene works. What the scene is sent is received here, and nothing is painted.
        """
        self.painted = False
        self._go(path.replace(PAINTED, UNPAINTED))
        self.wait_live()

    def leave(self) -> None:
        """Leave the page empty for the next learner."""
        self.page.mouse.move(0, 0)
        self.page.unroute_all()
        self.page.goto("about:blank")
        self.painted = True
        self.sockets.forget()
        self.addresses.clear()
        self.frame = self.page.main_frame
        self.witness.begin()

    def _go(self, path: str) -> None:
        self.sockets.forget()
        self.page.goto(path if path.startswith("http") else f"{self.url}/sims/{path}")

    def open_page(self, path: str) -> None:
        """Open a page that holds the sim in a frame, and go on in the frame."""
        self.page.goto(path if path.startswith("http") else f"{self.url}/sims/{path}")
        self.enter_frame()

    def enter_frame(self) -> None:
        """Go on in the frame of the page that holds a sim."""
        self.frame = self.until(lambda: next(f for f in self.page.frames if f.url.split("?")[0].endswith("/embed")))
        self.wait_live()

    def reload(self) -> None:
        self.sockets.forget()
        self.page.reload()
        self.wait_live()

    def wait_live(self) -> None:
        if self.painted:
            self.frame.wait_for_function("window.sim3?.live === true")
            self.until(lambda: bool(self.sockets.state and self.sockets.camera))
            return
        self.until(lambda: bool(self.sockets.column.parts and self.sockets.state))
        self.sockets.draw(self.frame.evaluate("`${sim3.socket}?viewer=${sim3.viewer}`"))
        self.until(lambda: self.scene.version >= 0)

    def until(self, happened: Callable[[], T], patience: float = PATIENCE) -> T:
        """Wait until `happened` gives something true and raises nothing; sockets are heard meanwhile."""
        until = time.monotonic() + patience
        while True:
            try:
                answer = happened()
                assert answer is not False, "it hasn't happened"
            except (AssertionError, KeyError, StopIteration, IndexError):
                if time.monotonic() > until:
                    raise
            else:
                return answer
            self.page.wait_for_timeout(20)

    # ---- what is known of the sim

    @property
    def scene(self) -> SceneModel:
        self.sockets.hear()
        return self.sockets.scene

    @property
    def address(self) -> str:
        url: str = self.frame.evaluate("location.href")
        return url

    @property
    def room(self) -> str:
        """The link that shares control of the room; the page has it, its address doesn't."""
        link: str = self.frame.evaluate("sim3.place")
        return link

    @property
    def watch_link(self) -> str:
        """The link with which others only watch the room."""
        return self.room.removesuffix("/").rpartition("/")[0] + "/"

    @property
    def slug(self) -> str:
        return urlsplit(self.address).path.split("/sims/")[1].split("/")[0]

    @property
    def params(self) -> dict[str, Any]:
        """The state that the server told last."""
        params: dict[str, Any] = self.sockets.state["params"]
        return params

    @property
    def state(self) -> Params:
        sim = by_slug(self.slug)
        assert sim is not None
        state: Params = sim.params.model_validate(self.params)
        return state

    def solved(self) -> dict[str, Any]:
        """What the API answers for the present state."""
        address = f"{self.url}/api/sims/{self.slug}/solve"
        # it goes to this machine; reading all certificates at each call takes longer than the answer
        answer = httpx.post(address, json=self.params, timeout=PATIENCE, verify=False, trust_env=False)
        assert answer.status_code == 200, answer.text
        body: dict[str, dict[str, Any]] = answer.json()
        assert body["params"] == self.params
        return body["solution"]

    # ---- the scene, and what is linked with it

    def place(self, world: npt.ArrayLike) -> tuple[float, float]:
        """Pixel on the page where a point of the world is."""
        canvas = box(self.frame.locator("canvas[data-engine]"))
        return project(world, self.sockets.camera, canvas)

    def place_of(self, node: str) -> tuple[float, float]:
        """Pixel on the page of the middle of a node of the scene."""
        return self.place(self.scene.world_pose(node)[:3, 3])

    def click_on(self, node: str) -> None:
        """Click on a node of the scene."""
        x, y = self.place_of(node)
        self.page.mouse.move(x - 2, y)
        self.page.mouse.click(x, y)

    def lights(self, name: str, tags: str) -> bool:
        """Whether all that is highlighted in the column has that name; `tags` says what it is: "g g tr"."""
        lit: list[list[str]] = self.frame.evaluate(LIT)
        return sorted(lit) == sorted([tag, name] for tag in tags.split())

    def pressed(self, name: str) -> bool:
        """Whether the row of that name, and no other of its table, is the selected one."""
        row = self.frame.locator(f'tr.s3-selected[data-link="{name}"]')
        return row.locator('button[aria-pressed="true"]').count() == 1 == self.frame.locator("tr.s3-selected").count()

    # ---- the column

    def control(self, role: Any, name: str) -> Locator:
        """An input by the name of its parameter, or of an entry, as `angles.2`; the fold that it is in is opened."""
        found = self.frame.locator(f'[data-{INPUTS[role]}="{name}"]').first
        self.unfold(found)
        return found

    def find(self, role: Any, name: str) -> Locator:
        """Something of the column by its role and name; the fold that it is in is opened."""
        found = self.frame.get_by_role(role, name=name, exact=True, include_hidden=True).first
        self.unfold(found)
        return found

    def unfold(self, inside: Locator) -> None:
        """Open the fold that something is in."""
        fold = inside.locator(f"xpath={FOLDED}")
        if fold.count():
            fold.click()

    def slide(self, name: str, value: float) -> None:
        """Take a slider's thumb with the mouse and pull it to a value, or as near as a pixel comes."""
        slider = self.control("slider", name)
        slider.scroll_into_view_if_needed()
        low, high, now = (float(slider.evaluate(f"node => node.{each}")) for each in ("min", "max", "value"))
        track = box(slider)
        y = track["y"] + track["height"] / 2

        def at(value: float) -> float:
            share = (value - low) / (high - low)
            return track["x"] + THUMB / 2 + (track["width"] - THUMB) * share

        mouse = self.page.mouse
        mouse.move(at(now), y)
        mouse.down()
        mouse.move(at(value), y, steps=STEPS)
        mouse.up()

    def pull(self, start: tuple[float, float], dx: float, dy: float, *, key: str = "") -> None:
        """Press the mouse at a place on the page, move it, and let go; the key is held meanwhile."""
        mouse, keyboard, (x, y) = self.page.mouse, self.page.keyboard, start
        mouse.move(x - 3, y - 3)
        mouse.move(x, y)
        if key:
            keyboard.down(key)
        mouse.down()
        mouse.move(x + dx, y + dy, steps=STEPS)
        mouse.up()
        if key:
            keyboard.up(key)

    def says(self, words: str) -> None:
        """Wait until the column or a notice says it."""
        self.frame.locator(":is(.s3-column, .s3-notice)").get_by_text(words).first.wait_for(state="attached")

    def press_keys(self, name: str, *keys: str) -> None:
        """Keys on a slider's thumb."""
        thumb = self.control("slider", name)
        for key in keys:
            thumb.press(key)

    def type(self, name: str, text: str, *, box: int = 0) -> None:
        """Type into the number box of a control (of a vector's boxes, the one counted from 1), and press Enter."""
        field = self.control("textbox", f"{name}.{box - 1}" if box else name)
        field.fill(text)
        field.press("Enter")

    def choose(self, name: str, word: str | None) -> None:
        """Choose what is shown for a word, or for its absence."""
        found = self.control("combobox", name)
        if found.evaluate("node => node.tagName") == "SELECT":
            found.select_option(word or "")
        else:
            self.frame.locator(f'[data-choice="{name}"][value="{word or ""}"]').check()

    def press(self, label: str, *, force: bool = False) -> None:
        """Press a button of the column; by force also one that is disabled."""
        self.find("button", label).click(force=force)

    # ---- checking

    def solution(self, **expected: Any) -> dict[str, Any]:
        """What the API gives for the present state; the state must be as expected, and the address say it."""
        got = {name: self.params[name] for name in expected}
        assert got == expected
        assert self.query() == self.sockets.state["query"]
        assert self.scene.version == self.sockets.column.version == self.sockets.state["version"]
        return self.solved()

    def sees(self, **expected: Any) -> dict[str, Any]:
        """As `solution`, once the state is as expected."""
        return self.until(lambda: self.solution(**expected))

    def reads(self, name: str, value: npt.ArrayLike, digits: int = 3) -> bool:
        """Whether the read-outs show a number, vector or matrix under a name."""
        formulas = self.formulas()
        wanted = [figure(v, digits) for v in np.ravel(np.asarray(value, dtype=float)).tolist()]
        return [name, *wanted] in formulas

    def formulas(self) -> list[list[str]]:
        """The name and the numbers of each formula in the column."""
        found: list[list[str]] = self.frame.evaluate(FORMULAS)
        return found

    def spoken(self) -> str:
        """What the live region says to those who listen."""
        return self.frame.locator("[role=status][aria-live]").last.text_content() or ""

    def query(self) -> str:
        """The state in the address bar, without the page's own options."""
        query = urlsplit(self.address).query
        return "&".join(part for part in query.split("&") if part.split("=")[0] not in OPTIONS)


def touch(learner: Learner, *path: tuple[float, ...]) -> None:
    """Put a finger down, draw it along a path, and lift it; two fingers where there are x, y of both."""
    cdp = learner.page.context.new_cdp_session(learner.page)
    for k, places in enumerate(path):
        points = [{"x": x, "y": y, "id": n} for n, (x, y) in enumerate(zip(places[::2], places[1::2], strict=True))]
        cdp.send("Input.dispatchTouchEvent", {"type": "touchMove" if k else "touchStart", "touchPoints": points})
        learner.page.wait_for_timeout(16)
    cdp.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    cdp.detach()


def box(locator: Locator) -> dict[str, float]:
    found = locator.bounding_box()
    assert found is not None, f"{locator} isn't on the page"
    return {"x": found["x"], "y": found["y"], "width": found["width"], "height": found["height"]}


def project(world: npt.ArrayLike, camera: Message, canvas: dict[str, float]) -> tuple[float, float]:
    """Pinhole projection into a canvas; the camera looks along its z, x right, y down, `fov` from top to bottom."""
    pose = SceneNode("", "", "", False, {}, tuple(camera["wxyz"]), ORIGIN).pose[:3, :3]
    x, y, z = pose.T @ (np.asarray(world, dtype=float) - camera["position"])
    focal = canvas["height"] / 2 / np.tan(camera["fov"] / 2)
    assert z > 0, "the place is behind the viewer"
    return (
        float(canvas["x"] + canvas["width"] / 2 + focal * x / z),
        float(canvas["y"] + canvas["height"] / 2 + focal * y / z),
    )
