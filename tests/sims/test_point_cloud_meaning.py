"""What strangers' programs write is read as they meant it, or refused, and it is said what was taken for what."""

from __future__ import annotations

import io
import struct

import laspy
import numpy as np
import pytest

from sims.point_cloud.cloud import Cloud
from sims.point_cloud.derived import local, thinned
from sims.point_cloud.files import CloudFileError, read
from sims.point_cloud.files.meaning import letters_of, roles_of
from sims.point_cloud.library import Library
from sims.point_cloud.offers import CloudOffers
from sims.point_cloud.params import CloudParams

LARGEST = 60_000_000
THREE = [[1.5, 2.5, 3.5], [4.5, 5.5, 6.5], [7.5, 8.25, 9.75]]
SOME = np.random.default_rng(3)


def cloud_of(text: str | bytes, name: str = "a.xyz", columns: str = "", units: str = "auto") -> Cloud:
    return read(name, text.encode() if isinstance(text, str) else text, LARGEST, roles_of(columns), units)


def absolute(cloud: Cloud) -> np.ndarray:
    return np.asarray(cloud.points if cloud.origin is None else cloud.points + cloud.origin)


POINTS = "1.5 2.5 3.5\n4.5 5.5 6.5\n7.5 8.25 9.75\n"
COMMAS = POINTS.replace(".", ",")


@pytest.mark.parametrize(
    "text",
    [
        COMMAS.replace(" ", ";"),
        COMMAS,
        COMMAS.replace(" ", "\t"),
        POINTS.replace(" ", ","),
        POINTS.replace(" ", ", "),
        POINTS.replace(" ", "   ").replace("\n", "  \n"),
        POINTS.replace(" ", " \t "),
        POINTS.replace("\n", "\r"),
        POINTS.replace("\n", "\r\n"),
        "\ufeff" + POINTS,
        POINTS.encode("utf-16"),
        POINTS.encode("utf-16-le"),
        "3\n" + POINTS,
        "# by hand\n\n// twice\n" + POINTS,
        '"X","Y","Z","significant change"\n' + POINTS.replace(" ", ",").replace("\n", ",0\n"),
        '"x";"y";"z"\n' + "".join('"' + line.replace(" ", '";"') + '"\n' for line in COMMAS.split("\n")[:-1]),
        "index,x,y,z\n" + "".join(f"{k},{line.replace(' ', ',')}\n" for k, line in enumerate(POINTS.split("\n")[:-1])),
        ",x,y,z\n" + "".join(f"{k},{line.replace(' ', ',')}\n" for k, line in enumerate(POINTS.split("\n")[:-1])),
        "z,y,x\n" + "".join(",".join(line.split()[::-1]) + "\n" for line in POINTS.split("\n")[:-1]),
    ],
)
def test_a_table_of_any_dialect_gives_the_same_points(text: str | bytes) -> None:
    cloud = cloud_of(text)
    assert cloud.points.tolist() == THREE
    assert cloud.colors is None
    assert cloud.dropped == 0


@pytest.mark.parametrize("word", ["1.#QNAN", "-1.#IND", "-nan(ind)", "1.#INF", "-1.#INF00", "nan", "NaN", "null"])
def test_what_says_that_it_is_no_number_is_dropped_and_counted(word: str) -> None:
    head = (
        "ply\nformat ascii 1.0\nelement vertex 3\n" + "".join(f"property float {a}\n" for a in "xyz") + "end_header\n"
    )
    pcd = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA ascii\n"
    text = f"1 2 3\n4 5 {word}\n{word} 8 9\n"
    for name, start in (("a.xyz", ""), ("a.ply", head), ("a.pcd", pcd)):
        cloud = cloud_of(start + text, name)
        assert cloud.points.tolist() == [[1.0, 2.0, 3.0]]
        assert cloud.dropped == 2
        assert any("2 points without finite coordinates" in words for words in cloud.cautions)


def table(*columns: np.ndarray) -> str:
    points = np.round(SOME.uniform(0.0, 5.0, (40, 3)), 3)
    return "\n".join(" ".join(f"{v:.10g}" for v in row) for row in np.column_stack([points, *columns]))


def units() -> np.ndarray:
    vectors = SOME.normal(size=(40, 3))
    return np.asarray(np.round(vectors / np.linalg.norm(vectors, axis=1, keepdims=True), 6))


BYTES = SOME.integers(0, 256, (40, 3))


@pytest.mark.parametrize(
    ("columns", "taken"),
    [
        ((units(),), "xyzuvw"),
        ((BYTES,), "xyzrgb"),
        ((BYTES, np.full(40, 255)), "xyzrgb-"),
        ((np.linspace(-60.0, -3.0, 40), BYTES), "xyzirgb"),
        ((BYTES, units()), "xyzrgbuvw"),
        ((BYTES / 255.0,), "xyzrgb"),
        ((np.linspace(-2048.0, 2047.0, 40),), "xyzi"),
    ],
)
def test_columns_without_names_are_what_their_values_look_like(columns: tuple[np.ndarray, ...], taken: str) -> None:
    cloud = cloud_of(table(*columns))
    assert letters_of(cloud.roles) == taken
    assert (cloud.colors is not None) == ("r" in taken)
    assert (cloud.normals is not None) == ("u" in taken)
    assert (cloud.intensity is not None) == ("i" in taken)
    if cloud.colors is not None:
        np.testing.assert_allclose(cloud.colors, BYTES, atol=1)
    if cloud.intensity is not None:
        assert len(np.unique(cloud.intensity)) == 40, "none is clipped"


def test_row_numbers_are_no_coordinate_but_an_even_x_is() -> None:
    count = 30_000  # more than are looked at
    numbers, rest = np.arange(count), np.round(SOME.uniform(0.0, 5.0, (count, 3)), 3)
    lines = "\n".join(f"{k} {x} {y} {z}" for k, (x, y, z) in zip(numbers, rest.tolist(), strict=True))
    assert letters_of(cloud_of(lines).roles) == "-xyz"
    even = "\n".join(f"{k} 0.5 0.25 {r} {g} {b}" for k, (r, g, b) in enumerate(BYTES.tolist()))
    assert letters_of(cloud_of(even).roles) == "xyzrgb"
    assert letters_of(cloud_of("1 2 3 9\n4 5 6 9\n7 8 1 9\n").roles) == "xyzi"


def test_a_choice_of_columns_is_kept_to() -> None:
    text = table(units())
    cloud = cloud_of(text, columns="zyxrgb")
    assert letters_of(cloud.roles) == "zyxrgb"
    assert cloud.points[:, ::-1].tolist() == cloud_of(text).points.tolist()
    assert [len(entries) for entries in cloud.preview] == [3] * 6
    for columns, word in (("xxz", "2 columns are taken for x"), ("--z", "no coordinate x, y")):
        with pytest.raises(CloudFileError, match=word):
            cloud_of(text, columns=columns)


@pytest.mark.parametrize(("top", "kind"), [(1.0000002, "float"), (256.0, "float"), (1.6, "float")])
def test_one_colour_out_of_range_moves_no_other(top: float, kind: str) -> None:
    scale = 1.0 if top < 2.0 else 255.0
    colors = np.round(SOME.uniform(0.2, 1.0, (300, 3)), 3) * scale
    colors[7, 1] = top
    head = "ply\nformat ascii 1.0\nelement vertex 300\n"
    head += "".join(f"property {kind} {n}\n" for n in ("x", "y", "z", "red", "green", "blue")) + "end_header\n"
    text = "\n".join(f"{k} 0 0 {r:.9g} {g:.9g} {b:.9g}" for k, (r, g, b) in enumerate(colors.tolist()))
    found = cloud_of(head + text + "\n", "a.ply").colors
    assert found is not None
    np.testing.assert_allclose(found.astype(float), np.minimum(colors / scale, 1.0) * 255.0, atol=0.51)


def test_a_stray_costs_no_precision_and_is_named() -> None:
    points = np.array([512_060.0, 5_403_070.0, 240.0]) + np.round(SOME.uniform(-20.0, 20.0, (500, 3)), 3)
    text = "\n".join(" ".join(f"{v:.3f}" for v in row) for row in [*points, np.zeros(3)])
    cloud = cloud_of(text)
    assert (len(cloud), cloud.strays) == (500, 1)
    assert any(words.startswith("1 point far from all others") for words in cloud.cautions)
    assert np.abs(cloud.points.astype(np.float32) - cloud.points).max() < 1e-4
    np.testing.assert_allclose(absolute(cloud), points, rtol=0, atol=1e-6)


def test_colours_that_are_all_zero_are_none() -> None:
    cloud = cloud_of(table(np.zeros((40, 3))), columns="xyzrgb")
    assert cloud.colors is None
    assert any("colours are all zero" in words for words in cloud.cautions)


@pytest.mark.parametrize(
    ("row", "choice", "unit", "metres"),
    [
        ("512049123 5403059456 247789", "auto", "millimetres", [512049.123, 5403059.456, 247.789]),
        ("1000 2000 3000", "millimetres", "millimetres", [1.0, 2.0, 3.0]),
        ("10 20 30", "feet", "feet", [3.048, 6.096, 9.144]),
        ("3937 0 0", "us-feet", "us-feet", [1200.0, 0.0, 0.0]),
        ("1 2 3", "auto", "metres", [1.0, 2.0, 3.0]),
    ],
)
def test_units_are_guessed_or_chosen_and_said(row: str, choice: str, unit: str, metres: list[float]) -> None:
    cloud = cloud_of(row, units=choice)
    assert cloud.unit == unit
    np.testing.assert_allclose(absolute(cloud)[0], metres, rtol=0, atol=1e-6)
    assert unit.split("-")[-1] in cloud.notes[0].lower()


def test_degrees_become_metres_east_and_north() -> None:
    cloud = cloud_of("lon,lat,height\n10,50,100\n10.001,50.001,101\n10,50,102\n", "a.csv")
    assert cloud.unit == "degrees"
    # WGS 84 at 50° north: a degree of longitude is 71,695.8 m, one of latitude 111,229.0 m
    np.testing.assert_allclose(np.ptp(cloud.points, axis=0), [71.696, 111.229, 2.0], rtol=0, atol=0.02)


TYPED = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"


def las(vlr: laspy.VLR | None) -> bytes:
    header = laspy.LasHeader(version="1.2", point_format=0)
    header.scales, header.offsets = np.full(3, 0.01), np.zeros(3)
    if vlr is not None:
        header.vlrs.append(vlr)
    points = laspy.LasData(header)
    points.x, points.y, points.z = np.array([[10.0, 20.0, 30.0], [13.0, 24.0, 42.0]]).T
    file = io.BytesIO()
    points.write(file)
    return file.getvalue()


WKT = 'PROJCS["Somewhere / State plane",GEOGCS["NAD83",UNIT["degree",0.0174532925199433]],{}]'
KEYS = [1, 1, 0, 1, 3076, 0, 1]
"""GeoTIFF's: one key, of the linear unit."""


@pytest.mark.parametrize(
    ("vlr", "metres"),
    [
        (laspy.VLR("LASF_Projection", 2112, "", WKT.format('UNIT["metre",1]').encode()), 1.0),
        (
            laspy.VLR("LASF_Projection", 2112, "", WKT.format('UNIT["Foot_US",0.3048006096012192]').encode()),
            1200 / 3937,
        ),
        (laspy.VLR("LASF_Projection", 34735, "", struct.pack("<8H", *KEYS, 9002)), 0.3048),
        (None, 1.0),
    ],
    ids=["WKT, metres", "WKT, US feet", "keys, feet", "none"],
)
def test_the_coordinate_system_of_a_las_file_says_its_unit(vlr: laspy.VLR | None, metres: float) -> None:
    cloud = cloud_of(las(vlr), "a.las")
    np.testing.assert_allclose(np.ptp(cloud.points, axis=0), np.array([3.0, 4.0, 12.0]) * metres, atol=1e-9)
    assert ("coordinate system" in cloud.notes[0]) == (vlr is not None)


PCD = {
    "version .5": f"# .PCD v.5\nVERSION .5\n{TYPED}COUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n",
    "version .6, no count": f"VERSION .6\n{TYPED}WIDTH 2\nHEIGHT 1\nPOINTS 2\n",
    "columns": "COLUMNS x y z\nPOINTS 2\n",
    "of now": f"VERSION .7\n{TYPED}COUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 9 1 0 0 0\nPOINTS 2\n",
}


@pytest.mark.parametrize("kind", PCD)
def test_pcd_of_any_version_is_read(kind: str) -> None:
    cloud = cloud_of(PCD[kind] + "DATA ascii\n72.25        -18.18    0.85  \n68.27        -16.61    0.48  \n", "a.pcd")
    assert cloud.points.tolist() == [[72.25, -18.18, 0.85], [68.27, -16.61, 0.48]]
    assert (None if cloud.sensor is None else cloud.sensor.tolist()) == ([0.0, 0.0, 9.0] if kind == "of now" else None)


def test_normals_face_the_viewpoint_or_are_the_files_own() -> None:
    grid = "".join(f"{x} {y} 0\n" for x in range(6) for y in range(6))
    head = (
        "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 36\nHEIGHT 1\nVIEWPOINT 0 0 {} 1 0 0 0\nDATA ascii\n"
    )
    for height in (9, -9):
        cloud = cloud_of(head.format(height) + grid, "a.pcd")
        np.testing.assert_allclose(local(cloud, 8).normals[:, 2], np.sign(height))
    own = cloud_of(grid.replace(" 0\n", " 0 0.6 0 0.8\n"), columns="xyzuvw")
    np.testing.assert_allclose(local(own, 8).normals, [[0.6, 0.0, 0.8]] * 36, atol=1e-12)
    thin = thinned(own, 3.0)
    assert len(thin) < 36
    np.testing.assert_allclose(local(thin, 8).normals, [[0.6, 0.0, 0.8]] * len(thin), atol=1e-12)


def test_ply_with_other_elements_lists_and_line_ends_gives_its_points() -> None:
    head = "ply\nformat binary_little_endian 1.0\nelement camera 2\nproperty list uchar short a\nproperty int b\n"
    head += "element vertex 2\nproperty float x\nproperty list uchar float t\nproperty float y\nproperty float z\n"
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    body = struct.pack("<BhiBhhi", 1, 7, 1, 2, 8, 9, 2) + struct.pack("<fBff", 1, 0, 2, 3)
    body += struct.pack("<fBffff", 4, 2, 9, 9, 5, 6) + struct.pack("<Biii", 3, 0, 1, 0)
    for ending in ("\n", "\r", "\r\n"):
        cloud = cloud_of(head.replace("\n", ending).encode() + body, "a.ply")
        assert cloud.points.tolist() == [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]


def test_all_numbers_of_a_ply_may_be_on_one_line() -> None:
    head = "ply\nformat ascii 1.0\nelement vertex 60000\n"
    head += "".join(f"property float {axis}\n" for axis in "xyz") + "end_header\n"
    assert len(cloud_of(head + "0 1 2 " * 60_000 + "\n", "a.ply")) == 60_000


def test_points_too_many_are_chosen_at_random_to_the_limit() -> None:
    rows = 500_001
    cells = np.column_stack([np.arange(rows) * 1e-3, np.arange(rows) % 7, 5.0 * (np.arange(rows) % 2)]).astype("<f4")
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {rows}\n"
    head += "property float x\nproperty float y\nproperty float z\nend_header\n"
    data = head.encode() + cells.tobytes()
    cloud = cloud_of(data, "a.ply")
    assert (len(cloud), cloud.left_out) == (500_000, 1)
    fewer = read("a.ply", data, LARGEST, most=1_000)
    assert len(fewer) == 1_000
    assert 0.4 < np.mean(fewer.points[:, 2] == 0.0) < 0.6, "both scanners are there"
    np.testing.assert_array_equal(fewer.points, read("a.ply", data, LARGEST, most=1_000).points)


def test_lengths_of_a_file_follow_its_size() -> None:
    for size, greatest in ((0.1, 0.02), (5.0, 1.0), (2_000.0, 500.0)):
        cloud = Cloud("", np.array([[0.0, 0.0, 0.0], [size, size, size]]))
        library = Library()
        library.known = lambda *_, cloud=cloud: cloud  # type: ignore[method-assign]
        offers = CloudOffers(CloudParams(dataset="file", file="some.xyz"), None, library)
        low, high = offers.bounds("voxel_size")
        assert low == 0.0
        assert high == pytest.approx(greatest)
        assert offers.increment("voxel_size") == pytest.approx(greatest / 200.0)
    assert CloudParams().bounds("voxel_size") == (0.0, 1.0)
    with pytest.raises(ValueError, match="from 0 to 1"):
        CloudParams(voxel_size=1.5)
