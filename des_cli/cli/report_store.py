"""``report --store``: the runs of a store that fulfil a condition."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from des_cli.batch.source import STANDARD_STREAM
from des_cli.cli.console import Console
from des_cli.cli.outputs import files_held
from des_cli.cli.stdout import write_data, write_line

_SHOWN = {
    "profile.name": "profile",
    "machine": "machine",
    "solver.status": "status",
    "coriolis.vector.reduction": "vector reduction",
    "fidelity.seat_rate_deviation_relative": "seat rate",
    "fidelity.seat_g_rms_error_g": "G rms [g]",
    "fidelity.seat_angular_acceleration_peak_ratio": "turning peak",
    "folder": "folder",
}
"""The columns that a person sees, and their titles."""

_AT_ONCE = 1000
"""Rows of which the widths of columns are taken together."""


def list_store(
    console: Console, store: str, where: str | None, out: str | None, *, overwrite: bool = False
) -> None:
    """Print or write the runs of a store.

    Parameters
    ----------
    console : Console
    store : str
        Its folder.
    where : str, optional
        A condition.
    out : str, optional
        A file for CSV, or ``-``; None is stdout, on a terminal as aligned text.
    overwrite : bool
        Whether a file that exists may be replaced.
    """
    from des_cli.runs_out.store import read_rows
    from des_cli.runs_out.store_filter import parse_condition

    condition = None if where is None else lambda kinds: parse_condition(where, kinds)
    columns, rows = read_rows(Path(store), condition)
    counted = _Counted(rows)
    if out is None and sys.stdout is not None and sys.stdout.isatty():
        for line in _lines(counted):
            write_line(line)
    elif out in (None, STANDARD_STREAM):
        for data in _csv(columns, counted):
            write_data(data)
    else:
        from des_cli.runs_out.atomic import write_file

        with files_held([str(out)], overwrite):
            write_file(str(out), b"".join(_csv(columns, counted)), overwrite=overwrite)
    console.say("1 run" if counted.count == 1 else f"{counted.count} runs")


class _Counted:
    """Rows, counted as they pass."""

    def __init__(self, rows: Iterable[Mapping[str, Any]]) -> None:
        self._rows, self.count = rows, 0

    def __iter__(self) -> Iterator[Mapping[str, Any]]:
        for row in self._rows:
            self.count += 1
            yield row


def _csv(columns: Sequence[str], rows: Iterable[Mapping[str, Any]]) -> Iterator[bytes]:
    from des_cli.runs_out.mixed_csv import encode_mixed_csv

    yield encode_mixed_csv(columns, [])
    for row in rows:
        yield encode_mixed_csv(columns, [row]).split(b"\n", 1)[1]


def _lines(rows: Iterable[Mapping[str, Any]]) -> Iterator[str]:
    """Yield aligned lines, a head above every so many."""
    pending: list[Sequence[str]] = []
    for row in rows:
        pending.append([_cell(row.get(name)) for name in _SHOWN])
        if len(pending) == _AT_ONCE:
            yield from _aligned(pending)
            pending = []
    if pending:
        yield from _aligned(pending)


def _aligned(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    table = [tuple(_SHOWN.values()), *rows]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for cells in table:
        padded = (f"{cell:<{width}}" for cell, width in zip(cells, widths, strict=True))
        yield "  ".join(padded).rstrip()


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value)
