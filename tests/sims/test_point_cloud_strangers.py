"""More of how programs write tables, what is refused in words, and what a learner then reads.

Expected values are written down from the text of each file by hand.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from sims.kit import readout
from sims.point_cloud import SIM, CloudParams
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files import CloudFileError, read
from sims.point_cloud.library import Library
from sims.point_cloud.offers import CloudOffers
from tests.sims.markup import words

LARGEST = 100_000_000
TWO = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]
PCD = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n{rest}DATA ascii\n{rows}"


def cloud_of(text: str, name: str = "a.csv") -> Cloud:
    return read(name, text.encode(), LARGEST)


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


def normal_of(p: CloudParams, library: Library) -> np.ndarray[Any, np.dtype[np.float64]]:
    """The normal of the selected point."""
    selected = SIM.solve(p, library).selected
    assert selected is not None
    assert selected.normal is not None
    return np.asarray(selected.normal)


def test_a_viewpoint_is_where_normals_point_and_none_is_not_spoken_of() -> None:
    rows = "".join(f"{x} {y} 0\n" for x in range(5) for y in range(5))
    for viewpoint, sensor in (
        ("VIEWPOINT 2 2 -9 1 0 0 0\n", [2.0, 2.0, -9.0]),
        ("VIEWPOINT 0 0 0 1 0 0 0\n", None),
        ("", None),
    ):
        text = PCD.format(rest=f"POINTS 25\n{viewpoint}", rows=rows)
        library = Library(largest=LARGEST)
        _, changes = library.add("a.pcd", text.encode())
        p = CloudParams.model_validate({**changes, "selected": 12})
        s = SIM.solve(p, library)
        assert (s.drawn.cloud.sensor is None) == (sensor is None)
        assert normal_of(p, library)[2] == pytest.approx(-1.0 if sensor else 1.0)
        said = words(readout.render(SIM.readouts(p, s)))
        assert ("towards the sensor" in said) == (sensor is not None)


def test_a_learner_sees_what_was_taken_for_what_and_changes_it() -> None:
    library = Library(largest=LARGEST)
    _, changes = library.add("a.csv", b"1,2,3,10,20,30\n4,5,6,40,50,60\n")
    p = CloudParams().moved(changes)
    s = SIM.solve(p, library)
    said = words(readout.render(SIM.readouts(p, s)))
    for part in ("Columns taken for", "Taken as metres"):
        assert part in said
    assert CloudOffers(p, s, library).entries("columns") == "xyzrgb"
    assert p.columns == "", "as it seems needs no place in a link"
    p = CloudOffers(p, s, library).moved({"columns.0": "z"})
    assert p.columns == "zyxrgb", "the two change places"
    np.testing.assert_array_equal(SIM.solve(p, library).maximum, [6.0, 5.0, 4.0])
    p = p.moved({"units": "millimetres"})
    np.testing.assert_allclose(SIM.solve(p, library).maximum, [0.006, 0.005, 0.004])
    assert CloudParams.from_query(p.query_items().items()) == p
    bad = CloudOffers(p, s, library).moved({"columns.0": "-"})
    assert "no coordinate" in SIM.solve(bad, library).trouble
    assert p.moved({"file": None}).columns == ""


def test_coordinates_that_are_nothing_beside_the_clouds_size_are_zero() -> None:
    """Squares of such distances are zero: a search for neighbours would look at every point for each."""
    rng = np.random.default_rng(2)
    spread = 10.0 ** rng.uniform(-300.0, 3.0, (400, 3))
    for points, least in ((spread, 1e-9 * spread.max()), (1e-310 * rng.random((400, 3)), 1e-15)):
        cloud = cloud_of("\n".join("{:.17g} {:.17g} {:.17g}".format(*row) for row in points.tolist()), "a.xyz")
        np.testing.assert_array_equal(cloud.points, np.where(points < least, 0.0, points))
    millimetre = cloud_of("0.001 0.002 0\n1000 2000 3000\n", "a.xyz")
    assert millimetre.points[0].tolist() == [0.001, 0.002, 0.0]
