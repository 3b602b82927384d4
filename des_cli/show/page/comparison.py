"""Runs side by side: a row a quantity, a column a run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import get_args

from des_cli.model.coriolis import COMPONENTS, Component
from des_cli.model.felt import BeforeAfter
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_ERROR,
    JOINT_DEVIATION,
    JOINT_DEVIATION_SQUARED,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
    MetricKey,
)
from des_cli.model.metrics import ConstantBaseline, Metrics, SweepBaseline, When
from des_cli.results.budgets import spent_budgets
from des_cli.results.ends import end_words
from des_cli.results.worse import FeltNumber, worse_numbers
from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.plots.standing import status_words
from des_cli.show.words import PAGE, text_of


@dataclass(frozen=True, slots=True)
class Cell:
    """A value as it is shown.

    Parameters
    ----------
    text : str
    mark : str
        ``good`` for the best of its row, ``bad`` for what needs attention,
        else empty.
    """

    text: str
    mark: str = ""


@dataclass(frozen=True, slots=True)
class Row:
    """One quantity of every run; a row without cells is the heading of a group."""

    label: str
    cells: tuple[Cell, ...] = ()


@dataclass(frozen=True, slots=True)
class _Quantity:
    """A number that runs are compared by; ``better`` is the larger (1) or the smaller (-1).

    Where ``before`` is given, what it reads is shown before the number. ``worse`` is what
    the number is called among those of the ride that may have got worse.
    """

    label: str
    read: Callable[[Metrics], float | None]
    write: Callable[[float | None], str]
    better: int = 0
    before: Callable[[Metrics], float | None] | None = None
    worse: FeltNumber | None = None


def _felt(
    label: str, read: Callable[[Metrics], BeforeAfter], worse: FeltNumber | None = None
) -> _Quantity:
    """Return a quantity of the pilot's, before and after; less is better."""
    return _Quantity(
        label,
        lambda metrics: read(metrics).after,
        _three,
        -1,
        lambda metrics: read(metrics).before,
        worse,
    )


def _fidelity(label: str, metric: MetricKey, write: Callable[[float | None], str]) -> _Quantity:
    """Return a fidelity metric; less is better."""
    return _Quantity(label, lambda metrics: metrics.fidelity.value(metric), write, -1)


def _gained(component: Component) -> _Quantity:
    return _Quantity(
        component.label, lambda metrics: metrics.coriolis.reduction(component.key), PAGE.change, 1
    )


def _three(value: float | None) -> str:
    return PAGE.number(value)


def _four(value: float | None) -> str:
    return PAGE.number(value, 4)


def _sweep(metrics: Metrics) -> SweepBaseline:
    return metrics.baseline.report_sweep or SweepBaseline()


def _constant(metrics: Metrics) -> ConstantBaseline:
    return metrics.baseline.constant_p or ConstantBaseline()


_GROUPS: tuple[tuple[str, tuple[_Quantity, ...]], ...] = (
    (
        "What the pilot feels, before → after",
        (
            _felt("cross-coupling, rms [rad/s²]", lambda m: m.coriolis.parts["vector"].sizes.rms),
            _felt(
                "total angular acceleration, rms [rad/s²]",
                lambda m: m.felt.turning.rms,
                "turning rms",
            ),
            _felt("… peak [rad/s²]", lambda m: m.felt.turning.peak, "turning peak"),
            _felt("peak Gy [g]", lambda m: m.felt.seat_g["gy"].peak, "gy peak"),
            _felt("onset of Gx [g/s]", lambda m: m.felt.seat_g["gx"].onset, "gx onset"),
            _felt("… of Gy", lambda m: m.felt.seat_g["gy"].onset, "gy onset"),
            _felt("… of Gz", lambda m: m.felt.seat_g["gz"].onset, "gz onset"),
        ),
    ),
    (
        "How far from the profile",
        (
            _fidelity("seat rate", SEAT_RATE_DEVIATION, PAGE.percent),
            _fidelity(
                "total angular acceleration, rms [rad/s²]", ANGULAR_ACCELERATION_ERROR, _three
            ),
            _fidelity("seat G, rms [g]", SEAT_G_ERROR, _three),
            _Quantity("tilt, at most [deg]", lambda m: m.fidelity.tilt_error_max_deg, _three, -1),
            _Quantity(
                "seat rate, by keeping the limits alone",
                lambda m: m.executable.change.value(SEAT_RATE_DEVIATION),
                PAGE.percent,
            ),
        ),
    ),
    (
        "Change of the cross-coupling, ∫ after² against ∫ before²",
        tuple(_gained(each) for each in COMPONENTS if each.key not in ("ab3", "cb3")),
    ),
    (
        "The study's measure",
        (
            _fidelity("joint deviation", JOINT_DEVIATION, PAGE.percent),
            _fidelity("… squared", JOINT_DEVIATION_SQUARED, PAGE.percent),
            _Quantity(
                "desired motion changed for the limits",
                lambda m: m.executable.change.joint_change_relative,
                PAGE.percent,
            ),
        ),
    ),
    (
        "What else would have done",
        (
            _Quantity("study's single sweep", lambda m: _sweep(m).reduction, PAGE.change),
            _Quantity("… joint deviation", lambda m: _sweep(m).joint_deviation, PAGE.percent),
            _Quantity("constant p, equal reduction", lambda m: _constant(m).p, _four),
            _Quantity("… joint deviation", lambda m: _constant(m).joint_deviation, PAGE.percent),
        ),
    ),
)


def comparison_rows(metrics: Sequence[Metrics]) -> list[Row]:
    """Return the table that compares runs.

    Parameters
    ----------
    metrics : sequence of Metrics
        Of each run.

    Returns
    -------
    list of Row
        With a cell for each run, in their order.
    """
    solvers = [each.solver for each in metrics]
    rows = [
        Row("status", tuple(_status(each) for each in metrics)),
        Row("method", tuple(Cell(text_of(each.method)) for each in solvers)),
        Row("algorithm", tuple(Cell(text_of(each.algorithm)) for each in solvers)),
        Row("control", tuple(Cell(text_of(each.control)) for each in solvers)),
        Row("axes", tuple(Cell(text_of(each.axes)) for each in solvers)),
        Row("budget", tuple(_budget(each) for each in metrics)),
        Row("limits", tuple(limits_cell(each) for each in metrics)),
        Row("cost J", tuple(Cell(PAGE.number(each.cost, 4)) for each in solvers)),
    ]
    for when in get_args(When):
        ends = (end_words(each.fidelity, when) for each in metrics)
        rows.append(Row(when, tuple(Cell(words or PAGE.unknown) for words in ends)))
    for heading, quantities in _GROUPS:
        rows += [Row(heading), *(_compared(quantity, metrics) for quantity in quantities)]
    return rows


def labels(runs: Sequence[StoredRun]) -> list[str]:
    """Return what each run is called on the page: its name, told apart where two share it."""
    names = [run.name for run in runs]
    return [
        run.name if names.count(run.name) == 1 else f"{run.name} ({run.folder.resolve().name})"
        for run in runs
    ]


def limits_cell(metrics: Metrics) -> Cell:
    """Say whether the modified motion keeps the limits of every joint."""
    verdicts = {joint: load.ok for joint, load in metrics.limits.modified.items()}
    broken = [joint for joint, ok in verdicts.items() if ok is False]
    if broken:
        return Cell(f"broken: {', '.join(broken)}", "bad")
    return Cell("kept" if all(ok is True for ok in verdicts.values()) else PAGE.unknown)


def _status(metrics: Metrics) -> Cell:
    unfinished = status_words(metrics)
    return Cell(unfinished or text_of(metrics.solver.status), "bad" if unfinished else "")


def _budget(metrics: Metrics) -> Cell:
    return Cell(", ".join(each.allowed for each in spent_budgets(metrics)) or PAGE.unknown)


def _compared(quantity: _Quantity, metrics: Sequence[Metrics]) -> Row:
    values = [quantity.read(each) for each in metrics]
    known = [quantity.better * value for value in values if value is not None]
    # With a single run, or equal ones, there is no best.
    best = max(known) if quantity.better and len(set(known)) > 1 else None
    cells = []
    for each, value in zip(metrics, values, strict=True):
        mark = ""
        if value is not None and quantity.better * value == best:
            mark = "good"
        grew = value is not None and quantity.better > 0 and value < 0
        if grew or quantity.worse in worse_numbers(each):
            mark = "bad"
        text = quantity.write(value)
        if quantity.before and value is not None:
            text = f"{quantity.write(quantity.before(each))} → {text}"
        cells.append(Cell(text, mark))
    return Row(quantity.label, tuple(cells))
