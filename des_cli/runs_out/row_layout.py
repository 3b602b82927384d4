"""Rows of joints as lines of text: which columns, in which units, with what between them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.joint_rows import JointRows
from des_cli.model.machine import JOINTS
from des_cli.runs_out.table_reading import COLUMNS
from des_cli.units import split_unit

# Rows turned into text at a time: a line is to wait for few others.
_ROWS_AT_ONCE = 64


@dataclass(frozen=True)
class Column:
    """A column of numbers.

    Parameters
    ----------
    name : str
        A quantity with its unit, as in ``fork_deg_s``; see `column_values`.
    header : str
        What the header calls it.
    """

    name: str
    header: str


@dataclass(frozen=True)
class Layout:
    """How rows are written.

    Parameters
    ----------
    columns : tuple of Column
    separator : str
    header : bool
        Whether a line of names comes first.
    """

    columns: tuple[Column, ...]
    separator: str = ","
    header: bool = True


COMMANDS = Layout(tuple(Column(name, name) for name in COLUMNS))
"""Of a command table."""


def column_values(rows: JointRows, name: str) -> Floats:
    """Return what a column holds, (n,), in the unit of its name.

    Parameters
    ----------
    rows : JointRows
    name : str
        ``t``, or a joint, and a unit of time; of an angle, a rate or an acceleration.

    Raises
    ------
    KeyError
        If there is no such column.
    """
    stem, unit = split_unit(name)
    if unit is None:
        raise KeyError(name)
    if stem == "t" and unit.quantity == "time":
        return rows.t / unit.to_si
    quantities = {"angle": rows.angle, "rate": rows.rate, "acceleration": rows.acceleration}
    if stem not in JOINTS or unit.quantity not in quantities:
        raise KeyError(name)
    return np.asarray(quantities[unit.quantity][:, JOINTS.index(stem)] / unit.to_si)


def header_line(layout: Layout) -> bytes:
    """Return the line above the rows; empty where there is none."""
    if not layout.header:
        return b""
    return (layout.separator.join(column.header for column in layout.columns) + "\n").encode()


def row_lines(rows: JointRows, layout: Layout = COMMANDS) -> Iterator[bytes]:
    """Yield a line for each row, of the shortest texts that read back the same doubles.

    Parameters
    ----------
    rows : JointRows
    layout : Layout
    """
    values = np.column_stack([column_values(rows, column.name) for column in layout.columns])
    for start in range(0, len(values), _ROWS_AT_ONCE):
        block: Sequence[list[float]] = values[start : start + _ROWS_AT_ONCE].tolist()
        for row in block:
            yield (layout.separator.join(map(repr, row)) + "\n").encode()
