"""The rows of a run's summary: what is felt, and what stands behind it."""

from __future__ import annotations

from collections.abc import Collection
from typing import get_args

from des_cli.model.coriolis import ComponentKey
from des_cli.model.loads import Driven
from des_cli.model.metric import (
    ATTITUDE_ERROR,
    JOINT_DEVIATION,
    JOINT_DEVIATION_SQUARED,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
)
from des_cli.model.metrics import Change, Metrics, When
from des_cli.results.budgets import spent_budgets
from des_cli.results.ends import end_words
from des_cli.results.worse import FeltNumber
from des_cli.show.words import CONSOLE, PARTS, axis_name, steps_taken, told_parts

_DRIVEN: tuple[Driven, ...] = get_args(Driven)


def felt_words(metrics: Metrics) -> str:
    """Say in one line what the pilot feels of the reduction."""
    rate, error = metrics.fidelity.value(SEAT_RATE_DEVIATION), metrics.fidelity.value(SEAT_G_ERROR)
    reduction = metrics.coriolis.reduction("vector")
    return _joined(
        ("cross-coupling", "" if reduction is None else CONSOLE.less(reduction), ""),
        ("seat rate off by", "" if rate is None else CONSOLE.percent(rate), ""),
        ("G off by", "" if error is None else CONSOLE.number(error), "g rms"),
    )


def felt_rows(
    metrics: Metrics, objective: Collection[str], told: Collection[FeltNumber] = ()
) -> list[tuple[str, str]]:
    """Return labels and texts of what is felt, beside what `felt_words` says.

    Parameters
    ----------
    metrics : Metrics
    objective : collection of str
        The parts of the cross-coupling that are weighed, by their keys.
    told : collection of FeltNumber
        Numbers that are left out, because they were told as what got worse.
    """
    seat: tuple[ComponentKey, ...] = ("seat_x", "seat_y", "seat_z")
    weighed = tuple(key for key in told_parts(objective) if key not in ("vector", *seat))
    size = CONSOLE.from_to(metrics.coriolis.parts["vector"].sizes.rms)
    rows = [
        (
            "cross-coupling",
            "; ".join(
                text
                for text in (
                    f"{size} rad/s² rms" if size else "",
                    changes(metrics, (*weighed, *seat)),
                )
                if text
            ),
        ),
        ("turning", _turning(metrics, told)),
        ("seat G", _force(metrics, told)),
        ("ends", _ends(metrics)),
    ]
    return [(label, text) for label, text in rows if text]


def other_rows(metrics: Metrics) -> list[tuple[str, str]]:
    """Return labels and texts of what stands behind it: budgets, the study, the solver."""
    solver = metrics.solver
    how = (
        f"{solver.method} cross-coupling by {solver.algorithm}, "
        f"{solver.control} control, {solver.axes} axes"
    )
    rows = [
        ("changed first", changed_words(metrics)),
        ("budgets", _budgets(metrics)),
        ("constants", _constants(metrics)),
        ("study", "; ".join(_study(metrics))),
        ("solved", f"{solver.status} in {steps_taken(solver.iterations)} ({how})"),
    ]
    return [(label, text) for label, text in rows if text]


def _budgets(metrics: Metrics) -> str:
    told = ", ".join(map(str, spent_budgets(metrics)))
    return f"{told} (of what the reduction adds)" if told and metrics.added else told


def changed_words(metrics: Metrics) -> str:
    """Say what each step before the reduction changed of the record."""
    steps = {
        "damping": metrics.changes.damping,
        "machine": metrics.changes.machine,
        "smoothing": metrics.changes.smoothing,
        "limits": metrics.executable.change,
    }
    told = {name: _change_numbers(step or Change()) for name, step in steps.items()}
    return "; ".join(f"{name} {', '.join(numbers)}" for name, numbers in told.items() if numbers)


def _change_numbers(step: Change) -> list[str]:
    """Return the numbers of a step that are worth telling."""
    rate = step.value(SEAT_RATE_DEVIATION) or 0.0
    force = step.value(SEAT_G_ERROR) or 0.0
    attitude = step.value(ATTITUDE_ERROR) or 0.0
    numbers = [
        text
        for value, least, text in (
            (rate, 0.0005, f"seat rate {CONSOLE.percent(rate)}"),
            (force, 0.0005, f"G {CONSOLE.number(force)} g rms"),
            (attitude, 0.05, f"attitude {CONSOLE.number(attitude)} deg"),
        )
        if value >= least
    ]
    reduction = step.coriolis_reduction
    if numbers and reduction is not None and abs(reduction) >= 0.0005:
        numbers.append(f"cross-coupling {CONSOLE.less(reduction)}")
    return numbers


def _constants(metrics: Metrics) -> str:
    """Say which constants were found together with the motion."""
    pairs = {name: each.angle.known for name, each in (metrics.parameters or {}).items()}
    return ", ".join(
        f"{name.replace('_', ' ')} {CONSOLE.fixed(pair[0], 1)} -> {CONSOLE.fixed(pair[1], 1)} deg"
        for name, pair in pairs.items()
        if pair is not None
    )


def changes(metrics: Metrics, keys: tuple[ComponentKey, ...]) -> str:
    """Say what became of components, of those of which it is known."""
    return ", ".join(
        f"{PARTS[key]} {CONSOLE.less(reduction)}"
        for key in keys
        if (reduction := metrics.coriolis.reduction(key)) is not None
    )


def _joined(*parts: tuple[str, str, str]) -> str:
    """Join the parts that are known: what stands before, the numbers, what stands behind."""
    return ", ".join(
        f"{before} {numbers} {behind}".strip() for before, numbers, behind in parts if numbers
    )


def _turning(metrics: Metrics, told: Collection[FeltNumber]) -> str:
    turning = metrics.felt.turning
    rms = "" if "turning rms" in told else CONSOLE.from_to(turning.rms)
    peak = "" if "turning peak" in told else CONSOLE.from_to(turning.peak)
    return _joined(
        ("total angular acceleration", rms, "rad/s² rms"),
        ("peak", peak, "" if rms else "rad/s²"),
    )


def _force(metrics: Metrics, told: Collection[FeltNumber]) -> str:
    tilt = metrics.fidelity.tilt_error_max_deg
    axis, sizes = metrics.felt.hardest_onset, metrics.felt.seat_g
    peak = "" if "gy peak" in told else CONSOLE.from_to(sizes["gy"].peak)
    onset = "" if f"{axis} onset" in told else CONSOLE.from_to(sizes[axis].onset)
    return _joined(
        ("tilt", "" if tilt is None else CONSOLE.number(tilt), "deg at most"),
        ("peak Gy", peak, "g"),
        (f"{axis_name(axis)} onset", onset, "g/s"),
    )


def _ends(metrics: Metrics) -> str:
    told: list[str] = []
    for when in get_args(When):
        words = end_words(metrics.fidelity, when)
        if words:
            told.append(f"{when} {words if words.startswith('as') else f'off by {words}'}")
    return ", ".join(told)


def limits_used(metrics: Metrics) -> str:
    """Say how much of each kind of limit the modified motion uses, by its busiest joint."""
    parts = []
    for driven in _DRIVEN:
        shares = []
        for joint, load in metrics.limits.modified.items():
            peak, limit = load.peak(driven), load.limit(driven)
            if peak is not None and limit:
                shares.append((peak / limit, joint))
        if shares:
            share, joint = max(shares)
            parts.append(f"{driven} {CONSOLE.percent(share)} ({joint})")
    return f"; used at most: {', '.join(parts)}" if parts else ""


def _study(metrics: Metrics) -> list[str]:
    """Say what the study's measure is, and what simpler means get on the same profile."""
    joints = CONSOLE.percent(metrics.fidelity.value(JOINT_DEVIATION))
    squared = CONSOLE.percent(metrics.fidelity.value(JOINT_DEVIATION_SQUARED))
    texts = [f"joints off by {joints} (squared {squared})"]
    sweep, constant = metrics.baseline.report_sweep, metrics.baseline.constant_p
    if sweep:
        cost = CONSOLE.percent(sweep.joint_deviation)
        texts.append(f"its sweep: {CONSOLE.less(sweep.reduction)} at {cost}")
    if constant:
        texts.append(
            f"a constant factor: as much by p = {CONSOLE.number(constant.p)} "
            f"at {CONSOLE.percent(constant.joint_deviation)}"
        )
    return texts
