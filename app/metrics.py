"""What is counted and timed, for Prometheus. No name of a room, key or address is a label."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from prometheus_client import CollectorRegistry, Counter, Histogram, generate_latest
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.gc_collector import GCCollector
from prometheus_client.platform_collector import PlatformCollector
from prometheus_client.process_collector import ProcessCollector
from prometheus_client.registry import Collector

REGISTRY = CollectorRegistry()
"""What holds for this process."""
ProcessCollector(registry=REGISTRY)
PlatformCollector(registry=REGISTRY)
GCCollector(registry=REGISTRY)
LATENCY = Histogram(
    "sim3_update_seconds", "From a change of a session's state until it is drawn and told; their count is the updates",
    ["sim"], registry=REGISTRY, buckets=(0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30),
)  # fmt: skip
SOLVING = Histogram(
    "sim3_solve_seconds", "Time that solving a state takes, with the wait for its turn", ["sim"], registry=REGISTRY,
    buckets=(0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30),
)  # fmt: skip
COALESCED = Counter(
    "sim3_coalesced", "Changes that were drawn together with a later one", ["sim"], registry=REGISTRY
)  # fmt: skip
FAILURES = Counter(
    "sim3_failures",
    "Solves, drawings and checks of challenges that raised what nobody has foreseen",
    ["sim", "what"],
    registry=REGISTRY,
)  # fmt: skip
UPLOADS = Counter("sim3_uploads", "Files of learners that were taken", registry=REGISTRY)


class Now(Collector):
    """What a server has at the moment: gauges by sim and single ones, and what it has refused, by reason."""

    def __init__(
        self, by_sim: Callable[[], dict[str, tuple[int, int]]], single: Callable[[], dict[str, tuple[str, float]]],
        refused: Callable[[], dict[str, int]],
    ) -> None:  # fmt: skip
        self._by_sim = by_sim
        self._single = single
        self._refused = refused

    def collect(self) -> Iterator[Metric]:
        """What there is just now."""
        sessions = GaugeMetricFamily("sim3_sessions", "Sessions that are open", labels=["sim"])
        viewers = GaugeMetricFamily("sim3_viewers", "Scenes that are looked at", labels=["sim"])
        for sim, (open_, seen) in self._by_sim().items():
            sessions.add_metric([sim], open_)
            viewers.add_metric([sim], seen)
        refused = CounterMetricFamily(
            "sim3_refused", "Messages, websockets and rooms that were refused", labels=["reason"]
        )
        for reason, count in self._refused().items():
            refused.add_metric([reason], count)
        yield from (sessions, viewers, refused)
        for name, (words, value) in self._single().items():
            yield GaugeMetricFamily(name, words, value=value)


def text(now: Now) -> bytes:
    """All of it in Prometheus' text format."""
    registry = CollectorRegistry()
    registry.register(now)
    return bytes(generate_latest(REGISTRY)) + bytes(generate_latest(registry))
