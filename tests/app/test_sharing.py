"""What a state is handed on by: the page that the dialog shows, its codes and texts, and what other sites ask."""

from __future__ import annotations

import ast
import base64
import json
import re
from html.parser import HTMLParser
from typing import Any
from urllib.parse import parse_qs, quote, urlsplit

import cv2
import httpx
import numpy as np
import pytest
from markdown_it import MarkdownIt
from playwright.sync_api import Browser
from segno import make

from app.routes.sharing import FORM, LONGEST, linked
from app.routes.snippets import ALLOW, snippets
from sims import SIMS
from tests.app.conftest import PREFIX
from tests.server import Server

LINK = 'https://school.example/sims/euler-angles/embed?yaw=45&only=yaw,pitch&order="zyx"'
FILTERED = {"src", "width", "height", "name", "scrolling", "frameborder", "title", "style", "class", "id"}
"""What HTMLPurifier, which Moodle filters by, leaves of a frame; others leave more."""


class Elements(HTMLParser):
    """The elements of a text, with their attributes and, of a textarea, what it holds."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str]]] = []
        self.texts: dict[str, str] = {}
        self._in = ""
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.found.append((tag, given))
        self._in = given.get("data-result", "") if tag == "textarea" else ""

    def handle_data(self, data: str) -> None:
        if self._in:
            self.texts[self._in] = self.texts.get(self._in, "") + data

    def handle_endtag(self, tag: str) -> None:
        self._in = ""

    def result(self, name: str) -> dict[str, str]:
        """The attributes of what the dialog takes by this name."""
        (found,) = [given for _, given in self.found if given.get("data-result") == name]
        return found

    def one(self, tag: str) -> dict[str, str]:
        (found,) = [given for each, given in self.found if each == tag]
        return found


def shared(client: httpx.Client, path: str) -> Elements:
    answer = client.get(path)
    assert answer.status_code == 200, answer.text
    assert answer.headers["access-control-allow-origin"] == "*", "a sandboxed frame has an origin of its own"
    return Elements(answer.text)


# ---- the page of the dialog


@pytest.mark.parametrize("sim", SIMS, ids=lambda sim: sim.slug)
def test_every_sim_can_be_shared_and_no_parameter_is_taken_for_the_forms_own(client: httpx.Client, sim: Any) -> None:
    found = shared(client, f"/sims/{sim.slug}/share")
    assert found.result("link")["value"].endswith(f"{PREFIX}/sims/{sim.slug}/embed")
    assert not {*FORM} & {*sim.params.model_fields}


def test_the_form_leads_to_the_link_that_it_describes(client: httpx.Client, server: Server) -> None:
    view = "4,1,2,0,0,0"
    chosen = (
        f"yaw=45&view={view}&share-seen={view}&controls=some&only=yaw&only=pitch&theme=dark&lesson=1&share-height=480"
    )
    found = shared(client, f"/sims/euler-angles/share?{chosen}&challenge=reach-target&share-opens=lesson")
    link = found.result("link")["value"]
    assert link.startswith(f"{server.url}/sims/euler-angles?")
    assert parse_qs(urlsplit(link).query) == {
        "yaw": ["45"], "view": [view], "only": ["yaw,pitch"], "theme": ["dark"], "lesson": ["1"],
        "challenge": ["reach-target"],
    }  # fmt: skip
    assert client.get(link).status_code == 200
    frame = Elements(found.texts["html"]).one("iframe")
    assert frame["src"] == link.replace("euler-angles?", "euler-angles/embed?")
    assert frame["height"] == found.result("frame")["height"] == "480"
    assert client.get(frame["src"]).status_code == 200
    assert urlsplit(frame["src"])[2:] == urlsplit(found.result("frame")["src"])[2:], "the preview is what is pasted"


def test_a_form_as_it_is_at_first_adds_nothing_to_the_link() -> None:
    first = [
        ("yaw", "45"),
        ("share-seen", ""),
        ("share-opens", "sim"),
        ("controls", "1"),
        ("theme", ""),
        ("challenge", ""),
    ]
    assert linked([*first, ("share-height", "600"), ("only", "pitch")]) == [("yaw", "45")]
    assert linked([("controls", "0"), ("only", "yaw")]) == [("controls", "0")]
    assert linked([("only", "yaw,pitch")]) == [("only", "yaw,pitch")], "as a link has it"
    assert linked([("controls", "some")]) == []


def test_what_is_wrong_is_named(client: httpx.Client) -> None:
    for query, words in (("share-height=9", "200 to 2000 pixels"), ("yaw=999", "−180 to 180"), ("only=sway", "only")):
        answer = client.get(f"/sims/euler-angles/share?{query}")
        assert answer.status_code == 422
        assert words.replace("−", "-") in answer.text.replace("−", "-")
    assert client.get("/sims/nothing/share").status_code == 404
    assert client.get("/lessons/nothing/share").status_code == 404


def test_a_lesson_of_ones_own_is_shared_under_its_own_address(client: httpx.Client, server: Server) -> None:
    found = shared(client, "/lessons/ours/share?yaw=45&share-opens=lesson")
    assert found.result("link")["value"] == f"{server.url}/lessons/ours?yaw=45"
    assert found.result("frame")["src"] == f"{PREFIX}/sims/euler-angles/embed?yaw=45"


# ---- codes

# The picture that the page shows, as a PNG: a page that nobody has seen yet may not be photographed.
ON_BLACK = """async () => {
    const image = new Image(300, 300);
    image.src = location.href;
    await image.decode();
    const canvas = document.createElementNS("http://www.w3.org/1999/xhtml", "canvas");
    canvas.width = canvas.height = 300;
    const pen = canvas.getContext("2d", { alpha: false });
    pen.drawImage(image, 0, 0, 300, 300);
    return canvas.toDataURL().split(",")[1];
}"""


def test_a_phone_reads_the_link_from_the_code(client: httpx.Client, server: Server, browser: Browser) -> None:
    link = f"{server.url}/sims/camera/embed?fx=800&view=4,1,2,0,0,0&only=fx,fy&theme=dark"
    address = f"{server.url}/qr?url={quote(link, safe='')}"
    answer = client.get(address)
    assert answer.headers["content-type"] == "image/svg+xml"
    page = browser.new_page()
    page.goto(address)
    seen = cv2.imdecode(np.frombuffer(base64.b64decode(page.evaluate(ON_BLACK)), np.uint8), cv2.IMREAD_COLOR)
    page.close()
    assert seen is not None
    assert cv2.QRCodeDetector().detectAndDecode(seen)[0] == link


@pytest.mark.parametrize(
    "other",
    ["", "nonsense", "https://elsewhere.example/geo/sim3/sims/camera", "javascript:alert(1)", "http://[",
     "{origin}/sims", "{origin}/geo/sim34/x", "http://me@{host}/geo/sim3/", "//{host}/geo/sim3/"],
)  # fmt: skip
def test_nothing_is_said_of_other_addresses(client: httpx.Client, server: Server, other: str) -> None:
    url = other.format(origin=server.origin, host=urlsplit(server.origin).netloc)
    assert client.get("/qr", params={"url": url}).status_code == 404
    assert client.get("/oembed", params={"url": url}).status_code == 404


def test_a_link_too_long_for_a_code_says_so(client: httpx.Client, server: Server) -> None:
    url = f"{server.url}/?{'x' * LONGEST}"
    assert client.get("/qr", params={"url": url}).status_code == 404
    assert int(make(url[:LONGEST], error="l").version) <= 22, "what is allowed has squares that can be told apart"


# ---- texts to paste


def test_every_text_holds_the_link_as_it_is_where_it_is_pasted() -> None:
    texts = {each.name: each.text for each in snippets(LINK, "A & “B”", 480)}
    for name in ("html", "moodle", "canvas", "mkdocs"):
        assert Elements(texts[name]).one("iframe")["src"] == LINK
        assert "\n" not in texts[name], "an empty line or an indent would end the block"
    assert (
        Elements(MarkdownIt("commonmark").render(f"Before\n\n{texts['mkdocs']}\n\nAfter")).one("iframe")["src"] == LINK
    )
    for name, kind in (("jupyter-book", "{raw} html"), ("quarto", "{=html}")):
        (fence,) = MarkdownIt("commonmark").parse(texts[name])
        assert fence.info == kind
        assert Elements(fence.content).one("iframe")["src"] == LINK
    assert texts["myst"].splitlines()[0] == f":::{{iframe}} {LINK}"
    call = ast.parse(texts["notebook"]).body[1]
    assert isinstance(call, ast.Expr)
    assert isinstance(call.value, ast.Call)
    assert ast.literal_eval(call.value.args[0]) == LINK
    given = {word.arg: ast.literal_eval(word.value) for word in call.value.keywords}
    assert given["height"] == 480
    made = Elements(f"<iframe {' '.join(given['extras'])}></iframe>").one("iframe")
    assert (made["title"], made["allow"]) == ("A & “B”", ALLOW)


def test_what_an_editor_that_filters_leaves_of_a_frame_shows_the_sim() -> None:
    frame = Elements(snippets(LINK, "A & “B”", 480)[0].text).one("iframe")
    left = {name: value for name, value in frame.items() if name in FILTERED}
    assert left == {"src": LINK, "title": "A & “B”", "width": "100%", "height": "480", "style": "border: 0"}


# ---- what other sites ask


def asked(client: httpx.Client, url: str, **more: Any) -> Any:
    answer = client.get("/oembed", params={"url": url, **more})
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_oembed_answers_for_the_page_that_leads_to_it(client: httpx.Client, server: Server) -> None:
    page = Elements(client.get("/sims/euler-angles?yaw=45&utm_source=mail").text)
    (link,) = [given for tag, given in page.found if given.get("type") == "application/json+oembed"]
    answer = client.get(link["href"])
    assert answer.headers["access-control-allow-origin"] == "*"
    told = answer.json()
    assert (told["version"], told["type"], told["provider_name"]) == ("1.0", "rich", "Sim3")
    frame = Elements(told["html"]).one("iframe")
    assert frame["src"] == f"{server.url}/sims/euler-angles/embed?yaw=45"
    assert (frame["width"], frame["height"]) == (str(told["width"]), str(told["height"]))
    assert client.get(told["thumbnail_url"]).headers["content-type"] == "image/webp"


def test_oembed_keeps_within_the_room_that_there_is(client: httpx.Client, server: Server) -> None:
    url = f"{server.url}/sims/camera/embed"
    told = asked(client, url, maxwidth=500, maxheight=400)
    assert (told["width"], told["height"]) == (500, 400)
    assert "thumbnail_url" not in told, "it is larger than that"
    assert asked(client, url, maxwidth=5000)["width"] == 800
    assert client.get("/oembed", params={"url": url, "maxwidth": "wide"}).status_code == 400


def test_oembed_says_what_it_has_no_answer_for(client: httpx.Client, server: Server) -> None:
    sim = f"{server.url}/sims/camera"
    refused = {
        sim + "?fx=wide": 404, f"{server.url}/sims/nothing": 404, f"{server.url}/": 404, f"{sim}/s/abc/key/": 404,
    }  # fmt: skip
    for url, status in refused.items():
        answer = client.get("/oembed", params={"url": url})
        assert answer.status_code == status
        assert answer.json()["detail"]
    assert client.get("/oembed", params={"url": sim, "format": "xml"}).status_code == 501
    assert asked(client, f"{server.url}/lessons/ours")["title"] == "Our own lesson"


def test_oembed_and_codes_know_the_host_that_a_proxy_forwards(client: httpx.Client) -> None:
    proxied = {"x-forwarded-host": "school.example"}
    url = f"https://school.example{PREFIX}/sims/camera"
    for path in ("/oembed", "/qr"):
        assert client.get(path, params={"url": url}, headers=proxied).status_code == 200
        assert client.get(path, params={"url": url}).status_code == 404
    told = client.get("/oembed", params={"url": url}, headers=proxied).json()
    assert Elements(told["html"]).one("iframe")["src"] == f"{url}/embed"


@pytest.mark.parametrize("sim", SIMS, ids=lambda sim: sim.slug)
def test_a_lessons_page_describes_itself_to_other_sites(client: httpx.Client, sim: Any) -> None:
    html = client.get(f"/sims/{sim.slug}").text
    metas = {
        given.get("property", ""): given.get("content", "") for tag, given in Elements(html).found if tag == "meta"
    }
    assert metas["og:url"] == f"{client.base_url}sims/{sim.slug}"
    assert client.get(metas["og:image"]).status_code == 200
    assert f"/{sim.slug}-light.webp" in metas["og:image"]
    assert metas["og:title"]
    (found,) = re.findall(r'<script type="application/ld\+json">(.*?)</script>', html, re.S)
    resource = json.loads(found)
    assert resource["@type"] == "LearningResource"
    assert resource["teaches"] == [objective.text for objective in sim.objectives]
    assert resource["image"] == metas["og:image"]
