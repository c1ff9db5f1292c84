"""Known arms, with what their makers or the literature publish of them."""

from __future__ import annotations

from dataclasses import dataclass

from sims.transform_chain.params import ChainParams

Numbers = tuple[float, ...]


@dataclass(frozen=True)
class Preset:
    """An arm, in a posture of no meaning of its own."""

    name: str
    label: str
    axes: str
    lengths: Numbers
    angles: Numbers
    says: str
    twists: Numbers = ()
    offsets: Numbers = ()
    joints: str = ""
    stroke: tuple[float, float] | None = None
    """How far its joint slides, in metres."""

    def is_that(self, p: ChainParams) -> bool:
        """Whether an arm is this one, in any posture."""
        same = (p.axes, p.lengths, p.twists, p.joints) == (self.axes, self.lengths, self.twists, self.joints)
        return same and not any(p.starts) and self._fixed(p.offsets) == self._fixed(self.offsets)

    def _fixed(self, offsets: Numbers) -> Numbers:
        return tuple(d for d, joint in zip(offsets, self.joints or "r" * len(offsets), strict=False) if joint == "r")


# Dimensions in metres, twists in degrees, by rows of Denavit and Hartenberg where all axes are z.
PRESETS = (
    Preset(
        "planar-2r", "Planar 2R arm", "zz", (1.0, 0.8), (30.0, 60.0),
        "Planar 2R arm: both joints turn about z, so the arm stays in the plane z = 0.",
    ),
    Preset(
        "planar-3r", "Planar 3R arm", "zzz", (1.0, 0.8, 0.5), (20.0, 50.0, 40.0),
        "Planar 3R arm: the third joint leaves the end effector a choice of direction at every place.",
    ),
    Preset(
        "scara", "SCARA arm", "zzzz", (0.425, 0.375, 0.0, 0.0), (-20.0, 70.0, 0.0, 0.0),
        "SCARA arm with the link lengths and the stroke (0 to 0.21 m) of an Adept Cobra s800: its third joint slides."
        " The height of its column is left out.",
        (0.0, 180.0, 0.0, 0.0), (0.0, 0.0, 0.12, 0.0), "rrpr", (0.0, 0.21),
    ),
    Preset(
        "six-axis", "Six-axis arm", "zyyxyx",
        (0.15, 0.7, 0.6, 0.0, 0.0, 0.065), (30.0, -60.0, 80.0, 0.0, 40.0, 0.0),
        "Six-axis arm with the link lengths of an ABB IRB 1600-6/1.45: shoulder 0.15, upper arm 0.7, forearm 0.6,"
        " flange 0.065 m; the last three axes meet. Left out: the height of its column, which isn’t along x.",
    ),
    Preset(
        "ur5", "UR5", "zzzzzz", (0.0, -0.425, -0.39225, 0.0, 0.0, 0.0), (180.0, -60.0, 80.0, -20.0, 50.0, 0.0),
        "UR5 with the Denavit–Hartenberg parameters that Universal Robots publishes. At the angles 180°, −45°, 0°, 90°,"
        " 0°, 0° its end effector is at (0.51096, 0.19145, 0.60011) m, as in textbooks.",
        (90.0, 0.0, 0.0, 90.0, -90.0, 0.0), (0.089159, 0.0, 0.0, 0.10915, 0.09465, 0.0823),
    ),
    Preset(
        "puma-560", "PUMA 560", "zzzzzz", (0.0, 0.4318, 0.0203, 0.0, 0.0, 0.0), (30.0, 45.0, -160.0, 0.0, 45.0, 0.0),
        "PUMA 560 with the Denavit–Hartenberg parameters that Corke gives. The last three axes meet: turning about them"
        " moves nothing, as the wrist has no length. Left out: the height of its column.",
        (90.0, 0.0, -90.0, 90.0, -90.0, 0.0), (0.0, 0.0, 0.15005, 0.4318, 0.0, 0.0),
    ),
)  # fmt: skip


def known(p: ChainParams) -> Preset | None:
    """The preset that an arm is."""
    return next((preset for preset in PRESETS if preset.is_that(p)), None)
