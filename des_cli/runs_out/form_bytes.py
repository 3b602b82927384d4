"""Rows of joints in the bytes of a form."""

from __future__ import annotations

from des_cli.model.joint_rows import JointRows
from des_cli.model.machine import Machine, Seat
from des_cli.runs_out.forms import Form
from des_cli.runs_out.row_text import header_lines, row_lines, values_of
from des_cli.runs_out.tables import encode_table


def encode_rows(rows: JointRows, form: Form, machine: Machine, seat: Seat) -> bytes:
    """Return the bytes of rows in a form.

    Parameters
    ----------
    rows : JointRows
    form : Form
    machine, seat : Machine, Seat
        Whose frames a recording shows.

    Raises
    ------
    NotReleasedError
        If a value is not a finite number.
    FileAccessError
        If there are more rows than the form has room for.
    """
    match form.kind:
        case "csv":
            return header_lines(form) + b"".join(row_lines(rows, form))
        case "ros2":
            from des_cli.runs_out.trajectory_message import encode_trajectory

            return encode_trajectory(rows)
        case "xlsx":
            from des_cli.runs_out.spreadsheet import encode_spreadsheet

            return encode_spreadsheet(rows, form)
        case "mcap":
            from des_cli.runs_out.recording import encode_recording

            return encode_recording(rows, machine, seat)
    names = [column.header for column in form.columns]
    return encode_table(dict(zip(names, values_of(rows, form).T, strict=True)), form.kind)
