"""A command table read back from its bytes, as strictly as it was written.

This is no reader of profiles: what the tool writes has one spelling, and what is spelled
otherwise, or was cut, is not what was written. Nothing is skipped, guessed or repaired.
"""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np

from des_cli.errors import Complaint, NotReleasedError
from des_cli.model.arrays import Floats
from des_cli.model.command_table import CommandTable
from des_cli.runs_out.tables import LONG_TABLE
from des_cli.units import split_unit

COLUMNS = ("t_s", "arm_rpm", "fork_deg", "cab_deg")
"""Names of the columns, in their order; the unit is a part of the name."""

_NUMBER = rb"-?[0-9]+(?:\.[0-9]+)?(?:e[+-][0-9]+)?"
_ROW = re.compile(rb"%b(?:,%b){%d}" % (_NUMBER, _NUMBER, len(COLUMNS) - 1))
_PARQUET = b"PAR1"

_SIGNS = b"0123456789.e+-,\n"
_UNFINISHED = (b".,", b".\n", b".e", b",.", b"\n.", b"-.")
"""What Arrow takes for a number and `_NUMBER` does not: one that begins or ends with the point."""


def parse_command_table(data: bytes, label: str) -> CommandTable:
    """Read a command table in any of the formats that are written.

    Parameters
    ----------
    data : bytes
        CSV, NDJSON, JSON or Parquet; which of them shows at its first bytes.
    label : str
        What messages call it.

    Raises
    ------
    NotReleasedError
        If it is not spelled as it would be written, names other columns, has fewer than
        two rows, or holds what is not a finite number.
    """
    try:
        columns = _columns(data)
    except _UnlikeError as error:
        raise NotReleasedError([Complaint(label, f"is no command table: {error}")]) from None
    si = [columns[:, i] * _to_si(name) for i, name in enumerate(COLUMNS)]
    return CommandTable(si[0], si[1], np.column_stack(si[2:]))


class _UnlikeError(Exception):
    """Why bytes are no command table, a part of a sentence."""


def _columns(data: bytes) -> Floats:
    if data.startswith(_PARQUET):
        columns = _parquet(data)
    elif data.startswith(b"["):
        columns = _json(b"\n".join(_lines(data)))
    elif data.startswith(b"{"):
        columns = _json(b"[" + b",".join(_lines(data)) + b"]")
    else:
        columns = _csv(data)
    if len(columns) < 2:
        raise _UnlikeError("it has fewer than two rows")
    bad = np.flatnonzero(~np.all(np.isfinite(columns), axis=1))
    if bad.size:
        raise _UnlikeError(f"row {bad[0] + 1} holds a number that is not finite")
    return columns


def _require_end(data: bytes) -> None:
    if not data.endswith(b"\n"):
        raise _UnlikeError("its last line does not end: it was cut")


def _lines(data: bytes) -> list[bytes]:
    """Return the lines; the last one must end."""
    _require_end(data)
    return data[:-1].split(b"\n")


def _csv(data: bytes) -> Floats:
    _require_end(data)
    header = ",".join(COLUMNS).encode()
    if not data.startswith(header + b"\n"):
        raise _UnlikeError(f"its first line is not {','.join(COLUMNS)}")
    if data.count(b"\n") > LONG_TABLE and (columns := _long_csv(data[len(header) :])) is not None:
        return columns
    _, *rows = _lines(data)
    for number, row in enumerate(rows, start=1):
        if not _ROW.fullmatch(row):
            raise _UnlikeError(f"row {number} is not {len(COLUMNS)} plain numbers between commas")
    if not rows:
        return np.empty((0, len(COLUMNS)))
    numbers = [float(text) for text in b",".join(rows).split(b",")]
    return np.array(numbers).reshape(-1, len(COLUMNS))


def _long_csv(rows: bytes) -> Floats | None:
    """Read the rows by Arrow, or return None where one is not spelled as it would be written.

    Parameters
    ----------
    rows : bytes
        With the end of the header's line.
    """
    # Imported here: it costs a tenth of a second that a short table does not need.
    import pyarrow as pa
    import pyarrow.csv as pc

    plus = rows.count(b"e+")
    signed = plus + rows.count(b"e-") == rows.count(b"e") and plus == rows.count(b"+")
    if rows.translate(None, _SIGNS) or not signed or any(odd in rows for odd in _UNFINISHED):
        return None
    try:
        table = pc.read_csv(
            pa.BufferReader(memoryview(rows)[1:]),
            read_options=pc.ReadOptions(use_threads=False, column_names=COLUMNS),
            parse_options=pc.ParseOptions(quote_char=False, ignore_empty_lines=False),
            convert_options=pc.ConvertOptions(
                column_types=dict.fromkeys(COLUMNS, pa.float64()), null_values=[]
            ),
        )
    except (pa.ArrowException, ValueError):
        return None
    return np.column_stack([column.to_numpy() for column in table.columns])


def _json(data: bytes) -> Floats:
    try:
        # Pairs, so that a name that stands twice is seen.
        rows: Any = json.loads(data, object_pairs_hook=tuple)
    except (ValueError, RecursionError):
        raise _UnlikeError("it is not the JSON of rows") from None
    for number, row in enumerate(rows, start=1):
        named = isinstance(row, tuple) and tuple(name for name, _ in row) == COLUMNS
        if not named or not all(type(value) is float for _, value in row):
            raise _UnlikeError(f"row {number} is not an object of numbers {', '.join(COLUMNS)}")
    return np.array([[value for _, value in row] for row in rows]).reshape(-1, len(COLUMNS))


def _parquet(data: bytes) -> Floats:
    # Imported here: it costs a tenth of a second that a CSV table does not need.
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        # Without threads of its own: one that still ends when the process does aborts it.
        table = pq.read_table(pa.BufferReader(data), use_threads=False, pre_buffer=False)
    except (pa.ArrowException, OSError, ValueError) as error:
        raise _UnlikeError("it is not Parquet") from error
    if tuple(table.column_names) != COLUMNS:
        raise _UnlikeError(f"its columns are not {', '.join(COLUMNS)}")
    if any(column.type != pa.float64() or column.null_count for column in table.columns):
        raise _UnlikeError("its columns are not doubles throughout")
    return np.column_stack([column.to_numpy() for column in table.columns])


def _to_si(name: str) -> float:
    unit = split_unit(name)[1]
    assert unit is not None, name
    return unit.to_si
