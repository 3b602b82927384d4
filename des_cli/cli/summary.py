"""A finished run in a few lines for a person: what was gained, and what it cost."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from des_cli.cli.console import Console
from des_cli.errors import ExitCode
from des_cli.failure import Failure
from des_cli.job import JobResult

_LABEL_WIDTH = 11

_COMPONENTS = {
    "ab3": "AB3",
    "bb3": "BB3",
    "cb3": "CB3",
    "vector": "whole vector",
    "seat_x": "seat x",
    "seat_y": "seat y",
    "seat_z": "seat z",
}


def print_result(console: Console, result: JobResult, *, alone: bool) -> None:
    """Print how one job ended.

    Parameters
    ----------
    console : Console
    result : JobResult
    alone : bool
        Whether it is the only one: then in full, otherwise on one line, with
        everything that needs attention below it.
    """
    if result.exit_code:
        failure = Failure(result.exit_code, result.problems, result.traceback)
        console.failure(failure)
        console.warn(result.notices)
        return
    if result.state != "reduced" or result.metrics is None:
        console.say(_short_line(console, result))
        return
    if alone:
        console.say(_headline(console, result))
        for label, text in summary_rows(result):
            console.say(f"  {label:<{_LABEL_WIDTH}} {text}")
    else:
        console.say(_short_line(console, result))
    label = f"  {'limits':<{_LABEL_WIDTH}} "
    whose = "" if alone else f"{result.name}: "
    console.warn(f"{label}{whose}{line}" for line in result.violations)
    if alone and not any(line.startswith("modified") for line in result.violations):
        console.say(label + ("kept by the modified motion" if result.violations else "all kept"))
    for notice in result.notices:
        console.say(console.style(f"  {'notice':<{_LABEL_WIDTH}} {notice}", "warning"))
    if alone and result.table is None:
        console.say(f"  {'written':<{_LABEL_WIDTH}} {console.style(result.written, 'good')}")


def print_closing(console: Console, results: list[JobResult], planned: int) -> None:
    """Print how a batch ended, in one line."""
    failed = sum(bool(result.exit_code) for result in results)
    kept = sum(result.state == "kept" for result in results)
    dry = sum(result.state == "planned" for result in results)
    missing = planned - len(results)
    parts = [
        f"{count} {what}"
        for count, what in (
            (len(results) - failed - kept - dry, "done"),
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


def summary_rows(result: JobResult) -> list[tuple[str, str]]:
    """Return labels and texts of the summary, from the metrics alone."""
    assert result.metrics is not None
    metrics = result.metrics
    fidelity = metrics["fidelity"]
    rows = [
        ("Coriolis", _changes(metrics, _objective(result))),
        ("", _changes(metrics, ("seat_x", "seat_y", "seat_z"))),
        (
            "deviation",
            f"joints {percent(fidelity['joint_deviation_relative'])} "
            f"(squared {percent(fidelity['joint_deviation_relative_squared'])})",
        ),
        (
            "felt",
            f"seat rate {percent(fidelity['seat_rate_deviation_relative'])}, "
            f"G {percent(fidelity['seat_g_deviation_relative'])} "
            f"({number(fidelity['seat_g_rms_error_g'])} g rms)",
        ),
    ]
    for metric, most in (metrics["solver"].get("budget") or {}).items():
        rows.append(("budget", f"{metric} at most {number(most)}, is {fidelity[metric]:.4g}"))
    texts = _baselines(metrics.get("baseline") or {})
    return rows + [("compare" if not i else "", text) for i, text in enumerate(texts)]


def change(reduction: float | None) -> str:
    """Say a reduction in words that need no sign.

    >>> change(0.689), change(-0.28), change(None)
    ('68.9 % less', '28.0 % more', 'not known')
    """
    if reduction is None or not math.isfinite(reduction):
        return "not known"
    return f"{percent(abs(reduction))} {'less' if reduction >= 0 else 'more'}"


def percent(value: float | None) -> str:
    """Write a ratio in percent, with digits that mean something.

    >>> percent(0.6892), percent(0.00163), percent(7.5)
    ('68.9 %', '0.16 %', '750 %')
    """
    if value is None or not math.isfinite(value):
        return "not known"
    hundredths = 100.0 * value
    size = abs(hundredths)
    digits = 0 if size >= 100 else 1 if size >= 1 else 2
    return f"{hundredths:.{digits}f} %"


def number(value: float | None) -> str:
    """Write a number with three digits."""
    return "not known" if value is None or not math.isfinite(value) else f"{value:.3g}"


def _objective(result: JobResult) -> tuple[str, ...]:
    """Name the component that was weighed, if it is one, and the whole vector."""
    return (*(result.objective if len(result.objective) == 1 else ()), "vector")


def _changes(metrics: Mapping[str, Any], keys: tuple[str, ...]) -> str:
    coriolis = metrics["coriolis"]
    return ", ".join(f"{_COMPONENTS[key]} {change(coriolis[key]['reduction'])}" for key in keys)


def _baselines(baseline: Mapping[str, Any]) -> list[str]:
    """Say what the same profile gets without the optimum."""
    texts = []
    sweep = baseline.get("report_sweep")
    if sweep:
        texts.append(
            f"the study's sweep: {change(sweep['reduction'])} "
            f"at joints {percent(sweep['joint_deviation_relative'])}"
        )
    constant = baseline.get("constant_p")
    if constant:
        texts.append(
            f"as much by a constant p = {number(constant['p'])}: "
            f"joints {percent(constant['joint_deviation_relative'])}"
        )
    return texts


def _headline(console: Console, result: JobResult) -> str:
    assert result.metrics is not None
    solver = result.metrics["solver"]
    steps = "1 iteration" if solver["iterations"] == 1 else f"{solver['iterations']} iterations"
    how = (
        f"{solver['method']} Coriolis by {solver['algorithm']}, "
        f"{solver['control']} control, {solver['axes']} axes"
    )
    look = "good" if solver["status"] == "converged" else "warning"
    status = console.style(f"{solver['status']} in {steps}", look)
    return f"{console.style(result.name, 'title')}: {status} ({how})"


def _short_line(console: Console, result: JobResult) -> str:
    name = console.style(f"{result.name:<20}", "title")
    if result.state == "kept":
        return f"{name} already done in {result.written}"
    if result.state == "planned":
        return f"{name} would be reduced into {result.written}"
    assert result.metrics is not None
    joints = percent(result.metrics["fidelity"]["joint_deviation_relative"])
    gained = _changes(result.metrics, _objective(result))
    return f"{name} {gained}, joints {joints}  {console.style(result.written, 'good')}"


def exit_code_of(results: list[JobResult], planned: int) -> ExitCode:
    """Return the exit code of a whole batch: of a single profile, its own."""
    if planned == 1:
        return results[0].exit_code
    done = len(results) == planned and not any(result.exit_code for result in results)
    return ExitCode.DONE if done else ExitCode.FILE
