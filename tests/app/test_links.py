"""What is linked across scene, pictures and tables: pointing is seen by the room, watchers point for themselves."""

from __future__ import annotations

import asyncio

import numpy as np

from app.rooms.registry import Sessions
from app.rooms.session import Session
from sims.camera import SIM as CAMERA
from sims.kit.world import PLACES
from tests.app.conftest import Local
from tests.app.page import Page


def lit(page: Page, name: str) -> bool:
    """Whether a page's scene lights up the point of that name; an empty name is nothing."""
    if not name or not page.model.visible("/lit"):
        return not name and not page.model.visible("/lit")
    return np.allclose(page.model.world_pose("/lit")[:3, 3], PLACES[name])


def lights(page: Page, name: str) -> None:
    """Wait until a page's scene does."""
    page.until(lambda: lit(page, name), f"{name or 'nothing'} to be lit")


def point_at(page: Page, name: str) -> None:
    page.tell({"type": "point", "name": name})


def heard(page: Page) -> list[str]:
    """What the page was told that others point at."""
    return [m["name"] for m in page.told if m["type"] == "point"]


def test_what_somebody_points_at_lights_up_for_the_whole_room_and_stays_lit_while_things_move(local: Local) -> None:
    teacher = Page(local.url, slug="camera")
    with Page(local.url, slug="camera", room=teacher.room) as watcher, Page(local.url, slug="camera") as stranger:
        point_at(teacher, "far-post")
        for page in (teacher, watcher):
            lights(page, "far-post")
        watcher.until(lambda: heard(watcher) == ["far-post"], "the word")
        teacher.tell({"type": "set", "params": {"pan": 10}})
        for page in (teacher, watcher):
            page.settle()
            assert page.params["pan"] == 10
            assert lit(page, "far-post"), "it stays lit when the scene is drawn anew"
        assert heard(teacher) == [], "a page isn't told what it points at itself"
        stranger.settle()
        assert lit(stranger, "")
        assert heard(stranger) == []

        teacher.close()
        lights(watcher, "")  # it goes with who pointed
        watcher.until(lambda: heard(watcher) == ["far-post", ""], "the word")


def test_who_only_watches_points_for_their_own_eyes_and_selects_nothing(local: Local) -> None:
    with Page(local.url, slug="camera") as teacher, Page(local.url, slug="camera", room=teacher.room) as watcher:
        before = local.refusals["watching"]
        point_at(watcher, "cube-left")
        lights(watcher, "cube-left")
        watcher.tell({"type": "select", "name": "cube-left"})
        local.refused("watching", before)
        teacher.settle()
        assert lit(teacher, "")
        assert heard(teacher) == []
        assert teacher.params["selected"] == "roof-near"
        assert local.refusals["watching"] == before + 1, "pointing isn't refused"


def test_what_is_linked_is_selected_and_what_is_not_does_nothing(local: Local) -> None:
    with Page(local.url, slug="camera") as page, Page(local.url) as other:
        page.tell({"type": "select", "name": "cube-left"})
        page.until(lambda: page.params["selected"] == "cube-left", "the selection")
        for at, name in ((page, "nobody"), (page, ""), (other, "cube-left")):
            at.tell({"type": "select", "name": name})
            at.settle()
            assert at.errors == []
        assert page.params["selected"] == "cube-left"


def test_a_selection_ends_a_motion_and_one_that_is_none_does_not() -> None:
    async def test() -> None:
        session = Sessions(1).open(CAMERA, "room", CAMERA.params())
        session.act("dolly-zoom")
        await asyncio.sleep(0.1)
        session.select("nobody")
        assert moving(session)
        session.select("far-foot")
        assert not moving(session)
        assert session.params.model_dump()["selected"] == "far-foot"

    asyncio.run(asyncio.wait_for(test(), 20))


def moving(session: Session) -> bool:
    return session.motion.task is not None
