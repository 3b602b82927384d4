"""Every option that more than one command has, or that maps to a key of ``reduction:``, once.

A shared option is a decorator; a command picks those that it understands.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import click

from des_cli.cli.command import BATCH, OUTPUT, REDUCTION, option
from des_cli.cli.completion import complete_budget
from des_cli.model.metric import STUDY_METRIC, metric_named
from des_cli.model.notice import HARMS
from des_cli.profiles_in.setting import Setting, value_of_option

F = TypeVar("F", bound=Callable[..., Any])

TABLE_FORMATS = ("csv", "ndjson", "json", "parquet")
"""Formats of the command table; a file's suffix is one of them."""

ANY_HARM = "notice"
"""Stands for every notice that warns of harm."""

DEFAULT_RUNS = "runs"
"""Where runs go, and where ``report`` looks for them."""


def text_or_json_option(text: str) -> Callable[[F], F]:
    """Add ``--format text|json`` to a command that answers in lines."""
    return option(
        OUTPUT,
        "-f",
        "--format",
        "form",
        type=click.Choice(["text", "json"]),
        default="text",
        show_default=True,
        help=text,
    )


def overwrite_option(text: str) -> Callable[[F], F]:
    """Return what adds ``--overwrite`` to a command that refuses what exists."""
    return option(OUTPUT, "--overwrite", is_flag=True, help=text)


def jobs_option(text: str) -> Callable[[F], F]:
    """Return what adds ``--jobs`` to a command that does several things at a time."""
    return option(
        BATCH,
        "--jobs",
        type=click.IntRange(min=0),
        metavar="N",
        default=1,
        show_default=True,
        help=text,
    )


def fail_on_option(command: F) -> F:
    """Add ``--fail-on``, which comes to the command as a set of notices' names."""
    return option(
        OUTPUT,
        "--fail-on",
        metavar="NAME",
        multiple=True,
        type=click.Choice([ANY_HARM, *HARMS]),
        callback=_named_notices,
        help=f"Refuse with 5 what has this notice: {', '.join(HARMS)}, or any of them: {ANY_HARM}; "
        "repeatable.",
    )(command)


def _named_notices(
    context: click.Context, parameter: click.Parameter, names: tuple[str, ...]
) -> frozenset[str]:
    return frozenset(HARMS) if ANY_HARM in names else frozenset(names)


# The options that are keys of `reduction:` by name. What a value may be is the
# schema's business, but for the words that --help lists.
_REDUCTION: tuple[tuple[str, Any, str], ...] = (
    ("method", click.Choice(["minimum", "zero"]), "Least cross-coupling, or none."),
    (
        "algorithm",
        click.Choice(["optimum", "report-sweep"]),
        "The true optimum, or the study's single sweep.",
    ),
    (
        "control",
        click.Choice(["free", "scalar", "per-joint"]),
        "Free joints, or the study's factors: one for all joints, or one each.",
    ),
    (
        "axes",
        click.Choice(["report", "seat"]),
        "Weigh the Coriolis vector in the study's axes or in the seat's.",
    ),
    (
        "jacobian",
        click.Choice(["desired", "adapted"]),
        "Where the Jacobian is taken; the study takes the desired motion.",
    ),
    ("r1", "WEIGHTS", "Weight on the Coriolis components: 0,2,0 or a 3x3 matrix in brackets."),
    ("r2", "WEIGHT", "Weight on leaving the desired rates: a number, or one a joint as 1,1,1."),
    ("tracking", "WEIGHT", "Weight on leaving the desired angles: a number, or one a joint."),
    (
        "limits",
        click.Choice(["enforce", "check", "warn"]),
        "Solve inside the machine's limits, refuse beyond them, or only name them.",
    ),
    (
        "budget",
        "METRIC=MOST",
        "The most reduction of the cross-coupling for at most so much of a fidelity metric, inside "
        f"the machine's limits; 5% for a share; a number alone is {STUDY_METRIC}.",
    ),
    (
        "objective",
        click.Choice(["coriolis", "blend", "felt"]),
        "Minimise the cross-coupling, this and a tenth of the felt error, or the felt error.",
    ),
    (
        "ends",
        click.Choice(["free", "match-start", "match-rates", "match-both"]),
        "Keep no rates, those at the start, at both ends, or angles and rates at both ends.",
    ),
    (
        "optimise",
        click.Choice(["seat_yaw", "seat_pitch", "fork_start", "cab_start"]),
        "Find this constant together with the motion.",
    ),
    ("lead_in", "SECONDS", "Ramp from rest to the start in this time."),
    ("lead_out", "SECONDS", "Ramp from the end to rest in this time."),
    (
        "allow_change",
        "SHARE",
        "Let conditioning and limits change so much of the record's seat rate or G first; the "
        "budgets are then what the reduction may add.",
    ),
    ("tolerance", "RAD_S2", "Largest Coriolis component that --method zero leaves."),
    ("iterations", click.IntRange(min=1), "Backward-forward sweeps of report-sweep."),
)
_REPEATABLE = ("budget", "optimise")
_SECONDS = ("lead_in", "lead_out")
_PERCENT = ("allow_change",)
"""Shares, which may be given as percentages."""


def reduction_words() -> dict[str, tuple[str, ...]]:
    """Return the keys of ``reduction:`` that have an option, each with the words it may be."""
    return {
        f"{key}_s" if key in _SECONDS else key: tuple(getattr(kind, "choices", ()))
        for key, kind, _ in _REDUCTION
    }


def reduction_options(command: F) -> F:
    """Add an option for each common key of ``reduction:``; see `reduction_settings`."""
    return reduction_options_without()(command)


def reduction_options_without(*keys: str) -> Callable[[F], F]:
    """Return a decorator that adds the options of `reduction_options` but for some keys."""

    def add(command: F) -> F:
        for key, kind, text in reversed(_REDUCTION):
            if key in keys:
                continue
            typed: dict[str, Any] = {"metavar": kind} if isinstance(kind, str) else {"type": kind}
            if key in _REPEATABLE:
                typed["multiple"] = True
                text = f"{text.removesuffix('.')}; repeatable."
            if isinstance(kind, click.IntRange):
                typed["metavar"] = "N"
            if key == "budget":
                typed["shell_complete"] = complete_budget
            name = f"--{key.replace('_', '-')}"
            command = option(REDUCTION, name, key, help=text, **typed)(command)
        return command

    return add


def reduction_settings(values: Mapping[str, Any]) -> tuple[Setting, ...]:
    """Turn the options of `reduction_options` into settings.

    Raises
    ------
    click.UsageError
        If a budget is given together with the weights that it stands instead of, or
        twice for the same metric.

    >>> [str(each) for each in reduction_settings({"r1": "0,2,0", "r2": None})]
    ['reduction.r1=[0, 2, 0]']
    """
    given: dict[str, tuple[Any, str]] = {}
    for key, kind, _ in _REDUCTION:
        value = values.get(key)
        if value is not None and value != ():
            option = f"--{key.replace('_', '-')}"
            said = option if key in _REPEATABLE else f"{option} {value}"
            if key in _PERCENT:
                value = share_text(value)
            given[key] = value_of_option(str(value)) if isinstance(kind, str) else value, said
    if "budget" in given:
        if weights := [f"--{key}" for key in ("r2", "tracking") if key in given]:
            raise click.UsageError(f"--budget stands instead of {' and '.join(weights)}.")
        budgets = read_budgets(values["budget"])
        said = " ".join(f"--budget {each}" for each in values["budget"])
        given["budget"] = {metric: value_of_option(most) for metric, most in budgets.items()}, said
        # what a budget buys is meant inside the limits, unless it is said otherwise
        given.setdefault("limits", ("enforce", said))
    if values.get("method") == "zero":
        given.setdefault("limits", ("enforce", "--method zero"))  # without them it jumps
    if "optimise" in given:
        said = " ".join(f"--optimise {each}" for each in values["optimise"])
        given["optimise"] = list(values["optimise"]), said
    units = dict.fromkeys(_SECONDS, "_s")
    return tuple(
        Setting(f"reduction.{key}{units.get(key, '')}", value, said)
        for key, (value, said) in given.items()
    )


def read_budgets(texts: Sequence[str]) -> dict[str, str]:
    """Return the largest values by metric, as a profile writes them.

    Parameters
    ----------
    texts : sequence of str
        ``METRIC=MOST``, or ``MOST`` of the study's measure. What a metric or a number
        may be is the schema's business, but for a percentage of a share: ``5%``.

    Raises
    ------
    click.UsageError
        If a metric is there twice, or has a percentage and is no share.

    >>> read_budgets(["5%"]) == {STUDY_METRIC: "0.05"}, read_budgets(["metric = 0.1"])
    (True, {'metric': '0.1'})
    """
    budgets: dict[str, str] = {}
    for text in texts:
        metric, _, most = text.rpartition("=")
        metric = metric.strip() or STUDY_METRIC
        if metric in budgets:
            raise click.UsageError(f"--budget is given twice for {metric}.")
        budgets[metric] = without_percent(metric, most.strip())
    return budgets


def without_percent(metric: str, most: str) -> str:
    """Return a largest value as a plain number where it is a percentage of a share.

    Raises
    ------
    click.UsageError
        If the metric is no share.

    >>> without_percent(STUDY_METRIC, "12.5 %")
    '0.125'
    """
    if not most.endswith("%"):
        return most
    known = metric_named(metric)
    if known is not None and not known.relative:
        raise click.UsageError(
            f"{metric}={most} is a percentage of what is no share: give it in {known.unit}."
        )
    return share_text(most)


def share_text(text: str) -> str:
    """Return a share as a plain number where it is a percentage: ``5%`` is ``0.05``.

    >>> [share_text(text) for text in ("12.3%", "0.1 %", "0.3", "half%")]
    ['0.123', '0.001', '0.3', 'half%']
    """
    from decimal import Decimal, InvalidOperation

    number = text.strip().removesuffix("%").rstrip()
    if number == text.strip() or "_" in number:
        return text
    try:
        # Not a quotient of doubles: 12.3 / 100 is not the double that 0.123 is.
        return repr(float(Decimal(number).scaleb(-2)))
    except InvalidOperation:
        return text  # the schema says what is wrong with it


_BUDGET, _SHARES = "reduction.budget", ("reduction.allow_change",)


def plain_setting(text: str) -> str:
    """Return the text of a ``--set`` with a plain number where it gives a share as a percentage.

    Raises
    ------
    click.UsageError
        If it is a budget on what is no share.

    >>> plain_setting("reduction.budget=5%") == "reduction.budget=0.05"
    True
    >>> plain_setting("reduction.allow_change=30%"), plain_setting("name=5%")
    ('reduction.allow_change=0.3', 'name=5%')
    """
    key, equals, value = text.partition("=")
    path, value = key.strip(), value.strip()
    if not value.endswith("%"):
        return text
    if path in _SHARES:
        return f"{key}{equals}{share_text(value)}"
    if path == _BUDGET or path.startswith(f"{_BUDGET}."):
        metric = path[len(_BUDGET) + 1 :] or STUDY_METRIC
        return f"{key}{equals}{without_percent(metric, value)}"
    return text


def existing_folder(path: str) -> bool:
    """Whether an argument means a folder: it is one, or ends like one."""
    return path.endswith(("/", os.sep)) or Path(path).is_dir()
