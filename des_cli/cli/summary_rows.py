"""The rows of a run's summary: what is felt first, then what it cost."""

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
from des_cli.show.words import CONSOLE, PARTS, axis_name, told_parts

_DRIVEN: tuple[Driven, ...] = get_args(Driven)


def summary_rows(metrics: Metrics, objective: Collection[str]) -> list[tuple[str, str]]:
    """Return labels and texts of the summary: what is felt first.

    Parameters
    ----------
    metrics : Metrics
    objective : collection of str
        The parts of the cross-coupling that are weighed, by their keys.
    """
    rows = [
        ("changed first", changed_words(metrics)),
        ("cross-coupling", changes(metrics, told_parts(objective), rms=True)),
        ("", changes(metrics, ("seat_x", "seat_y", "seat_z"))),
        ("turning", _turning(metrics)),
        ("seat G", _force(metrics)),
        ("budgets", _budgets(metrics)),
        ("constants", _constants(metrics)),
        ("ends", _ends(metrics)),
        ("study", "; ".join(_study(metrics))),
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


def changes(metrics: Metrics, keys: tuple[ComponentKey, ...], *, rms: bool = False) -> str:
    """Say what became of components; with ``rms`` also of the whole vector's size."""
    texts = []
    for key in keys:
        part = metrics.coriolis.parts[key]
        text = f"{PARTS[key]} {CONSOLE.less(part.reduction)}"
        pair = CONSOLE.from_to(part.sizes.rms) if rms and key == "vector" else ""
        texts.append(f"{text} ({pair} rad/s² rms)" if pair else text)
    return ", ".join(texts)


def _joined(*parts: tuple[str, str, str]) -> str:
    """Join the parts that are known: what stands before, the numbers, what stands behind."""
    return ", ".join(
        f"{before} {numbers} {behind}".strip() for before, numbers, behind in parts if numbers
    )


def _turning(metrics: Metrics) -> str:
    rate, turning = metrics.fidelity.value(SEAT_RATE_DEVIATION), metrics.felt.turning
    return _joined(
        ("total angular acceleration", CONSOLE.from_to(turning.rms), "rad/s² rms"),
        ("peak", CONSOLE.from_to(turning.peak), ""),
        ("seat rate off by", "" if rate is None else CONSOLE.percent(rate), ""),
    )


def _force(metrics: Metrics) -> str:
    error, tilt = metrics.fidelity.value(SEAT_G_ERROR), metrics.fidelity.tilt_error_max_deg
    axis, sizes = metrics.felt.hardest_onset, metrics.felt.seat_g
    return _joined(
        ("off by", "" if error is None else CONSOLE.number(error), "g rms"),
        ("tilt", "" if tilt is None else CONSOLE.number(tilt), "deg at most"),
        ("peak Gy", CONSOLE.from_to(sizes["gy"].peak), "g"),
        (f"{axis_name(axis)} onset", CONSOLE.from_to(sizes[axis].onset), "g/s"),
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
