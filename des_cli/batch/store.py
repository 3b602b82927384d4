"""The runs of a batch, added to a store as they end."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from des_cli.batch.job import JobResult

_ROWS_A_PART = 500
"""Rows that are kept in memory at the most."""


class StoreWriter:
    """Takes results, and writes a part whenever there are enough.

    Parameters
    ----------
    store : Path
    """

    def __init__(self, store: Path) -> None:
        self._store = store
        self._rows: list[dict[str, Any]] = []

    def add(self, result: JobResult) -> None:
        """Note a run; what has no run is passed over."""
        if not result.ok or result.metrics is None or result.state == "planned":
            return
        from des_cli.results.reading import read_metrics
        from des_cli.runs_out.store import MACHINE, flat_metrics

        machine = read_metrics(result.metrics).profile.machine or "unknown"
        told = {"source": result.source, "folder": result.written, MACHINE: machine}
        self._rows.append({**told, **flat_metrics(result.metrics)})
        if len(self._rows) >= _ROWS_A_PART:
            self.flush()

    def flush(self) -> None:
        """Write what was noted."""
        from des_cli.runs_out.store import append_rows

        rows, self._rows = self._rows, []
        if rows:
            append_rows(self._store, rows)


@contextmanager
def storing(store: str | None) -> Iterator[StoreWriter | None]:
    """Offer what takes the results of a batch, also of one that is stopped."""
    if store is None:
        yield None
        return
    writer = StoreWriter(Path(store))
    try:
        yield writer
    finally:
        writer.flush()
