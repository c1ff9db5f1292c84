"""Reading clouds: the same cloud from every format, and a clear word for every file that is broken or lies."""

from __future__ import annotations

import contextlib
import io
import math
import re
import struct
import tracemalloc
from collections.abc import Callable

import laspy
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pypcd4.pypcd4 import Encoding, PointCloud

from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files import FORMATS, CloudFileError, ply_bytes, read

LARGEST = 1_000_000
POINTS = np.round(np.random.default_rng(0).uniform(-5.0, 5.0, (60, 3)), 3)
COLORS = np.random.default_rng(1).integers(0, 256, (60, 3)).astype(np.uint8)
INTENSITY = np.round(np.random.default_rng(2).random(60), 3)
CLOUD = Cloud("cloud", POINTS, COLORS, INTENSITY)


def ascii_ply(points: np.ndarray = POINTS, claimed: int | None = None) -> bytes:
    head = f"ply\nformat ascii 1.0\ncomment of mine\nelement vertex {len(points) if claimed is None else claimed}\n"
    head += "property float x\nproperty float y\nproperty float z\n"
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    rows = "\n".join(" ".join(f"{value}" for value in row) for row in points)
    return f"{head}{rows}\n3 0 1 2\n".encode()


def big_endian_ply() -> bytes:
    head = b"ply\nformat binary_big_endian 1.0\nelement camera 2\nproperty short a\nelement vertex 60\n"
    head += b"property double x\nproperty double y\nproperty double z\nend_header\n"
    return head + b"\0\1\0\2" + POINTS.astype(">f8").tobytes()


def pcd(encoding: Encoding) -> bytes:
    bits = COLORS.astype(np.uint32) @ np.array([65536, 256, 1], np.uint32)
    cloud = PointCloud.from_points(
        [*POINTS.T.astype(np.float32), bits.astype(np.uint32).view(np.float32), INTENSITY.astype(np.float32)],
        ("x", "y", "z", "rgb", "intensity"),
        (np.float32,) * 5,
    )
    file = io.BytesIO()
    cloud.save(file, Encoding.BINARY if encoding == Encoding.BINARY_COMPRESSED else encoding)
    return file.getvalue() if encoding != Encoding.BINARY_COMPRESSED else packed(file.getvalue(), cloud)


def packed(plain: bytes, cloud: PointCloud) -> bytes:
    """Compressed by columns, in runs of literal bytes: random numbers don't get smaller, and pypcd4 then gives up."""
    columns = b"".join(cloud.pc_data[name].tobytes() for name in cloud.fields)
    runs = [columns[start : start + 32] for start in range(0, len(columns), 32)]
    body = b"".join(bytes([len(run) - 1]) + run for run in runs)
    head = plain[: plain.index(b"DATA")] + b"DATA binary_compressed\n"
    return head + struct.pack("<II", len(body), len(columns)) + body


def las(compressed: bool, version: str = "1.4", form: int = 7) -> bytes:
    header = laspy.LasHeader(version=version, point_format=form)
    header.scales, header.offsets = np.full(3, 0.001), np.zeros(3)
    points = laspy.LasData(header)
    points.x, points.y, points.z = POINTS.T
    points.intensity = np.round(INTENSITY * 65535.0).astype(np.uint16)
    points.red, points.green, points.blue = COLORS.T.astype(np.uint16) * 257
    file = io.BytesIO()
    points.write(file, do_compress=compressed)
    return file.getvalue()


def table(separator: str, head: str = "", *columns: np.ndarray) -> bytes:
    rows = np.column_stack([POINTS, *columns])
    return (head + "\n".join(separator.join(f"{value:g}" for value in row) for row in rows) + "\n").encode()


FILES: dict[str, tuple[str, Callable[[], bytes], bool, bool]] = {
    "PLY, binary": ("a.ply", lambda: ply_bytes(CLOUD), True, True),
    "PLY, text": ("a.PLY", ascii_ply, False, False),
    "PLY, big-endian, points second": ("a.ply", big_endian_ply, False, False),
    "XYZ": ("a.xyz", lambda: table(" "), False, False),
    "XYZ with colours": ("a.xyz", lambda: table(" ", "", COLORS), True, False),
    "XYZ with intensity": ("a.txt", lambda: table("\t", "# a comment\n", INTENSITY), False, True),
    "CSV": ("a.csv", lambda: table(",", "X,Y,Z,Intensity,R,G,B\n", INTENSITY, COLORS), True, True),
    "CSV with semicolons": ("a.csv", lambda: table(";", '"x";"y";"z";"i"\r\n', INTENSITY), False, True),
    "PCD, text": ("a.pcd", lambda: pcd(Encoding.ASCII), False, True),
    "PCD, binary": ("a.pcd", lambda: pcd(Encoding.BINARY), True, True),
    "PCD, compressed": ("a.pcd", lambda: pcd(Encoding.BINARY_COMPRESSED), True, True),
    "LAS": ("a.las", lambda: las(False), True, True),
    "LAS 1.2": ("a.las", lambda: las(False, "1.2", 3), True, True),
    "LAZ": ("a.laz", lambda: las(True), True, True),
}
files = pytest.mark.parametrize("kind", FILES)


@files
def test_every_format_gives_the_same_cloud(kind: str) -> None:
    name, make, has_colors, has_intensity = FILES[kind]
    cloud = read(name, make(), LARGEST)
    np.testing.assert_allclose(cloud.points, POINTS, rtol=0, atol=2e-6)
    assert cloud.dropped == 0
    if has_colors:
        np.testing.assert_array_equal(cloud.colors, COLORS)
    if has_intensity:
        assert cloud.intensity is not None
        expected = INTENSITY / INTENSITY.max() if "LA" in kind else INTENSITY
        np.testing.assert_allclose(cloud.intensity, expected, rtol=0, atol=1e-4)


@files
def test_cut_off_anywhere_it_is_refused_or_read_as_far_as_its_lines_go(kind: str) -> None:
    name, make, _, _ = FILES[kind]
    data = make()
    for end in [*range(0, len(data) - 12, max(1, len(data) // 60)), len(data) // 2]:
        try:
            cloud = read(name, data[:end], LARGEST)
        except CloudFileError:
            continue
        assert name.endswith(("xyz", "csv", "txt")) or len(cloud) == 60


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(sorted(FORMATS)), st.binary(max_size=600))
def test_any_bytes_give_a_cloud_or_a_clear_word(suffix: str, data: bytes) -> None:
    for start in (b"", b"ply\nformat ascii 1.0\n", b"VERSION .7\nFIELDS x y z\n", b"LASF"):
        with contextlib.suppress(CloudFileError):
            assert len(read(f"some{suffix}", start + data, LARGEST)) > 0


@settings(max_examples=150, deadline=None)
@given(st.sampled_from(sorted(FILES)), st.data())
def test_a_few_wrong_bytes_give_a_cloud_or_a_clear_word(kind: str, draw: st.DataObject) -> None:
    name, make, _, _ = FILES[kind]
    data = bytearray(make())
    for _ in range(draw.draw(st.integers(1, 4))):
        data[draw.draw(st.integers(0, min(len(data), 700) - 1))] = draw.draw(st.integers(0, 255))
    with contextlib.suppress(CloudFileError):
        cloud = read(name, bytes(data), LARGEST)
        assert len(cloud) > 0
        assert np.isfinite(cloud.points).all()


def test_numbers_that_signal_that_they_are_none_are_left_out_without_a_warning() -> None:
    signals = struct.pack("<f", math.nan)[:2] + b"\xa0\x7f"
    for place, dropped in ((0, 1), (4, 1), (16, 0)):
        data = bytearray(pcd(Encoding.BINARY))
        at = data.index(b"DATA binary\n") + len(b"DATA binary\n") + place
        data[at : at + 4] = signals
        cloud = read("a.pcd", bytes(data), LARGEST)
        assert (len(cloud), cloud.dropped) == (60 - dropped, dropped)


def claims() -> dict[str, tuple[str, bytes]]:
    """Files whose headers claim two thousand million points."""
    many = 2_000_000_000
    binary = ply_bytes(CLOUD).replace(b"vertex 60", b"vertex %d" % many)
    plain = pcd(Encoding.BINARY).replace(b"POINTS 60", b"POINTS %d" % many).replace(b"WIDTH 60", b"WIDTH %d" % many)
    small = pcd(Encoding.BINARY_COMPRESSED)
    start = small.index(b"\n", small.index(b"DATA")) + 1
    small = small[: start + 4] + struct.pack("<I", 4_000_000_000) + small[start + 8 :]
    huge = small.replace(b"POINTS 60", b"POINTS 200000000").replace(b"WIDTH 60", b"WIDTH 200000000")
    flat, zipped = bytearray(las(False)), bytearray(las(True))
    for file in (flat, zipped):
        struct.pack_into("<Q", file, 247, many)
    records = bytearray(las(False))
    struct.pack_into("<I", records, 100, 0xFFFFFFFF)
    return {
        "PLY": ("a.ply", binary),
        "PLY, text": ("a.ply", ascii_ply(claimed=many)),
        "PCD": ("a.pcd", plain),
        "PCD, its packed size": ("a.pcd", small),
        "PCD, all its sizes": ("a.pcd", huge),
        "LAS": ("a.las", bytes(flat)),
        "LAZ": ("a.laz", bytes(zipped)),
        "LAS, records": ("a.las", bytes(records)),
    }


@pytest.mark.parametrize("kind", claims())
def test_a_header_that_claims_much_gets_no_memory(kind: str) -> None:
    name, data = claims()[kind]
    tracemalloc.start()
    try:
        with pytest.raises(CloudFileError):
            read(name, data, LARGEST)
        assert tracemalloc.get_traced_memory()[1] < 20_000_000
    finally:
        tracemalloc.stop()


def test_points_without_coordinates_are_dropped_and_counted() -> None:
    points, colors = POINTS.copy(), COLORS
    points[3, 1], points[7, 0], points[9, 2] = np.nan, np.inf, 1e30
    cloud = read("a.ply", ply_bytes(Cloud("", points, colors, INTENSITY)), LARGEST)
    good = np.delete(np.arange(60), [3, 7, 9])
    assert cloud.dropped == 3
    np.testing.assert_array_equal(cloud.points, POINTS[good])
    np.testing.assert_array_equal(cloud.colors, COLORS[good])
    assert read("a.xyz", b"1 2 3\nnan nan nan\n4 5 6\n", LARGEST).dropped == 1


@pytest.mark.parametrize(
    ("name", "data", "word"),
    [
        ("a.ply", b"", "empty"),
        ("a.xyz", b"", "empty"),
        ("a.ply", ascii_ply(np.empty((0, 3))), "no points"),
        ("a.xyz", b"# nothing\n", "three"),
        ("a.csv", b"x,y,z\n", "three"),
        ("a.ply", ply_bytes(Cloud("", np.full((5, 3), np.nan))), "finite"),
        ("a.xyz", b"nan nan nan\nnan nan nan\n", "finite"),
        ("a.xyz", b"1 2\n3 4\n", "three"),
        ("a.xyz", b"1 2 3\n4 5\n", "Line 2 isn't 3 numbers like the others: “4 5”"),
        ("a.csv", b"a,b,c\n1,2,3\n", "no coordinate x, y, z"),
        ("a.xyz", b"\x00\x01\x02\x03", "text"),
        ("a.ply", b"plx\n", "PLY"),
        ("a.ply", b"ply\nformat ascii 1.0\n", "no end"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement face 3\nend_header\n", "vertex"),
        ("a.pcd", b"hello\n", "PCD"),
        ("a.pcd", b"VERSION .7\nFIELDS x y\nDATA ascii\n1 2\n", "no coordinate z; its columns are x, y"),
        ("a.las", b"LASF" + bytes(50), "LAS"),
        ("a.obj", b"v 0 0 0\n", "end in"),
        ("ply", b"ply\n", "end in"),
        ("a.xyz", b"0 0 0\n" * 200_000, "at most 1.0 MB"),
    ],
)
def test_a_file_without_a_cloud_gets_a_clear_word(name: str, data: bytes, word: str) -> None:
    with pytest.raises(CloudFileError, match=word):
        read(name, data, LARGEST)


def test_one_point_and_points_in_one_place_are_fine() -> None:
    assert len(read("a.xyz", b"1 2 3\n", LARGEST)) == 1
    assert len(read("a.xyz", b"1 2 3", LARGEST)) == 1
    assert len(read("a.ply", ply_bytes(Cloud("", np.ones((4, 3)))), LARGEST)) == 4


@pytest.mark.parametrize("name", ["../../etc/passwd.xyz", "..\\..\\windows\\a.xyz", "/etc/a.xyz", "a" * 5000 + ".xyz"])
def test_of_a_name_only_the_ending_counts(name: str) -> None:
    cloud = read(name, b"1 2 3\n", LARGEST)
    assert cloud.name.endswith(".xyz")
    assert len(cloud.name) <= 80
    assert not set(cloud.name) & set("/\\")


def test_colours_of_other_scales_become_bytes() -> None:
    assert read("a.xyz", b"0 0 0 1 0.5 0\n", LARGEST).colors.tolist() == [[255, 128, 0]]  # type: ignore[union-attr]
    assert read("a.xyz", b"0 0 0 65535 0 257\n", LARGEST).colors.tolist() == [[255, 0, 1]]  # type: ignore[union-attr]


def test_what_is_written_is_read_again() -> None:
    again = read("a.ply", ply_bytes(CLOUD), LARGEST)
    np.testing.assert_array_equal(again.points, POINTS)
    np.testing.assert_array_equal(again.colors, COLORS)


def test_a_long_table_is_read_whole_and_its_odd_line_is_quoted() -> None:
    count = 40_000
    lines = b"".join(b"%d 2 %d\n" % (k, k % 7) for k in range(count))
    cloud = read("a.xyz", b"# of mine\n" + lines, len(lines) + 100)
    assert cloud.origin is not None
    np.testing.assert_array_equal(cloud.points[:, 0] + cloud.origin[0], np.arange(count))
    head = (
        f"ply\nformat ascii 1.0\nelement vertex {count}\nproperty int x\nproperty int y\nproperty int z\nend_header\n"
    )
    assert len(read("a.ply", head.encode() + lines + b"3 0 1 2\n" * 9, 2 * len(lines))) == count
    for broken, word in ((b"4 5\n", "“4 5”"), (b"1 2 3 4\n", "“1 2 3 4”"), (b"1 two 3\n", "“1 two 3”")):
        with pytest.raises(CloudFileError, match=f"^Line {count + 1:,} isn't 3 numbers like the others: {word}"):
            read("a.xyz", lines + broken, 2 * len(lines))


@pytest.mark.parametrize("kind", FILES)
def test_no_librarys_words_are_said_to_learners(kind: str) -> None:
    name, make, _, _ = FILES[kind]
    with contextlib.suppress(CloudFileError):
        read(name, make()[:-100], LARGEST)
        return
    with pytest.raises(CloudFileError) as said:
        read(name, make()[:-100], LARGEST)
    assert re.search(r"usecols|dtype|IoError|buffer|column|\brow\b", str(said.value)) is None
