"""Files that learners bring and take: to whom they belong, what is refused, and that nobody else feels it."""

from __future__ import annotations

import asyncio
import os
import socket
import threading
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest

from app.rooms.keys import new_key, room_of
from app.rooms.session import Session
from app.routes import coming
from sims import by_slug
from sims.kit import child
from sims.point_cloud import SIM as POINT_CLOUD
from sims.point_cloud import CloudParams, library, solve
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files import ply_bytes, read
from sims.point_cloud.library import GUESSED, Library
from tests.app.conftest import Local
from tests.server import PATIENCE, wait_for

HOSTILE = ("chunk_count.laz", "pointwise.laz")
"""Over the first one lazrs aborts, over the second it panics."""
POINTS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]])
FILE = ply_bytes(Cloud("mine", POINTS))


def hostile(name: str) -> bytes:
    """The bytes of a file of `HOSTILE`."""
    return (Path(__file__).parent / "clouds" / name).read_bytes()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The administrator's, of clouds good and bad."""
    folder = tmp_path_factory.mktemp("clouds")
    (folder / "church.xyz").write_text("0 0 0\n1 2 3\n4 5 6\n7 8 1\n")
    (folder / "broken.ply").write_bytes(b"ply\nnothing")
    for name in HOSTILE:
        (folder / name).write_bytes(hostile(name))
    (folder / "notes.md").write_text("not a cloud")
    (folder / "inside").mkdir()
    (folder.parent / "secret.xyz").write_text("1 2 3\n")
    return folder


@pytest.fixture(scope="module")
def local(folder: Path) -> Iterator[Local]:
    """A server that takes files of 1 MB, and has a folder of its own."""
    with Local(max_upload=1, cloud_dir=folder) as local:
        yield local


def library_of(local: Local) -> Library:
    """The server's clouds."""
    (library,) = local.services.sessions.given(POINT_CLOUD)
    assert isinstance(library, Library)
    return library


@contextmanager
def with_folder(local: Local, folder: Path) -> Iterator[Library]:
    """A server whose folder is looked through anew."""
    library = Library(folder, 1_000_000)
    before = dict(vars(library_of(local)))
    vars(library_of(local)).update(vars(library))
    yield library_of(local)
    vars(library_of(local)).update(before)


class Desk:
    """A room on the server."""

    def __init__(self, local: Local, query: str = "", slug: str = "point-cloud") -> None:
        self.local = local
        self.key = new_key()
        self.path = f"/sims/{slug}/s/{room_of(self.key)}/{self.key}/"
        assert local.http.get(f"{self.path}?{query}").status_code == 200
        sim = by_slug(slug)
        assert sim is not None
        session = local.services.sessions.find(sim, room_of(self.key))
        assert session is not None
        self.session: Session = session

    def bring(self, name: str, data: bytes, **headers: str) -> httpx.Response:
        return self.local.http.post(f"{self.path}file", params={"name": name}, content=data, headers=headers)

    @property
    def params(self) -> Any:
        return self.session.params

    def change(self, changes: Mapping[str, Any]) -> None:
        """What a control does, on the server's loop."""

        async def changed() -> None:
            self.session.change(changes)

        asyncio.run_coroutine_threadsafe(changed(), self.local._host.loop).result(PATIENCE)

    @property
    def offers(self) -> Any:
        return self.session.sim.offers(self.params, self.session.solution, *self.session.given)

    def solution(self) -> Any:
        asyncio.run_coroutine_threadsafe(self.session.settled(), self.local._host.loop).result(PATIENCE)
        return self.session.solution


def test_a_file_becomes_the_state_of_its_room_alone(local: Local) -> None:
    mine, other = Desk(local), Desk(local)
    assert mine.bring("mine.ply", FILE).status_code == 200
    assert mine.params.dataset == "file"
    solution = mine.solution()
    assert solution.points_out == 4
    np.testing.assert_allclose(solution.maximum, [1.0, 2.0, 3.0])
    assert other.params.dataset == "room"
    assert other.solution().points_out > 100_000
    assert mine.params.file in mine.params.query()


def test_what_is_shown_can_be_taken_home(local: Local) -> None:
    desk = Desk(local)
    assert desk.bring("mine.ply", FILE).status_code == 200
    answer = local.http.get(f"{desk.path}result/point-cloud.ply")
    assert answer.status_code == 200
    assert "attachment" in answer.headers["content-disposition"]
    np.testing.assert_array_equal(read("x.ply", answer.content, 10**6).points, POINTS)
    assert local.http.get(f"{desk.path}result/other.ply").status_code == 404


def test_two_files_of_a_registration_are_kept_together(local: Local) -> None:
    desk = Desk(local)
    assert desk.bring("first.ply", FILE).status_code == 200
    desk.change({"process": "register"})
    first = desk.params.file
    assert desk.bring("second.ply", FILE).status_code == 200
    second = desk.params.second
    assert (desk.params.file, set(desk.session.uploads)) == (first, {first, second})
    assert desk.bring("another.ply", FILE).status_code == 200
    assert set(desk.session.uploads) == {first, desk.params.second}
    assert desk.params.second != second
    desk.change({"process": "none"})
    assert desk.bring("alone.ply", FILE).status_code == 200
    assert desk.params.second is None
    assert desk.session.uploads == {desk.params.file: len(FILE)}


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("empty.ply", b"", "empty"),
        ("cut.ply", FILE[:-5], ""),
        ("picture.png", b"\x89PNG", "end in"),
        ("nothing.xyz", b"nan nan nan\n", ""),
        ("noise.las", bytes(range(256)) * 8, ""),
    ],
)
def test_a_bad_file_is_refused_in_words_and_changes_nothing(local: Local, name: str, data: bytes, words: str) -> None:
    desk = Desk(local, "voxel_size=0.1")
    before = desk.params
    answer = desk.bring(name, data)
    assert answer.status_code == 422
    assert words in answer.json()["detail"]
    assert answer.json()["detail"][0].isupper()
    assert desk.params == before
    assert not desk.session.uploads


@pytest.mark.parametrize(
    ("name", "data", "count"),
    [
        ("one.xyz", b"1 2 3\n", 1),
        ("same.xyz", b"1 2 3\n" * 50, 50),
        ("line.xyz", b"".join(b"%d 0 0\n" % k for k in range(50)), 50),
        ("../../../etc/passwd.ply", FILE, 4),
        ("..\\..\\windows\\a.ply", FILE, 4),
        ("<script>alert(1)</script>.ply", FILE, 4),
    ],
)
def test_an_odd_file_is_shown_whatever_is_done_with_it(local: Local, name: str, data: bytes, count: int) -> None:
    desk = Desk(local, "show_normals=1&color=variation")
    assert desk.bring(name, data).status_code == 200
    assert desk.solution().points_out == count
    (shown,) = [words for file, words in desk.offers.options("file").items() if file == desk.params.file]
    assert shown.startswith("Yours: ")
    assert not set(shown) & set("/\\")
    for process in ("ground", "clusters", "outliers", "register", "surface"):
        solution = desk.session.sim.solve(desk.params.changed({"process": process, "selected": 0}), *desk.session.given)
        assert solution.points_in == count


def test_points_without_coordinates_are_counted(local: Local) -> None:
    desk = Desk(local)
    assert desk.bring("holes.xyz", b"0 0 0\nnan 1 1\n1 1 1\n2 0 1\n").status_code == 200
    assert desk.solution().points_in == 3
    assert desk.solution().source.dropped == 1


def test_a_file_that_is_too_big_is_refused_unread(local: Local) -> None:
    desk = Desk(local)
    answer = desk.bring("big.xyz", b"0" * 1_000_001)
    assert answer.status_code == 413
    assert "MB" in answer.json()["detail"]

    def without_length() -> Iterator[bytes]:
        yield b"0 0 0\n"

    answer = local.http.post(f"{desk.path}file", params={"name": "a.xyz"}, content=without_length())
    assert answer.status_code == 411
    assert desk.params.dataset == "room"


def test_only_the_key_lets_files_in_and_out(local: Local) -> None:
    desk = Desk(local)
    room = room_of(desk.key)
    for path in (f"/sims/point-cloud/s/{room}/{new_key()}/", f"/sims/camera/s/{room}/{desk.key}/"):
        assert local.http.post(f"{path}file", params={"name": "a.ply"}, content=FILE).status_code == 404
        assert local.http.get(f"{path}result/point-cloud.ply").status_code == 404
    camera = Desk(local, slug="camera")
    assert camera.bring("a.ply", FILE).status_code == 404


def test_other_addresses_take_no_large_bodies(local: Local) -> None:
    answer = local.http.post("/api/sims/point-cloud/solve", content=b"0" * 100_000)
    assert answer.status_code == 413


def test_files_are_kept_as_long_as_their_session(local: Local) -> None:
    desk = Desk(local)
    assert desk.bring("mine.ply", FILE).status_code == 200
    name = desk.params.file
    assert local.services.sessions.uploaded_bytes() >= len(FILE)
    assert library_of(local).trouble(name) == ""
    assert "gone" in library_of(local).trouble("upload-never-there")
    assert desk.bring("other.ply", FILE).status_code == 200
    assert "gone" in library_of(local).trouble(name), "of two files the newer one is kept"
    desk.session.left_at = -1e9
    local.services.sessions.sweep()
    assert "gone" in library_of(local).trouble(desk.params.file)


def test_servers_in_one_process_have_files_of_their_own(local: Local) -> None:
    assert library_of(local).trouble("church.xyz") == ""
    assert "no file" in Library().trouble("church.xyz")
    assert not solve(CloudParams(dataset="file", file="church.xyz")).points_in


def test_the_server_keeps_no_more_than_it_can(local: Local, monkeypatch: pytest.MonkeyPatch) -> None:
    desk = Desk(local)
    monkeypatch.setattr(local.services.sessions, "uploaded_bytes", lambda: 10_000_000)
    answer = desk.bring("mine.ply", FILE)
    assert answer.status_code == 503
    assert desk.params.dataset == "room"


def test_slow_files_hold_up_nobody_and_are_given_up(local: Local, monkeypatch: pytest.MonkeyPatch) -> None:
    slow = Desk(local)
    head = f"POST {slow.path}file?name=a.xyz HTTP/1.1\r\nHost: here\r\nContent-Length: 1000000\r\n\r\n0 0 0"
    address = httpx.URL(local.url)
    with ExitStack() as stack:
        lines = [stack.enter_context(socket.create_connection((address.host, address.port or 80))) for _ in range(6)]
        for line in lines[:-1]:
            line.sendall(head.encode())
        assert Desk(local).bring("mine.ply", FILE).status_code == 200
        monkeypatch.setattr(coming, "STALL", 0.05)
        lines[-1].sendall(head.encode())
        lines[-1].settimeout(PATIENCE)
        answer = lines[-1].makefile("rb").read(4000)
    assert b" 400 " in answer.splitlines()[0]
    assert b"broke off" in answer
    assert slow.params.dataset == "room"


def test_the_administrators_folder_is_offered_by_name(local: Local) -> None:
    desk = Desk(local, "dataset=file&file=church.xyz")
    assert desk.solution().points_out == 4
    assert set(desk.offers.options("file")) == {None, "church.xyz", "broken.ply", *HOSTILE}
    broken = Desk(local, "dataset=file&file=broken.ply").solution()
    assert broken.points_out == 0
    assert "broken.ply" in broken.trouble


def reading_of(local: Local, name: str) -> Any:
    """What the API says of a file of the folder."""
    answer = local.http.post("/api/sims/point-cloud/solve", json={"dataset": "file", "file": name})
    assert answer.status_code == 200
    return answer.json()["solution"]


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_of_the_folder_gives_words_and_is_read_once(
    local: Local, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun = list[str]()
    begin = child.begin

    def counted(*given: Any, **kept: Any) -> Any:
        begun.append(given[1])
        return begin(*given, **kept)

    monkeypatch.setattr(child, "begin", counted)
    for _ in range(3):
        solution = reading_of(local, name)
        assert solution["points_in"] == 0
        assert name in solution["trouble"]
    assert Desk(local, f"dataset=file&file={name}").solution().trouble == solution["trouble"]
    assert begun in ([name], []), "a failure is remembered"
    assert reading_of(local, "church.xyz")["points_in"] == 4


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_that_is_brought_is_refused_in_words(local: Local, name: str) -> None:
    desk = Desk(local)
    answer = desk.bring(name, hostile(name))
    assert answer.status_code == 422
    assert answer.json()["detail"][0].isupper()
    assert desk.bring("mine.ply", FILE).status_code == 200


def test_a_file_of_the_folder_that_was_replaced_is_read_anew(local: Local, folder: Path) -> None:
    assert reading_of(local, "broken.ply")["points_in"] == 0
    good, bad = (folder / "broken.ply", (folder / "broken.ply").read_bytes())
    try:
        good.write_bytes(FILE)
        assert reading_of(local, "broken.ply")["points_in"] == 4
        os.utime(good, ns=(0, 0))  # of the same size
        assert reading_of(local, "broken.ply")["points_in"] == 4
    finally:
        good.write_bytes(bad)
    assert reading_of(local, "broken.ply")["points_in"] == 0
    good.unlink()
    assert "can't be read" in reading_of(local, "broken.ply")["trouble"]
    good.write_bytes(bad)


def test_what_a_child_failed_over_is_tried_again_after_a_while(
    local: Local, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may have been for want of memory; a refusal stays as it is."""
    (folder / "unlucky.xyz").write_text("1 2 3\n")
    with with_folder(local, folder) as clouds:
        refused = reading_of(local, "broken.ply")["trouble"], clouds._readings["broken.ply", GUESSED]
        with monkeypatch.context() as patch:
            patch.setattr(library, "FIELDS", "tests.sims.strange_reader:errs")
            assert "can't be read" in reading_of(local, "unlucky.xyz")["trouble"]
        assert "can't be read" in reading_of(local, "unlucky.xyz")["trouble"], "for a while it isn't tried again"
        monkeypatch.setattr(library, "AGAIN", 0.0)
        assert reading_of(local, "unlucky.xyz")["points_in"] == 1
        assert refused == (reading_of(local, "broken.ply")["trouble"], clouds._readings["broken.ply", GUESSED])
    (folder / "unlucky.xyz").unlink()


def test_columns_and_units_are_chosen_in_the_api_the_link_and_the_controls(local: Local) -> None:
    desk = Desk(local)
    assert desk.bring("mine.xyz", b"1 2 3 9\n4 5 6 9\n7 8 1 9\n").status_code == 200
    assert desk.offers.entries("columns") == "xyzi"
    desk.change({"columns.0": "z"})
    desk.change({"columns.3": "-"})
    assert desk.params.columns == "zyx-", "the column that was z became x"
    solution = desk.solution()
    assert solution.source.taken_for == ["z", "y", "x", "-"]
    np.testing.assert_allclose(solution.minimum, [1.0, 2.0, 1.0])
    np.testing.assert_allclose(solution.maximum, [6.0, 8.0, 7.0])
    assert "columns=zyx-" in desk.params.query()
    desk.change({"units": "feet"})
    np.testing.assert_allclose(desk.solution().maximum, np.array([6.0, 8.0, 7.0]) * 0.3048, atol=1e-6)
    desk.change({"columns.0": "-"})
    assert "no coordinate z" in desk.solution().trouble
    assert desk.offers.entries("columns") == "-yx-", "it can be mended"
    desk.change({"columns": "", "units": "auto"})
    assert desk.solution().points_in == 3

    body = {"dataset": "file", "file": "church.xyz", "columns": "yxz", "units": "millimetres"}
    told = local.http.post("/api/sims/point-cloud/solve", json=body).json()["solution"]
    np.testing.assert_allclose(told["maximum"], [0.008, 0.007, 0.006], atol=1e-8)
    assert told["source"]["unit"] == "millimetres"
    linked = Desk(local, "dataset=file&file=church.xyz&columns=yxz&units=millimetres")
    np.testing.assert_allclose(linked.solution().maximum, [0.008, 0.007, 0.006], atol=1e-8)


def test_the_clouds_of_the_folder_that_nobody_looks_at_are_few(folder: Path) -> None:
    names = [f"many {number}.xyz" for number in range(library.KEPT + 3)]
    for name in names:
        (folder / name).write_text("0 0 0\n1 2 3\n")
    clouds = Library(folder, 1_000_000)
    first = clouds.find(names[0])
    assert clouds.find(names[0]) is first, "every state has the same cloud"
    for name in names:
        assert len(clouds.find(name)) == 2
    assert len(clouds._readings) <= library.KEPT + 1
    for name in names:
        (folder / name).unlink()


@pytest.mark.parametrize("name", ["../secret.xyz", "..", "inside/x.xyz", "/etc/passwd", "..\\secret.xyz"])
def test_no_name_leads_out_of_the_folder(local: Local, name: str) -> None:
    answer = local.http.get("/sims/point-cloud/embed", params={"dataset": "file", "file": name})
    assert answer.status_code in (200, 422)
    assert not len(library_of(local).find(name))
    assert "secret" not in library_of(local).offered(name).values()


def test_reading_doesnt_hold_up_the_loop(local: Local) -> None:
    """While a file is read, the event loop goes on answering."""
    desk = Desk(local)
    text = "\n".join(f"{k} {k % 7} {k % 11}" for k in range(60_000)).encode()

    async def both() -> list[httpx.Response]:
        async with httpx.AsyncClient(base_url=local.url, trust_env=False, timeout=60) as http:
            coming = asyncio.create_task(
                http.post(f"{desk.path}file", params={"name": "long.xyz"}, content=text[:900_000])
            )
            answers = []
            while not coming.done():
                answers.append(await http.get("/healthz"))
            return [await coming, *answers]

    brought, *health = asyncio.run(both())
    assert brought.status_code == 200
    assert health
    assert all(answer.status_code == 200 for answer in health)


def test_a_file_that_is_given_up_while_it_is_read_changes_nothing(local: Local) -> None:
    desk = Desk(local)
    begun, go_on = threading.Event(), threading.Event()
    clouds = library_of(local)
    before = set(clouds._uploads)

    class Slow(Library):
        def add(self, name: str, data: bytes) -> tuple[str, Mapping[str, Any]]:
            begun.set()
            assert go_on.wait(20)
            return clouds.add(name, data)

        def remove(self, known_as: str) -> None:
            clouds.remove(known_as)

    desk.session.library = Slow()
    with socket.create_connection(("127.0.0.1", httpx.URL(local.url).port)) as page:
        head = f"POST {desk.path}file?name=mine.ply HTTP/1.1\r\nhost: x\r\ncontent-length: {len(FILE)}\r\n\r\n"
        page.sendall(head.encode() + FILE)
        assert begun.wait(20)
    assert local.http.get("/healthz").status_code == 200  # the loop has heard by now that the page is gone
    go_on.set()
    local.services.sessions.aside.submit(lambda: None).result()
    assert local.http.get("/healthz").status_code == 200
    assert desk.params.dataset == "room"
    wait_for(lambda: set(clouds._uploads) == before, "the file to be forgotten")
    assert not desk.session.uploads


# ---- a text of one's own


def pasted(desk: Desk, text: bytes) -> httpx.Response:
    return desk.local.http.post(f"{desk.path}paste", content=text)


def test_a_text_becomes_the_state_of_its_room_alone(local: Local) -> None:
    mine, other = (Desk(local, slug="euler-angles") for _ in range(2))
    answer = pasted(mine, "\ufeffwxyz 0.5 0.5 -0.5 0.5".encode())
    assert answer.status_code == 200
    assert answer.headers["access-control-allow-origin"] == "*"
    assert mine.params.yaw != other.params.yaw == type(other.params)().yaw


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (b"no rotation at all", "Nothing has changed."),
        (b"\xff\xfe\x00", "isn’t text in UTF-8"),
        (b"1 2 3 4 5 6 7 8 9", "Nothing has changed."),
    ],
)
def test_a_text_that_says_nothing_is_refused_in_words_and_changes_nothing(
    local: Local, text: bytes, words: str
) -> None:
    desk = Desk(local, "yaw=12", slug="euler-angles")
    answer = pasted(desk, text)
    assert answer.status_code == 422
    assert words in answer.json()["detail"]
    assert desk.params.yaw == 12.0


def test_a_text_needs_its_rooms_key_a_sim_that_takes_it_and_a_sensible_length(local: Local) -> None:
    desk = Desk(local, slug="euler-angles")
    assert local.http.post(f"{desk.path.replace(desk.key, new_key())}paste", content=b"1").status_code == 404
    assert pasted(Desk(local, slug="gimbal-lock"), b"1 0 0 0").status_code == 404
    assert pasted(desk, b"1 " * 40_000).status_code == 413
