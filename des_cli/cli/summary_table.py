"""How a batch ended: a table with a line a run, and one line for all."""

from __future__ import annotations

from collections.abc import Sequence

from des_cli.batch.summary import SummaryRow
from des_cli.cli.console import Console
from des_cli.errors import ExitCode
from des_cli.show.words import CONSOLE

_HEADS: tuple[tuple[str, ...], ...] = (
    ("", "", "cross-", "seat rate", "G off", "turning", ""),
    ("profile", "status", "coupling", "off", "[g rms]", "peak", "exit"),
)
"""Two lines, so that the table of usual names fits 80 columns."""


def print_table(console: Console, rows: Sequence[SummaryRow]) -> None:
    """Print a line for each run, under a header; nothing of a batch that was only planned."""
    if console.log_format == "json" or all(row.state == "planned" for row in rows):
        return  # a program was told each
    lines = [*_HEADS, *(_cells(row) for row in rows)]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    for at, cells in enumerate(lines):
        name, status, *numbers = (
            f"{cell:<{width}}" if column < 2 else f"{cell:>{width}}"
            for column, (cell, width) in enumerate(zip(cells, widths, strict=True))
        )
        run = at - len(_HEADS)
        look = "faint" if run < 0 else "error" if rows[run].exit_code else "plain"
        console.table(console.style("  ".join([name, status, *numbers]).rstrip(), look))


def print_closing(console: Console, rows: Sequence[SummaryRow], planned: int) -> None:
    """Print how a batch ended, in one line."""
    failed = sum(bool(row.exit_code) for row in rows)
    kept = sum(row.state == "kept" for row in rows)
    dry = sum(row.state == "planned" for row in rows)
    missing = planned - len(rows)
    counts = {
        "done": len(rows) - failed - kept - dry,
        "would be done": dry,
        "already done": kept,
        "failed": failed,
        "not run": missing,
    }
    parts = [f"{count} {what}" for what, count in counts.items() if count]
    hint = " (--keep-going runs them all)" if missing else ""
    text = f"{planned} profiles: {', '.join(parts)}{hint}"
    facts = {what.replace(" ", "_"): count for what, count in counts.items()}
    console.say(console.style(text, "error" if failed else "good"), "batch", **facts)


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
        "-" if peak is None else f"{CONSOLE.fixed(peak, 2)} x",
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
