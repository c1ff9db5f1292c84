"""Which column is what: by its name, by the values where there is no name, or as the learner says."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

import numpy as np

from geometry.arrays import Array
from sims.point_cloud.files.columns import CloudFileError, Table, Values, floats

IGNORED = "-"
ROLES = {
    "x": "x", "y": "y", "z": "z", "red": "Red", "green": "Green", "blue": "Blue", "intensity": "Intensity",
    "nx": "Normal x", "ny": "Normal y", "nz": "Normal z", IGNORED: "Not used",
}  # fmt: skip
"""What a column may be taken for, and how that is shown."""
LETTERS = {"r": "red", "g": "green", "b": "blue", "i": "intensity", "u": "nx", "v": "ny", "w": "nz"}
"""How some of them are spelled in a choice of columns; the others are letters already."""
COLORS = ("red", "green", "blue")
NORMALS = ("nx", "ny", "nz")
_NAMES = {
    "x": "x easting east e longitude lon lng long x_coordinate xcoord coord_x position_x points_0 points_m_xyz_0",
    "y": "y northing north n latitude lat y_coordinate ycoord coord_y position_y points_1 points_m_xyz_1",
    "z": "z height elevation elev altitude alt ele h up z_coordinate zcoord coord_z position_z points_2 points_m_xyz_2",
    "red": "red r diffuse_red rf color_r colour_r rgb_0 rgb_r color_0",
    "green": "green g diffuse_green gf color_g colour_g rgb_1 rgb_g color_1",
    "blue": "blue b diffuse_blue bf color_b colour_b rgb_2 rgb_b color_2",
    "intensity": "intensity i scalar_intensity intens reflectance scalar_reflectance reflectivity remission amplitude "
    "scalar_amplitude intensities laser_intensity gray grey scalar scalar_scalar_field value",
    "nx": "nx normal_x normalx n_x normals_0 normal_0 scalar_nx",
    "ny": "ny normal_y normaly n_y normals_1 normal_1 scalar_ny",
    "nz": "nz normal_z normalz n_z normals_2 normal_2 scalar_nz",
}
"""What programs call them, in lower case; of several in one file the one that stands first here."""
_ROLE_OF = {name: (role, rank) for role, names in _NAMES.items() for rank, name in enumerate(names.split())}
_UNIT = re.compile(r"[\[(].*?[\])]|_(?:m|mm|cm|ft|deg)$")
_ROW_NUMBERS = {"", "index", "id", "no", "nr", "number", "point", "point_id", "pointid", "fid", "unnamed_0"}
_TRIAL = 20_000
"""Points whose values are looked at."""


def roles_of(letters: str) -> tuple[str, ...]:
    """What a choice of columns, one letter for each, takes them for."""
    return tuple(LETTERS.get(letter, letter) for letter in letters)


def letters_of(roles: Sequence[str]) -> str:
    """The same as letters."""
    letters = {role: letter for letter, role in LETTERS.items()}
    return "".join(letters.get(role, role) for role in roles)


def named_roles(names: Sequence[str]) -> list[str]:
    """What columns are by their names; each role once."""
    found: dict[str, tuple[int, int]] = {}
    for column, name in enumerate(names):
        role, rank = _role_of(name)
        if role != IGNORED and (role not in found or rank < found[role][1]):
            found[role] = column, rank
    roles = [IGNORED] * len(names)
    for role, (column, _) in found.items():
        roles[column] = role
    return roles


def _role_of(name: str) -> tuple[str, int]:
    plain = re.sub(r"\W+", "_", name.strip().lower()).strip("_")
    bare = re.sub(r"\W+", "_", _UNIT.sub("", name.strip().lower())).strip("_")
    for spelling in (plain, bare, bare.removeprefix("scalar_"), _UNIT.sub("", plain)):
        if spelling in _ROLE_OF:
            return _ROLE_OF[spelling]
    return IGNORED, 0


def taken(table: Table, chosen: Sequence[str] = ()) -> list[str]:
    """What each column is taken for; `chosen` are the learner's words for the first ones.

    Raises CloudFileError if a coordinate is missing, or two columns are to be the same.
    """
    roles = _guessed(table)
    if chosen:
        rest = [role if role not in chosen else IGNORED for role in roles[len(chosen) :]]
        roles = [*chosen[: len(roles)], *rest]
    for role, shown in ROLES.items():
        if role != IGNORED and roles.count(role) > 1:
            raise CloudFileError(f"{roles.count(role)} columns are taken for {shown}: one can be.")
    missing = [axis for axis in "xyz" if axis not in roles]
    if missing:
        names = ", ".join(name for name in table.names if name)[:120]
        said = f"its columns are {names}" if names and not chosen else "choose its columns"
        raise CloudFileError(f"It has no coordinate {', '.join(missing)}; {said}.")
    words = [table.names[k] or f"{k + 1}" for k, v in enumerate(table.values) if v is None and roles[k] != IGNORED]
    if words:
        raise CloudFileError(f"Its column {words[0][:40]} holds words, not numbers.")
    return roles


def _guessed(table: Table) -> list[str]:
    if any(table.names):
        roles = named_roles(table.names)
        for triple in (COLORS, NORMALS):  # part of one is something else that is called so
            if not set(triple) <= set(roles):
                roles = [IGNORED if role in triple else role for role in roles]
        if table.declared or set("xyz") & set(roles) or all(table.names):
            return _with_unnamed(table, roles)
    return _by_values(table)


def _with_unnamed(table: Table, roles: list[str]) -> list[str]:
    """With what the values say of columns behind the named ones that have no name."""
    count = max((k + 1 for k, name in enumerate(table.names) if name), default=0)
    if set("xyz") <= set(roles[:count]) and len(roles) > count:
        known = set(roles)
        more = list(_attributes([_some(v) for v in table.values[count:]]))
        roles[count:] = [role if role not in known else IGNORED for role in more]
    return roles


def _by_values(table: Table) -> list[str]:
    """Roles of columns without names: x, y and z come first, but for row numbers; then what their values look like."""
    values = [_some(v) for v in table.values]
    numbers = [k for k, v in enumerate(values) if v is not None]
    # six are likelier coordinates and colours, or normals, of which x is evenly spaced
    first = 1 if len(numbers) > 3 and len(numbers) != 6 and _counts(values[numbers[0]], _every(len(table))) else 0
    roles = [IGNORED] * len(values)
    for axis, k in zip("xyz", numbers[first:], strict=False):
        roles[k] = axis
    if len(numbers) >= first + 3:
        start = numbers[first + 2] + 1
        roles[start:] = _attributes(values[start:])
    return roles


def _some(values: Values | None) -> Array | None:
    """Values of so many points, evenly over the file, that show what they are."""
    return None if values is None else floats(values[:: _every(len(values))])


def _every(count: int) -> int:
    return max(-(-count // _TRIAL), 1)


def _counts(values: Array | None, every: int) -> bool:
    """Row numbers, of lines that are evenly picked."""
    if values is None or len(values) < 3 or values[0] not in (0.0, 1.0):
        return False
    return bool((np.diff(values) == every).all())


def _attributes(values: Sequence[Array | None]) -> Iterator[str]:
    """What columns behind the coordinates are, from left to right."""
    left = list(values)
    known: set[str] = set()
    while left:
        run = [] if COLORS[0] in known else _channels(left)
        roles: tuple[str, ...]
        if NORMALS[0] not in known and _are_normals(left[:3]):
            roles = NORMALS
        elif len(run) > 3 and _opaque(left[3]):
            roles = (*COLORS, IGNORED)
        elif len(run) == 3 or (len(run) > 3 and run[3] > max(run[:3])):
            roles = COLORS
        else:
            roles = ("intensity" if left[0] is not None and "intensity" not in known else IGNORED,)
        known |= set(roles)
        yield from roles
        del left[: len(roles)]


def _are_normals(columns: Sequence[Array | None]) -> bool:
    """Unit vectors, some of which may be zero; if they could as well be colours, they aren't."""
    kept = [column for column in columns if column is not None]
    if len(kept) < 3:
        return False
    vectors = np.stack(kept, axis=1)
    squares = np.vecdot(vectors, vectors)
    given = squares[np.isfinite(squares) & (squares > 0.0)]
    units = np.abs(given - 1.0) < 0.03
    whole = (vectors == 0.0) | (vectors == 1.0)
    return len(given) > 0 and bool(units.mean() > 0.95) and not bool(whole.all())


def _channels(columns: Sequence[Array | None]) -> list[int]:
    """The tops of the columns from the first on that could together be channels of colours."""
    tops: list[int] = []
    for column in columns:
        top = None if column is None else _top(column)
        if top is None or (top and any(other and (other == 1) != (top == 1) for other in tops)):
            break
        tops.append(top)
    return tops


def _top(column: Array) -> int | None:
    """What could be a channel of colours goes up to 1 or, in whole numbers, to 255 or 65535, but for a few values.

    0 for what would be either, None for what can't be one.
    """
    finite = column[np.isfinite(column)]
    if not len(finite) or np.percentile(finite, 1) < 0.0:
        return None
    top, whole = float(np.percentile(finite, 99)), bool(np.mean(finite == np.rint(finite)) > 0.99)
    if top <= 1.01:
        return 0 if whole else 1
    return (255 if top <= 256.0 else 65535 if top <= 65536.0 else None) if whole else None


def _opaque(column: Array | None) -> bool:
    """One opacity for all points."""
    return column is not None and column[0] in (0.0, 1.0, 255.0, 65535.0) and bool((column == column[0]).all())
