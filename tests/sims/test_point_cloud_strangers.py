"""Files as programs and countries write them: each gives what it says, or is refused in words, never something else.

Expected values are written down from the text of each file by hand.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Callable, Mapping
from typing import Any

import laspy
import numpy as np
import pytest

from sims.kit import readout
from sims.point_cloud import SIM, CloudParams, library
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files import CloudFileError, read
from sims.point_cloud.files.meaning import ROLES
from tests.sims.markup import words

LARGEST = 100_000_000
TWO = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]
PLY = "ply\nformat ascii 1.0\nelement vertex {count}\n{properties}end_header\n{rows}"
XYZ = "property float x\nproperty float y\nproperty float z\n"
PCD = "FIELDS x y z{more}\nSIZE 4 4 4{four}\nTYPE F F F{type}\n{rest}DATA ascii\n{rows}"


def cloud_of(text: str | bytes, name: str = "a.xyz", **how: Any) -> Cloud:
    return read(name, text.encode() if isinstance(text, str) else text, LARGEST, **how)


def ply(rows: str, more: str = "", count: int = 2) -> str:
    return PLY.format(count=count, properties=XYZ + more, rows=rows)


# ---- one locale, one writer

DIALECTS = {
    "blanks": "1 2 3\n4 5 6\n",
    "several blanks": "  1   2  3  \n\t4 5    6\n",
    "tabs": "1\t2\t3\n4\t5\t6\n",
    "commas": "1,2,3\n4,5,6\n",
    "commas and blanks": "1, 2, 3\n4, 5, 6\n",
    "semicolons": "1;2;3\n4;5;6\n",
    "decimal commas": "1,0;2,0;3,0\n4,0;5,0;6,0\n",
    "decimal commas and blanks": "1,0 2,0 3,0\n4,0 5,0 6,0\n",
    "decimal commas and tabs": "1,0\t2,0\t3,0\n4,0\t5,0\t6,0\n",
    "quoted decimal commas": '"1,0","2,0","3,0"\n"4,0","5,0","6,0"\n',
    "thousands": '"1.00","2.00","3.00"\n"4.00","5.00","6.00"\n',
    "quoted numbers": '"1","2","3"\n"4","5","6"\n',
    "CR": "1 2 3\r4 5 6\r",
    "CR LF": "1 2 3\r\n4 5 6\r\n",
    "no end": "1 2 3\n4 5 6",
    "byte order mark": "\ufeff1 2 3\n4 5 6\n",
    "names": "x y z\n1 2 3\n4 5 6\n",
    "names in quotes, with blanks": '"X","Y","Z","significant change"\n1,2,3,0\n4,5,6,1\n',
    "names in another order": "z,x,y\n3,1,2\n6,4,5\n",
    "names in a comment": "//X Y Z Intensity\n1 2 3 7\n4 5 6 9\n",
    "eastings": "Easting,Northing,Elevation\n1,2,3\n4,5,6\n",
    "comments": "# from a scanner\n1 2 3 # the first\n4 5 6\n",
    "a count first": "2\n1 2 3\n4 5 6\n",
    "row numbers without a name": "x y z\n1 1 2 3\n2 4 5 6\n",
    "a delimiter at the end": "x;y;z;\n1;2;3;\n4;5;6;\n",
    "exponents": "1e0 20.0E-1 +3\n4 5. .6e1\n",
}


@pytest.mark.parametrize("text", DIALECTS.values(), ids=DIALECTS.keys())
def test_a_table_is_read_as_it_is_written(text: str) -> None:
    cloud = cloud_of(text, "a.csv")
    np.testing.assert_array_equal(cloud.points, TWO)
    assert cloud.colors is None
    assert not cloud.dropped


@pytest.mark.parametrize("coding", ["utf-16", "utf-16-le", "utf-16-be", "utf-8-sig"])
def test_a_table_is_read_in_any_coding(coding: str) -> None:
    np.testing.assert_array_equal(cloud_of("x,y,z\n1,2,3\n4,5,6\n".encode(coding), "a.csv").points, TWO)


NOTHING = ["nan", "-nan(ind)", "1.#QNAN", "-1.#IND", "1.#INF", "NaN", "inf", "null", "NA"]


@pytest.mark.parametrize("word", NOTHING)
@pytest.mark.parametrize("form", [lambda w: f"1 2 3\n7 8 {w}\n4 5 6\n", lambda w: f"1,2,3\n7,8,{w}\n4,5,6\n"])
def test_what_says_that_there_is_no_number_is_dropped_and_counted(form: Callable[[str], str], word: str) -> None:
    cloud = cloud_of(form(word))
    np.testing.assert_array_equal(cloud.points, TWO)
    assert cloud.dropped == 1
    assert any("1 points without finite" in caution for caution in cloud.cautions)


@pytest.mark.parametrize("word", ["1.#QNAN", "-nan(ind)", "nan"])
def test_formats_with_a_header_have_such_words_too(word: str) -> None:
    for name, text in (
        ("a.ply", ply(f"1 2 3\n7 8 {word}\n4 5 6\n", count=3)),
        ("a.pcd", PCD.format(more="", four="", type="", rest="POINTS 3\n", rows=f"1 2 3\n7 8 {word}\n4 5 6\n")),
    ):
        cloud = cloud_of(text, name)
        np.testing.assert_array_equal(cloud.points, TWO)
        assert cloud.dropped == 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1,5 2.5 3,5\n1,5 2.5 3,5\n", "comma"),
        ("1 2\n3 4\n", "three"),
        ("a b c\nd e f\n", "three numbers"),
        ("1 2 3\n4 5\n", "Line 2"),
        ("name,x,y\nfirst,1,2\n", "no line of three numbers"),
        ("1,2 3\n4,5 6\n", "comma"),
    ],
)
def test_what_is_not_sure_is_refused_in_words(text: str, said: str) -> None:
    with pytest.raises(CloudFileError, match=said):
        cloud_of(text)


# ---- columns


def test_a_column_of_row_numbers_is_none_of_coordinates() -> None:
    cloud = cloud_of("1 7 2 3\n2 4 5 6\n3 0 0 9\n")
    np.testing.assert_array_equal(cloud.points, [[7.0, 2.0, 3.0], [4.0, 5.0, 6.0], [0.0, 0.0, 9.0]])
    assert cloud.roles == ("-", "x", "y", "z")


@pytest.mark.parametrize(
    ("text", "roles"),
    [
        ("1 2 3 0.6 0 0.8\n4 5 6 0 1 0\n", "xyzuvw"),
        ("1 2 3 200 100 50\n4 5 6 10 20 30\n", "xyzrgb"),
        ("1 2 3 200 100 50 255\n4 5 6 10 20 30 255\n", "xyzrgb-"),
        ("1 2 3 0.5 0.25 1\n4 5 6 1 1 0\n", "xyzrgb"),
        ("1 2 3 -25.5\n4 5 6 -31\n", "xyzi"),
        ("1 2 3 12 200 100 50\n4 5 6 13 10 20 30\n", "xyzirgb"),
        ("x,y,z,nx,ny,nz\n1,2,3,0,0,1\n4,5,6,0,1,0\n", "xyzuvw"),
        ("x y z temperature\n1 2 3 20\n4 5 6 21\n", "xyz-"),
        ("r g b x y z\n9 8 7 1 2 3\n6 5 4 4 5 6\n", "rgbxyz"),
        ("X,Y,Z,Reflectance\n1,2,3,-3\n4,5,6,-9\n", "xyzi"),
    ],
)
def test_columns_are_taken_for_what_their_names_and_values_say(text: str, roles: str) -> None:
    cloud = cloud_of(text)
    assert cloud.roles == tuple(library.LETTERS[letter] for letter in roles)
    np.testing.assert_array_equal(cloud.points, TWO)


def test_intensities_below_zero_keep_their_order_and_are_told() -> None:
    cloud = cloud_of("1 2 3 -40\n4 5 6 -30\n7 8 9 -20\n")
    assert cloud.intensity is not None
    np.testing.assert_allclose(cloud.intensity, [0.0, 0.5, 1.0])
    assert cloud.intensity_span == (-40.0, -20.0)
    assert any("-40 to -20" in note for note in cloud.notes)


def test_columns_can_be_chosen_and_a_bad_choice_is_refused_in_words() -> None:
    text = "1 2 3 10 20 30\n4 5 6 40 50 60\n"
    other = cloud_of(text, columns=["z", "x", "y", "-", "-", "intensity"])
    np.testing.assert_array_equal(other.points, [[2.0, 3.0, 1.0], [5.0, 6.0, 4.0]])
    assert other.colors is None
    assert other.intensity is not None
    for columns, said in ((["x", "x"], "2 columns"), (["-", "y", "z"], "no coordinate x")):
        with pytest.raises(CloudFileError, match=said):
            cloud_of(text, columns=columns)


# ---- one extreme value


@pytest.mark.parametrize("extreme", ["1.0000002", "256"])
def test_one_value_out_of_range_moves_no_other_colour(extreme: str) -> None:
    scale = 1.0 if extreme.startswith("1") else 255.0
    body = "".join(f"{k} 0 0 {0.8 * scale} {0.4 * scale} {0.2 * scale}\n" for k in range(300))
    cloud = cloud_of(body + f"0 0 1 {extreme} 0 0\n")
    assert cloud.colors is not None
    assert cloud.colors[0].tolist() == [204, 102, 51]
    assert cloud.colors[-1].tolist() == [255, 0, 0]


def test_a_stray_at_zero_costs_no_digits_and_is_named() -> None:
    rng = np.random.default_rng(1)
    points = np.round(np.array([512_000.0, 5_403_000.0, 250.0]) + rng.uniform(0, 30, (1500, 3)), 3)
    rows = "".join("{:.3f} {:.3f} {:.3f}\n".format(*p) for p in [*points[:700], (0.0, 0.0, 0.0), *points[700:]])
    cloud = cloud_of(rows)
    assert cloud.strays == 1
    assert cloud.origin is not None
    np.testing.assert_allclose(cloud.points.astype(np.float32) + cloud.origin, points, rtol=0, atol=1e-4)
    assert any("1 point far from all others" in caution for caution in cloud.cautions)


def test_colours_that_are_all_zero_are_no_colours() -> None:
    cloud = cloud_of(
        ply("1 2 3 0 0 0\n4 5 6 0 0 0\n", "property uchar red\nproperty uchar green\nproperty uchar blue\n"), "a.ply"
    )
    assert cloud.colors is None
    assert any("all zero" in caution for caution in cloud.cautions)


# ---- what a file says of itself


def test_declared_types_say_how_colours_are_meant() -> None:
    dark = ply("1 2 3 1 0 1\n4 5 6 0 1 1\n", "property uchar red\nproperty uchar green\nproperty uchar blue\n")
    cloud = cloud_of(dark, "a.ply")
    assert cloud.colors is not None
    assert cloud.colors.tolist() == [[1, 0, 1], [0, 1, 1]]
    bright = cloud_of(dark.replace("uchar", "float"), "a.ply")
    assert bright.colors is not None
    assert bright.colors.tolist() == [[255, 0, 255], [0, 255, 255]]


def test_a_viewpoint_is_where_normals_point_and_none_is_not_spoken_of() -> None:
    rows = "".join(f"{x} {y} 0\n" for x in range(5) for y in range(5))
    for viewpoint, sensor in (
        ("VIEWPOINT 2 2 -9 1 0 0 0\n", [2.0, 2.0, -9.0]),
        ("VIEWPOINT 0 0 0 1 0 0 0\n", None),
        ("", None),
    ):
        text = PCD.format(more="", four="", type="", rest=f"POINTS 25\n{viewpoint}", rows=rows)
        kept, changes = library.bring("a.pcd", text.encode(), LARGEST)
        p = CloudParams.model_validate({**changes, "selected": 12})
        s = SIM.solve(p)
        assert (s.drawn.cloud.sensor is None) == (sensor is None)
        assert normal_of(p)[2] == pytest.approx(-1.0 if sensor else 1.0)
        said = words(readout.render(SIM.readouts(p, s)))
        assert ("towards the sensor" in said) == (sensor is not None)
        del kept


def test_normals_of_a_file_are_shown_as_they_are() -> None:
    rows = "".join(f"{x} {y} 0 0 0 -2\n" for x in range(5) for y in range(5))
    kept, changes = library.bring("a.xyz", b"x y z nx ny nz\n" + rows.encode(), LARGEST)
    p = CloudParams.model_validate({**changes, "selected": 12, "show_normals": True})
    s = SIM.solve(p)
    np.testing.assert_allclose(normal_of(p), [0.0, 0.0, -1.0])
    assert "as the file has it" in words(readout.render(SIM.readouts(p, s)))
    np.testing.assert_allclose(normal_of(p.changed({"voxel_size": 0.9, "selected": 0})), [0.0, 0.0, -1.0])
    del kept


def normal_of(p: CloudParams) -> np.ndarray[Any, np.dtype[np.float64]]:
    """The normal of the selected point."""
    selected = SIM.solve(p).selected
    assert selected is not None
    assert selected.normal is not None
    return np.asarray(selected.normal)


def las(scale: float = 0.001, wkt: str = "") -> bytes:
    header = laspy.LasHeader(point_format=6 if wkt else 3, version="1.4" if wkt else "1.2")
    header.scales, header.offsets = np.full(3, scale), np.array([100.0, 200.0, 0.0])
    if wkt:
        header.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(wkt))
    made = laspy.LasData(header)
    made.x, made.y, made.z = np.array([101.0, 104.0]), np.array([202.0, 205.0]), np.array([3.0, 6.0])
    file = io.BytesIO()
    made.write(file)
    return file.getvalue()


def test_scale_offset_and_unit_of_a_las_file_count() -> None:
    np.testing.assert_allclose(cloud_of(las(), "a.las").points, [[101, 202, 3], [104, 205, 6]], atol=1e-9)
    wkt = 'PROJCS["somewhere",GEOGCS["x",UNIT["degree",0.0174532925]],UNIT["US survey foot",0.304800609601219]]'
    cloud = cloud_of(las(wkt=wkt), "a.las")
    assert cloud.unit == "us-feet"
    np.testing.assert_allclose(cloud.points[1] - cloud.points[0], np.array([3, 3, 3]) * 1200 / 3937, atol=1e-9)
    assert any("somewhere" in note and "survey feet" in note for note in cloud.notes)


@pytest.mark.parametrize(
    ("units", "factor"), [("metres", 1.0), ("millimetres", 0.001), ("feet", 0.3048), ("us-feet", 1200 / 3937)]
)
def test_units_can_be_chosen(units: str, factor: float) -> None:
    np.testing.assert_allclose(cloud_of("1 2 3\n4 5 6\n", units=units).points, np.array(TWO) * factor, rtol=1e-12)


def test_degrees_become_metres() -> None:
    cloud = cloud_of("13.40 52.50 30\n13.41 52.50 30\n13.40 52.51 40\n", units="degrees")
    east, north = cloud.points[1] - cloud.points[0], cloud.points[2] - cloud.points[0]
    assert east[0] == pytest.approx(679.0, abs=1.0)  # of a hundredth of a degree at 52.5° N, by WGS 84
    assert north[1] == pytest.approx(1112.7, abs=1.0)
    assert north[2] == pytest.approx(10.0)
    with pytest.raises(CloudFileError, match="longitude"):
        cloud_of("512000 5403000 30\n512001 5403000 30\n", units="degrees")


def test_numbers_without_sense_as_metres_are_millimetres() -> None:
    cloud = cloud_of("512049123 5403059456 247789\n512050123 5403060456 247800\n")
    assert cloud.unit == "millimetres"
    np.testing.assert_allclose(cloud.points[1] - cloud.points[0], [1.0, 1.0, 0.011], atol=1e-9)
    assert any("guessed" in note for note in cloud.notes)


# ---- a strict library's refusals

KINDS = "SIZE 4 4 4\nTYPE F F F\n"
PCDS = {
    "version .5, no COUNT or VIEWPOINT": f"# .PCD v.5\nVERSION .5\nFIELDS x y z\n{KINDS}POINTS 2\nDATA ascii\n",
    "COLUMNS, as in version .6": f"VERSION .6\nCOLUMNS x y z\n{KINDS}COUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nDATA ascii\n",
    "trailing blanks": "FIELDS x y z \nSIZE 4 4 4 \nTYPE F F F \nCOUNT 1 1 1 \nPOINTS 2 \nDATA ascii \n",
    "names in small letters": "fields x y z\nsize 4 4 4\ntype F F F\npoints 2\ndata ascii\n",
    "CR LF": "FIELDS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nPOINTS 2\r\nDATA ascii\r\n",
}


@pytest.mark.parametrize("head", PCDS.values(), ids=PCDS.keys())
@pytest.mark.parametrize("rows", ["1 2 3\n4 5 6\n", "1        2        3 \n4        5        6 \n"])
def test_pcd_is_read_as_pcl_writes_it(head: str, rows: str) -> None:
    np.testing.assert_array_equal(cloud_of(head + rows, "a.pcd").points, TWO)


def test_elements_and_lists_of_ply_are_skipped() -> None:
    head = (
        "ply\nformat binary_little_endian 1.0\nelement camera 1\nproperty list uchar int ids\nproperty double f\n"
        "element vertex 2\nproperty list uchar float more\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    body = struct.pack("<Biid", 2, 7, 8, 0.5)
    for row, more in zip(TWO, ((9.0,), (1.0, 2.0, 3.0)), strict=True):
        body += struct.pack(f"<B{len(more)}f3f", len(more), *more, *row)
    np.testing.assert_array_equal(cloud_of(head.encode() + body, "a.ply").points, TWO)
    text = head.replace("binary_little_endian", "ascii") + "2 7 8 0.5\n1 9 1 2 3\n3 1 2 3 4 5 6\n3 0 1 1\n"
    np.testing.assert_array_equal(cloud_of(text, "a.ply").points, TWO)
    one_line = ply("1 2 3 4 5 6\n")
    np.testing.assert_array_equal(cloud_of(one_line, "a.ply").points, TWO)


# ---- too many


def test_of_two_scanners_in_turn_none_vanishes() -> None:
    rows = np.zeros((1001, 3))
    rows[1::2, 0] = 100.0
    rows[:, 1] = np.arange(1001)
    text = "\n".join(" ".join(map(str, row)) for row in rows.tolist())
    cloud = cloud_of(text, most=500)
    assert (len(cloud), cloud.left_out) == (500, 501)
    share = float((cloud.points[:, 0] > 50.0).mean())
    assert 0.4 < share < 0.6
    np.testing.assert_array_equal(cloud.points, cloud_of(text, most=500).points)
    assert len(cloud_of(text, most=1000)) == 1000


# ---- in the sim


def test_a_learner_sees_what_was_taken_for_what_and_changes_it() -> None:
    kept, changes = library.bring("a.csv", b"1,2,3,10,20,30\n4,5,6,40,50,60\n", LARGEST)
    p = CloudParams().moved(changes)
    s = SIM.solve(p)
    said = words(readout.render(SIM.readouts(p, s)))
    for part in ("Its columns", "taken for", "column 4 red 10 40", "Taken as metres"):
        assert part in said
    (choose,) = (action for action in SIM.actions if action.name == "columns")
    chosen = choose.run(p)
    assert isinstance(chosen, Mapping)
    p = p.moved(chosen)
    assert p.columns == "xyzrgb"
    p = p.moved({"columns.0": "z"})
    assert p.columns == "zyxrgb", "the two change places"
    np.testing.assert_array_equal(SIM.solve(p).maximum, [6.0, 5.0, 4.0])
    p = p.moved({"units": "millimetres"})
    np.testing.assert_allclose(SIM.solve(p).maximum, [0.006, 0.005, 0.004])
    assert CloudParams.from_query(p.query_items().items()) == p
    bad = p.moved({"columns.0": "-"})
    assert "no coordinate" in SIM.solve(bad).trouble
    assert p.moved({"file": None}).columns == ""
    del kept


def test_lengths_go_with_the_size_of_the_cloud() -> None:
    for size, span in ((0.05, 0.01), (7.0, 1.0), (600.0, 100.0)):
        kept, changes = library.bring("a.xyz", f"0 0 0\n{size} 0 0\n0 {size / 2} 0\n".encode(), LARGEST)
        p = CloudParams().moved(changes)
        np.testing.assert_allclose(p.bounds("voxel_size"), (0.0, span))
        assert p.increment("voxel_size") == pytest.approx(0.005 * span)
        assert p.moved({"voxel_size": 1e6}).voxel_size == pytest.approx(span)
        del kept
    assert CloudParams().bounds("voxel_size") == (0.0, 1.0)
    gone = CloudParams.from_query([("dataset", "file"), ("file", "upload-gone"), ("voxel_size", "50")])
    assert gone.voxel_size == 50.0, "a link holds what it was made with"


def test_every_role_has_a_letter() -> None:
    assert [*library.LETTERS.values()] == [*ROLES]
