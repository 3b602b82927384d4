"""A finished run in a few lines for a person: what is felt of it, and what it cost."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from des_cli.batch.job import JobResult
from des_cli.cli.console import LABEL_WIDTH, QUIET, Console
from des_cli.cli.summary_rows import changes, felt_rows, felt_words, limits_used, other_rows
from des_cli.errors import Failure
from des_cli.model.metrics import Metrics
from des_cli.model.notice import Notice
from des_cli.results.reading import read_metrics
from des_cli.results.worse import find_worse, worse_numbers, worse_words
from des_cli.show.words import told_parts

if TYPE_CHECKING:
    from des_cli.cli.lines import Level

_WORSE = "worse"
"""The notice that says of a ride what its first line says."""


def print_result(
    console: Console, result: JobResult, *, alone: bool, counted: bool = False
) -> None:
    """Print how one job ended.

    Parameters
    ----------
    console : Console
    result : JobResult
    alone : bool
        Whether it is the only one: then in full, otherwise on one line, with
        everything that needs attention below it.
    counted : bool
        Whether a status line counts the jobs and a table follows: then a job of several
        has its line only if something is to be told below it.
    """
    profile = result.name or result.source
    if result.exit_code:
        failure = Failure(result.exit_code, result.complaints, result.traceback)
        console.failure(failure, profile=profile)
        refused = "\n".join(result.complaints)
        for notice in result.notices:
            if notice.text not in refused:
                facts = {"profile": profile, "name": notice.name}
                console.warn([notice.text], kind="notice", **facts)
        return
    if result.state != "reduced" or result.metrics is None:
        if not counted or result.state == "planned":
            kind = "planned" if result.state == "planned" else "summary"
            console.say(_idle_line(console, result), kind, **_facts(console, result))
        return
    metrics = read_metrics(result.metrics)
    if console.log_format == "json":
        words = felt_words(metrics)
        console.say(f"{profile}: {words}", "summary", **_facts(console, result))
        _print_attention(console, result, result.notices, "")
    elif alone:
        _print_alone(console, result, metrics)
    else:
        if not counted or result.violations or result.notices:
            console.headline(_reduced_line(console, result, metrics))
        # Without the line above, what follows must say whose it is.
        whose = f"{result.name}: " if console.verbosity <= QUIET else ""
        _print_attention(console, result, result.notices, whose)


def _print_alone(console: Console, result: JobResult, metrics: Metrics) -> None:
    name, felt = console.style(result.name, "title"), felt_words(metrics)
    told = result.notices
    if worse := worse_words(metrics):
        console.headline(f"{name}: {console.style(worse, 'warning')}")
        if console.verbosity > QUIET:
            # Its notice says the same once more, and what bounds it.
            told = tuple(notice for notice in told if notice.name != _WORSE)
        if cures := [each.cure for each in find_worse(metrics) if each.cure]:
            console.row("bounded by", ", ".join(cures))
        console.row("felt", felt)
    else:
        console.headline(f"{name}: {felt}")
    for label, text in felt_rows(metrics, result.objective, worse_numbers(metrics)):
        console.row(label, text)
    _print_attention(console, result, told, "")
    if not any(line.startswith("modified") for line in result.violations):
        kept = "kept by the modified motion" if result.violations else "all kept"
        console.row("limits", f"{kept}{limits_used(metrics)}")
    for label, text in other_rows(metrics):
        console.row(label, text)
    if result.table is None:
        console.row("written", result.written, "good")


def _print_attention(
    console: Console, result: JobResult, notices: tuple[Notice, ...], whose: str
) -> None:
    """Print the limits that are broken, and the notices: those that warn of harm always."""
    for line in result.violations:
        facts = {"profile": result.name}
        console.row("limits", f"{whose}{line}", _LOOK, kind="limit", level=_LOOK, **facts)
    for notice in notices:
        level: Level = "warning" if notice.harmful else "info"
        facts = {"profile": result.name, "name": notice.name}
        console.row("notice", f"{whose}{notice}", _LOOK, kind="notice", level=level, **facts)


_LOOK: Level = "warning"


def _facts(console: Console, result: JobResult) -> dict[str, Any]:
    """Return what a program is told of a run: what ``summary.csv`` says of it."""
    if console.log_format != "json":
        return {}
    from dataclasses import asdict

    from des_cli.batch.summary import SummaryRow

    row = asdict(SummaryRow.of(result)) | {"profile": result.name, "written": result.written}
    return {key: value for key, value in row.items() if key not in ("name", "message", "folder")}


def _idle_line(console: Console, result: JobResult) -> str:
    """Say of a profile that was not reduced why not."""
    what = "already done in" if result.state == "kept" else "would be reduced into"
    return f"{_column(console, result)} {what} {result.written}"


def _reduced_line(console: Console, result: JobResult, metrics: Metrics) -> str:
    # A notice below it says what got worse with all its numbers.
    noticed = any(notice.name == _WORSE for notice in result.notices)
    worse = "" if noticed else worse_words(metrics, short=True)
    told = f"{console.style(worse, 'warning')}; " if worse else ""
    weighed = changes(metrics, told_parts(result.objective)[1:])
    felt = ", ".join(text for text in (felt_words(metrics), weighed) if text)
    return f"{_column(console, result)} {told}{felt}  {console.style(result.written, 'good')}"


def _column(console: Console, result: JobResult) -> str:
    return console.style(f"{result.name:<{LABEL_WIDTH + 2}}", "title")
