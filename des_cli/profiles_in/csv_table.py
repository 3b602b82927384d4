"""A CSV file of numbers, read strictly and fast.

The whole file goes through numpy's C reader first. Only where that fails, or
finds what is not a plain finite number, is the file read again row by row, to
say what is wrong and where.
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from des_cli.errors import Problem, ProfileError
from des_cli.model.arrays import Floats
from des_cli.profiles_in.sampling import MAX_SAMPLES
from des_cli.profiles_in.wording import plain, shown

_NUMBER = re.compile(r"\s*[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?\s*", re.ASCII)
_WORTH_TELLING = 30
"""Rows described before the rest is only counted."""


@dataclass(frozen=True)
class Header:
    """The first row of a CSV file.

    Parameters
    ----------
    label : str
        What messages call the file.
    names : list of str
        Without the blanks around them.
    text : str
        The rows below it.
    lines : int
        Number of lines that the header takes.
    """

    label: str
    names: list[str]
    text: str
    lines: int


def split_header(text: str, label: str) -> Header:
    """Split off the header of a CSV file.

    Raises
    ------
    ProfileError
        If the file is empty, or a name is empty or stands twice.
    """
    stream = io.StringIO(text, newline="")
    reader = csv.reader(stream, strict=True)
    try:
        names = [name.strip() for name in next(reader, [])]
    except csv.Error as error:
        raise ProfileError([Problem(f"{label}:1", f"is not a CSV header: {error}")]) from None
    if not any(names):
        raise ProfileError([Problem(label, "is empty: a header such as t_s,arm_rpm,… is missing")])
    problems = [
        Problem(f"{label}:1", f"column {index + 1} has no name")
        for index, name in enumerate(names)
        if not name
    ]
    problems += [
        Problem(f"{label}:1", f"the column {plain(name)} stands {names.count(name)} times")
        for name in dict.fromkeys(names)
        if name and names.count(name) > 1
    ]
    if problems:
        raise ProfileError(problems)
    rest = text[stream.tell() :]
    return Header(label, names, rest, reader.line_num)


def read_columns(header: Header, wanted: Sequence[str], may_lack: Sequence[str] = ()) -> Floats:
    """Read the numbers of some columns.

    Parameters
    ----------
    header : Header
    wanted : sequence of str
        Names of the file's columns.
    may_lack : sequence of str
        Those of them whose cells may be empty; they become not a number.

    Returns
    -------
    (n, k) array
        A column each, n >= 1.

    Raises
    ------
    ProfileError
        With every row that is not as long as the header or holds something
        else than finite numbers.
    """
    places = [header.names.index(name) for name in wanted]
    values = _read_fast(header, places)
    if values is None:
        values = _read_slowly(header, places, [name in may_lack for name in wanted])
    return values


def _read_fast(header: Header, places: Sequence[int]) -> Floats | None:
    """Read with numpy's C reader, or return None where it is not sure to be right."""
    body = header.text.rstrip("\r\n")
    # Quotes, lone CRs and whatever numpy might take for a number are left to the careful reader.
    if not body or re.search(r"[^0-9eE.+\-,\r\n \t]|\r(?!\n)", body):
        return None
    try:
        values = np.loadtxt(io.StringIO(body), delimiter=",", comments=None, ndmin=2)
    except ValueError:
        return None
    if values.shape != (body.count("\n") + 1, len(header.names)):
        return None
    chosen = np.ascontiguousarray(values[:, places])
    return chosen if np.isfinite(chosen).all() and len(chosen) <= MAX_SAMPLES else None


def _read_slowly(header: Header, places: Sequence[int], may_lack: Sequence[bool]) -> Floats:
    problems: list[Problem] = []
    rows: list[list[float]] = []
    unsaid = 0
    for line, cells in _rows(header, problems):
        found = _row_problems(header, cells, places, may_lack)
        unsaid += len(found) if len(problems) >= _WORTH_TELLING else 0
        if len(problems) < _WORTH_TELLING:
            problems += [Problem(f"{header.label}:{line}", what) for what in found]
        if not problems:
            rows.append([_number(cells[place]) for place in places])
            if len(rows) > MAX_SAMPLES:
                raise ProfileError([Problem(header.label, f"has more than {MAX_SAMPLES} rows")])
    if not rows and not problems:
        problems.append(Problem(header.label, "has a header but no rows"))
    if unsaid:
        problems.append(Problem(header.label, f"… and {unsaid} more cells or rows like these"))
    if problems:
        raise ProfileError(problems)
    return np.array(rows)


def _rows(header: Header, problems: list[Problem]) -> Iterator[tuple[int, list[str]]]:
    """Iterate over the rows with their line numbers; blank lines at the end are none."""
    reader = csv.reader(io.StringIO(header.text, newline=""), strict=True)
    blank: list[int] = []
    first = header.lines + 1
    while True:
        line = first + reader.line_num
        try:
            cells = next(reader)
        except StopIteration:
            return
        except csv.Error as error:
            problems.append(Problem(f"{header.label}:{line}", f"is not a CSV row: {error}"))
            return
        if not cells or (len(cells) == 1 and not cells[0].strip() and len(header.names) > 1):
            blank.append(line)
            continue
        for empty in blank[:_WORTH_TELLING]:
            problems.append(Problem(f"{header.label}:{empty}", "is a blank line between rows"))
        blank.clear()
        yield line, cells


def _row_problems(
    header: Header, cells: Sequence[str], places: Sequence[int], may_lack: Sequence[bool]
) -> list[str]:
    if len(cells) != len(header.names):
        return [f"has {len(cells)} cells, the header has {len(header.names)}"]
    found = []
    for place, optional in zip(places, may_lack, strict=True):
        cell, name = cells[place], plain(header.names[place])
        if not cell.strip() or cell.strip().lower() == "nan":
            if not optional:
                found.append(f"{name}: is missing" if not cell.strip() else f"{name}: is nan")
        elif not _NUMBER.fullmatch(cell):
            found.append(f"{name}: must be a number, is {shown(cell)}")
        elif not math.isfinite(float(cell)):
            found.append(f"{name}: {shown(cell)} is too large for a number")
    return found


def _number(cell: str) -> float:
    return float(cell) if cell.strip() else math.nan
