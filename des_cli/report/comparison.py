"""Runs side by side: a row a quantity, a column a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from des_cli.files.run_folder import StoredRun
from des_cli.model.machine import JOINTS
from des_cli.plots.standing import budget_words, status_words
from des_cli.report.numbers import DASH, change, percent, plain, words
from des_cli.results.reading import lookup, number


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
    """A number that runs are compared by; ``better`` is the larger (1) or the smaller (-1)."""

    label: str
    path: str
    write: Callable[[float | None], str]
    better: int


_GROUPS: tuple[tuple[str, tuple[_Quantity, ...]], ...] = (
    (
        "Change of the Coriolis, ∫ after² against ∫ before²",
        (
            _Quantity("BB3", "coriolis.bb3.reduction", change, 1),
            _Quantity("whole vector", "coriolis.vector.reduction", change, 1),
            _Quantity("seat x", "coriolis.seat_x.reduction", change, 1),
            _Quantity("seat y", "coriolis.seat_y.reduction", change, 1),
            _Quantity("seat z", "coriolis.seat_z.reduction", change, 1),
        ),
    ),
    (
        "What it costs",
        (
            _Quantity("joint deviation", "fidelity.joint_deviation_relative", percent, -1),
            _Quantity("… squared", "fidelity.joint_deviation_relative_squared", percent, -1),
            _Quantity("seat rate deviation", "fidelity.seat_rate_deviation_relative", percent, -1),
            _Quantity("seat G deviation", "fidelity.seat_g_deviation_relative", percent, -1),
            _Quantity(
                "desired motion changed for the limits",
                "executable.joint_change_relative",
                percent,
                0,
            ),
        ),
    ),
    (
        "What else would have done",
        (
            _Quantity(
                "study's single sweep",
                "baseline.report_sweep.reduction",
                change,
                0,
            ),
            _Quantity(
                "… joint deviation", "baseline.report_sweep.joint_deviation_relative", percent, 0
            ),
            _Quantity("constant p, equal reduction", "baseline.constant_p.p", plain, 0),
            _Quantity(
                "… joint deviation", "baseline.constant_p.joint_deviation_relative", percent, 0
            ),
        ),
    ),
)


def comparison_rows(runs: Sequence[StoredRun]) -> list[Row]:
    """Return the table that compares runs.

    Parameters
    ----------
    runs : sequence of StoredRun

    Returns
    -------
    list of Row
        With a cell for each run, in their order.
    """
    metrics = [run.metrics for run in runs]
    rows = [
        Row("status", tuple(_status(each) for each in metrics)),
        Row("method", tuple(Cell(words(lookup(each, "solver.method"))) for each in metrics)),
        Row("algorithm", tuple(Cell(words(lookup(each, "solver.algorithm"))) for each in metrics)),
        Row("control", tuple(Cell(words(lookup(each, "solver.control"))) for each in metrics)),
        Row("axes", tuple(Cell(words(lookup(each, "solver.axes"))) for each in metrics)),
        Row("budget", tuple(_budget(each) for each in metrics)),
        Row("cost J", tuple(Cell(plain(number(each, "solver.cost"))) for each in metrics)),
        Row("limits", tuple(limits_cell(each) for each in metrics)),
    ]
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


def limits_cell(metrics: Mapping[str, Any]) -> Cell:
    """Say whether the modified motion keeps the limits of every joint."""
    verdicts = {joint: lookup(metrics, f"limits.modified.{joint}.ok") for joint in JOINTS}
    broken = [joint for joint, ok in verdicts.items() if ok is False]
    if broken:
        return Cell(f"broken: {', '.join(broken)}", "bad")
    return Cell("kept" if all(ok is True for ok in verdicts.values()) else DASH)


def _status(metrics: Mapping[str, Any]) -> Cell:
    unfinished = status_words(metrics)
    return Cell(unfinished or words(lookup(metrics, "solver.status")), "bad" if unfinished else "")


def _budget(metrics: Mapping[str, Any]) -> Cell:
    # what was spent of it stands among the costs
    return Cell(budget_words(metrics).replace(" at most ", " ≤ ").partition(", is ")[0] or DASH)


def _compared(quantity: _Quantity, metrics: Sequence[Mapping[str, Any]]) -> Row:
    values = [number(each, quantity.path) for each in metrics]
    known = [quantity.better * value for value in values if value is not None]
    # With a single run, or equal ones, there is no best.
    best = max(known) if quantity.better and len(set(known)) > 1 else None
    cells = []
    for value in values:
        mark = ""
        if value is not None and quantity.better * value == best:
            mark = "good"
        if value is not None and quantity.better > 0 and value < 0:
            mark = "bad"
        cells.append(Cell(quantity.write(value), mark))
    return Row(quantity.label, tuple(cells))
