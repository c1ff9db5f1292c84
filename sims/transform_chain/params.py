"""Parameters of the sim."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Annotated, Any, Literal, Self

from pydantic import model_validator

from geometry.kinematics import Chain
from sims.kit.fields import Choice, Letters, Numbers, OptionalNumber, Vector
from sims.kit.params import Params
from sims.kit.refusals import refusal

Place = tuple[float, float, float]
MOST = 8
LISTS = ("angles", "lengths", "axes")
ROWS = ("twists", "offsets", "starts", "joints")
"""What each link may have besides: none, or one for each joint."""
FAR, FARTHEST = (-20.0, -20.0, -20.0), (20.0, 20.0, 20.0)


POINT, OWN = "A point on the end effector", "An arm of your own"
"""Titles of folds."""


class ChainParams(Params):
    """State of the sim."""

    angles: Annotated[
        tuple[float, ...],
        Numbers(-180, 180, step=0.5, unit="°", title="Joint angles", entry="Joint {} angle", most=MOST),
    ] = (30.0, 40.0, -30.0)
    """How far each joint turns about its axis, counter-clockwise as seen from the axis's tip"""
    lengths: Annotated[
        tuple[float, ...],
        Numbers(
            0, 2, step=0.01, unit="m", title="Link lengths", entry="Link {} length", most=MOST, group="Link lengths"
        ),
    ] = (1.0, 0.8, 0.5)
    """How far each link leads along the x axis of its frame; 0 is a turn alone"""
    axes: Annotated[
        str,
        Letters(
            title="Joint axes",
            labels={"x": "x: twist", "y": "y: up and down", "z": "z: sideways"},
            entry="Joint {} axis",
            most=MOST,
            group="Joint axes",
        ),
    ] = "zyy"
    """The axis of the frame before a joint that the joint turns about"""
    offsets: Annotated[
        tuple[float, ...],
        Numbers(-2, 2, step=0.01, unit="m", title="Joint offsets", entry="Joint {} slide", most=MOST, least=0),
    ] = ()
    """How far each link leads along its joint’s axis, the d of Denavit and Hartenberg; a sliding joint changes it"""
    show: Annotated[
        Literal["individual", "composed"],
        Choice(
            title="Transforms",
            labels={"individual": "Individual: frame to frame", "composed": "Composed: from the world"},
        ),
    ] = "individual"
    """Arrows and matrices: from each frame to the next, or from the world to each frame"""
    swap: Annotated[
        int | None, OptionalNumber(1, MOST - 1, title="Swap transforms", words="{0} ↔ {1}", group="The arm")
    ] = None
    """Compare with the arm whose two neighbouring transforms are multiplied in the other order"""
    trace: Annotated[
        int | None, OptionalNumber(1, MOST, title="Trace of joint", words="Joint {0}", group="The arm")
    ] = None
    """The circle that the end effector describes as this joint turns; follows the joint that you move"""
    stage: Annotated[
        int | None, OptionalNumber(1, MOST, title="One transform alone", words="Link {0}", off="All", group="The arm")
    ] = None
    """Show only the transform of this link, and the product up to it"""
    point: Annotated[Place, Vector(-1, 1, step=0.01, unit="m", title="Point p", group=POINT)] = (0.1, 0.2, 0.0)
    """Coordinates in the end effector's frame of the point that is taken through the chain"""
    twists: Annotated[
        tuple[float, ...],
        Numbers(-180, 180, step=0.5, unit="°", title="Link twists", most=MOST, least=0, hidden=True),
    ] = ()
    """How far each link turns about its x axis at its end, the α of Denavit and Hartenberg"""
    starts: Annotated[
        tuple[float, ...],
        Numbers(-360, 360, step=0.5, unit="°", title="Angle offsets", most=MOST, least=0, hidden=True),
    ] = ()
    """What is added to each joint angle: the θ of Denavit and Hartenberg where the joint’s own angle is 0"""
    joints: Annotated[
        str,
        Letters(
            title="Kinds of joints", labels={"r": "r: turns", "p": "p: slides", "f": "f: fixed"},
            entry="Joint {} kind", most=MOST, fewest=0, hidden=True,
        ),
    ] = ""  # fmt: skip
    """Which joints turn (revolute), slide along their axis (prismatic) or are fixed; all turn where it is absent"""
    target: Annotated[Place | None, Vector(FAR, FARTHEST, step=0.01, unit="m", title="Target", hidden=True)] = None
    """A place to reach with the end effector; absent is none"""
    pull: Annotated[Place | None, Vector(FAR, FARTHEST, step=0.01, unit="m", title="Pull", hidden=True)] = None
    """Where the end effector was last dragged to, if the arm doesn't get there; absent otherwise"""

    @property
    def count(self) -> int:
        """Number of joints."""
        return len(self.axes)

    @property
    def rows(self) -> bool:
        """Whether links have more than an axis, an angle and a length."""
        return any(getattr(self, name) for name in ROWS)

    @property
    def arm(self) -> Chain:
        """The arm, whatever its posture."""
        starts = self.starts
        if self.joints:  # what doesn't turn has its angle for good
            fixed = (0.0 if self.kind(k) == "r" else angle for k, angle in enumerate(self.angles))
            starts = tuple(map(sum, zip(starts or (0.0,) * self.count, fixed, strict=True)))
        return _arm(self.axes, self.lengths, self.twists, self.offsets, starts, self.joints)

    @property
    def moves(self) -> list[float]:
        """How far each joint of the arm has moved: radians, or metres where it slides."""
        turned = [math.radians(angle) for angle in self.angles]
        return (
            [self.offset(k) if self.kind(k) == "p" else turn for k, turn in enumerate(turned)]
            if self.joints
            else turned
        )

    @property
    def plane(self) -> str | None:
        """The axis that all joints turn about, where the arm stays in a plane."""
        flat = len({*self.axes}) == 1 and not any(self.twists) and not {*self.joints} - {"r"}
        return self.axes[0] if flat else None

    def kind(self, k: int) -> str:
        """What the k-th joint, from 0, does: r, p or f."""
        return self.joints[k] if self.joints else "r"

    def slides(self, k: int) -> bool:
        """Whether the k-th joint, from 0, slides."""
        return self.kind(k) == "p"

    def offset(self, k: int) -> float:
        """How far the k-th link leads along its joint's axis."""
        return self.offsets[k] if self.offsets else 0.0

    def form(self) -> tuple[Any, ...]:
        return self.count, self.joints, self.rows

    def bounds(self, name: str) -> tuple[float, float]:
        if name == "lengths":
            return (-2.0 if self.rows else 0.0), 2.0
        if name == "swap":
            return 1, self.count - 1
        return (1, self.count) if name in ("trace", "stage") else super().bounds(name)

    def moved(self, changes: Mapping[str, Any]) -> Self:
        """A joint that is moved leaves its trace; where the hand pulled before says nothing then."""
        turned = [int(k) + 1 for field, _, k in (name.partition(".") for name in changes) if field == "angles" and k]
        follows = {"trace": turned[0]} if turned and "trace" not in changes else {}
        arm = {name.partition(".")[0] for name in changes} & {*LISTS, *ROWS}
        return super().moved({**({"pull": None} if arm else {}), **follows, **changes})

    @model_validator(mode="after")
    def _as_many_of_each(self) -> Self:
        if len({len(getattr(self, name)) for name in LISTS}) > 1:
            got = ", ".join(f"{len(getattr(self, name))} {name}" for name in LISTS)
            words = f"as many angles and lengths as letters in axes, one of each for every joint; got {got}"
            raise refusal([name for name in LISTS if name in self.model_fields_set], words)
        for name in ROWS:
            if (size := len(getattr(self, name))) not in (0, self.count):
                raise refusal([name], f"no {name}, or as many as letters in axes, {self.count}; got {size}")
        return self


@lru_cache(maxsize=256)
def _arm(
    axes: str, lengths: tuple[float, ...], twists: tuple[float, ...], offsets: tuple[float, ...],
    starts: tuple[float, ...], joints: str,
) -> Chain:  # fmt: skip
    """The arm of a state, in metres and radians; what slides does so from an offset of zero."""
    fixed = tuple(0.0 if joint == "p" else d for d, joint in zip(offsets, joints or "r" * len(axes), strict=False))
    twists, starts = (tuple(map(math.radians, degrees)) for degrees in (twists, starts))
    return Chain(axes, lengths, twists, fixed, starts, joints)
