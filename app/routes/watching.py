"""For those who watch a server: is it alive, does it take new rooms, how is it."""

from __future__ import annotations

import asyncio
import threading
from typing import Any

from fastapi import APIRouter
from fastapi.responses import JSONResponse, Response
from prometheus_client import CONTENT_TYPE_PLAIN_0_0_4

from app import metrics
from app.routes.services import Given, Services
from app.security import NEVER_KEPT
from sims import SIMS

router = APIRouter(include_in_schema=False)


@router.api_route("/healthz", methods=["GET", "HEAD"])
async def healthz(given: Given) -> dict[str, Any]:
    return {"status": "ok", "sims": len(SIMS), "sessions": len(given.sessions)}


@router.api_route("/readyz", methods=["GET", "HEAD"])
async def readyz(given: Given) -> Response:
    """503 while it ends, and takes no new rooms."""
    ready = not given.sessions.draining
    said = {"status": "ready" if ready else "draining"}
    return JSONResponse(said, 200 if ready else 503, NEVER_KEPT)


@router.api_route("/metrics", methods=["GET", "HEAD"])
async def measured(given: Given) -> Response:
    found = metrics.text(metrics.Now(lambda: _by_sim(given), lambda: _single(given), lambda: given.bridge.refusals))
    return Response(found, headers={**NEVER_KEPT, "content-type": CONTENT_TYPE_PLAIN_0_0_4})


def _by_sim(given: Services) -> dict[str, tuple[int, int]]:
    """Sessions and viewers of each sim, also where there are none."""
    running = given.sessions.by_sim()
    each = {sim.slug: running.get(sim.slug, []) for sim in SIMS}
    return {slug: (len(found), sum(len(s.drawing.viewers) for s in found)) for slug, found in each.items()}


def _single(given: Services) -> dict[str, tuple[str, float]]:
    return {
        "sim3_pages": ("Pages that are open", len(given.bridge.visits)),
        "sim3_classes": ("Classes that are open", len(given.classes)),
        "sim3_session_limit": ("Sessions that may be open at once", given.sessions.limit),
        "sim3_uploaded_bytes": ("Bytes of learners' files that sessions keep", given.sessions.uploaded_bytes()),
        "sim3_solved_bytes": ("Bytes of solutions that take long", given.sessions.solved_bytes()),
        "sim3_tasks": ("Tasks of the event loop", len(asyncio.all_tasks())),
        "sim3_threads": ("Threads", threading.active_count()),
        "sim3_draining": ("1 while the server ends", float(given.sessions.draining)),
    }
