"""Random problems as users pose them: maneuvers, machines, budgets, ends, leads, holds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from des_cli.model.machine import JOINTS, Machine, OccupantBounds
from des_cli.model.machines import DES
from des_cli.model.metric import Budget, MetricKey
from des_cli.model.motion import Motion
from des_cli.model.profile import Profile, Reduction
from tests.support.claims import profile_of

RANGES: dict[MetricKey, tuple[float, float]] = {
    "joint_deviation_relative": (0.01, 0.1),
    "joint_deviation_relative_squared": (1e-4, 1e-2),
    "seat_rate_deviation_relative": (0.03, 0.3),
    "seat_g_deviation_relative": (0.01, 0.1),
    "seat_g_rms_error_g": (0.02, 0.2),
    "seat_angular_acceleration_deviation_relative": (0.1, 0.6),
    "seat_angular_acceleration_rms_error_rad_s2": (0.05, 0.5),
    "attitude_error_max_deg": (2.0, 10.0),
    "seat_angular_acceleration_rms_ratio": (0.7, 1.2),
    "seat_angular_acceleration_peak_ratio": (0.7, 1.2),
}
"""Least and most of each kind of budget."""

USUAL: tuple[MetricKey, ...] = (
    "joint_deviation_relative",
    "seat_rate_deviation_relative",
    "seat_g_rms_error_g",
    "seat_angular_acceleration_rms_error_rad_s2",
    "attitude_error_max_deg",
    "seat_angular_acceleration_peak_ratio",
)
"""The kinds of which these problems have one or two."""

ENDS = ("match-start", "free", "match-rates", "match-both")


def random_profile(seed: int) -> Profile:
    """Return a profile that may or may not have a solution inside its machine's limits."""
    draw = np.random.default_rng(seed)
    motion = _motion(draw)
    return profile_of(motion, _reduction(draw), _machine(draw))


def random_budgets(draw: np.random.Generator, kinds: Sequence[MetricKey]) -> tuple[Budget, ...]:
    """Return one or two budgets, each of another kind."""
    chosen = draw.choice(len(kinds), size=draw.integers(1, 2, endpoint=True), replace=False)
    return tuple(
        Budget(kinds[i], math.exp(draw.uniform(*np.log(RANGES[kinds[i]])))) for i in chosen
    )


def _motion(draw: np.random.Generator) -> Motion:
    """Return smooth waves, in part with steps of the rates, uneven samples, joints that stand."""
    rows, duration = int(draw.integers(12, 41)), math.exp(draw.uniform(0.0, 3.0))
    share = draw.uniform(0.2, 1.0, rows - 1) if draw.random() < 0.3 else np.ones(rows - 1)
    t = duration * np.concatenate([[0.0], np.cumsum(share)]) / share.sum()
    angle, rate = np.zeros((rows, 3)), np.zeros((2, rows - 1, 3))
    loudness = draw.uniform(0.1, 1.0)
    for j, (rise, speed) in enumerate(((0.3, 1.5), (0.8, 0.0), (0.8, 0.0))):
        first = speed * draw.uniform(0.0, 1.0)
        angle[:, j] = draw.uniform(-0.5, 0.5) + first * t
        rate[:, :, j] = first
        if draw.random() < 0.15:
            continue
        for wave in (1, 2):
            w = 2.0 * math.pi * wave * draw.uniform(0.7, 1.3) / max(duration, 6.0)
            phase = draw.uniform(0.0, 2.0 * math.pi)
            size = loudness * rise * draw.normal() / wave**2
            angle[:, j] += size * np.sin(w * t + phase)
            smooth = size * w * np.cos(w * t + phase)
            rate[:, :, j] += np.stack([smooth[:-1], smooth[1:]])
        if draw.random() < 0.2:
            at, step = draw.integers(1, rows - 1), draw.uniform(-0.1, 0.1)
            angle[at:, j] += step * (t[at:] - t[at])
            rate[:, at:, j] += step
    return Motion(t, angle, rate[0], rate[1])


def _machine(draw: np.random.Generator) -> Machine:
    limits: Any = tuple(
        replace(
            limit,
            rate=limit.rate * draw.uniform(0.5, 2.0),
            acceleration=limit.acceleration * (most := draw.uniform(0.5, 3.0)),
            jerk=limit.acceleration * most * draw.choice([1.0, 2.0, 5.0, math.inf]),
        )
        for limit in DES.limits
    )
    machine = replace(DES, limits=limits, name="drawn")
    if draw.random() < 0.2:
        occupant = OccupantBounds(gy=(-2.0, 2.0), angular_acceleration=draw.uniform(0.5, 3.0))
        machine = replace(machine, occupant=occupant)
    return machine


def _reduction(draw: np.random.Generator) -> Reduction:
    control = draw.choice(["scalar", "per-joint", "free"], p=[0.6, 0.37, 0.03])
    options: dict[str, Any] = {
        "control": control,
        "axes": draw.choice(["seat", "report"]),
        "ends": draw.choice(ENDS if control == "free" else ("match-start", "match-both")),
        "hold": frozenset({str(draw.choice(JOINTS))})
        if draw.random() < 0.15 and control != "scalar"
        else frozenset(),
        "allow_change": 0.5 if draw.random() < 0.5 else None,
        "budget": (),
        "r2": np.full(3, math.exp(draw.uniform(-3.0, 2.0))),
    }
    if control == "free" or draw.random() < 0.05:
        options["budget"] = random_budgets(draw, USUAL)
    if draw.random() < 0.2:
        options |= {"lead_in": 8.0, "lead_out": 8.0}
    return Reduction(**options)
