"""Rows of numbers and words, with gaps, as CSV that programs and spreadsheets read alike."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from typing import Any

_FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""How a text begins that a spreadsheet would compute; numbers are written as they are."""


def encode_mixed_csv(columns: Sequence[str], rows: Sequence[Mapping[str, Any]]) -> bytes:
    r"""Return rows as CSV.

    What is not known is an empty cell, a truth ``true`` or ``false``, and a number its
    shortest exact form.

    >>> encode_mixed_csv(["name", "share"], [{"name": "=a", "share": 0.5}, {"name": "b, c",
    ...     "share": None}])
    b'name,share\n\'=a,0.5\n"b, c",\n'
    """
    stream = io.StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_cell(row[name]) for name in columns] for row in rows)
    return stream.getvalue().encode()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f"'{value}" if value.startswith(_FORMULA) else value
    return float.__repr__(value) if isinstance(value, float) else str(value)
