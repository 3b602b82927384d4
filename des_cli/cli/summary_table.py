"""How a batch ended: a table with a line a run, and one line for all."""

from __future__ import annotations

from collections.abc import Sequence

from des_cli.batch.summary import SummaryRow
from des_cli.cli.console import Console
from des_cli.errors import ExitCode
from des_cli.show.words import CONSOLE

_HEAD: tuple[str, ...] = (
    *("profile", "status", "cross-coupling", "seat rate off", "G off (g rms)"),
    *("turning peak", "exit"),
)


def print_table(console: Console, rows: Sequence[SummaryRow]) -> None:
    """Print a line for each run, under a header; nothing of a batch that was only planned."""
    if all(row.state == "planned" for row in rows):
        return
    lines = [_HEAD, *(_cells(row) for row in rows)]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    for at, cells in enumerate(lines):
        name, status, *numbers = (
            f"{cell:<{width}}" if column < 2 else f"{cell:>{width}}"
            for column, (cell, width) in enumerate(zip(cells, widths, strict=True))
        )
        look = "faint" if at == 0 else "error" if rows[at - 1].exit_code else "plain"
        console.say(console.style("  ".join([name, status, *numbers]), look))


def print_closing(console: Console, rows: Sequence[SummaryRow], planned: int) -> None:
    """Print how a batch ended, in one line."""
    failed = sum(bool(row.exit_code) for row in rows)
    kept = sum(row.state == "kept" for row in rows)
    dry = sum(row.state == "planned" for row in rows)
    missing = planned - len(rows)
    parts = [
        f"{count} {what}"
        for count, what in (
            (len(rows) - failed - kept - dry, "done"),
            (dry, "would be done"),
            (kept, "already done"),
            (failed, "failed"),
            (missing, "not run"),
        )
        if count
    ]
    hint = " (--keep-going runs them all)" if missing else ""
    text = f"{planned} profiles: {', '.join(parts)}{hint}"
    console.say(console.style(text, "error" if failed else "good"))


def _cells(row: SummaryRow) -> tuple[str, ...]:
    """Return a run in the columns of the table; what it has not is a dash."""
    peak = row.seat_angular_acceleration_peak_ratio
    rate, force = row.seat_rate_deviation_relative, row.seat_g_rms_error_g
    return (
        row.name or row.source,
        _status(row),
        "-" if row.vector_reduction is None else CONSOLE.less(row.vector_reduction),
        "-" if rate is None else CONSOLE.percent(rate),
        "-" if force is None else CONSOLE.number(force),
        "-" if peak is None else f"{CONSOLE.fixed(peak, 2)} times",
        str(row.exit_code),
    )


def _status(row: SummaryRow) -> str:
    if row.state == "failed":
        # The solver may have converged, and its answer was refused.
        known = ExitCode(row.exit_code).name.lower().replace("_", " ")
        return {ExitCode.FILE: "failed", ExitCode.PROFILE: "rejected"}.get(
            ExitCode(row.exit_code), known
        )
    return f"{row.status or row.state}{', kept' if row.state == 'kept' and row.status else ''}"
