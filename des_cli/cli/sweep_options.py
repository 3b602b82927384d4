"""The lists that ``sweep`` varies, as they stand on the command line."""

from __future__ import annotations

import math
from typing import TypeAlias

import click

from des_cli.cli.options import without_percent
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
