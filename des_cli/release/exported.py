"""Rows in the form of another program: made, measured, and read back before they get a name."""

from __future__ import annotations

import numpy as np

from des_cli.errors import Complaint, NotReleasedError
from des_cli.model.arrays import Floats
from des_cli.model.command_table import CommandTable
from des_cli.model.joint_rows import JointRows
from des_cli.model.run import Run
from des_cli.release.clocked import Clock
from des_cli.release.gate import require_table
from des_cli.release.playback import Playback
from des_cli.runs_out.form_bytes import encode_rows
from des_cli.runs_out.form_reading import UnlikeFormError, read_rows
from des_cli.runs_out.forms import Form
from des_cli.runs_out.row_text import column_values, values_of
from des_cli.runs_out.tables import command_columns, encode_table

UNEVEN = 1e-6
"""Relative difference of steps from which rows without a time are not evenly spaced."""

SPREADSHEET_DIGITS = 1e-15
"""Relative error of the numbers in a spreadsheet, which have sixteen digits there."""


class Export:
    """Rows of a table in a form, and whether bytes are they.

    Parameters
    ----------
    playback : Playback
        The table and its machine, under the name that messages call it.
    form : Form
    enforced : bool
        Whether rows at other times are to keep the limits.

    Raises
    ------
    NotReleasedError
        If they do not, or if rows without a time are not evenly spaced.
    FileAccessError
        If there are more rows than the form has room for.
    """

    def __init__(self, playback: Playback, form: Form, *, enforced: bool = True) -> None:
        self.name, self.form = playback.label, form
        self.rows = _rows(playback, form, enforced=enforced)
        if not form.timed:
            _require_even(self.name, self.rows)
        self.data = encode_rows(self.rows, form, playback.machine, playback.seat)

    def require(self, data: bytes) -> None:
        """Raise unless bytes, as they were read back, hold the rows.

        Raises
        ------
        NotReleasedError
        """
        try:
            found = read_rows(data, self.form)
        except UnlikeFormError as error:
            raise _wrong(self.name, str(error)) from error
        right = _expected(self.rows, self.form)
        if found.shape != right.shape:
            raise _wrong(self.name, f"it has {len(found)} rows, not {len(right)}")
        allowed = SPREADSHEET_DIGITS * np.abs(right) if self.form.kind == "xlsx" else 0.0
        bad = np.flatnonzero(np.any(~(np.abs(found - right) <= allowed), axis=1))
        if bad.size:
            raise _wrong(self.name, f"row {bad[0] + 1} holds other numbers")


def export_of_run(run: Run, form: Form, fail_on: frozenset[str] = frozenset()) -> Export:
    """Return the command table of a run in a form, after the gate of any table.

    Parameters
    ----------
    run : Run
    form : Form
    fail_on : frozenset of str
        Names of notices with which it is not to be released.

    Raises
    ------
    NotReleasedError
        With everything that is wrong.
    """
    require_table(run, encode_table(command_columns(run), "csv"), fail_on)
    playback = Playback(
        CommandTable.of_motion(run.commands),
        run.profile.machine,
        run.seat,
        float(run.commands.angle[0, 0]),
        run.profile.name,
    )
    enforced = run.profile.reduction.limits != "warn"
    return Export(playback, form, enforced=enforced)


def _rows(playback: Playback, form: Form, *, enforced: bool) -> JointRows:
    if form.hz is None:
        return playback.own_rows(bounded=enforced)
    clocked = playback.on(Clock(form.hz))
    if enforced and clocked.failed:
        raise NotReleasedError(
            [Complaint(playback.label, f"at {form.hz:g} Hz: {check}") for check in clocked.failed]
        )
    return clocked.rows


def _require_even(name: str, rows: JointRows) -> None:
    step = np.diff(rows.t)
    if np.max(np.abs(step - np.mean(step))) > UNEVEN * np.mean(step):
        what = "its rows are not evenly spaced, and this form tells no times: give --hz"
        raise NotReleasedError([Complaint(name, what)])


def _expected(rows: JointRows, form: Form) -> Floats:
    """Return what `read_rows` is to find."""
    if form.kind == "ros2":
        time = np.rint((rows.t - rows.t[0]) * 1e9)
        return np.column_stack([time, rows.angle, rows.rate, rows.acceleration])
    if form.kind == "mcap":
        from des_cli.runs_out.recording import ROW

        return np.column_stack([column_values(rows, column.name) for column in ROW])
    return values_of(rows, form)


def _wrong(name: str, what: str) -> NotReleasedError:
    return NotReleasedError([Complaint(name, f"what was written is wrong: {what}")])
