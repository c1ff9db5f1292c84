"""The address bar holds the state; it survives reload, Back and Forward, and can be shared."""

from __future__ import annotations

from urllib.parse import parse_qs, urlsplit

import numpy as np
import pytest
from playwright.sync_api import expect

from sims.kit.palette import DARK
from tests.e2e.conftest import DESK, Classroom
from tests.e2e.learner import box
from tests.e2e.picture import Picture
from tests.e2e.test_lessons import NOTED


def test_the_address_holds_the_state_and_reload_restores_it(classroom: Classroom) -> None:
    learner = classroom.open_column("euler-angles/embed?yaw=45&pitch=20")
    learner.sees(yaw=45)
    assert learner.query() == "yaw=45", "default values are left out"

    learner.type("roll", "-77")
    learner.choose("frame", "extrinsic")
    learner.sees(yaw=45, roll=-77, frame="extrinsic")
    assert parse_qs(learner.query()) == {"yaw": ["45"], "roll": ["-77"], "frame": ["extrinsic"]}
    learner.type("yaw", "30")
    learner.sees(yaw=30)
    assert "yaw" not in learner.query()

    room = learner.room
    learner.reload()
    solution = learner.sees(yaw=30, roll=-77, frame="extrinsic")
    assert learner.room == room, "a reload goes on in its room"
    learner.until(
        lambda: np.testing.assert_allclose(
            learner.scene.world_pose("/turn1/turn2/turn3")[:3, :3], solution["R"], atol=1e-6
        )
    )

    learner.press("Reset")
    learner.sees(yaw=45, pitch=20, roll=10, frame="intrinsic")
    assert set().union(*(parse_qs(urlsplit(a).query) for a in learner.addresses)) <= {
        "yaw",
        "pitch",
        "roll",
        "frame",
    }, "at no moment, not even while it loads, does the address hold anything but the state"


def test_the_address_rests_while_the_page_is_left(classroom: Classroom) -> None:
    """Or a page that is reloaded while its state changes would be a new one to the browser, without its room."""
    learner = classroom.open_column("euler-angles/embed?yaw=45")
    learner.frame.evaluate(NOTED)
    learner.frame.evaluate("dispatchEvent(new Event('beforeunload'))")
    learner.type("yaw", "50")
    learner.until(lambda: learner.params["yaw"] == 50 and learner.control("textbox", "yaw").input_value() == "50")
    assert learner.query() == "yaw=45"
    learner.frame.evaluate("passes()")  # it wasn't left
    learner.sees(yaw=50)
    learner.type("yaw", "55")
    learner.sees(yaw=55)


def test_back_and_forward_keep_working(classroom: Classroom) -> None:
    learner = classroom.enter(painted=False)
    page = learner.page
    page.goto(learner.url + "/")
    page.get_by_role("heading", name="Euler angles").get_by_role("link").click()
    page.goto(page.get_by_role("link", name="Full screen").evaluate("link => link.href"))
    learner.wait_live()
    learner.type("yaw", "99")
    learner.sees(yaw=99)
    history = page.evaluate("history.length")
    learner.type("yaw", "98")
    learner.sees(yaw=98)
    assert page.evaluate("history.length") == history, "moving a control adds nothing to go back through"

    page.go_back()
    expect(page.locator(".intro .which")).to_contain_text("Euler angles")
    learner.sockets.forget()
    page.go_forward()
    learner.wait_live()
    learner.sees(yaw=98)
    learner.type("pitch", "-5")
    learner.sees(yaw=98, pitch=-5)


def test_the_sim_page_follows_the_sim(classroom: Classroom) -> None:
    learner = classroom.enter(painted=False)
    learner.open_page("euler-angles?yaw=45&theme=light")
    learner.sees(yaw=45)
    learner.type("yaw", "-15")
    learner.sees(yaw=-15)
    page = learner.page
    learner.until(lambda: parse_qs(urlsplit(page.url).query) == {"yaw": ["-15"], "theme": ["light"]})
    full = page.get_by_role("link", name="Full screen").get_attribute("href") or ""
    assert parse_qs(urlsplit(full).query) == {"yaw": ["-15"], "theme": ["light"]}
    share = page.get_by_role("link", name="Share", exact=True).get_attribute("href") or ""
    assert parse_qs(urlsplit(share).query) == {"yaw": ["-15"], "theme": ["light"]}


def test_share_gives_a_link_to_the_same_state(classroom: Classroom) -> None:
    learner = classroom.open_column(
        "euler-angles/embed?order=zxz&view=4,1,2,0,0,0", permissions=["clipboard-read", "clipboard-write"]
    )
    learner.type("yaw", "123")
    solution = learner.sees(yaw=123, order="zxz")
    learner.press("Share")
    learner.page.get_by_role("button", name="Copy link").click()
    learner.page.get_by_role("status").get_by_text("Copied.").wait_for()
    link = learner.page.evaluate("navigator.clipboard.readText()")
    assert "/s/" not in link, "a shared link opens a room of its own"

    learner.page.keyboard.press("Escape")
    friend = classroom.open(link)
    assert friend.sees(yaw=123, order="zxz") == solution
    np.testing.assert_allclose(friend.sockets.camera["position"], [4, 1, 2], atol=1e-6)
    friend.type("yaw", "1")
    friend.sees(yaw=1)
    learner.type("pitch", "50")
    learner.sees(yaw=123, pitch=50)


def test_theme_and_view_of_a_link_work_and_last(classroom: Classroom) -> None:
    view = "2,-4,1.5,0.1,0,0.2"
    learner = classroom.open(f"euler-angles/embed?theme=dark&view={view}&yaw=-50&pitch=-20")
    for _ in range(2):
        learner.sees(yaw=-50)
        camera = learner.sockets.camera
        np.testing.assert_allclose(camera["position"], [2, -4, 1.5], atol=1e-6)
        np.testing.assert_allclose(camera["look_at"], [0.1, 0, 0.2], atol=1e-6)
        assert camera["fov"] == pytest.approx(0.7)
        assert parse_qs(urlsplit(learner.address).query) == {
            "theme": ["dark"], "view": [view], "yaw": ["-50"], "pitch": ["-20"],
        }  # fmt: skip
        tip = learner.scene.points("/turn1/turn2/turn3/arrows")[2]
        at = tip[0] + 0.94 * (tip[1] - tip[0])
        learner.until(lambda at=at: Picture(learner, DARK).shows("z", at))  # type: ignore[misc]
        learner.reload()


def test_a_link_without_controls_has_only_the_scene(classroom: Classroom) -> None:
    learner = classroom.open_column("euler-angles/embed?controls=0&yaw=5")
    assert learner.frame.get_by_role("slider").count() == 0
    assert learner.frame.locator(".s3-readouts").count() == 0
    assert box(learner.frame.locator(".s3-scene"))["width"] == DESK["width"], "the scene has the whole width"
    learner.reload()
    learner.sees(yaw=5)
    assert learner.frame.get_by_role("slider").count() == 0


def test_the_address_never_holds_the_key_of_a_room(classroom: Classroom) -> None:
    teacher = classroom.open_column("euler-angles/embed?yaw=45&theme=light")
    helper = classroom.open_column(f"{teacher.room}?theme=light")
    for learner in (teacher, helper):
        learner.sees(yaw=45)
        assert learner.address == f"{teacher.url}/sims/euler-angles/embed?yaw=45&theme=light"
    assert helper.room == teacher.room
    helper.type("yaw", "50")
    teacher.sees(yaw=50)

    copied = classroom.open_column(teacher.address)
    copied.sees(yaw=50)
    assert copied.room != teacher.room, "whoever copies the address gets a room of their own"
    helper.reload()
    helper.type("yaw", "55")
    teacher.sees(yaw=55)
    copied.sees(yaw=50)
    key = teacher.room.rstrip("/").rpartition("/")[2]
    assert [address for address in teacher.addresses + copied.addresses if key in address] == []
