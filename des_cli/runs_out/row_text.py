"""Rows of joints as lines of text, in a form of columns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.joint_rows import JointRows
from des_cli.model.machine import JOINTS
from des_cli.runs_out.forms import TIMES, Form
from des_cli.units import split_unit

NANO_DIGITS = 9
"""Of seconds, to which the time since the first row is rounded."""

# Rows turned into text at a time: a line is to wait for few others.
_ROWS_AT_ONCE = 64


def column_values(rows: JointRows, name: str, start: float | None = None) -> Floats:
    """Return what a column holds, (n,), in the unit of its name.

    Parameters
    ----------
    rows : JointRows
    name : str
        See ``forms.is_column``.
    start : float, optional
        When the first row of all is [s], where these are not the first.
    """
    stem, unit = split_unit(name)
    assert unit is not None, name
    if stem in TIMES:
        if stem == "t":
            return rows.t / unit.to_si
        elapsed = np.round(rows.t - (rows.t[0] if start is None else start), NANO_DIGITS)
        # Once more, so that whole milliseconds are whole numbers.
        return np.round(elapsed / unit.to_si, NANO_DIGITS)
    quantities = {"angle": rows.angle, "rate": rows.rate, "acceleration": rows.acceleration}
    return np.asarray(quantities[unit.quantity][:, JOINTS.index(stem)] / unit.to_si)


def values_of(rows: JointRows, form: Form, start: float | None = None) -> Floats:
    """Return all columns of a form, (n, m)."""
    return np.column_stack([column_values(rows, column.name, start) for column in form.columns])


def header_lines(form: Form) -> bytes:
    """Return the lines above the rows; empty where there are none."""
    lines = []
    if form.header:
        lines.append(form.separator.join(column.header for column in form.columns))
    if form.unit_row:
        lines.append(form.separator.join(_unit_label(column.name) for column in form.columns))
    return "".join(line + "\n" for line in lines).encode()


def row_lines(rows: JointRows, form: Form, start: float | None = None) -> Iterator[bytes]:
    """Yield a line for each row, of the shortest texts that read back the same doubles.

    Parameters
    ----------
    rows : JointRows
    form : Form
        Of kind ``csv``.
    start : float, optional
        As of `column_values`.
    """
    values = values_of(rows, form, start)
    counts = [split_unit(column.name)[0] == "elapsed" for column in form.columns]
    texts = [_count if counted else repr for counted in counts]
    for begin in range(0, len(values), _ROWS_AT_ONCE):
        block: Sequence[list[float]] = values[begin : begin + _ROWS_AT_ONCE].tolist()
        for row in block:
            cells = (text(value) for text, value in zip(texts, row, strict=True))
            yield (form.separator.join(cells) + "\n").encode()


def _count(value: float) -> str:
    """Write a time since the first row: whole ones as counts, for who reads only these."""
    return str(int(value)) if value.is_integer() else repr(value)


def _unit_label(name: str) -> str:
    """Write a unit as Simulink reads it below the name of a signal; none below the time.

    >>> _unit_label("fork_rad_s2"), _unit_label("elapsed_s")
    ('Unit: rad/s^2', '')
    """
    stem, _ = split_unit(name)
    if stem in TIMES:
        return ""
    unit = name.removeprefix(f"{stem}_").replace("_s2", "/s^2").replace("_s", "/s")
    return f"Unit: {unit}"
