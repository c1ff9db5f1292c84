"""What those see who watch a server, and how it ends."""

from __future__ import annotations

import io
import json
import logging
import re
import socket
from types import SimpleNamespace
from typing import Any

import httpx
import kubernetes_validate
import pytest
import yaml
from prometheus_client.parser import text_string_to_metric_families
from websockets.exceptions import InvalidStatus

from app import logs
from app.rooms import telling
from app.settings import Settings
from app.trouble import error_message
from tests.app.conftest import Local
from tests.app.page import SLUG, Page, closed, connect
from tests.app.toys import toy
from tests.server import PATIENCE, ROOT, Server, wait_for

KUBERNETES = "1.33"
DASHBOARD = ROOT / "deploy" / "dashboard.json"


def measured(local: Local) -> dict[tuple[str, str], float]:
    """Every sample by its name and the values of its labels."""
    text = local.http.get("/metrics").text
    return {
        (sample.name, " ".join(value for name, value in sample.labels.items() if name != "le")): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }


def test_metrics_count_what_happens() -> None:
    with Local() as local:
        before = measured(local)
        with Page(local.url) as page:
            page.works()
            during = measured(local)
        assert during["sim3_sessions", SLUG] == before["sim3_sessions", SLUG] + 1
        assert during["sim3_viewers", SLUG] == 1
        assert during["sim3_pages", ""] == 1
        updates = ("sim3_update_seconds_count", SLUG)
        assert during[updates] > before.get(updates, 0)
        assert during["process_resident_memory_bytes", ""] > 1e7
        assert during["sim3_failures_total", f"{SLUG} draw"] == 0  # there before the first, which is an increase
        with pytest.raises(InvalidStatus):
            connect(f"{local.url}/sims/{SLUG}/s/{'0' * 20}/wrong/channel", viser=False)
        assert measured(local)["sim3_refused_total", "address"] == 1


def test_the_dashboard_asks_for_what_there_is() -> None:
    with Local() as local, Page(local.url) as page:
        page.works()
        known = {name for name, _ in measured(local)}
    asked = re.findall(r"\b((?:sim3|process|python)_\w+)", DASHBOARD.read_text())
    assert len({*asked}) > 8
    assert {*asked} <= known | {"sim3_refused_total", "sim3_failures_total", "sim3_uploads_total"}, {*asked} - known


def test_no_label_says_who() -> None:
    with Local() as local, Page(local.url) as page:
        text = local.http.get("/metrics").text
        assert str(page.key) not in text
        assert page.room not in text
        assert "127.0.0.1" not in text


def test_a_server_that_ends_takes_no_new_rooms_and_sends_its_pages_elsewhere() -> None:
    with Server(SIM3_DRAIN_SECONDS="8", SIM3_LOG="json") as server, Page(server.url) as page:
        with httpx.Client(base_url=server.url, trust_env=False, timeout=PATIENCE) as http:
            assert http.get("/readyz").status_code == 200
            server.send_end()
            wait_for(lambda: http.get("/readyz").status_code == 503, "the server to say that it ends")
            refused = http.get(f"/sims/{SLUG}/embed")
            assert (refused.status_code, refused.headers["retry-after"]) == (503, "2")
            assert "restarted" in refused.text
            page.works()
            assert http.get(f"/sims/{SLUG}").status_code == 200  # lessons are read, for nobody
        with socket.create_connection(("127.0.0.1", server.port)) as nonsense:
            nonsense.sendall(b"this is no HTTP\r\n\r\n")
            assert nonsense.recv(100).startswith(b"HTTP/1.1 400")
        server.send_end()  # asked for the second time, it ends at once
        assert closed(page.channel) == 1012
        said = [
            json.loads(line)["message"] for line in server.log().splitlines() if not line.startswith("Sim3 is ready")
        ]
        assert "Invalid HTTP request received." in said


def test_before_it_ends_pages_are_told_the_state_with_which_they_go_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(telling, "STATE_INTERVAL", 1e9)
    with Local() as local, Page(local.url) as page:
        page.slide("yaw", 33)
        page.until(lambda: "by 33.0°" in page.column.html("read"), "the slider to be obeyed")
        assert page.params["yaw"] != 33.0
        local.drain()
        page.until(lambda: page.params["yaw"] == 33.0, "the state")
        page.works()


def test_json_lines_say_the_same_and_nothing_secret() -> None:
    out = io.StringIO()
    handler = logging.StreamHandler(out)
    handler.setFormatter(logs.Json())
    log = logging.Logger("sim3")
    log.addHandler(handler)
    try:
        raise ZeroDivisionError("by the seed")
    except ZeroDivisionError:
        log.exception("drawing %s failed in the state %s", "camera", "fx=300")
    (line,) = out.getvalue().splitlines()
    said = json.loads(line)
    assert said["level"] == "error"
    assert said["message"] == "drawing camera failed in the state fx=300"
    assert "ZeroDivisionError: by the seed" in said["traceback"]


def test_what_goes_wrong_again_and_again_is_logged_seldom(monkeypatch: pytest.MonkeyPatch) -> None:
    seldom = logs.Seldom()

    def written(at: float, sim: str, error: str) -> str:
        record = logging.LogRecord("sim3", logging.ERROR, __file__, 1, "%s can't go on: %s", (sim, error), None)
        monkeypatch.setattr(logs, "time", SimpleNamespace(monotonic=lambda: at))
        record.created = -at  # the clock on the wall may be set back
        return record.getMessage() if seldom.filter(record) else ""

    assert written(0.0, "camera", "first") == "camera can't go on: first"
    assert not any(written(k, "camera", f"{k}") for k in (1.0, 2.0, 59.0))
    assert written(3.0, "epipolar", "another") == "epipolar can't go on: another"
    assert written(61.0, "camera", "later") == "camera can't go on: later (3 more like it before)"
    assert written(122.0, "camera", "again") == "camera can't go on: again"


def test_faults_of_two_places_are_both_logged() -> None:
    def here() -> None:
        raise ValueError("a")

    def there() -> None:
        raise ValueError("b")

    out = io.StringIO()
    handler = logging.StreamHandler(out)
    handler.addFilter(logs.Seldom())
    sim, _ = toy()
    logging.getLogger().addHandler(handler)
    try:
        for fails in (here, there, here, there):
            try:
                fails()
            except ValueError as error:
                error_message(sim, error)
                logging.getLogger("uvicorn.error").exception("Exception in ASGI application")
    finally:
        logging.getLogger().removeHandler(handler)
    said = out.getvalue()
    assert re.findall(r"^(?:ValueError: |toy in .*ValueError\(')(.)", said, re.M) == ["a", "a", "b", "b"]


def test_compose_passes_every_setting_on() -> None:
    compose = yaml.safe_load((ROOT / "compose.yaml").read_text("utf-8"))
    settings = {f"SIM3_{name.upper()}" for name in Settings.model_fields} - {"SIM3_FORWARDED_ALLOW_IPS"}
    own = {"SIM3_HOST", "SIM3_PORT", "SIM3_DRAIN_SECONDS"}  # the image's, the host's and the balancer's
    assert {*compose["x-settings"]} == settings - own | {"FORWARDED_ALLOW_IPS"}


def manifests() -> list[dict[str, Any]]:
    return [*yaml.safe_load_all((ROOT / "deploy" / "kubernetes" / "sim3.yaml").read_text())]


@pytest.mark.parametrize("manifest", manifests(), ids=lambda each: f"{each['kind']} {each['metadata']['name']}")
def test_manifests_are_what_kubernetes_takes(manifest: dict[str, Any]) -> None:
    kubernetes_validate.validate(manifest, KUBERNETES, strict=True)


def test_manifests_ask_for_what_there_is() -> None:
    deployment, *others = manifests()
    (container,) = deployment["spec"]["template"]["spec"]["containers"]
    settings = {f"SIM3_{name.upper()}" for name in Settings.model_fields} | {"FORWARDED_ALLOW_IPS"}
    assert {each["name"] for each in container["env"]} <= settings
    seconds = next(float(each["value"]) for each in container["env"] if each["name"] == "SIM3_DRAIN_SECONDS")
    assert seconds < deployment["spec"]["template"]["spec"]["terminationGracePeriodSeconds"] - 10
    with Local() as local:
        for probe in ("readinessProbe", "livenessProbe"):
            assert local.http.get(container[probe]["httpGet"]["path"]).status_code == 200
        (scaled,) = (each for each in others if each["kind"] == "HorizontalPodAutoscaler")
        (metric,) = scaled["spec"]["metrics"]
        assert metric["pods"]["metric"]["name"] in {name for name, _ in measured(local)}
