"""What a viewer may say to viser: the only message types and fields that pass the bridge.

They are where it looks from, and drags and clicks in the scene. Everything else that viser's server would take
(opening its public tunnel, setting any attribute of a control, sending files) is refused here.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

Finite = Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]
Text = Annotated[str, msgspec.Meta(max_length=400)]
Vec2 = tuple[Finite, Finite]
Vec3 = tuple[Finite, Finite, Finite]
Vec4 = tuple[Finite, Finite, Finite, Finite]


class Incoming(msgspec.Struct, tag_field="type", forbid_unknown_fields=True, gc=False):
    """Base of the messages that pass."""

    @property
    def value_of(self) -> str | None:
        """What a newer message of the same kind replaces while it waits; None: never replaced."""
        return None

    @property
    def commands(self) -> bool:
        """Whether it changes the session, which somebody who only watches may not."""
        return True


class ViewerCameraMessage(Incoming, tag=True):
    wxyz: Vec4
    position: Vec3
    fov: Finite
    near: Finite
    far: Finite
    image_height: int
    image_width: int
    look_at: Vec3
    up_direction: Vec3

    @property
    def value_of(self) -> str | None:
        return "camera"

    @property
    def commands(self) -> bool:
        return False


class ScenePointerMessage(Incoming, tag=True):
    event_type: Literal["click"]
    ray_origin: Vec3
    ray_direction: Vec3
    screen_pos: tuple[Vec2]
    modifier: Text | None = None


class SceneNodeClickMessage(Incoming, tag=True):
    name: Text
    instance_index: int | None
    ray_origin: Vec3
    ray_direction: Vec3
    screen_pos: Vec2
    modifier: Text | None = None
    owner: Text = ""


class SceneNodeDragMessage(Incoming, tag=True):
    phase: Literal["start", "update", "end"]
    name: Text
    instance_index: int | None
    start_position: Vec3
    start_screen_pos: Vec2
    end_position: Vec3
    end_screen_pos: Vec2
    button: Literal["left", "middle", "right"]
    modifier: Text | None = None
    owner: Text = ""

    @property
    def value_of(self) -> str | None:
        return self.name if self.phase == "update" else None


decoder = msgspec.msgpack.Decoder(
    ViewerCameraMessage | ScenePointerMessage | SceneNodeClickMessage | SceneNodeDragMessage
)
