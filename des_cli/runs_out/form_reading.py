"""Rows read back from the bytes of a form, by code that does not share the writer's.

What is read is what a form holds of each row as numbers: the columns of a table; of a trajectory
the time in nanoseconds and nine numbers; of a recording its rows.
"""

from __future__ import annotations

import json
import struct
import zipfile
import zlib
from io import BytesIO
from typing import Any

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.runs_out.forms import Form

_BROKEN = (zipfile.BadZipFile, zlib.error, struct.error)
"""What libraries raise at bytes that were cut."""


class UnlikeFormError(Exception):
    """Why bytes are not in a form, a part of a sentence."""


def read_rows(data: bytes, form: Form) -> Floats:
    """Return the numbers of each row, (n, m).

    Raises
    ------
    UnlikeFormError
        If the bytes are not in the form.
    """
    reader = _READERS[form.kind]
    try:
        return np.array(reader(data, form), dtype=np.float64)
    except (ValueError, LookupError, TypeError, EOFError, OSError, *_BROKEN) as error:
        raise UnlikeFormError(f"it does not read back as {form.kind}") from error


def _csv(data: bytes, form: Form) -> Any:
    lines = data.decode("ascii").split("\n")
    if lines.pop():
        raise UnlikeFormError("its last line does not end: it was cut")
    if form.header and lines.pop(0).split(form.separator) != [c.header for c in form.columns]:
        raise UnlikeFormError("its header is another")
    if form.unit_row:
        lines.pop(0)
    cells = [line.split(form.separator) for line in lines]
    return [[float(cell) for cell in row] for row in cells]


def _objects(data: bytes, form: Form) -> Any:
    text = data if form.kind == "json" else b"[" + b",".join(data.splitlines()) + b"]"
    names = [column.header for column in form.columns]
    return [[row[name] for name in names] for row in json.loads(text)]


def _parquet(data: bytes, form: Form) -> Any:
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = pq.read_table(pa.BufferReader(data), use_threads=False, pre_buffer=False)
    if table.column_names != [column.header for column in form.columns]:
        raise UnlikeFormError("its columns are others")
    return np.column_stack([column.to_numpy() for column in table.columns])


def _trajectory(data: bytes, form: Form) -> Any:
    rows = []
    _, _, points = data.decode("ascii").partition("\npoints:\n")
    for line in points.splitlines():
        point = json.loads(line.removeprefix("- "))
        time = point["time_from_start"]
        rows.append(
            [
                time["sec"] * 1_000_000_000 + time["nanosec"],
                *point["positions"],
                *point["velocities"],
                *point["accelerations"],
            ]
        )
    return rows


def _spreadsheet(data: bytes, form: Form) -> Any:
    from openpyxl import load_workbook

    book = load_workbook(BytesIO(data), read_only=True)
    names, *rows = book.worksheets[0].iter_rows(values_only=True)
    book.close()
    if list(names) != [column.header for column in form.columns]:
        raise UnlikeFormError("its first row are other names")
    return rows


def _recording(data: bytes, form: Form) -> Any:
    from mcap.exceptions import McapError
    from mcap.reader import make_reader

    from des_cli.runs_out.recording import ROW, ROWS

    try:
        messages = make_reader(BytesIO(data)).iter_messages(topics=[ROWS])
        rows = [json.loads(message.data) for _, _, message in messages]
    except McapError as error:
        raise UnlikeFormError("it does not read back as mcap") from error
    return [[row[column.name] for column in ROW] for row in rows]


_READERS = {
    "csv": _csv,
    "ndjson": _objects,
    "json": _objects,
    "parquet": _parquet,
    "ros2": _trajectory,
    "xlsx": _spreadsheet,
    "mcap": _recording,
}
