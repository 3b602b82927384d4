"""Which columns of a file are read, and as what."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum

from des_cli.errors import Problem
from des_cli.profiles_in.clock import is_clock
from des_cli.profiles_in.csv_header import Header
from des_cli.profiles_in.unit_spelling import HeaderName, read_name, unit_of
from des_cli.profiles_in.wording import did_you_mean, one_of, plain
from des_cli.units import Unit, split_unit, suffixes

QUANTITIES: Mapping[str, tuple[str, ...]] = {
    "t": ("time",),
    "arm": ("rate",),
    "fork": ("angle",),
    "cab": ("angle",),
    "p": ("rate",),
    "q": ("rate",),
    "r": ("rate",),
}
"""What each column may measure."""

JOINTS = ("arm", "fork", "cab")
RATES = ("p", "q", "r")
_KINDS: tuple[tuple[str, ...], ...] = (JOINTS, RATES)
QUATERNION = ("q0", "q1", "q2", "q3")
"""Recorded attitude (w, x, y, z), without a unit."""

IGNORED = ("quality",)
"""Columns that recorders add and that say nothing about the motion."""

_ARTICLE = {"rate": "a rate", "angle": "an angle", "time": "a time"}
_HOW_TO_NAME = "name those to read with --column NAME=HEADER"
_SIGNS = {"rad_s": "rad/s", "deg_s": "deg/s"}


class Said(IntEnum):
    """Who says that a column is what it is taken for; the first one has the word."""

    BY_USER = 0
    BY_CONTRACT = 1
    BY_SPELLING = 2


@dataclass(frozen=True, slots=True)
class Column:
    """A column of the file that may be read.

    Parameters
    ----------
    stem : str
        Which quantity it gives.
    name : str
        Its name, with the unit where that has one.
    in_file : str
        Its name in the file.
    place : int
        Which column of the file.
    unit : Unit, optional
        None of an attitude, of times of day, and where the unit is not known.
    unit_text : str
        The unit as it is written.
    said : Said
    is_clock : bool
        Whether it holds times of day or dates instead of numbers.
    """

    stem: str
    name: str
    in_file: str
    place: int
    unit: Unit | None = None
    unit_text: str = ""
    said: Said = Said.BY_CONTRACT
    is_clock: bool = False

    @property
    def usable(self) -> bool:
        """Whether its numbers mean what the stem asks for."""
        if self.stem in QUATERNION or (self.stem == "t" and self.is_clock):
            return True
        return self.unit is not None and self.unit.quantity in QUANTITIES[self.stem]


def choose_columns(
    header: Header, named: Mapping[str, str], problems: list[Problem], remarks: list[str]
) -> list[Column]:
    """Match the columns of a file with what a profile needs.

    Parameters
    ----------
    header : Header
    named : mapping of str to str
        Our name to the name in the file, as asked for. They go before names of
        the contract (``p_rad_s``), and these before other spellings (``P (deg/s)``).
    problems, remarks : list
        Take what is wrong, and what was done.

    Returns
    -------
    list of Column
        Time, joints or body rates, and a complete attitude, in the order of the
        file; incomplete where there are problems.
    """
    found = [*_named(header, named, problems, remarks), *_recognised(header, named)]
    if problems:
        return []
    kind = _kind(header, found, problems)
    if not kind:
        return []
    chosen = []
    for stem in ("t", *kind):
        same = _first_said([column for column in found if column.stem == stem and column.usable])
        if len(same) == 1:
            chosen += same
        elif same:
            problems.append(Problem(header.where, _repeated(stem, same)))
    _check_missing(header, kind, found, problems)
    if kind == RATES:
        chosen += _attitude(found)
    for column in chosen:
        _check_units(header, column, problems, remarks)
    if not set(kind) <= {read_name(name).stem for name in named}:
        _tell_unread(header, chosen, remarks)
    return sorted(chosen, key=lambda column: column.place)


def _named(
    header: Header, named: Mapping[str, str], problems: list[Problem], remarks: list[str]
) -> list[Column]:
    """Return the columns that the user names."""
    found = []
    for name, in_file in named.items():
        where = f"{header.label}: column {plain(name)}={plain(in_file)}"
        own, theirs = read_name(name), read_name(in_file)
        count = header.names.count(in_file)
        if not count:
            same_unit = [other for other in header.names if _units_agree(other, in_file)]
            hint = did_you_mean(in_file, same_unit) or f"; there are {some(header.names)}"
            problems.append(Problem(where, f"the file has no column {plain(in_file)}{hint}"))
            continue
        if count > 1:
            problems.append(Problem(where, f"the column {plain(in_file)} stands {count} times"))
        elif list(named.values()).count(in_file) > 1:
            problems.append(Problem(where, f"the column {plain(in_file)} is named twice"))
        if name in QUATERNION:
            found.append(
                Column(name, name, in_file, header.names.index(in_file), said=Said.BY_USER)
            )
            continue
        if own.stem not in QUANTITIES:
            known = [stem + name[len(own.stem) :] for stem in QUANTITIES]
            hint = did_you_mean(name, known)
            problems.append(Problem(where, f"the name {plain(name)} is not known{hint}"))
            continue
        column = _column(header, header.names.index(in_file), own, Said.BY_USER, name)
        if not own.unit_text and theirs.unit_text and column.unit is None:
            column = _column(header, column.place, _with_unit_of(own, theirs), Said.BY_USER, name)
        if own.unit and theirs.unit and own.unit != theirs.unit:
            words = f"{plain(in_file)} is read in {own.unit.suffix}, as {plain(name)} says"
            remarks.append(f"{words}, and not in {theirs.unit.suffix}")
        if not column.usable:
            problems.append(Problem(where, _unusable(column)))
        found.append(column)
    return found


def _recognised(header: Header, named: Mapping[str, str]) -> list[Column]:
    """Return the columns whose names in the file say what they are."""
    found = []
    for place, name in enumerate(header.names):
        if not name or name in named.values():
            continue
        own = read_name(name)
        if name.lower() in QUATERNION:
            found.append(Column(name.lower(), name, name, place))
        elif own.stem in QUANTITIES:
            by_contract = split_unit(name)[0] == own.stem
            said = Said.BY_CONTRACT if by_contract else Said.BY_SPELLING
            found.append(_column(header, place, own, said, name))
    return found


def _column(header: Header, place: int, own: HeaderName, said: Said, name: str) -> Column:
    """Make a column with its own unit, or else with that of the row of units."""
    unit, text = own.unit, own.unit_text
    if not text and header.units:
        text = header.units[place]
        unit = unit_of(text)
    clock = place < len(header.first) and is_clock(header.first[place])
    return Column(own.stem, name, header.names[place], place, unit, text, said, clock)


def _with_unit_of(own: HeaderName, theirs: HeaderName) -> HeaderName:
    return HeaderName(own.stem, theirs.unit, theirs.unit_text)


def _units_agree(name: str, other: str) -> bool:
    """Whether two names do not differ by their units: a hint must not cost a factor."""
    units = read_name(name).unit, read_name(other).unit
    return None in units or units[0] == units[1]


def _first_said(columns: Sequence[Column]) -> list[Column]:
    """Keep the columns of whoever has the word."""
    first = min((column.said for column in columns), default=Said.BY_USER)
    return [column for column in columns if column.said == first]


def _kind(header: Header, found: Sequence[Column], problems: list[Problem]) -> tuple[str, ...]:
    """Return the stems of the commands that the file gives; empty after saying why not.

    Those that the user names, else those that are complete, else those of which
    there is more.
    """
    by_user = {column.stem for column in found if column.said is Said.BY_USER}
    usable = {column.stem for column in found if column.usable}
    kinds = [kind for kind in _KINDS if by_user & {*kind}]
    kinds = kinds or [kind for kind in _KINDS if usable >= {*kind}]
    kinds = kinds or _likely_kinds(header, found)
    if len(kinds) == 1:
        return kinds[0]
    if kinds:
        present = {column.stem for column in found}
        joints, rates = (", ".join(s for s in kind if s in present) for kind in kinds)
        what = f"holds both joint commands ({joints}) and body rates ({rates})"
        problems.append(Problem(header.where, f"{what}; choose with --column"))
        return ()
    what = (
        "has neither joint commands (t_s,arm_rpm,fork_deg,cab_deg) nor body rates "
        "(t_s,p_rad_s,q_rad_s,r_rad_s)"
    )
    there = f"there are {some([name for name in header.names if name])}"
    problems.append(Problem(header.where, f"{what}; {there}; {_HOW_TO_NAME}"))
    return ()


def _likely_kinds(header: Header, found: Sequence[Column]) -> list[tuple[str, ...]]:
    """Return the commands, neither of them complete, of which the file seems to have more."""
    present = {column.stem for column in found}
    weights = {
        kind: sum(2 if stem in present else bool(_misspelt(header, stem)) for stem in kind)
        for kind in _KINDS
    }
    most = max(weights.values())
    return [kind for kind, weight in weights.items() if weight == most > 0]


def _check_missing(
    header: Header, kind: Sequence[str], found: Sequence[Column], problems: list[Problem]
) -> None:
    """Say of each quantity without a usable column which one may be meant."""
    lost = False
    for stem in ("t", *kind):
        own = [column for column in found if column.stem == stem]
        if any(column.usable for column in own):
            continue
        words = [_unusable(column) for column in own] or _misspelt(header, stem)
        if not words:
            lost = True
            words = [f"a column is missing: {one_of(_spelled(stem))}"]
        problems += [Problem(header.where, each) for each in words]
    unknown = [
        name
        for name in header.names
        if name and read_name(name).stem not in QUANTITIES and name not in (*QUATERNION, *IGNORED)
    ]
    if lost and unknown:
        are = "column is" if len(unknown) == 1 else "columns are"
        what = f"{len(unknown)} {are} not known: {some(unknown)}; {_HOW_TO_NAME}"
        problems.append(Problem(header.where, what))


def _misspelt(header: Header, stem: str) -> list[str]:
    """Say which names of the file differ from a stem's by their spelling, not by their unit."""
    for name in header.names:
        own = read_name(name)
        if own.stem in QUANTITIES or own.unit is None or len(own.stem) < 2:
            continue
        if own.unit.quantity in QUANTITIES[stem] and did_you_mean(own.stem.casefold(), [stem]):
            right = f"{stem}_{own.unit.suffix}"
            return [f"the column {plain(name)} is not known (did you mean {right}?)"]
    return []


def _unusable(column: Column) -> str:
    """Say why a column's numbers do not mean what its name promises."""
    stem, name = column.stem, plain(column.name)
    is_a = f"{stem} is {one_of([_ARTICLE[kind] for kind in QUANTITIES[stem]])}"
    needs = f"{is_a} and needs its unit in the name: {one_of(_spelled(stem))}"
    if column.unit_text and column.unit is None:
        return f"the column {name}: the unit {plain(column.unit_text)} is not known; {needs}"
    if column.unit is not None:
        return f"the column {name}: {needs}, and {column.unit.suffix} is none of them"
    example = _spelled(stem)[0]
    unit = _SIGNS.get(example.removeprefix(f"{stem}_"), example.removeprefix(f"{stem}_"))
    rename = f"--column {example}={plain(column.in_file)} where it is in {unit}"
    return f"the column {name}: {needs} ({rename})"


def _repeated(stem: str, same: Sequence[Column]) -> str:
    names = [plain(column.in_file) for column in same]
    if len(set(names)) == 1:
        return f"the column {names[0]} stands {len(names)} times"
    return f"{stem} is given twice: {' and '.join(names)}; choose one with --column"


def _attitude(found: Sequence[Column]) -> list[Column]:
    """Return the recorded attitude if it is complete and each part of it stands once."""
    parts = [
        _first_said([column for column in found if column.stem == stem]) for stem in QUATERNION
    ]
    return [part[0] for part in parts] if all(len(part) == 1 for part in parts) else []


def _check_units(
    header: Header, column: Column, problems: list[Problem], remarks: list[str]
) -> None:
    """Say where the row of units contradicts the name of a column."""
    below = unit_of(header.units[column.place]) if header.units else None
    if below is None or column.unit is None or below == column.unit:
        return
    says = f"the row of units says {below.suffix}"
    if column.said is Said.BY_USER:
        own = (
            f"{plain(column.in_file)} is read in {column.unit.suffix}, as {plain(column.name)} says"
        )
        remarks.append(f"{own}, and {says}")
    else:
        what = f"the column {plain(column.in_file)} is in {column.unit.suffix}, but {says}"
        problems.append(Problem(header.where, f"{what}; correct one of them"))


def _tell_unread(header: Header, chosen: Sequence[Column], remarks: list[str]) -> None:
    read = {column.place for column in chosen}
    unread = [
        name
        for place, name in enumerate(header.names)
        if name and place not in read and name not in IGNORED
    ]
    if unread:
        are = "column is" if len(unread) == 1 else "columns are"
        remarks.append(f"{len(unread)} {are} not read: {some(unread, 5)}")


def _spelled(stem: str) -> list[str]:
    """Return every name of the contract for a quantity."""
    return [f"{stem}_{suffix}" for kind in QUANTITIES[stem] for suffix in suffixes(kind)]


def some(names: Sequence[str], most: int = 12) -> str:
    """List the first of some names."""
    words = ", ".join(plain(name) for name in names[:most] if name)
    return f"{words}, …" if len(names) > most else words
