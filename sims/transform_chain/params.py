"""Parameters of the sim."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import model_validator

from sims.kit.fields import Choice, Letters, Numbers, OptionalNumber, Vector
from sims.kit.params import Params
from sims.kit.refusals import refusal

Place = tuple[float, float, float]
MOST = 8
LISTS = ("angles", "lengths", "axes")
FAR, FARTHEST = (-20.0, -20.0, -20.0), (20.0, 20.0, 20.0)


POINT = "A point on the end effector"
"""Title of a fold."""


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
    point: Annotated[Place, Vector(-1, 1, step=0.01, unit="m", title="Point p", group=POINT)] = (0.1, 0.2, 0.0)
    """Coordinates in the end effector's frame of the point that is taken through the chain"""
    target: Annotated[Place | None, Vector(FAR, FARTHEST, step=0.01, unit="m", title="Target", hidden=True)] = None
    """A place to reach with the end effector; absent is none"""
    pull: Annotated[Place | None, Vector(FAR, FARTHEST, step=0.01, unit="m", title="Pull", hidden=True)] = None
    """Where the end effector was last dragged to, if the arm doesn't get there; absent otherwise"""

    @property
    def count(self) -> int:
        """Number of joints."""
        return len(self.axes)

    def bounds(self, name: str) -> tuple[float, float]:
        if name == "swap":
            return 1, self.count - 1
        return (1, self.count) if name == "trace" else super().bounds(name)

    def moved(self, changes: Mapping[str, Any]) -> Self:
        """A joint that is moved leaves its trace; where the hand pulled before says nothing then."""
        turned = [int(k) + 1 for field, _, k in (name.partition(".") for name in changes) if field == "angles" and k]
        follows = {"trace": turned[0]} if turned and "trace" not in changes else {}
        arm = {name.partition(".")[0] for name in changes} & {*LISTS}
        return super().moved({**({"pull": None} if arm else {}), **follows, **changes})

    @model_validator(mode="after")
    def _as_many_of_each(self) -> Self:
        if len({len(getattr(self, name)) for name in LISTS}) > 1:
            got = ", ".join(f"{len(getattr(self, name))} {name}" for name in LISTS)
            words = f"as many angles and lengths as letters in axes, one of each for every joint; got {got}"
            raise refusal([name for name in LISTS if name in self.model_fields_set], words)
        return self
