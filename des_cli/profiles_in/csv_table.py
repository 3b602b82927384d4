"""A CSV file of numbers, read strictly and fast.

The whole file goes through a reader in C first, numpy's or, if it is long, Arrow's. Only
where that fails, or finds what is not a plain finite number, is the file read again row by
row, to say what is wrong and where.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from des_cli.errors import Complaint, ProfileError
from des_cli.model.arrays import Floats
from des_cli.profiles_in.caps import DEFAULT_CAPS
from des_cli.profiles_in.clock import is_clock
from des_cli.profiles_in.csv_header import Header, is_comment, lines_of, require_line
from des_cli.profiles_in.gaps import LONGEST_BRIDGED
from des_cli.profiles_in.wording import plain, shown

_WORTH_TELLING = 30
"""Kinds of wrong rows described before the rest is only counted."""

_WORTH_COUNTING = 10_000
"""Wrong rows left unsaid after which reading stops."""

LONG = 2_000_000
"""Characters from which on a text is read by Arrow."""

_LEFT_OUT = (
    f"take out the rows without a number: a gap of up to {LONGEST_BRIDGED:g} s is then bridged, "
    "and --gap (or gap) says what is done about a longer one"
)


@dataclass(frozen=True)
class Rows:
    """The numbers of a file's rows.

    Parameters
    ----------
    values : (n, k) array
        A column each, n >= 1.
    lines : sequence of int
        The line of the file on which each row starts.
    comments : int
        Comment lines that were passed over between the rows.
    """

    values: Floats
    lines: Sequence[int]
    comments: int = 0


def read_columns(
    header: Header,
    places: Sequence[int],
    may_lack: Sequence[int] = (),
    clock: int | None = None,
    *,
    most_rows: int = DEFAULT_CAPS.rows,
) -> Rows:
    """Read the numbers of some columns.

    Parameters
    ----------
    header : Header
    places : sequence of int
        Which columns of the file.
    may_lack : sequence of int
        Those of them whose cells may be empty; they become not a number.
    clock : int, optional
        The one of them that may hold times of day or dates; they become not a
        number, and `column_text` has them.
    most_rows : int

    Returns
    -------
    Rows

    Raises
    ------
    ProfileError
        With every row that is not as long as the header or holds something
        else than finite numbers; what is wrong alike on many rows is one line.
    """
    require_few_rows(header.text.count("\n"), header.label, most_rows)
    _require_end(header, places)
    rows = _read_fast(header, places)
    if rows is None:
        optional = [place in may_lack for place in places]
        rows = _read_slowly(header, places, optional, clock, most_rows)
    return rows


def require_few_rows(rows: int, label: str, most: int) -> None:
    """Refuse a file before its numbers are made, which take more memory than its text."""
    if rows > most:
        what = f"has more than {most} rows; --max-rows reads more"
        raise ProfileError([Complaint(label, what)])


def _require_end(header: Header, places: Sequence[int]) -> None:
    """Refuse a last line that does not end where its last number is read.

    Such a file may have been cut inside the number: 0.0 of 0.0125 is a number too.
    """
    if not header.text or header.text.endswith(("\n", "\r")):
        return
    start = max(header.text.rfind("\n"), header.text.rfind("\r")) + 1
    cells = header.dialect.split(header.text[start:])
    if len(cells) - 1 in places and header.dialect.is_number(cells[-1]):
        line = header.lines + header.text.count("\n") + 1
        what = (
            f"{plain(header.names[len(cells) - 1])}: the last line does not end, and may have been "
            f"cut inside its number {shown(cells[-1].strip())}: end the line, or take it out"
        )
        raise ProfileError([Complaint(f"{header.label}:{line}", what)])


def column_text(header: Header, place: int) -> list[str]:
    """Return the cells of a column of a file that `read_columns` has read, as they are."""
    return [cells[place] for _, cells in _Records(header)]


def _read_fast(header: Header, places: Sequence[int]) -> Rows | None:
    """Read with a reader in C, or return None where it is not sure to be right."""
    body = header.text.rstrip("\r\n")
    separator, decimal = header.dialect.separator, header.dialect.decimal
    if not body or separator == decimal or body.count("\r") != body.count("\r\n"):
        return None
    by_arrow = len(body) >= LONG and separator != " "
    chosen = (_by_arrow if by_arrow else _by_numpy)(header, body, places)
    # one line a row: cells in quotes may go over several
    if chosen is None or len(chosen) != body.count("\n") + 1 or not np.isfinite(chosen).all():
        return None
    return Rows(chosen, range(header.lines + 1, header.lines + 1 + len(chosen)))


def _by_numpy(header: Header, body: str, places: Sequence[int]) -> Floats | None:
    separator, decimal = header.dialect.separator, header.dialect.decimal
    # Quotes and whatever numpy might take for a number are left to the careful reader.
    if re.search(rf"[^0-9eE+\-\r\n \t{re.escape(separator)}{re.escape(decimal)}]", body):
        return None
    if decimal == ",":
        body = body.replace(",", ".")
    delimiter = None if separator == " " else separator
    try:
        values = np.loadtxt(lines_of(body), delimiter=delimiter, comments=None, ndmin=2)
    except ValueError:
        return None
    return values[:, places].copy() if values.shape[1] == len(header.names) else None


def _by_arrow(header: Header, body: str, places: Sequence[int]) -> Floats | None:
    # Imported here: it costs a tenth of a second, as long as numpy takes for a LONG text.
    import pyarrow as pa
    import pyarrow.csv as pc

    # To Arrow a comment with as many separators is a row, and a quote may stand anywhere.
    if "#" in body and any(map(is_comment, lines_of(body))):
        return None
    if '"' in body:
        other = re.escape(header.dialect.separator)
        cell = rf'(?:"[^"\r\n]*"|[^"\r\n{other}]*)'
        row = re.compile(rf"{cell}(?:{other}{cell})*[\r\n]*")
        if not all(map(row.fullmatch, lines_of(body))):
            return None
    names = [f"f{place}" for place in range(len(header.names))]
    wanted = [names[place] for place in places]
    try:
        table = pc.read_csv(
            pa.BufferReader(body.encode()),
            # Without threads of its own: one that still ends when the process does aborts it.
            read_options=pc.ReadOptions(use_threads=False, column_names=names),
            parse_options=pc.ParseOptions(
                delimiter=header.dialect.separator, ignore_empty_lines=False
            ),
            convert_options=pc.ConvertOptions(
                column_types=dict.fromkeys(wanted, pa.float64()),
                include_columns=wanted,
                null_values=[],
                decimal_point=header.dialect.decimal,
            ),
        )
    except (pa.ArrowException, ValueError):
        return None
    return np.column_stack([table.column(name).to_numpy() for name in wanted])


def _read_slowly(
    header: Header,
    places: Sequence[int],
    may_lack: Sequence[bool],
    clock: int | None,
    most_rows: int,
) -> Rows:
    complaints = _ByWords(header.label)
    records = _Records(header, complaints)
    values: list[list[float]] = []
    lines: list[int] = []
    cell_complaint = _cell_checker(header)
    for line, cells in records:
        if wrong := _row_complaint(header, cells):
            complaints.add(line, wrong)
            continue
        row = []
        for place, optional in zip(places, may_lack, strict=True):
            cell = cells[place]
            if header.dialect.is_number(cell):
                row.append(float(header.dialect.number(cell)))
                if math.isfinite(row[-1]):
                    continue
            elif (place == clock and is_clock(cell)) or (optional and _is_lacking(cell)):
                row.append(math.nan)
                continue
            complaints.add(line, cell_complaint(place, cell))
        if complaints.many:
            break
        if not complaints:
            values.append(row)
            lines.append(line)
            require_few_rows(len(values), header.label, most_rows)
    found = complaints.complaints()
    if not values and not found:
        found.append(Complaint(header.label, "has a header but no rows"))
    if found:
        raise ProfileError(found)
    return Rows(np.array(values), lines, records.comments)


class _ByWords:
    """What is wrong with rows: the same words on many of them are one line."""

    def __init__(self, label: str) -> None:
        self._label = label
        self._found: dict[str, list[int]] = {}  # first line and number of lines
        self._unsaid = 0

    def __bool__(self) -> bool:
        return bool(self._found)

    @property
    def many(self) -> bool:
        """Whether so many kinds were left unsaid that nobody needs the exact number."""
        return self._unsaid >= _WORTH_COUNTING

    def add(self, line: int, what: str) -> None:
        """Add what is wrong with a row."""
        if what in self._found:
            self._found[what][1] += 1
        elif len(self._found) < _WORTH_TELLING:
            self._found[what] = [line, 1]
        else:
            self._unsaid += 1

    def complaints(self) -> list[Complaint]:
        """Return a complaint for each kind, at the first line that has it."""
        said = [
            Complaint(
                f"{self._label}:{line}", what if count == 1 else f"{what} ({count} rows like this)"
            )
            for what, (line, count) in self._found.items()
        ]
        if self._unsaid:
            count = f"{self._unsaid} or more" if self.many else f"{self._unsaid} more"
            words = f"… and {count} cells or rows like these"
            said.append(Complaint(self._label, words))
        return said


class _Records:
    """The rows with their line numbers; comments, and blank lines at the end, are none.

    Parameters
    ----------
    header : Header
    complaints : _ByWords, optional
        Takes what is wrong with rows that cannot be split into cells.
    """

    def __init__(self, header: Header, complaints: _ByWords | None = None) -> None:
        self._header = header
        self._complaints = _ByWords(header.label) if complaints is None else complaints
        self._line = header.lines
        self._fresh = True
        self.comments = 0

    def _lines(self) -> Iterator[str]:
        """Iterate over the lines; what starts inside a quoted cell is no comment."""
        for line in lines_of(self._header.text):
            self._line += 1
            require_line(line, self._header.label, self._line)
            if self._fresh and is_comment(line):
                self.comments += 1
                continue
            if self._fresh:
                self._start = self._line
            self._fresh = False
            yield line

    def __iter__(self) -> Iterator[tuple[int, list[str]]]:
        reader = self._header.dialect.records(self._lines())
        blank: list[int] = []
        while True:
            self._fresh, self._start = True, self._line + 1
            try:
                cells = next(reader)
            except StopIteration:
                return
            except csv.Error as error:
                self._complaints.add(self._start, f"is not a CSV row: {error}")
                return
            if not cells or (len(cells) == 1 and not cells[0].strip()):
                blank.append(self._start)
                continue
            for line in blank:
                self._complaints.add(line, "is a blank line between rows; take it out")
            blank.clear()
            yield self._start, cells


def _row_complaint(header: Header, cells: Sequence[str]) -> str:
    """Say what is wrong with a row as a whole; separators too many at its end are not."""
    names, width = header.names, len(header.names)
    if cells[0].strip() == names[0] and [cell.strip() for cell in cells] == names:
        return "is the header again; take it out"
    if len(cells) == width or (len(cells) > width and not any(map(str.strip, cells[width:]))):
        return ""
    if len(cells) < width and len(cells) >= max(i + 1 for i, name in enumerate(names) if name):
        return ""
    what = f"has {len(cells)} cell{'s' * (len(cells) != 1)}, the header has {width}"
    if len(cells) == 2 * width and header.dialect.separator == ",":
        what += "; a decimal comma cannot be told from one between columns: save with semicolons"
    return what


def _cell_checker(header: Header) -> Callable[[int, str], str]:
    """Return what says why a cell is no number of its column."""
    other = "," if header.dialect.decimal == "." else "."

    def complaint(place: int, cell: str) -> str:
        name, cell = plain(header.names[place]), cell.strip()
        if not cell:
            return f"{name}: is missing; {_LEFT_OUT}"
        if cell.lower() == "nan":
            return f"{name}: is nan; {_LEFT_OUT}"
        if header.dialect.is_number(cell):
            return f"{name}: {shown(cell)} is too large for a number"
        hint = ""
        if header.dialect.is_number(cell.replace(other, header.dialect.decimal)):
            sign = "comma" if other == "," else "point"
            hint = f", with a decimal {sign} where the file has the other sign"
        return f"{name}: must be a number, is {shown(cell)}{hint}"

    return complaint


def _is_lacking(cell: str) -> bool:
    return not cell.strip() or cell.strip().lower() == "nan"
