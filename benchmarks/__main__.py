"""Measure speed: `python -m benchmarks [--quick] [--json FILE]`. Linux, two cores.

Beside each number stands the one of the plain viser way of writing the same sim, from the same run on the same
machine: compare the ratios, since times depend on the machine and on what else runs there.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from benchmarks import cloud, clouds, felt, opening
from benchmarks.process import CORES, resident
from benchmarks.servers import Plain, Sim3
from geometry.clouds import voxels
from sims.point_cloud.datasets import dataset

WAYS: tuple[type[Sim3 | Plain], ...] = (Sim3, Plain)
SATURATED, LATE = 0.8, 5.0
"""Share of its core, and milliseconds, from which on the load generator may be what is slow."""
FORGOTTEN_AFTER = 62.0
"""Seconds after which the server forgets a session that nobody looks at."""
CLOUD = "room"
"""The dataset whose voxel slider is dragged."""
PARTS = "learners", "beside", "sessions", "opening", "felt", "clouds"
Rows = list[dict[str, Any]]


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer learners and seconds, less certain numbers")
    parser.add_argument("--only", choices=PARTS, help="one part")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all numbers there too")
    args = parser.parse_args()
    if len(CORES) < 2:
        raise SystemExit("The benchmark needs Linux and two cores: one for the server, one for the load.")
    parts = {
        "learners": learners, "beside": beside, "sessions": sessions, "opening": openings, "felt": felt_speed,
        "clouds": clouds.measure,
    }  # fmt: skip
    print(f"{len(CORES)} cores, load average {os.getloadavg()[0]:.1f} before the start")
    results = {name: part(args.quick) for name, part in parts.items() if args.only in (None, name)}
    if args.json:
        text = json.dumps(results, indent=1).replace("NaN", "null")  # percentiles of nothing
        args.json.write_text(text + "\n")


def learners(quick: bool) -> Rows:
    """Learners who drag a slider at 20 Hz."""
    print("Learners who each drag a slider at 20 Hz, in rooms of their own; the server has one core")
    print("Milliseconds, p50/p95/p99: until a value's own state came; from sending it until it or a later one came")
    table = Table(
        "N, way|drawn|   own state  |      age     |lost last|CPU ms/update|/drawn|server|load|MB before, after"
    )
    rows: Rows = []
    for count in (1, 30) if quick else (1, 10, 30, 120):
        pair: Rows = []
        for kind in WAYS:
            with kind() as server:
                pair.append({"way": server.way, **server.load("drag", count, seconds=2 if quick else 6)})
            table.add(learners_cells(pair[-1]))
        ours, plain = pair
        gains = [plain[key] / ours[key] for key in ("age_p95_ms", "cpu_ms_per_update", "cpu_ms_per_drawn")]
        table.say("    plain / sim3: age p95 ×{:.1f}, CPU per update ×{:.1f}, per drawn ×{:.1f}".format(*gains))
        rows += pair
    for row in rows:
        if row["load_share"] > SATURATED or row["late_p95_ms"] > LATE:
            table.say(
                f"    {row['learners']} {row['way']}: values left up to {row['late_p95_ms']:.0f} ms late (p95), "
                f"since the load generator used {row['load_share']:.0%} of its core or others needed it"
            )
    return rows


def learners_cells(row: dict[str, Any]) -> Iterator[str]:
    yield f"{row['learners']} {row['way']}"
    yield from seen_cells(row)
    yield f"{row['cpu_ms_per_update']:.2f}"
    yield f"{row['cpu_ms_per_drawn']:.2f}"
    yield from share_cells(row)
    yield f"{row['rss_before_mb']:.0f} {row['rss_after_mb']:.0f}"


def seen_cells(row: dict[str, Any]) -> Iterator[str]:
    """How much of what was dragged came, and when."""
    yield f"{row['drawn'] / row['sent']:.0%}"
    yield percentiles(row, "delay")
    yield percentiles(row, "age")
    yield f"{row['lost_last']}"


def share_cells(row: dict[str, Any]) -> Iterator[str]:
    """How much of their cores the server and the load generator used."""
    yield f"{row['server_share']:.0%}"
    yield f"{row['load_share']:.0%}"


def percentiles(row: dict[str, Any], name: str) -> str:
    return "/".join(f"{row[f'{name}_p{level}_ms']:.0f}" for level in (50, 95, 99))


def beside(quick: bool) -> Rows:
    """Learners who drag while another one has a point cloud registered."""
    print("\n30 learners who each drag a slider at 20 Hz, while one more has 200 thousand points registered")
    print("Milliseconds, p50/p95/p99, as above; seconds of a registration, the median")
    table = Table("way|drawn|   own state  |      age     |lost last|server|load|registered|seconds each")
    with Sim3() as server:
        row: dict[str, Any] = {"way": server.way}
        options = {"seconds": 2 if quick else 8, "cloud": server.page(cloud.SLUG)}
        row.update(server.load("beside", 30, **options))
        sizes = [[round(start + 0.005 * k, 3) for k in range(20 if quick else 60)] for start in (0.322, 0.02)]
        counts = [[(size, len(voxels(dataset(CLOUD).points, size).points)) for size in drag] for drag in sizes]
        row["voxels"] = server.load("voxels", 0, counts=counts, cloud=server.page(cloud.SLUG))
    quiet = {name.removeprefix("quiet_"): value for name, value in row.items() if name.startswith("quiet_")}
    table.add(["quiet", *seen_cells(quiet), *share_cells(quiet), "", ""])
    each = [f"{row['registered']}", f"{row['seconds_each']:.2f}"]
    table.add(["registering", *seen_cells(row), *share_cells(row), *each])
    points, ages = len(dataset(CLOUD)), percentiles(row["voxels"], "age")
    table.say(f"    a voxel slider at 20 Hz on {points} points: {ages} ms until a cloud or a later one came")
    return [row]


def sessions(quick: bool) -> Rows:
    """What sessions cost that nobody moves, and what they leave behind."""
    print("\nSessions that nobody moves, and many opens and closes")
    table = Table("way|MB/session|CPU of all|opens|CPU ms/open|MB after warm-up|after opens|sessions kept")
    idle, opens, warm_up = (20, 50, 20) if quick else (100, 1000, 100)
    rows: Rows = []
    for kind in WAYS:
        with kind() as server:
            row: dict[str, Any] = {"way": server.way, **server.load("idle", 20 + idle, first=20)}
            server.load("churn", warm_up)
            row["rss_warm_mb"] = resident(server.pid)
            row.update(server.load("churn", opens if isinstance(server, Sim3) else warm_up))
            if isinstance(server, Sim3):
                if not quick:
                    time.sleep(FORGOTTEN_AFTER)
                    server.load("churn", 1)
                row["kept"] = server.sessions()
            row["rss_opened_mb"] = resident(server.pid)
        rows.append(row)
        table.add(sessions_cells(row))
    return rows


def sessions_cells(row: dict[str, Any]) -> Iterator[str]:
    yield row["way"]
    yield f"{row['mb_per_session']:.2f}"
    yield f"{row['idle_share']:.1%}"
    yield f"{row['opened']}"
    yield f"{row['cpu_ms_per_open']:.1f}"
    yield f"{row['rss_warm_mb']:.0f}"
    yield f"{row['rss_opened_mb']:.0f}"
    yield f"{row.get('kept', '')}"


def openings(quick: bool) -> Rows:
    """How long opening takes."""
    print(
        "\nOpening the sim in a new headless Chromium, software rendering; seconds, median, until it is on the screen"
    )
    table = Table("way|still picture|controls live|each")
    rows: Rows = []
    for way, times in opening.measure(1 if quick else 5, warm_up=0 if quick else 1).items():
        rows.append({"way": way, **times})
        still = f"{statistics.median(times['still']):.2f}" if "still" in times else ""
        live = f"{statistics.median(times['live']):.2f}"
        table.add([way, still, live, " ".join(f"{seconds:.2f}" for seconds in times["live"])])
    return rows


def felt_speed(quick: bool) -> Rows:
    """From a hand to the numbers and the frame."""
    print("\nFrom an input in headless Chromium, software rendering, to what is seen; milliseconds, medians")
    table = Table("sim, way                |   numbers|     frame|main thread|  layouts|laying out")
    rows: Rows = []
    for way, took in felt.measure(3 if quick else 12):
        rows.append({"way": way, **took})
        times = [f"{took[name]:.0f}" for name in ("numbers", "frame", "main")]
        table.add([way, *times, f"{took['layouts']:.1f}", f"{took['laying_out']:.1f}"])
    return rows


class Table:
    """Columns under a head, printed row by row as the numbers come."""

    def __init__(self, head: str) -> None:
        self._widths = [max(len(title), 6) for title in head.split("|")]
        self._widths[0] = 16
        self.add(head.split("|"))

    def add(self, cells: Iterable[str]) -> None:
        first, *rest = cells
        columns = [cell.rjust(width) for cell, width in zip(rest, self._widths[1:], strict=False)]
        self.say("  ".join([first.ljust(self._widths[0]), *columns]))

    def say(self, line: str) -> None:
        print(line, flush=True)


if __name__ == "__main__":
    main()
