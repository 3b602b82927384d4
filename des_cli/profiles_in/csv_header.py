"""Where the numbers of a CSV file start, and what stands above them."""

from __future__ import annotations

import csv
import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from des_cli.errors import Complaint, ProfileError
from des_cli.profiles_in.clock import is_clock
from des_cli.profiles_in.dialect import PLAIN, SEPARATORS, Dialect, how_to_ask, recognise
from des_cli.profiles_in.unit_spelling import unit_of
from des_cli.profiles_in.wording import plain

COMMENT = ("#", "%", "//")
"""How a comment line starts; no number does."""

LONGEST_LINE = 1 << 22
"""Characters of a line: some 200,000 columns. Each cell takes a hundred bytes of memory."""

_LINE_END = re.compile(r"\r\n?|\n")


@dataclass(frozen=True)
class Header:
    """What stands above the rows of a CSV file.

    Parameters
    ----------
    label : str
        What messages call the file.
    names : list of str
        Of the columns, without the blanks around them; may be empty or repeated.
    text : str
        The rows below it.
    lines : int
        Number of lines above the rows.
    line : int
        The line of the names.
    dialect : Dialect
    units : tuple of str
        The row of units below the names, as long as these; empty without one.
    first : tuple of str
        The cells of the first row.
    remarks : tuple of str
        Sentences on what was passed over.
    """

    label: str
    names: list[str]
    text: str
    lines: int
    line: int = 1
    dialect: Dialect = PLAIN
    units: tuple[str, ...] = ()
    first: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def where(self) -> str:
        """The place of the names, as a message starts."""
        return f"{self.label}:{self.line}"


def require_line(line: str, label: str, number: int) -> None:
    """Refuse a line that is longer than that of any table."""
    if len(line) > LONGEST_LINE:
        what = f"is longer than {LONGEST_LINE >> 20} MiB: this is no line of a table"
        raise ProfileError([Complaint(f"{label}:{number}", what)])


def is_comment(line: str) -> bool:
    """Whether a line holds a comment, and neither names nor numbers."""
    return line.lstrip().startswith(COMMENT)


def split_header(
    text: str,
    label: str,
    separator: str | None = None,
    decimal: str | None = None,
    named: Collection[str] = (),
) -> Header:
    """Split off what stands above the rows of a CSV file.

    Parameters
    ----------
    text, label : str
    separator, decimal : str, optional
        As asked for; without them a comma and a point are expected. A first line
        ``sep=;`` in the file, as Excel writes it, has the last word.
    named : collection of str
        Names that the columns are known to have, even where they are numbers.

    Raises
    ------
    ProfileError
        If the file is empty, has no header, or is written with another
        separator or decimal sign than expected.
    """
    lines = _Lines(text, label)
    separator = lines.pass_declaration() or separator
    comments, last_comment = lines.pass_comments()
    start, line = lines.place, lines.number + 1
    asked = Dialect(separator or ",", decimal or ".")
    found = recognise(text[start[0] :], asked.separator, decimal)
    names = _record(lines, found, label)
    if not any(names):
        raise ProfileError(
            [Complaint(label, "is empty: a header such as t_s,arm_rpm,… is missing")]
        )
    remarks = []
    complaints = [Complaint(f"{label}:{line}", how_to_ask(found, asked))] if found != asked else []
    if any(_is_value(found, name) for name in names) and not {*named} & {*names}:
        inside = _commented_names(last_comment[1], names, found)
        if inside:
            line, names, comments = last_comment[0], inside, comments - 1
            remarks.append(f"line {line}, a comment, is read as the header")
            lines.back_to(start)
        elif all(_is_value(found, name) for name in names if name):
            what = "the first line is numbers: a header is missing; put one above the numbers, "
            example = found.separator.join(("t_s", "p_rad_s", "q_rad_s", "r_rad_s"))
            complaints.append(Complaint(f"{label}:{line}", f"{what}such as {plain(example)}"))
    if complaints:
        raise ProfileError(complaints)
    units, first, below = _above_the_rows(lines, found, len(names), remarks)
    if comments or below:
        remarks.append(f"{comment_lines(comments + below)} skipped")
    rest, above = text[lines.offset :], lines.number
    return Header(label, names, rest, above, line, found, units, first, tuple(remarks))


def comment_lines(count: int) -> str:
    """Count comment lines, with the verb that follows."""
    return "a comment line is" if count == 1 else f"{count} comment lines are"


def _above_the_rows(
    lines: _Lines, dialect: Dialect, width: int, remarks: list[str]
) -> tuple[tuple[str, ...], tuple[str, ...], int]:
    """Pass over comments and a row of units; return these, the first row, and the comments."""
    comments, _ = lines.pass_comments(blank_too=False)
    start, first = lines.place, _peek(lines, dialect)
    units: tuple[str, ...] = ()
    if _is_row_of_units(dialect, first):
        units = (*first, *[""] * width)[:width]
        remarks.append(f"line {lines.number} is read as a row of units")
        comments += lines.pass_comments(blank_too=False)[0]
        start, first = lines.place, _peek(lines, dialect)
    lines.back_to(start)
    return units, tuple(first), comments


def lines_of(text: str) -> Iterator[str]:
    """Iterate over the lines of a text, with their ends; none is held longer than it is used.

    Unlike a stream in memory, which takes four bytes for each character.
    """
    start = 0
    while start < len(text):
        stop = _next_line(text, start)
        yield text[start:stop]
        start = stop


def _next_line(text: str, start: int) -> int:
    """Return where the line after the one that starts here begins."""
    end = _LINE_END.search(text, start)
    return end.end() if end else len(text)


class _Lines:
    """The lines of a text one by one, with the place that was reached."""

    def __init__(self, text: str, label: str) -> None:
        self._text = text
        self._label = label
        self.offset = 0
        self.number = 0

    @property
    def place(self) -> tuple[int, int]:
        """Where the next line starts, and how many are before it."""
        return self.offset, self.number

    def back_to(self, place: tuple[int, int]) -> None:
        """Go back to the start of an earlier line."""
        self.offset, self.number = place

    def __iter__(self) -> Iterator[str]:
        return self

    def __next__(self) -> str:
        stop = _next_line(self._text, self.offset)
        if stop == self.offset:
            raise StopIteration
        line = self._text[self.offset : stop]
        self.offset = stop
        self.number += 1
        require_line(line, self._label, self.number)
        return line

    def pass_declaration(self) -> str | None:
        """Pass over the first line if it names the separator as Excel does; return that."""
        line = next(self, "")
        match = re.fullmatch(r'"?sep=(.)"?[;,\t]*\s*', line, re.IGNORECASE)
        if match is None or match[1] not in SEPARATORS:
            self.back_to((0, 0))
            return None
        return match[1]

    def pass_comments(self, *, blank_too: bool = True) -> tuple[int, tuple[int, str]]:
        """Pass over comments, and blank lines if told to.

        Returns
        -------
        int
            How many comments there were.
        (int, str)
            Number and text of the last one.
        """
        count, last = 0, (0, "")
        while True:
            before = self.place
            line = next(self, "")
            if is_comment(line):
                count, last = count + 1, (self.number, line.strip())
            elif line.strip() or not (line and blank_too):
                self.back_to(before)
                return count, last


def _record(lines: _Lines, dialect: Dialect, label: str) -> list[str]:
    line = lines.number + 1
    try:
        return [cell.strip() for cell in next(dialect.records(lines), [])]
    except csv.Error as error:
        where = f"{label}:{line}"
        raise ProfileError([Complaint(where, f"is not a CSV header: {error}")]) from None


def _peek(lines: _Lines, dialect: Dialect) -> list[str]:
    """Return the cells of the next record; what is wrong with it is said with the rows."""
    try:
        return [cell.strip() for cell in next(dialect.records(lines), [])]
    except csv.Error:
        return []


def _is_value(dialect: Dialect, cell: str) -> bool:
    return dialect.is_number(cell) or is_clock(cell)


def _is_row_of_units(dialect: Dialect, cells: Sequence[str]) -> bool:
    """Whether a row holds units, perhaps some unknown ones, and not a single number."""
    return any(unit_of(cell) for cell in cells) and not any(
        _is_value(dialect, cell) for cell in cells
    )


def _commented_names(comment: str, values: Sequence[str], dialect: Dialect) -> list[str] | None:
    """Return the names in the comment right above the numbers, if it is their header."""
    names = [name.strip() for name in dialect.split(comment.lstrip("#%/").strip())]
    if len(names) == len(values) > 1 and not any(_is_value(dialect, name) for name in names):
        return names
    return None
