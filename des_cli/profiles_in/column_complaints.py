"""What is wrong with the columns of a file, in words; no hint offers another unit."""

from __future__ import annotations

from collections.abc import Sequence

from des_cli.errors import Complaint
from des_cli.profiles_in.clock import is_clock
from des_cli.profiles_in.column_kinds import (
    ASKED_G,
    BODY_RATES,
    IGNORED,
    KINDS,
    QUANTITIES,
    Column,
    Kind,
    spelled,
)
from des_cli.profiles_in.csv_header import Header
from des_cli.profiles_in.unit_spelling import read_name
from des_cli.profiles_in.wording import did_you_mean, one_of, option, plain

_ARTICLE = {"rate": "a rate", "angle": "an angle", "time": "a time", "specific_force": "a G"}
_SIGNS = {"rad_s": "rad/s", "deg_s": "deg/s"}
_HOW_TO_NAME = "name those to read with --column NAME=HEADER"


_LOOKED_AT = 500
"""Names among which a misspelt one is looked for; each takes a comparison of its letters."""


def nothing_to_fly(header: Header) -> str:
    """Say that a file has no column of any kind of commands."""
    kinds = [f"{kind.words} ({kind.example})" for kind in KINDS]
    neither = f"has neither {' nor '.join(kinds)}"
    if len(header.names) < 2:
        # No table, perhaps a file that nobody is to read: its text is not repeated.
        return f"{neither}; it has one column: is it a table? --separator says what divides columns"
    there = f"there are {some([name for name in header.names if name])}"
    return f"{neither}; {there}; {_HOW_TO_NAME}"


def several_kinds(kinds: Sequence[Kind], found: Sequence[Column]) -> str:
    """Say that a file has several kinds of commands."""
    present = {column.stem for column in found}
    each = [
        f"{kind.words} ({', '.join(stem for stem in kind.stems if stem in present)})"
        for kind in kinds
    ]
    what = f"holds both {' and '.join(each)}; choose with --column"
    if list(kinds) == [BODY_RATES, ASKED_G]:
        what += ": p and q can be followed beside G, and no joint is left for r"
    return what


def check_missing(
    header: Header, kind: Kind, found: Sequence[Column], complaints: list[Complaint]
) -> None:
    """Say of each quantity without a usable column which one may be meant."""
    lost = False
    for stem in ("t", *_needed(header, kind, found)):
        own = [column for column in found if column.stem == stem]
        if any(column.usable for column in own):
            continue
        words = [unusable(column) for column in own] or misspelt(header, stem)
        if not words:
            words = [f"a column is missing: {one_of(spelled(stem))}"]
            clocks = _clocks(header) if stem == "t" else []
            if clocks:
                form = option("--column", f"t={clocks[0]}")
                words = [f"{words[0]}; {plain(clocks[0])} holds clock times: {form} reads them"]
            lost = lost or not clocks
        complaints += [Complaint(header.where, each) for each in words]
    unknown = [
        name
        for name in header.names
        if name and read_name(name).stem not in QUANTITIES and name not in IGNORED
    ]
    if lost and unknown:
        are = "column is" if len(unknown) == 1 else "columns are"
        what = f"{len(unknown)} {are} not known: {some(unknown)}; {_HOW_TO_NAME}"
        complaints.append(Complaint(header.where, what))


def _clocks(header: Header) -> list[str]:
    """Return the names of columns that start with a time of day or a date."""
    cells = zip(header.names, header.first, strict=False)
    return [name for name, cell in cells if name and is_clock(cell)]


def _needed(header: Header, kind: Kind, found: Sequence[Column]) -> Sequence[str]:
    """Return the quantities of a kind that must be there: where one is enough, what is meant."""
    if not kind.any_of:
        return kind.stems
    usable = {column.stem for column in found if column.usable}
    present = {column.stem for column in found}
    near = {stem for stem in kind.stems if misspelt(header, stem)}
    for some_of in (usable, present, near):
        if meant := [stem for stem in kind.stems if stem in some_of]:
            return meant
    return kind.stems


def misspelt(header: Header, stem: str) -> list[str]:
    """Say which names of the file differ from a stem's by their spelling, not by their unit."""
    for name in header.names[:_LOOKED_AT]:
        own = read_name(name)
        if own.stem in QUANTITIES or own.unit is None or len(own.stem) < 2:
            continue
        if own.unit.quantity in QUANTITIES[stem] and did_you_mean(own.stem.casefold(), [stem]):
            right = f"{stem}_{own.unit.suffix}"
            return [f"the column {plain(name)} is not known (did you mean {right}?)"]
    return []


def unusable(column: Column) -> str:
    """Say why a column's numbers do not mean what its name promises."""
    stem, name = column.stem, plain(column.name)
    if not QUANTITIES[stem]:
        return f"the column {name}: {stem} has no unit"
    is_a = f"{stem} is {one_of([_ARTICLE[kind] for kind in QUANTITIES[stem]])}"
    needs = f"{is_a} and needs its unit in the name: {one_of(spelled(stem))}"
    if column.unit_text and column.unit is None:
        return f"the column {name}: the unit {plain(column.unit_text)} is not known; {needs}"
    if column.unit is not None:
        return f"the column {name}: {needs}, and {column.unit.suffix} is none of them"
    example = spelled(stem)[0]
    unit = _SIGNS.get(example.removeprefix(f"{stem}_"), example.removeprefix(f"{stem}_"))
    rename = f"{option('--column', f'{example}={column.in_file}')} where it is in {unit}"
    return f"the column {name}: {needs} ({rename})"


def repeated(stem: str, same: Sequence[Column]) -> str:
    """Say that several columns of one rank give the same quantity."""
    names = [plain(column.in_file) for column in same]
    if len(set(names)) == 1:
        return stands_often(names[0], len(names))
    return f"{stem} is given twice: {' and '.join(names)}; choose one with --column"


def stands_often(name: str, count: int) -> str:
    """Say that a header has a name more than once, between which no option can choose."""
    return f"the column {plain(name)} stands {count} times; rename all but one in the file's header"


def some(names: Sequence[str], most: int = 12) -> str:
    """List the first of some names."""
    words = ", ".join(plain(name) for name in names[:most] if name)
    return f"{words}, …" if len(names) > most else words
