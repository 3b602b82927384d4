"""The rows of a run's summary: what is felt first, then what it cost."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, get_args

from des_cli.batch.job import JobResult
from des_cli.model.coriolis import COMPONENTS
from des_cli.model.machine import JOINTS
from des_cli.results.budgets import spent_budgets
from des_cli.results.ends import When, end_words
from des_cli.results.reading import number as read
from des_cli.results.reading import section

_G_AXES = ("gx", "gy", "gz")
_KINDS = ("peak", "limit")

CHANGES = {
    "damping": "changes.damping",
    "machine": "changes.machine",
    "smoothing": "changes.smoothing",
    "limits": "executable",
}
"""Steps from the record to the motion that is reduced, and where the metrics have them."""

_TOTAL = "felt.seat_angular_acceleration.magnitude"


def summary_rows(result: JobResult) -> list[tuple[str, str]]:
    """Return labels and texts of the summary, from the metrics alone: what is felt first."""
    assert result.metrics is not None
    metrics = result.metrics
    rows = [
        ("changed first", changed_words(metrics)),
        ("cross-coupling", changes(metrics, objective_keys(result), rms=True)),
        ("", changes(metrics, ("seat_x", "seat_y", "seat_z"))),
        ("turning", _turning(metrics)),
        ("seat G", _force(metrics)),
        ("budgets", _budgets(metrics)),
        ("constants", _constants(metrics)),
        ("ends", _ends(metrics)),
        ("study", "; ".join(_study(metrics))),
    ]
    return [(label, text) for label, text in rows if text]


def _budgets(metrics: Mapping[str, Any]) -> str:
    told = ", ".join(map(str, spent_budgets(metrics)))
    return f"{told} (of what the reduction adds)" if told and metrics.get("added") else told


def changed_words(metrics: Mapping[str, Any]) -> str:
    """Say what each step before the reduction changed of the record."""
    steps = {name: _change_numbers(section(metrics, path)) for name, path in CHANGES.items()}
    return "; ".join(f"{name} {', '.join(numbers)}" for name, numbers in steps.items() if numbers)


def _change_numbers(step: Mapping[str, Any]) -> list[str]:
    """Return the numbers of a step that are worth telling."""
    rate, force, attitude = (
        read(step, key) or 0.0
        for key in ("seat_rate_deviation_relative", "seat_g_rms_error_g", "attitude_error_max_deg")
    )
    numbers = [
        text
        for value, least, text in (
            (rate, 0.0005, f"seat rate {percent(rate)}"),
            (force, 0.0005, f"G {number(force)} g rms"),
            (attitude, 0.05, f"attitude {number(attitude)} deg"),
        )
        if value >= least
    ]
    reduction = read(step, "coriolis_reduction")
    if numbers and reduction is not None and abs(reduction) >= 0.0005:
        numbers.append(f"cross-coupling {change(reduction)}")
    return numbers


def _constants(metrics: Mapping[str, Any]) -> str:
    """Say which constants were found together with the motion."""
    return ", ".join(
        f"{name.replace('_', ' ')} {each['before_deg']:.1f} -> {each['after_deg']:.1f} deg"
        for name, each in (metrics.get("parameters") or {}).items()
    )


def change(reduction: float | None) -> str:
    """Say a reduction in words that need no sign.

    >>> change(0.689), change(-0.28), change(None)
    ('68.9 % less', '28.0 % more', 'not known')
    """
    if reduction is None or not math.isfinite(reduction):
        return "not known"
    return f"{percent(abs(reduction))} {'less' if reduction >= 0 else 'more'}"


def percent(value: float | None) -> str:
    """Write a ratio in percent, with digits that mean something.

    >>> percent(0.6892), percent(0.00163), percent(7.5)
    ('68.9 %', '0.16 %', '750 %')
    """
    if value is None or not math.isfinite(value):
        return "not known"
    hundredths = 100.0 * value
    size = abs(hundredths)
    digits = 0 if size >= 100 else 1 if size >= 1 else 2
    return f"{hundredths:.{digits}f} %"


def number(value: float | None) -> str:
    """Write a number with three digits."""
    return "not known" if value is None or not math.isfinite(value) else f"{value:.3g}"


def objective_keys(result: JobResult) -> tuple[str, ...]:
    """Name the whole vector, and the component that was weighed, if it is one."""
    return ("vector", *(result.objective if len(result.objective) == 1 else ()))


def changes(metrics: Mapping[str, Any], keys: tuple[str, ...], *, rms: bool = False) -> str:
    """Say what became of components; with ``rms`` also of the whole vector's size."""
    texts = []
    for key in keys:
        label = next(component.label for component in COMPONENTS if component.key == key)
        text = f"{label} {change(read(metrics, f'coriolis.{key}.reduction'))}"
        pair = _pair(metrics, f"coriolis.{key}.rms", "rad_s2") if rms and key == "vector" else ""
        texts.append(f"{text} ({pair} rad/s² rms)" if pair else text)
    return ", ".join(texts)


def _pair(metrics: Mapping[str, Any], stem: str, unit: str) -> str:
    """Write a quantity before and after, empty where either is not known."""
    before, after = (read(metrics, f"{stem}_{when}_{unit}") for when in ("before", "after"))
    return "" if before is None or after is None else f"{number(before)} -> {number(after)}"


def _joined(*parts: tuple[str, str, str]) -> str:
    """Join the parts that are known: what stands before, the numbers, what stands behind."""
    return ", ".join(
        f"{before} {numbers} {behind}".strip() for before, numbers, behind in parts if numbers
    )


def _turning(metrics: Mapping[str, Any]) -> str:
    rate = read(metrics, "fidelity.seat_rate_deviation_relative")
    return _joined(
        ("total angular acceleration", _pair(metrics, f"{_TOTAL}.rms", "rad_s2"), "rad/s² rms"),
        ("peak", _pair(metrics, f"{_TOTAL}.peak", "rad_s2"), ""),
        ("seat rate off by", "" if rate is None else percent(rate), ""),
    )


def _force(metrics: Mapping[str, Any]) -> str:
    error = read(metrics, "fidelity.seat_g_rms_error_g")
    tilt = read(metrics, "fidelity.tilt_error_max_deg")
    onsets = {axis: read(metrics, f"felt.seat_g.{axis}.onset_after_g_s") for axis in _G_AXES}
    axis = max(_G_AXES, key=lambda name: onsets[name] or 0.0)
    return _joined(
        ("off by", "" if error is None else number(error), "g rms"),
        ("tilt", "" if tilt is None else number(tilt), "deg at most"),
        ("peak Gy", _pair(metrics, "felt.seat_g.gy.peak", "g"), "g"),
        (f"{axis.capitalize()} onset", _pair(metrics, f"felt.seat_g.{axis}.onset", "g_s"), "g/s"),
    )


def _ends(metrics: Mapping[str, Any]) -> str:
    told: list[str] = []
    for when in get_args(When):
        words = end_words(metrics, when)
        if words:
            told.append(f"{when} {words if words.startswith('as') else f'off by {words}'}")
    return ", ".join(told)


def limits_used(metrics: Mapping[str, Any] | None) -> str:
    """Say how much of each kind of limit the modified motion uses, by its busiest joint."""
    parts = []
    for quantity, unit in (("rate", "rad_s"), ("acceleration", "rad_s2"), ("jerk", "rad_s3")):
        shares = []
        for joint in JOINTS:
            stem = f"limits.modified.{joint}.{quantity}"
            peak, limit = (read(metrics or {}, f"{stem}_{kind}_{unit}") for kind in _KINDS)
            if peak is not None and limit:
                shares.append((peak / limit, joint))
        if shares:
            share, joint = max(shares)
            parts.append(f"{quantity} {100 * share:.0f} % ({joint})")
    return f"; used at most: {', '.join(parts)}" if parts else ""


def _study(metrics: Mapping[str, Any]) -> list[str]:
    """Say what the study's measure is, and what simpler means get on the same profile."""
    joints = percent(read(metrics, "fidelity.joint_deviation_relative"))
    squared = percent(read(metrics, "fidelity.joint_deviation_relative_squared"))
    texts = [f"joints off by {joints} (squared {squared})"]
    for key, name in (("report_sweep", "its sweep"), ("constant_p", "a constant factor")):
        baseline = section(metrics, f"baseline.{key}")
        if baseline:
            cost = percent(read(baseline, "joint_deviation_relative"))
            gained = (
                change(read(baseline, "reduction"))
                if key == "report_sweep"
                else f"as much by p = {number(read(baseline, 'p'))}"
            )
            texts.append(f"{name}: {gained} at {cost}")
    return texts
