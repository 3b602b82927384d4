"""What ``sweep`` varies and where it writes, as they stand on the command line."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

import click

from des_cli.batch.source import STANDARD_STREAM
from des_cli.cli.options import TABLE_FORMATS, read_budgets, without_percent
from des_cli.cli.outputs import files_held
from des_cli.model.metric import STUDY_METRIC

DEFAULT_METRIC, DEFAULT_BUDGETS = STUDY_METRIC, (0.01, 0.02, 0.05, 0.1)
CONTROLS = ("free", "scalar", "per-joint")
DEFAULT_CONTROLS = ("scalar", "per-joint")

Budgets: TypeAlias = tuple[str, tuple[float, ...]]
"""A metric and its budgets."""


def _read_numbers(text: str, example: str) -> tuple[float, ...]:
    """Read positive numbers with commas between, each once."""
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        raise click.BadParameter(f"{text!r} is not a list of numbers, such as {example}.") from None
    if not all(math.isfinite(value) and value > 0.0 for value in values):
        raise click.BadParameter(f"{text!r}: each must be a number above 0.")
    return tuple(dict.fromkeys(values))


def read_swept_budgets(
    context: click.Context, parameter: click.Parameter, text: str | None
) -> Budgets | None:
    """Read ``0.01,0.02``, ``METRIC=0.01,0.02``, or either in percent: ``1%,2%``."""
    if text is None:
        return None
    metric, equals, values = text.rpartition("=")
    if equals:
        _require_metric(metric.strip())
    metric = metric.strip() or DEFAULT_METRIC
    plain = ",".join(without_percent(metric, part.strip()) for part in values.split(","))
    return metric, _read_numbers(plain, "0.01,0.02,0.05,0.1")


def _require_metric(metric: str) -> None:
    from des_cli.model.metric import METRICS
    from des_cli.profiles_in.wording import did_you_mean, one_of

    if metric not in METRICS:
        hint = did_you_mean(metric, METRICS)
        raise click.BadParameter(
            f"{metric!r} is not a metric{hint}; it is {one_of(tuple(METRICS))}."
        )


def read_weights(
    context: click.Context, parameter: click.Parameter, text: str | None
) -> tuple[float, ...] | None:
    """Read ``8,1,0.2``."""
    return None if text is None else _read_numbers(text, "8,1,0.2")


def read_controls(context: click.Context, parameter: click.Parameter, text: str) -> tuple[str, ...]:
    """Read ``free,per-joint``."""
    controls = tuple(dict.fromkeys(part.strip() for part in text.split(",")))
    wrong = [control for control in controls if control not in CONTROLS]
    if wrong:
        raise click.BadParameter(
            f"{wrong[0]!r} is not {', '.join(CONTROLS[:-1])} or {CONTROLS[-1]}."
        )
    return controls


def point_format(out: str | None, named: str | None) -> str:
    """Return the format of the points, ``text`` where they are for a person."""
    on_terminal = sys.stdout is not None and sys.stdout.isatty()
    if out is None:
        return named or ("text" if on_terminal else "csv")
    suffix = "" if out == STANDARD_STREAM else Path(out).suffix.lower().removeprefix(".")
    if named is not None and suffix in TABLE_FORMATS and suffix != named:
        raise click.UsageError(f"--format {named} contradicts the suffix of {out}.")
    if named is None and suffix not in ("", *TABLE_FORMATS):
        known = f"{', '.join(f'.{each}' for each in TABLE_FORMATS[:-1])} or .{TABLE_FORMATS[-1]}"
        raise click.UsageError(f"{out}: .{suffix} is no format of a curve: name it {known}.")
    return named or (suffix if suffix in TABLE_FORMATS else "csv")


def refuse_weights(reduction: dict[str, Any], r2s: tuple[float, ...] | None) -> None:
    """Refuse weights beside those that are swept, or beside budgets."""
    if r2s and reduction["r2"] is not None:
        raise click.UsageError("--r2 and --r2s exclude each other.")
    if not r2s and reduction["tracking"] is not None:
        raise click.UsageError("--tracking needs --r2s: a budget brings its own weight.")


def refuse_budgets(reduction: dict[str, Any], swept: Budgets | None) -> None:
    """Refuse a budget beside swept weights, or on the metric that is swept."""
    fixed = read_budgets(reduction["budget"])
    if fixed and swept is None:
        raise click.UsageError("--budget and --r2s exclude each other.")
    if swept is not None and swept[0] in fixed:
        raise click.UsageError(f"--budget keeps {swept[0]}, which is swept: leave one of them out.")


@contextmanager
def outputs_held(out: str | None, plot: str | None, overwrite: bool) -> Iterator[None]:
    """Refuse before solving what would be refused when writing, and keep other runs off it."""
    if plot is not None and Path(plot).suffix.lower() != ".png":
        raise click.UsageError(f"--plot draws a PNG: name it FILE.png, not {plot}.")
    names = [name for name in (out, plot) if name is not None and name != STANDARD_STREAM]
    if len({os.path.realpath(name) for name in names}) < len(names):
        raise click.UsageError(f"--out and --plot both name {plot}: give each a file of its own.")
    with files_held(names, overwrite):
        yield
