"""Several runs as rows that can be sorted: what a person would choose one of them by."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from des_cli.model.felt import BeforeAfter
from des_cli.model.metric import JOINT_DEVIATION, SEAT_G_ERROR, SEAT_RATE_DEVIATION
from des_cli.model.metrics import Metrics
from des_cli.results.budgets import spent_budgets
from des_cli.results.margins import ROUNDING, nearest_limit
from des_cli.results.verdict import Verdict
from des_cli.results.worse import FeltNumber, worse_numbers
from des_cli.show.words import PAGE, text_of


@dataclass(frozen=True, slots=True)
class Column:
    """A quantity of the table.

    Parameters
    ----------
    label, unit : str
    value : callable
        What runs are compared and sorted by.
    write : callable
        How it is shown.
    better : int
        Whether the larger (1) or the smaller (-1) is, or neither (0).
    bad : callable
        Whether it grew where it should not have, or is wrong.
    """

    label: str
    unit: str
    value: Callable[[Metrics], float | None]
    write: Callable[[Metrics], str]
    better: int = -1
    bad: Callable[[Metrics], bool] = lambda _: False


@dataclass(frozen=True, slots=True)
class SortedCell:
    """A cell, and what its column is sorted by; empty where that is not known."""

    text: str
    mark: str
    key: float | str


@dataclass(frozen=True, slots=True)
class RunRow:
    """One run in the table.

    Parameters
    ----------
    anchor, name, maneuver : str
        Where its section is, what it is called, and its profile's name.
    verdict : Verdict
    cells : list of SortedCell
        One a column.
    """

    anchor: str
    name: str
    maneuver: str
    verdict: Verdict
    cells: list[SortedCell]


def _pair(
    label: str,
    unit: str,
    read: Callable[[Metrics], BeforeAfter],
    *worse: FeltNumber,
) -> Column:
    return Column(
        label,
        unit,
        lambda metrics: read(metrics).after,
        lambda metrics: PAGE.from_to(read(metrics)) or PAGE.number(read(metrics).after),
        bad=lambda metrics: bool(set(worse) & worse_numbers(metrics)),
    )


def _change(metrics: Metrics) -> float | None:
    reduction = metrics.coriolis.reduction("vector")
    return None if reduction is None else -reduction


def _onset(metrics: Metrics) -> BeforeAfter:
    return metrics.felt.seat_g[metrics.felt.hardest_onset].onset


def _margin(metrics: Metrics) -> float | None:
    use = nearest_limit(metrics)[1]
    return use.margin if use else None


COLUMNS: tuple[Column, ...] = (
    Column(
        "cross-coupling, squared",
        "",
        lambda m: _change(m),
        lambda m: PAGE.change(m.coriolis.reduction("vector")),
        bad=lambda m: (_change(m) or 0.0) > 0.0,
    ),
    _pair("… rms", "rad/s²", lambda m: m.coriolis.parts["vector"].sizes.rms),
    _pair("total angular acceleration, rms", "rad/s²", lambda m: m.felt.turning.rms, "turning rms"),
    _pair("… peak", "rad/s²", lambda m: m.felt.turning.peak, "turning peak"),
    Column(
        "seat rate off by",
        "",
        lambda m: m.fidelity.value(SEAT_RATE_DEVIATION),
        lambda m: PAGE.percent(m.fidelity.value(SEAT_RATE_DEVIATION)),
    ),
    Column(
        "G off by, rms",
        "g",
        lambda m: m.fidelity.value(SEAT_G_ERROR),
        lambda m: PAGE.number(m.fidelity.value(SEAT_G_ERROR)),
    ),
    _pair("peak Gy", "g", lambda m: m.felt.seat_g["gy"].peak, "gy peak"),
    Column(
        "largest onset of G",
        "g/s",
        lambda m: _onset(m).after,
        lambda m: PAGE.from_to(_onset(m)) or PAGE.unknown,
        bad=lambda m: f"{m.felt.hardest_onset} onset" in worse_numbers(m),
    ),
    Column(
        "smallest margin to a limit",
        "",
        _margin,
        lambda m: PAGE.percent(_margin(m)),
        1,
        lambda m: (_margin(m) or 0.0) < -ROUNDING,
    ),
    Column(
        "joint deviation",
        "",
        lambda m: m.fidelity.value(JOINT_DEVIATION),
        lambda m: PAGE.percent(m.fidelity.value(JOINT_DEVIATION)),
    ),
    Column("reduction", "", lambda m: None, lambda m: _asked(m), 0),
    Column("budget", "", lambda m: None, lambda m: _budget(m), 0),
)


def _asked(metrics: Metrics) -> str:
    solver = metrics.solver
    words = (solver.method, solver.algorithm, solver.control, solver.axes and f"{solver.axes} axes")
    return ", ".join(text_of(word) for word in words)


def _budget(metrics: Metrics) -> str:
    return ", ".join(each.allowed for each in spent_budgets(metrics)) or PAGE.unknown


def run_rows(
    names: Sequence[str], metrics: Sequence[Metrics], verdicts: Sequence[Verdict]
) -> list[RunRow]:
    """Return a row a run, in their order.

    The best of a column is marked only among runs of one maneuver, of which there are two
    or more: of different maneuvers none is better.
    """
    maneuvers = [each.profile.name or "" for each in metrics]
    columns = [_column(column, metrics, maneuvers) for column in COLUMNS]
    return [
        RunRow(
            f"run-{i + 1}",
            name,
            maneuvers[i],
            verdicts[i],
            [cells[i] for cells in columns],
        )
        for i, name in enumerate(names)
    ]


def _column(
    column: Column, metrics: Sequence[Metrics], maneuvers: Sequence[str]
) -> list[SortedCell]:
    values = [column.value(each) for each in metrics]
    cells = []
    for each, value, maneuver in zip(metrics, values, maneuvers, strict=True):
        rivals = {
            column.better * other
            for other, theirs in zip(values, maneuvers, strict=True)
            if other is not None and theirs == maneuver
        }
        best = (
            column.better
            and len(rivals) > 1
            and value is not None
            and column.better * value == max(rivals)
        )
        mark = "bad" if column.bad(each) else "good" if best else ""
        text = column.write(each)
        key = (text if column.better == 0 else "") if value is None else value
        cells.append(SortedCell(text, mark, key))
    return cells
