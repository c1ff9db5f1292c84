"""What a control stands for is highlighted in the scene with it, and looks as before afterwards."""

from __future__ import annotations

import pytest

from sims import SIMS, by_slug
from tests.frames import differences
from tests.server import Rig

LINKED = [
    ("coordinate-frames", "convention", "/axes/x"), ("coordinate-frames", "point", "/axes/box/x"),
    ("euler-angles", "yaw", "/arc0/line"), ("gimbal-lock", "pitch", "/outer/axis"),
    ("quaternion", "axis", "/axis/arrow"), ("quaternion", "angle", "/axis/turn/arc"),
    ("transform-chain", "show", "/link1/arrow"), ("transform-chain", "angles.0", "/link1/frame"),
    ("camera", "fx", "/camera/frustum"), ("camera", "tilt", "/camera/axis"), ("epipolar", "point", "/rays"),
    ("epipolar", "left_pan", "/left/frustum"), ("triangulation", "baseline", "/baseline"),
    ("triangulation", "focal", "/left/frustum"), ("point-cloud", "show_box", "/box/edges"),
    ("point-cloud", "deviations", "/marked/points"), ("point-cloud", "neighbors", "/cloud/normals"),
]  # fmt: skip


@pytest.mark.parametrize(("slug", "name", "node"), LINKED)
def test_what_a_control_moves_stands_out_while_it_is_pointed_at(slug: str, name: str, node: str) -> None:
    sim = by_slug(slug)
    assert sim is not None
    assert not sim.params.kinds[name.partition(".")[0]].hidden
    with Rig(sim) as rig:
        before, thick = rig.model.snapshot(), ("thickness", "shaft_radius", "point_size")

        def width() -> float:
            return float(next(rig.model.node(node).props[key] for key in thick if key in rig.model.node(node).props))

        plain = width()
        rig.host.call(lambda: rig.session.hover(name))
        rig.settle()
        assert width() == pytest.approx(2.0 * plain)
        rig.show(sim.params().changed(next(iter(sim.states.values()))))
        rig.show(sim.params())
        assert width() == pytest.approx(2.0 * plain), "it stays while the state changes"
        rig.host.call(lambda: rig.session.hover(""))
        rig.settle()
        assert not differences(before, rig.model.snapshot())


def test_every_sim_has_something_to_show() -> None:
    assert {slug for slug, *_ in LINKED} == {sim.slug for sim in SIMS}
