"""The tables of one run on the page, a row a component, a joint or an axis."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from des_cli.model.coriolis import COMPONENTS
from des_cli.model.felt import G_AXES, BeforeAfter, RateSizes, TurningSizes
from des_cli.model.loads import Driven, JointLoad
from des_cli.model.machine import JOINTS, Joint
from des_cli.model.metrics import Metrics
from des_cli.results.worse import worse_numbers
from des_cli.show.page.cells import Cell
from des_cli.show.words import PAGE, axis_name

# Rounding of the solver's last step is no violation.
_ROUNDING = 1e-9

_LIMITED: tuple[tuple[Driven, str], ...] = (
    ("rate", "rad/s"),
    ("acceleration", "rad/s²"),
    ("jerk", "rad/s³"),
)


def coriolis_rows(metrics: Metrics) -> list[list[Cell]]:
    """Return what became of each part of the cross-coupling."""
    rows = []
    for component in COMPONENTS:
        part = metrics.coriolis.parts[component.key]
        grew = part.reduction is not None and part.reduction < 0
        sizes = (Cell(PAGE.fixed(each, 4)) for each in (*part.sizes.rms, *part.sizes.peak))
        rows.append([Cell(component.label), Cell(PAGE.change(part.reduction), _mark(grew)), *sizes])
    return rows


def turning_rows(metrics: Metrics) -> list[list[Cell]]:
    """Return the seat's rates and its total angular acceleration, a row a component."""
    worse = worse_numbers(metrics)
    rows = []
    for name, sizes in _turning(metrics):
        total = sizes is metrics.felt.turning
        bad = (False, total and "turning rms" in worse, False, total and "turning peak" in worse)
        cells = [
            Cell(PAGE.fixed(each, 4), _mark(mark))
            for each, mark in zip((*sizes.rms, *sizes.peak), bad, strict=True)
        ]
        if any(cell.text != PAGE.unknown for cell in cells):
            rows.append([Cell(name), *cells])
    return rows


def _turning(metrics: Metrics) -> Iterator[tuple[str, RateSizes | TurningSizes]]:
    for rate, sizes in metrics.felt.seat_rate.items():
        yield f"{'|W|' if rate == 'magnitude' else rate} [rad/s]", sizes
    for axis, each in metrics.felt.seat_angular_acceleration.items():
        yield f"{'|α|' if axis == 'magnitude' else f'α{axis}'} [rad/s²]", each


def limit_rows(metrics: Metrics) -> list[list[Cell]]:
    """Return what each joint is driven with beside its limits, asked for and modified."""
    rows = []
    for joint in JOINTS:
        modified = metrics.limits.modified[joint]
        loads = (metrics.limits.desired[joint], modified)
        for driven, unit in _LIMITED:
            limit = modified.limit(driven)
            peaks = (_peak(load.peak(driven), limit) for load in loads)
            rows.append([Cell(f"{joint} {driven} [{unit}]"), Cell(PAGE.number(limit, 4)), *peaks])
        if any(load.rate_step_rad_s for load in loads):
            steps = (Cell(PAGE.fixed(load.rate_step_rad_s, 4)) for load in loads)
            rows.append([Cell(f"{joint} step of the rate [rad/s]"), Cell(PAGE.unknown), *steps])
        changes = [PAGE.number(load.acceleration_sign_changes, 4) for load in loads]
        if any(text != PAGE.unknown for text in changes):
            label = f"{joint}, sign changes of its acceleration"
            rows.append([Cell(label), Cell(""), *map(Cell, changes)])
        rows.append([Cell(f"{joint}, all limits"), Cell(""), *map(_verdict, loads)])
    return rows


def _peak(peak: float | None, limit: float | None) -> Cell:
    over = limit is not None and peak is not None and peak > limit * (1 + _ROUNDING)
    return Cell(f"{PAGE.fixed(peak, 4)} exceeds", "bad") if over else Cell(PAGE.fixed(peak, 4))


def _verdict(load: JointLoad) -> Cell:
    """Say whether a joint keeps its limits: also those of the angle, and steps of the rate."""
    return Cell("broken", "bad") if load.ok is False else Cell("kept" if load.ok else PAGE.unknown)


def joint_rows(metrics: Metrics) -> list[list[Cell]]:
    """Return how far each joint is off, over the maneuver and at its ends [deg, deg/s]."""
    fidelity = metrics.fidelity
    columns: tuple[Mapping[Joint, float | None], ...] = (
        fidelity.joint_rms_rad,
        *fidelity.offset("start"),
        *fidelity.offset("end"),
    )
    rows = []
    for joint in JOINTS:
        values = (column.get(joint) for column in columns)
        degrees = (None if value is None else math.degrees(value) for value in values)
        rows.append([Cell(joint), *(Cell(PAGE.fixed(value)) for value in degrees)])
    return rows


def seat_rows(metrics: Metrics) -> list[list[Cell]]:
    """Return extremes, onset and jumps of the G-vector by axis, before and after."""
    rows, worse = [], worse_numbers(metrics)
    for axis in G_AXES:
        sizes = metrics.felt.seat_g[axis]
        cells = [
            Cell(_from_to(sizes.least)),
            Cell(_from_to(sizes.largest)),
            Cell(_from_to(sizes.onset), _mark(f"{axis} onset" in worse)),
            Cell(_from_to(sizes.jump)),
            Cell(PAGE.fixed(sizes.rms_error_g)),
        ]
        if any(cell.text != PAGE.unknown for cell in cells):
            rows.append([Cell(axis_name(axis)), *cells])
    return rows


def _from_to(pair: BeforeAfter) -> str:
    if pair.known is None:
        return PAGE.unknown
    return f"{PAGE.fixed(pair.before)} {PAGE.arrow} {PAGE.fixed(pair.after)}"


def _mark(bad: bool) -> str:
    return "bad" if bad else ""
