"""Animations: they play, stop at the first touch, and step where the reader wants no motion."""

from __future__ import annotations

import numpy as np
from playwright.sync_api import ViewportSize

from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner

SMALL: ViewportSize = {"width": 640, "height": 480}


def progress(learner: Learner, since: int = 0) -> list[float]:
    """How far the sequence was in each state that the server told."""
    return [message["params"]["progress"] for message in learner.sockets.states[since:]]


def test_an_animation_plays_and_stops_at_the_touch_of_a_slider(classroom: Classroom) -> None:
    learner = classroom.open_column("euler-angles/embed?yaw=90", size=SMALL)
    watcher = classroom.open_column(learner.room, size=SMALL)
    watcher.sees(yaw=90)
    turned: list[float] = []
    learner.press("Animate sequence")

    def followed() -> bool:
        turned.append(learner.scene.world_pose("/turn1")[0, 0])
        return min(progress(learner)) < 1 and learner.params["progress"] == 3

    learner.until(followed)
    learner.sees(yaw=90, progress=3)
    watcher.sees(yaw=90, progress=3)
    for viewer in (learner, watcher):
        seen = progress(viewer)
        start = seen.index(min(seen[1:]))
        assert seen[start] < 1, "it begins with no turn applied"
        assert np.all(np.diff(seen[start:]) >= 0), "it goes forward"
        assert len({v for v in seen if 0 < v < 3}) >= 4, "it moves and doesn't jump"
    assert len({round(c, 3) for c in turned}) >= 4, "the aircraft turned little by little"

    slider = learner.control("slider", "roll")

    def stopped_by_hand() -> bool:  # on a busy machine the hand may come when the animation is over
        learner.type("roll", "10")
        learner.press("Animate sequence")
        learner.until(lambda: 0 < learner.params["progress"] < 2)
        slider.press("ArrowLeft")
        learner.until(lambda: learner.params["roll"] == 9)
        return bool(learner.params["progress"] < 3)

    learner.until(stopped_by_hand)
    stopped = learner.sockets.state
    learner.type("pitch", "-10")
    learner.sees(pitch=-10, progress=stopped["params"]["progress"])
    assert learner.sockets.state["version"] == stopped["version"] + 1, "it went on after the touch"


def test_an_animation_steps_under_reduced_motion(classroom: Classroom) -> None:
    learner = classroom.open_column("euler-angles/embed?yaw=90", size=SMALL, reduced_motion="reduce")
    since = len(learner.sockets.states)
    learner.press("Animate sequence")
    learner.until(lambda: learner.params["progress"] == 0)
    learner.until(lambda: learner.params["progress"] == 3)
    assert set(progress(learner, since)) == {0, 1, 2, 3}


RESOLUTIONS = """async (times) => {
    const root = { viewport: { dpr: 1 }, size: [] };
    root.setDpr = (dpr) => { root.viewport = { dpr }; };
    const store = { getState: () => ({ ...root, internal: { frames: 0 }, invalidate() {} }), subscribe(heard) { store.heard = heard; } };
    window.__viserMutable = { scene: { __r3f: { root: store } }, nodePoseData: {} };
    sim3.liveAt = 1 - 2000;
    const ask = window.requestAnimationFrame;
    const found = times.map((took) => {
        let now = 0;
        window.requestAnimationFrame = (draw) => draw(now += took);
        for (let k = 0; k < 8; k++) window.__viserMutable.requestRender();
        return root.viewport.dpr / devicePixelRatio;
    });
    window.requestAnimationFrame = ask;
    root.setDpr(2); // as when the page is laid out anew
    store.heard(root);
    found.push(root.viewport.dpr / devicePixelRatio);
    const rests = new Promise((resolve) => { root.setDpr = (dpr) => resolve(dpr / devicePixelRatio); });
    return [...found, await rests];
}"""
SMOOTH = "document.querySelector('canvas[role]').getContext('webgl2').getContextAttributes().antialias"
DRAWS = """() => {
    const { prototype } = WebGL2RenderingContext;
    for (const name of ["drawElements", "drawArrays", "drawElementsInstanced", "drawArraysInstanced"]) {
        const draw = prototype[name];
        prototype[name] = function (...given) { window.drawn = performance.now(); return draw.apply(this, given); };
    }
    window.drawn = performance.now();
}"""
TAKEN_AND_GIVEN_BACK = """() => {
    const canvas = document.querySelector("canvas[role]");
    const machine = canvas.getContext("webgl2").getExtension("WEBGL_lose_context");
    canvas.addEventListener("webglcontextlost", () => setTimeout(() => machine.restoreContext()));
    machine.loseContext();
}"""
WIDTHS = """() => {
    const canvas = document.querySelector("canvas[role]");
    const share = () => canvas.width / Math.floor(canvas.clientWidth * devicePixelRatio);
    window.widths = [share()];
    new MutationObserver(() => widths.push(share())).observe(canvas, { attributeFilter: ["width"] });
}"""


def test_a_moving_scene_is_coarser_only_where_its_frames_take_long_and_none_at_rest(classroom: Classroom) -> None:
    learner = classroom.open_column("quaternion/embed")
    assert learner.frame.evaluate(RESOLUTIONS, [17, 50, 30, 17, 30, 90]) == [1, 0.75, 0.75, 1, 1, 0.75, 0.75, 1]


def test_a_scene_without_a_gpu_rests_smooth_and_still_and_comes_back_when_it_was_taken(classroom: Classroom) -> None:
    learner = classroom.open("quaternion/embed")
    assert learner.frame.evaluate(SMOOTH) is False, "no time is spent on them while it moves"
    learner.frame.evaluate(WIDTHS)
    learner.frame.wait_for_function("widths.at(-1) > 1.4")
    learner.frame.evaluate("void widths.splice(0, widths.length - 1)")
    learner.press_keys("angle", "ArrowRight")
    learner.frame.wait_for_function("Math.min(...widths) < 1.1 && widths.at(-1) > 1.4")
    learner.frame.evaluate(DRAWS)
    learner.frame.wait_for_function("performance.now() > drawn + 2500")  # viser's client alone draws each second
    learner.press_keys("angle", "ArrowRight")
    learner.frame.wait_for_function("performance.now() < drawn + 2500")

    angle = learner.params["angle"]
    learner.frame.evaluate(TAKEN_AND_GIVEN_BACK)
    learner.frame.wait_for_function("!window.drawn")
    learner.wait_live()
    learner.sees(angle=angle)
