"""The load generator, a process of its own: many learners at one server. `python -m benchmarks.load < JOB`."""

from __future__ import annotations

import asyncio
import json
import os
import resource
import sys
import time
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import uvloop

from benchmarks.cloud import Cloud
from benchmarks.learner import FIRST, Learner
from benchmarks.process import cpu_seconds, resident

RATE = 20.0
"""Values a second, which is as often as viser's page sends them."""
WARM_UP = 10
LAST_WITHIN = 2.0
Job = dict[str, Any]
Result = dict[str, float]


async def drag(job: Job) -> Result:
    """All learners drag at once for some seconds."""
    learners = await _warmed_up(job)
    result = await _dragged(job, learners, FIRST + WARM_UP)
    await _close(learners)
    return result


async def beside(job: Job) -> Result:
    """All learners drag, first undisturbed and then while one more has a point cloud registered again and again."""
    learners = await _warmed_up(job)
    cloud = Cloud(job["host"], job["cloud"], job["camera"])
    await cloud.open()
    first = await cloud.register()
    quiet = await _dragged(job, learners, FIRST + WARM_UP)
    registering = asyncio.create_task(cloud.keep_registering())
    busy = await _dragged(job, learners, FIRST + WARM_UP + int(job["seconds"] * RATE))
    registering.cancel()
    await asyncio.gather(registering, return_exceptions=True)
    await cloud.close()
    await _close(learners)
    kept = {f"quiet_{name}": value for name, value in quiet.items()}
    took = float(np.median(cloud.took)) if cloud.took else float("nan")
    return {**busy, **kept, "registered": len(cloud.took), "seconds_each": took, "seconds_first": first}


async def _warmed_up(job: Job) -> list[Learner]:
    learners = [Learner(job["host"], path, job["camera"]) for path in job["paths"]]
    await _open(learners)
    await _drag_all(learners, range(FIRST, FIRST + WARM_UP))
    await _wait(lambda: all(learner.arrived for learner in learners), LAST_WITHIN)
    return learners


async def _dragged(job: Job, learners: list[Learner], start: int) -> Result:
    pid = job["pid"]
    memory, cpu, own, begin = resident(pid), cpu_seconds(pid), _own_cpu(), time.perf_counter()
    await _drag_all(learners, range(start, start + int(job["seconds"] * RATE)))
    took, cpu_dragging = time.perf_counter() - begin, cpu_seconds(pid) - cpu
    own_share, memory_after = (_own_cpu() - own) / took, resident(pid)
    await _wait(lambda: all(learner.arrived for learner in learners), LAST_WITHIN)
    now, cpu = time.perf_counter(), cpu_seconds(pid) - cpu
    sent = sum(len(x.sent) for x in learners)
    drawn = sum(len(x.delays) for x in learners)
    unanswered = [now - at for x in learners for at in x.sent[len(x.ages) :]]
    return {
        "learners": len(learners), "sent": sent, "drawn": drawn, "unanswered": len(unanswered),
        "lost_last": sum(not x.arrived for x in learners), "backwards": sum(x.backwards for x in learners),
        "cpu_ms_per_update": 1e3 * cpu / sent, "cpu_ms_per_drawn": 1e3 * cpu / max(drawn, 1),
        "server_share": cpu_dragging / took, "load_share": own_share,
        "rss_before_mb": memory, "rss_after_mb": memory_after,
        **_percentiles("delay", [d for x in learners for d in x.delays]),
        **_percentiles("age", [*(a for x in learners for a in x.ages), *unanswered]),
        **_percentiles("late", [s for x in learners for s in x.late]),
    }  # fmt: skip


async def voxels(job: Job) -> Result:
    """One learner drags the voxel slider, once to warm up, and then for good."""
    cloud = Cloud(job["host"], job["cloud"], job["camera"], looks=True)
    await cloud.open()
    ages: list[float] = []
    for counts in job["counts"]:
        ages = await cloud.drag(dict(counts), RATE)
    await cloud.close()
    return {"clouds": len(ages), **_percentiles("age", ages)}


async def idle(job: Job) -> Result:
    """Memory of learners who only look; the first few, which also warm the server up, aren't counted."""
    learners = [Learner(job["host"], path, job["camera"]) for path in job["paths"]]
    first, rest = learners[: job["first"]], learners[job["first"] :]
    await _open(first)
    before = await _settled(job["pid"])
    await _open(rest)
    after = await _settled(job["pid"])
    cpu = cpu_seconds(job["pid"])
    await asyncio.sleep(2.0)
    share = (cpu_seconds(job["pid"]) - cpu) / 2.0
    await _close(learners)
    return {"sessions": len(rest), "mb_per_session": (after - before) / len(rest), "idle_share": share}


async def churn(job: Job) -> Result:
    """Open and close, a few at a time."""
    paths = iter(job["paths"])

    async def visitor() -> None:
        for path in paths:
            learner = Learner(job["host"], path, job["camera"])
            await learner.open()
            await learner.close()

    cpu = cpu_seconds(job["pid"])
    await asyncio.gather(*(visitor() for _ in range(5)))
    cpu = cpu_seconds(job["pid"]) - cpu
    return {"opened": len(job["paths"]), "cpu_ms_per_open": 1e3 * cpu / len(job["paths"])}


async def _drag_all(learners: list[Learner], values: range) -> None:
    begin = asyncio.get_running_loop().time() + 0.1
    phase = 1.0 / RATE / len(learners)
    await asyncio.gather(*(x.drag(values, RATE, begin + k * phase) for k, x in enumerate(learners)))


async def _wait(condition: Callable[[], bool], within: float) -> None:
    end = time.perf_counter() + within
    while not condition() and time.perf_counter() < end:
        await asyncio.sleep(0.01)


async def _open(learners: list[Learner], at_once: int = 10) -> None:
    waiting = iter(learners)

    async def opener() -> None:
        for learner in waiting:
            await learner.open()

    await asyncio.gather(*(opener() for _ in range(at_once)))
    await asyncio.sleep(0.5)


async def _close(learners: Iterable[Learner]) -> None:
    await asyncio.gather(*(learner.close() for learner in learners))


async def _settled(pid: int) -> float:
    await asyncio.sleep(1.0)
    return resident(pid)


def _own_cpu() -> float:
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def _percentiles(name: str, seconds: list[float]) -> Result:
    levels = (50, 95, 99)
    found = np.percentile(seconds, levels) if seconds else [float("nan")] * 3
    return {f"{name}_p{level}_ms": 1e3 * float(v) for level, v in zip(levels, found, strict=True)}


JOBS = {"drag": drag, "beside": beside, "voxels": voxels, "idle": idle, "churn": churn}


def main() -> None:
    job = json.load(sys.stdin)
    os.sched_setaffinity(0, {job["core"]})
    json.dump(uvloop.run(JOBS[job["kind"]](job)), sys.stdout)


if __name__ == "__main__":
    main()
