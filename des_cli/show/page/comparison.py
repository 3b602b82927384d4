"""Runs side by side: a row a quantity, a column a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, get_args

from des_cli.model.coriolis import COMPONENTS
from des_cli.model.machine import JOINTS
from des_cli.results.budgets import spent_budgets
from des_cli.results.ends import When, end_words
from des_cli.results.reading import lookup, number
from des_cli.results.worse import worse_paths
from des_cli.runs_out.run_folder import StoredRun
from des_cli.show.page.numbers import DASH, change, percent, plain, words
from des_cli.show.plots.standing import status_words


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

    Where ``before`` is given, what stands there is shown before the number.
    """

    label: str
    path: str
    write: Callable[[float | None], str]
    better: int
    before: str = ""


def _felt(label: str, stem: str, unit: str) -> _Quantity:
    """Return a quantity of the pilot's, before and after; less is better."""
    return _Quantity(label, f"{stem}_after_{unit}", _three, -1, f"{stem}_before_{unit}")


def _three(value: float | None) -> str:
    return plain(value, 3)


_TOTAL = "felt.seat_angular_acceleration.magnitude"


_GROUPS: tuple[tuple[str, tuple[_Quantity, ...]], ...] = (
    (
        "What the pilot feels, before → after",
        (
            _felt("cross-coupling, rms [rad/s²]", "coriolis.vector.rms", "rad_s2"),
            _felt("total angular acceleration, rms [rad/s²]", f"{_TOTAL}.rms", "rad_s2"),
            _felt("… peak [rad/s²]", f"{_TOTAL}.peak", "rad_s2"),
            _felt("peak Gy [g]", "felt.seat_g.gy.peak", "g"),
            _felt("onset of Gx [g/s]", "felt.seat_g.gx.onset", "g_s"),
            _felt("… of Gy", "felt.seat_g.gy.onset", "g_s"),
            _felt("… of Gz", "felt.seat_g.gz.onset", "g_s"),
        ),
    ),
    (
        "How far from the profile",
        (
            _Quantity("seat rate", "fidelity.seat_rate_deviation_relative", percent, -1),
            _Quantity(
                "total angular acceleration, rms [rad/s²]",
                "fidelity.seat_angular_acceleration_rms_error_rad_s2",
                _three,
                -1,
            ),
            _Quantity("seat G, rms [g]", "fidelity.seat_g_rms_error_g", _three, -1),
            _Quantity("tilt, at most [deg]", "fidelity.tilt_error_max_deg", _three, -1),
            _Quantity(
                "seat rate, by keeping the limits alone",
                "executable.seat_rate_deviation_relative",
                percent,
                0,
            ),
        ),
    ),
    (
        "Change of the cross-coupling, ∫ after² against ∫ before²",
        tuple(
            _Quantity(component.label, f"coriolis.{component.key}.reduction", change, 1)
            for component in COMPONENTS
            if component.key not in ("ab3", "cb3")
        ),
    ),
    (
        "The study's measure",
        (
            _Quantity("joint deviation", "fidelity.joint_deviation_relative", percent, -1),
            _Quantity("… squared", "fidelity.joint_deviation_relative_squared", percent, -1),
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
        Row("limits", tuple(limits_cell(each) for each in metrics)),
        Row("cost J", tuple(Cell(plain(number(each, "solver.cost"))) for each in metrics)),
    ]
    for when in get_args(When):
        rows.append(Row(when, tuple(Cell(end_words(each, when) or DASH) for each in metrics)))
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
    return Cell(", ".join(each.allowed for each in spent_budgets(metrics)) or DASH)


def _compared(quantity: _Quantity, metrics: Sequence[Mapping[str, Any]]) -> Row:
    values = [number(each, quantity.path) for each in metrics]
    known = [quantity.better * value for value in values if value is not None]
    # With a single run, or equal ones, there is no best.
    best = max(known) if quantity.better and len(set(known)) > 1 else None
    cells = []
    for each, value in zip(metrics, values, strict=True):
        mark = ""
        if value is not None and quantity.better * value == best:
            mark = "good"
        grew = value is not None and quantity.better > 0 and value < 0
        if grew or quantity.path in worse_paths(each):
            mark = "bad"
        text = quantity.write(value)
        if quantity.before and value is not None:
            text = f"{quantity.write(number(each, quantity.before))} → {text}"
        cells.append(Cell(text, mark))
    return Row(quantity.label, tuple(cells))
