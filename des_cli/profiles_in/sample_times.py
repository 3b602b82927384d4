"""The times of recorded samples, in seconds without loss of digits."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

import numpy as np

from des_cli.errors import Complaint
from des_cli.model.arrays import Floats
from des_cli.profiles_in.clock import ClockError, is_clock, seconds_of
from des_cli.profiles_in.column_kinds import Column
from des_cli.profiles_in.csv_header import Header
from des_cli.profiles_in.csv_table import Rows, column_text
from des_cli.profiles_in.wording import plain

LARGE = 1e6
"""Times from here on [s] are counted from the first one: an epoch in doubles keeps
no more than a tenth of a microsecond, and the steps between samples are what counts."""


@dataclass(frozen=True)
class SampleTimes:
    """The times of the samples of a file.

    Parameters
    ----------
    t : (n,) array
        [s]
    recorded : (n,) array
        In the unit of the file.
    cells : list of str, optional
        As the file has them, where that is another number than `recorded`.
    """

    t: Floats
    recorded: Floats
    cells: list[str] | None = None

    def written(self, row: int) -> str:
        """Return a time as the file has it, with all its digits."""
        if self.cells is not None:
            return self.cells[row].strip()
        return repr(float(self.recorded[row])).removesuffix(".0")


def sample_times(
    header: Header,
    column: Column,
    recorded: Floats,
    rows: Rows,
    complaints: list[Complaint],
    remarks: list[str],
) -> SampleTimes | None:
    """Return the times of samples, or None after saying what is wrong.

    Parameters
    ----------
    header : Header
    column : Column
        The one that holds the times.
    recorded : (n,) array
        Its numbers; not a number where it holds a time of day or a date.
    rows : Rows
        Where each of them stands.
    complaints, remarks : list
        Take what is wrong, and what was done.
    """
    if np.isnan(recorded).any():
        return _clock_times(header, column, recorded, rows, complaints, remarks)
    assert column.unit is not None, "a column of numbers was chosen by its unit"
    with np.errstate(over="ignore"):  # what is infinite is too long
        t = recorded * column.unit.to_si
    if np.max(np.abs(t)) < LARGE:
        return SampleTimes(t, recorded)
    cells = column_text(header, column.place)
    exact = [Decimal(header.dialect.number(cell)) for cell in cells]
    # The table's factor as it is meant: 1e-9 and not the double next to it.
    factor = Decimal(repr(column.unit.to_si))
    t = np.array([float((value - exact[0]) * factor) for value in exact])
    remarks.append(f"times are counted from the first, {cells[0].strip()} {column.unit.suffix}")
    return SampleTimes(t, recorded, cells)


def _clock_times(
    header: Header,
    column: Column,
    recorded: Floats,
    rows: Rows,
    complaints: list[Complaint],
    remarks: list[str],
) -> SampleTimes | None:
    cells = column_text(header, column.place)
    name = plain(column.in_file)
    numbers = [row for row, cell in enumerate(cells) if not is_clock(cell)]
    try:
        if numbers:
            # Of two kinds, the second one to come is the odd one.
            row = next(
                row for row, cell in enumerate(cells) if is_clock(cell) != is_clock(cells[0])
            )
            raise ClockError(row, f"is not written as the first time, {cells[0].strip()}")
        seconds, turns = seconds_of(cells)
    except ClockError as error:
        where = f"{header.label}:{rows.lines[error.row]}"
        complaints.append(Complaint(where, f"{name}: {cells[error.row].strip()} {error}"))
        return None
    remarks.append(f"times are counted from the first, {cells[0].strip()}")
    if turns:
        remarks.append(f"the clock starts anew {turns} time{'s' * (turns > 1)}: the time goes on")
    return SampleTimes(np.array(seconds), recorded, cells)
