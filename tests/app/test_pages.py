"""The pages: launcher, sim pages, and those that say what is wrong with a link or an address."""

from __future__ import annotations

import functools
import io
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import fields
from html.parser import HTMLParser
from typing import Any
from urllib.parse import parse_qs, urljoin, urlsplit

import httpx
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page, Route

from app.lessons.concepts import CONCEPTS
from app.lessons.shelf import LEARNT, place
from app.settings import ROOT
from sims import SIMS
from sims.kit.palette import DARK, LIGHT
from sims.kit.sim import Sim
from tests.app.conftest import PREFIX, Local
from tests.axe import findings
from tests.browser import COARSE
from tests.server import Server

AnySim = Sim[Any, Any]
Found = Callable[[str], httpx.Response]
SIM = SIMS[0]
ADDRESSES = {
    "launcher": "/",
    **{sim.slug: f"/sims/{sim.slug}" for sim in SIMS},
    "dark": f"/sims/{SIM.slug}?theme=dark",
    "bad link": f"/sims/{SIM.slug}?colour=red&view=1,2&controls=0",
    "bad link in a frame": f"/sims/{SIM.slug}/embed?colour=red",
    **{f"{sim.slug} without its scene": f"/sims/{sim.slug}/text" for sim in SIMS},
    "sharing": f"/sims/{SIM.slug}/share?controls=some&lesson=1",
    "documentation": "/docs",
    "concepts": "/concepts",
    "about": "/about",
    "developers": "/developers",
    "check": "/check",
    "no such sim": "/sims/nothing",
    "no such page": "/nothing",
}
SIZES = ((1280, 800), (700, 600), (390, 780), (320, 640))
STAND_IN = """<!doctype html><html lang="en"><title>Sim</title><h1>Sim</h1><script>
const tell = () => parent.postMessage({type: "sim3:state", slug: "sim", query: 'yaw=45&name="', params: {}}, "*");
addEventListener("message", (event) => event.data.type === "sim3:get" && tell());
tell();
</script>"""
THUMB_BYTES = 40_000
each_sim = pytest.mark.parametrize("sim", SIMS, ids=lambda sim: sim.slug)
each_address = pytest.mark.parametrize("address", ADDRESSES.values(), ids=ADDRESSES.keys())


class Element:
    """An element of a page: its tag, attributes, and the words in it."""

    def __init__(self, tag: str, attributes: dict[str, str]) -> None:
        self.tag = tag
        self.attributes = attributes
        self.text = ""


class Document(HTMLParser):
    """Every element of a page, in order."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.elements: list[Element] = []
        self._open: list[Element] = []
        self.feed(html)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        element = Element(tag, {name: value or "" for name, value in attrs})
        if tag != "title" or all(other.tag != "svg" for other in self._open):  # a picture's marks have titles too
            self.elements.append(element)
        if tag not in ("br", "img", "input", "link", "meta", "source"):
            self._open.append(element)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append(Element(tag, {name: value or "" for name, value in attrs}))

    def handle_data(self, data: str) -> None:
        for element in self._open:
            element.text += data

    def handle_endtag(self, tag: str) -> None:
        assert self._open, f"</{tag}> closes nothing"
        assert self._open.pop().tag == tag, f"</{tag}> closes something else"

    def all(self, *tags: str) -> list[Element]:
        return [element for element in self.elements if element.tag in tags]

    def one(self, tag: str) -> Element:
        (element,) = self.all(tag)
        return element

    def links(self) -> list[str]:
        return [element.attributes["href"] for element in self.all("a")]

    def loaded(self) -> list[str]:
        """Addresses of everything that the browser fetches by itself."""
        attributes = ("src", "srcset", "href")
        elements = self.all("img", "source", "script", "iframe", "link")
        return [element.attributes[a] for element in elements for a in attributes if a in element.attributes]


@pytest.fixture(scope="module")
def found(client: httpx.Client) -> Found:
    """What is at an address, asked for once for all tests that only look at it."""
    return functools.cache(client.get)


def get(client: httpx.Client, address: str, status: int = 200) -> Document:
    answer = client.get(address)
    assert answer.status_code == status
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    return Document(answer.text)


# ---- every page


@each_address
def test_page_has_the_structure_that_people_find_their_way_by(found: Found, address: str) -> None:
    page = Document(found(address).text)
    assert page.one("html").attributes["lang"] == "en"
    assert "Sim3" in page.one("title").text
    assert page.one("main").attributes["id"] == "main"
    levels = [int(heading.tag[1]) for heading in page.all("h1", "h2", "h3")]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all("alt" in image.attributes for image in page.all("img"))
    assert all(heading.text.strip() for heading in page.all("h1", "h2", "h3"))
    ids = [element.attributes["id"] for element in page.elements if "id" in element.attributes]
    assert len(ids) == len(set(ids))


@each_address
def test_everything_a_page_needs_is_here(found: Found, server: Server, address: str) -> None:
    for wanted in Document(found(address).text).loaded():
        wanted = wanted.removeprefix(server.origin)  # what other sites ask for is whole
        assert wanted.startswith(PREFIX + "/")
        answer = found(server.origin + wanted)
        assert answer.status_code in (200, 307), wanted


@each_address
def test_every_link_of_a_page_leads_somewhere(found: Found, server: Server, address: str) -> None:
    page = Document(found(address).text)
    ids = {element.attributes.get("id") for element in page.elements}
    for link in page.links():
        if link.startswith("#"):
            assert link[1:] in ids
        elif not link.startswith("https://"):
            link = urljoin(PREFIX + address, link)
            assert link.startswith(PREFIX + "/")
            assert found(server.origin + link).status_code in (200, 307), link


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_theme_of_a_link_holds_for_the_page_and_its_pictures(client: httpx.Client, theme: str) -> None:
    page = get(client, f"/sims/{SIM.slug}?theme={theme}")
    assert page.one("html").attributes["data-theme"] == theme
    assert f"{SIM.slug}-{theme}.webp" in page.one("img").attributes["src"]
    assert not page.all("source")


# ---- launcher and sim pages


def test_launcher_shows_every_sim_in_order(client: httpx.Client) -> None:
    page = get(client, "/")
    to_sims = [link for link in page.links() if "/sims/" in link and not link.endswith("/text")]
    assert to_sims == [f"{PREFIX}/sims/{sim.slug}" for sim in SIMS]
    shown = [item.text for item in page.all("li")]
    for sim in SIMS:
        assert any(sim.title in text and sim.summary in text for text in shown)
        learnt = LEARNT.findall(place(sim).read_text("utf-8")) if place(sim).is_file() else []
        assert {CONCEPTS[slug] for slug in learnt} | (set() if learnt else {*sim.concepts}) <= {*shown}
        assert {f"{PREFIX}/concepts/{slug}" for slug in learnt} <= {*page.links()}


@each_sim
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_thumbnail_is_there_and_light(sim: AnySim, theme: str) -> None:
    data = (ROOT / "static" / "thumbs" / f"{sim.slug}-{theme}.webp").read_bytes()
    assert len(data) < THUMB_BYTES
    assert Image.open(io.BytesIO(data)).size == (800, 600)


@each_sim
def test_sim_page_says_what_the_sim_teaches(client: httpx.Client, sim: AnySim) -> None:
    page = get(client, f"/sims/{sim.slug}")
    assert sim.title in page.one("main").text
    items = [" ".join(item.text.split()) for item in page.all("li")]
    assert {f"{o.text} Bloom level: {o.level}" for o in sim.objectives} <= set(items)
    assert set(sim.concepts) <= set(items)


@each_sim
def test_sim_page_hands_its_query_on(client: httpx.Client, sim: AnySim) -> None:
    link = next((query for changes in sim.states.values() if (query := sim.params().changed(changes).query())), "")
    query = f"{link}&controls=0&theme=dark".lstrip("&")
    page = get(client, f"/sims/{sim.slug}?{query}")
    embed = f"{PREFIX}/sims/{sim.slug}/embed?{query}"
    assert page.one("iframe").attributes["src"] == embed
    assert embed in page.links()


def test_sim_page_leads_to_its_neighbours(client: httpx.Client) -> None:
    ways = [
        {
            a.attributes["rel"]: a.attributes["href"]
            for a in get(client, f"/sims/{sim.slug}").all("a")
            if "rel" in a.attributes
        }
        for sim in SIMS
    ]
    places = [f"{PREFIX}/sims/{sim.slug}" for sim in SIMS]
    assert [way.get("prev") for way in ways] == [None, *places][:-1]
    assert [way.get("next") for way in ways] == [*places, None][1:]


# ---- what is wrong with a link


@pytest.mark.parametrize("kind", ["", "/embed"])
def test_bad_parameters_are_named_and_the_good_ones_kept(client: httpx.Client, server: Server, kind: str) -> None:
    query = "colour=%3Cimg+src%3Dx%3E&view=1,2&theme=blue&controls=0"
    page = get(client, f"/sims/{SIM.slug}{kind}?{query}", 422)
    words = " ".join(page.one("main").text.split())
    for part in ("colour", "<img src=x>", "view", "1,2", "six numbers", "theme", "blue", "light or dark"):
        assert part in words
    assert not page.all("img")
    (way,) = [link for link in page.links() if "controls=0" in link]
    assert urlsplit(way).path == f"{PREFIX}/sims/{SIM.slug}{kind}"
    assert parse_qs(urlsplit(way).query) == {"controls": ["0"]}
    assert client.get(server.origin + way).status_code == 200


@each_sim
def test_every_parameter_of_the_wrong_type_is_named(client: httpx.Client, sim: AnySim) -> None:
    for name in sim.params.model_fields:
        page = get(client, f"/sims/{sim.slug}?{name}=%22nonsense%22", 422)
        described = [entry.text for entry in page.all("dd")]
        assert described[:2] == [name, '"nonsense"']
        assert described[2]


def test_page_for_a_frame_leaves_out_what_surrounds_it(client: httpx.Client) -> None:
    page = get(client, f"/sims/{SIM.slug}/embed?colour=red", 422)
    assert not page.all("header", "footer", "nav")


def test_full_server_says_so_and_offers_to_try_again() -> None:
    with Local(max_sessions=1) as local:
        address = f"/sims/{SIM.slug}/embed"
        assert local.http.get(address, follow_redirects=True).status_code == 200
        answer = local.http.get(address, follow_redirects=True)
        assert answer.status_code == 503
        assert str(answer.url) in Document(answer.text).links()


# ---- in a browser


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """A page on which sims are only a word, so that the page around them is what is tested."""
    with new_page(browser) as page:
        yield page


@pytest.fixture(scope="module")
def used_page(browser: Browser) -> Iterator[Page]:
    """The same, for tests that leave nothing behind: a new one takes longer than they do."""
    with new_page(browser) as page:
        yield page


@contextmanager
def new_page(browser: Browser) -> Iterator[Page]:
    context = browser.new_context(
        reduced_motion="reduce", device_scale_factor=COARSE, permissions=["clipboard-read", "clipboard-write"]
    )
    page = context.new_page()
    page.route("**/embed*", stand_in)
    yield page
    context.close()


def stand_in(route: Route) -> None:
    """Instead of a sim in a frame: what a sim tells its page. Pages of errors come as they are."""
    if route.request.frame.parent_frame is None:
        route.continue_()
        return
    route.fulfill(body=STAND_IN, content_type="text/html")


@pytest.mark.e2e
@each_address
def test_page_fits_every_width_and_axe_finds_nothing(used_page: Page, server: Server, address: str) -> None:
    """In the dark the markup is the same, and only colours differ."""
    page = used_page
    page.goto(server.url + address)
    for width, height in reversed(SIZES):
        page.set_viewport_size({"width": width, "height": height})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.evaluate("document.querySelectorAll('details').forEach((details) => (details.open = true))")
    page.emulate_media(color_scheme="light")
    assert findings(page) == []
    page.emulate_media(color_scheme="dark")
    assert findings(page, colours_alone=True) == []


@pytest.mark.e2e
def test_axe_finds_what_is_wrong(used_page: Page) -> None:
    """Once of each look, but each time: two texts that can't be read on two grounds, a link among words that looks like
    them (the one that stands alone does so too), and a picture that says nothing.
    """
    grey = '<p style="color: #aaa">a pale text</p>'
    link = '<a href="/" style="color: #222; text-decoration: none">a link that is longer</a>'
    among = f"<p>among {link[:-13]}</a> more words than it has</p>"
    bad = f'{grey * 2}<div style="background: #bbb">{grey}</div>{among}<img src="data:,">'
    used_page.set_content(
        f'<html lang="en"><title>Bad</title><main><h1>Bad</h1><p>good</p><p>{link}</p>{bad}</main></html>'
    )
    for _ in range(2):
        found = sorted(each.split()[0] for each in findings(used_page))
        assert found == ["color-contrast", "color-contrast", "image-alt", "link-in-text-block"]


@pytest.mark.e2e
@pytest.mark.parametrize("address", ["/", f"/sims/{SIM.slug}"])
def test_nothing_shifts_while_a_page_loads(page: Page, server: Server, address: str) -> None:
    page.add_init_script(
        "window.shifts = 0;"
        "new PerformanceObserver(list => list.getEntries().forEach(e => window.shifts += e.value))"
        ".observe({type: 'layout-shift', buffered: true})"
    )
    page.goto(server.url + address, wait_until="networkidle")
    assert page.evaluate("window.shifts") == 0


@pytest.mark.e2e
def test_address_links_and_code_follow_the_sim(page: Page, server: Server) -> None:
    place = f"{server.url}/sims/{SIM.slug}"
    page.goto(f"{place}?controls=0")
    page.wait_for_url(lambda url: "yaw=45" in url)
    assert page.url == f"{place}?yaw=45&name=%22&controls=0"
    assert page.get_by_role("link", name="Full screen").evaluate("link => link.href") == (
        f"{place}/embed?yaw=45&name=%22&controls=0"
    )
    share = page.get_by_role("link", name="Share", exact=True)
    assert share.evaluate("link => link.href") == f"{place}/share?yaw=45&name=%22&controls=0"


@pytest.mark.e2e
def test_keyboard_skips_to_the_content_and_past_the_sim(page: Page, server: Server) -> None:
    page.goto(f"{server.url}/sims/{SIM.slug}")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Skip to the content"
    page.keyboard.press("Enter")
    stops: list[str] = []
    while "Skip the sim" not in stops and len(stops) < 4:
        page.keyboard.press("Tab")
        stops.append(page.evaluate("document.activeElement.textContent"))
    assert stops[-1] == "Skip the sim"
    page.keyboard.press("Enter")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.closest('#after') !== null")


@pytest.mark.e2e
def test_page_around_a_frame_hears_of_a_bad_link(page: Page, server: Server) -> None:
    page.unroute("**/embed*")
    page.goto(f"{server.url}/")
    message = page.evaluate(
        """address => new Promise(resolve => {
            addEventListener("message", event => resolve(event.data));
            const frame = document.createElement("iframe");
            frame.src = address;
            document.body.append(frame);
        })""",
        f"{PREFIX}/sims/{SIM.slug}/embed?colour=red",
    )
    assert (message["type"], message["slug"]) == ("sim3:error", SIM.slug)
    assert "colour" in message["message"]


# ---- colours


@pytest.mark.parametrize("palette", [LIGHT, DARK], ids=["light", "dark"])
def test_pages_and_scenes_have_the_same_colours(palette: Any) -> None:
    css = (ROOT / "static" / "tokens.css").read_text()
    found = dict(re.findall(r"--(\w+): light-dark\((#\w{6}, #\w{6})\)", css))
    for field in fields(palette):
        if field.name != "dark":
            assert found[field.name].split(", ")[palette.dark] == getattr(palette, field.name), field.name


@pytest.mark.parametrize("palette", [LIGHT, DARK], ids=["light", "dark"])
def test_every_colour_can_be_read_on_its_page(palette: Any) -> None:
    for field in fields(palette):
        if field.name not in ("dark", "page"):
            assert contrast(getattr(palette, field.name), palette.page) >= 4.5, field.name


def contrast(a: str, b: str) -> float:
    """Contrast ratio of WCAG 2.2."""
    light, dark = sorted((luminance(a), luminance(b)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def luminance(color: str) -> float:
    """Relative luminance of WCAG 2.2."""
    parts = (int(color[k : k + 2], 16) / 255 for k in (1, 3, 5))
    r, g, b = (v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in parts)
    return 0.2126 * r + 0.7152 * g + 0.0722 * b
