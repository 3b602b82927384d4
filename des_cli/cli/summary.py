"""A finished run in a few lines for a person: what was gained, and what it cost."""

from __future__ import annotations

from des_cli.batch.job import JobResult
from des_cli.cli.console import Console
from des_cli.cli.summary_rows import (
    changes,
    limits_used,
    summary_rows,
)
from des_cli.errors import Failure
from des_cli.model.metric import SEAT_G_ERROR, SEAT_RATE_DEVIATION
from des_cli.model.metrics import Metrics
from des_cli.results.reading import read_metrics
from des_cli.results.worse import worse_words
from des_cli.show.words import CONSOLE, steps_taken, told_parts

_LABEL_WIDTH = 14


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
    if result.exit_code:
        failure = Failure(result.exit_code, result.complaints, result.traceback)
        console.failure(failure)
        refused = "\n".join(result.complaints)
        console.warn(each.text for each in result.notices if each.text not in refused)
        return
    if result.state != "reduced" or result.metrics is None:
        if not counted or result.state == "planned":
            console.say(_idle_line(console, result))
        return
    metrics = read_metrics(result.metrics)
    if alone:
        for line in _headlines(console, result.name, metrics):
            console.say(line)
        for label, text in summary_rows(metrics, result.objective):
            console.say(f"  {label:<{_LABEL_WIDTH}} {text}")
    elif not counted or result.violations or result.notices:
        console.say(_reduced_line(console, result, metrics))
    label = f"  {'limits':<{_LABEL_WIDTH}} "
    whose = "" if alone else f"{result.name}: "
    console.warn(f"{label}{whose}{line}" for line in result.violations)
    if alone and not any(line.startswith("modified") for line in result.violations):
        kept = "kept by the modified motion" if result.violations else "all kept"
        console.say(f"{label}{kept}{limits_used(metrics)}")
    for notice in result.notices:
        line = f"  {'notice':<{_LABEL_WIDTH}} {notice.text}"
        if notice.harmful:
            console.warn([line])
        else:
            console.say(console.style(line, "warning"))
    if alone and result.table is None:
        console.say(f"  {'written':<{_LABEL_WIDTH}} {console.style(result.written, 'good')}")


def _headlines(console: Console, profile: str, metrics: Metrics) -> list[str]:
    """Return the first lines: what got worse, if anything, then how it was solved."""
    solver = metrics.solver
    how = (
        f"{solver.method} cross-coupling by {solver.algorithm}, "
        f"{solver.control} control, {solver.axes} axes"
    )
    look = "good" if solver.status == "converged" else "warning"
    ended = console.style(f"{solver.status} in {steps_taken(solver.iterations)}", look)
    status = f"{ended} ({how})"
    name = console.style(profile, "title")
    worse = worse_words(metrics)
    if not worse:
        return [f"{name}: {status}"]
    return [
        f"{name}: {console.style(worse, 'warning')}",
        f"  {'solved':<{_LABEL_WIDTH}} {status}",
    ]


def _idle_line(console: Console, result: JobResult) -> str:
    """Say of a profile that was not reduced why not."""
    what = "already done in" if result.state == "kept" else "would be reduced into"
    return f"{_column(console, result)} {what} {result.written}"


def _reduced_line(console: Console, result: JobResult, metrics: Metrics) -> str:
    rate = CONSOLE.percent(metrics.fidelity.value(SEAT_RATE_DEVIATION))
    error = CONSOLE.number(metrics.fidelity.value(SEAT_G_ERROR))
    gained = changes(metrics, told_parts(result.objective))
    worse = worse_words(metrics, short=True)
    told = f"{console.style(worse, 'warning')}; " if worse else ""
    cost = f"seat rate {rate}, G {error} g rms"
    where = console.style(result.written, "good")
    return f"{_column(console, result)} {told}{gained}, {cost}  {where}"


def _column(console: Console, result: JobResult) -> str:
    return console.style(f"{result.name:<20}", "title")
