"""The decoder and the scene model that other tests rely on."""

from __future__ import annotations

import math
from typing import Any

import msgspec
import numpy as np
import pytest
import zstandard

from tests.frames import SceneModel, decode_frame, decode_message, differences, encode_frame, encode_message

QUARTER = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
"""90° about z."""


def node(name: str, owner: str = "1", *, virtual: bool = False, **props: Any) -> dict[str, Any]:
    return {"type": "FrameMessage", "name": name, "owner": owner, "virtual": virtual, "props": props}


def tell(kind: str, name: str, owner: str = "1", **values: Any) -> dict[str, Any]:
    return {"type": kind, "name": name, "owner": owner, **values}


def model_of(*messages: dict[str, Any]) -> SceneModel:
    model = SceneModel()
    model.feed(encode_frame(messages))
    return model


# ---- frames


def test_messages_come_back_as_they_went() -> None:
    messages = [node("/a", size=1.5), {"type": "Other", "text": "ψ", "list": [1, None, True]}]
    assert decode_frame(encode_frame(messages)) == messages
    assert decode_message(encode_message(messages[0])) == messages[0]


def with_buffers(*arrays: np.ndarray[Any, Any]) -> bytes:
    """A frame with arrays, put together by the description in viser's WebsocketClientWorker.ts."""
    places = [{"__binary_index": k, "dtype": a.dtype.str} for k, a in enumerate(arrays)]
    content = {"messages": [{"type": "T", "props": places}], "binaryBufferLengths": [a.nbytes for a in arrays]}
    inner = msgspec.msgpack.encode(content)
    packed = zstandard.ZstdCompressor().compress(inner)
    frame = len(inner).to_bytes(8, "little") + len(packed).to_bytes(8, "little") + packed
    for array in arrays:
        frame += b"\0" * (-len(frame) % 8) + array.tobytes()
    return frame


def test_arrays_are_found_behind_their_padding() -> None:
    arrays: list[np.ndarray[Any, Any]] = [
        np.arange(5, dtype=np.uint8),
        np.linspace(0, 1, 7, dtype=np.float32),
        np.empty(0, dtype=np.float64),
        np.array([-1, 2], dtype=np.int32),
        np.array([0.5, 2.0], dtype=np.float16),
    ]
    (message,) = decode_frame(with_buffers(*arrays))
    for sent, came in zip(arrays, message["props"], strict=True):
        assert came.dtype == sent.dtype
        np.testing.assert_array_equal(came, sent)


def test_a_frame_that_is_cut_off_is_no_frame() -> None:
    frame = with_buffers(np.arange(100.0))
    with pytest.raises(ValueError, match="names a buffer"):
        decode_frame(frame[:-8])
    with pytest.raises(zstandard.ZstdError):
        decode_frame(frame[:24])


# ---- the scene


def test_poses_follow_the_parents() -> None:
    model = model_of(
        node("/a"),
        node("/a/b"),
        tell("SetOrientationMessage", "/a", wxyz=QUARTER),
        tell("SetPositionMessage", "/a", position=(1.0, 0.0, 0.0)),
        tell("SetPositionMessage", "/a/b", position=(2.0, 0.0, 0.0)),
    )
    np.testing.assert_allclose(model.world_pose("/a/b")[:3, 3], (1.0, 2.0, 0.0), atol=1e-15)
    np.testing.assert_allclose(model.world_pose("/a/b")[:3, 0], (0.0, 1.0, 0.0), atol=1e-15)
    assert not model.strays


def test_a_node_is_hidden_with_its_parents() -> None:
    model = model_of(node("/a"), node("/a/b"), tell("SetSceneNodeVisibilityMessage", "/a", visible=False))
    assert not model.visible("/a/b")
    assert model.node("/a/b").visible


def test_removing_takes_the_children_along_and_nothing_else() -> None:
    model = model_of(node("/a"), node("/a/b"), node("/ab"), tell("RemoveSceneNodeMessage", "/a"))
    assert model.names == ["/ab"]


def test_a_node_made_again_keeps_pose_and_visibility_as_in_the_client() -> None:
    model = model_of(
        node("/a"),
        tell("SetPositionMessage", "/a", position=(1.0, 2.0, 3.0)),
        tell("SetSceneNodeVisibilityMessage", "/a", visible=False),
        node("/a", size=2),
    )
    assert model.node("/a").props == {"size": 2}
    np.testing.assert_array_equal(model.world_pose("/a")[:3, 3], (1.0, 2.0, 3.0))
    assert not model.visible("/a")


def test_of_two_scopes_the_clients_own_is_shown_and_a_real_node_before_an_anchor() -> None:
    model = model_of(node("/a", "", size=1), node("/a", "1", size=2))
    assert model.node("/a").props == {"size": 2}
    model.apply(tell("RemoveSceneNodeMessage", "/a"))
    assert model.node("/a").props == {"size": 1}
    model.apply(node("/a", "1", virtual=True))
    assert model.node("/a").props == {"size": 1}


def test_points_are_placed_scaled_and_shaped() -> None:
    lines = {**node("/a", points=np.arange(12.0, dtype=np.float32), scale=2.0), "type": "LineSegmentsMessage"}
    model = SceneModel()
    model.apply(lines)
    model.apply(tell("SetPositionMessage", "/a", position=(0.0, 0.0, 1.0)))
    wanted = 2.0 * np.arange(12.0).reshape(2, 2, 3) + (0.0, 0.0, 1.0)
    np.testing.assert_array_equal(model.points("/a"), wanted)
    model.apply(tell("SceneNodeUpdateMessage", "/a", updates={"points": np.zeros(6, np.float32)}))
    assert model.points("/a").shape == (1, 2, 3)


def test_updates_of_what_is_not_there_are_noticed() -> None:
    model = model_of(tell("SetPositionMessage", "/a", position=(0.0, 0.0, 0.0)))
    assert model.strays == ["SetPositionMessage for /a"]
    with pytest.raises(KeyError, match="no node '/a'"):
        model.node("/a")


# ---- comparing


def test_snapshots_differ_where_something_else_is_seen() -> None:
    one = model_of(node("/a", size=1), node("/b"), tell("SetSceneNodeVisibilityMessage", "/b", visible=False))
    other = model_of(node("/a", "7", size=1), node("/c", "7"))
    assert differences(one.snapshot(), other.snapshot()) == ["scene /c: only in the second"]
    other = model_of(node("/a", size=2))
    assert differences(one.snapshot(), other.snapshot()) == ["scene /a: props: size: differ by 1: 1 and 2"]
    assert not differences(one.snapshot(), other.snapshot(), within=1.0)


@pytest.mark.parametrize(
    ("a", "b", "same"),
    [
        ([1.0, 2.0], [1.0, 2.0 + 1e-13], True),
        ([1.0, 2.0], [1.0, 2.1], False),
        ([1.0, 2.0], [1.0], False),
        (np.array([np.nan]), np.array([1.0]), False),
        ("x", "y", False),
        (True, 1, True),
        (None, 0.0, False),
        ([], [], True),
    ],
)
def test_differences(a: Any, b: Any, same: bool) -> None:
    assert (not differences({"k": a}, {"k": b}, within=1e-12)) is same
