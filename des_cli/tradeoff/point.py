"""A point of the trade-off between Coriolis reduction and deviation: one reduction."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.coriolis import ComponentKey
from des_cli.model.felt import Felt
from des_cli.model.loads import JointLoad
from des_cli.model.machine import Joint
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_ERROR,
    ATTITUDE_ERROR,
    JOINT_DEVIATION,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
    MetricKey,
)
from des_cli.model.metrics import CrossCoupling
from des_cli.model.profile import Profile
from des_cli.model.run import Run
from des_cli.model.solution import Iteration
from des_cli.model.stage import OnStage, untold
from des_cli.model.tradeoff import SOLVED, TradePoint
from des_cli.pipeline import Prepared, reduce_profile

PARTS: tuple[ComponentKey, ...] = ("bb3", "vector", "seat_x", "seat_y", "seat_z")
"""Parts of the Coriolis vector whose reduction a point has, beside the objective's."""

COSTS: tuple[MetricKey, ...] = (
    JOINT_DEVIATION,
    SEAT_RATE_DEVIATION,
    SEAT_G_ERROR,
    ANGULAR_ACCELERATION_ERROR,
    ATTITUDE_ERROR,
)
"""Fidelity metrics that a point has."""


def trade_point(
    profile: Profile,
    prepared: Prepared | None = None,
    on_iteration: Callable[[Iteration], None] | None = None,
    on_stage: OnStage = untold,
) -> TradePoint:
    """Reduce a profile and return its point on the trade-off curve.

    Parameters
    ----------
    profile : Profile
        With a budget, or a weight r2, which is what the point is named after.
    prepared : Prepared, optional
        Its desired motion, where that is made already.
    on_iteration : callable, optional
        Called with each line of the solver's log.
    on_stage : callable, optional
        Called with what is done next.

    Raises
    ------
    UsageError
        If the reduction asks for things that exclude each other.
    """
    run = reduce_profile(profile, prepared=prepared, on_iteration=on_iteration, on_stage=on_stage)
    reduction = profile.reduction
    swept, value = (
        (reduction.budget[0].metric, reduction.budget[0].most)
        if reduction.budget
        else ("r2", mean_weight(reduction.r2))
    )
    status, message = _outcome(run)
    point = TradePoint(
        "optimum",
        reduction.control,
        swept,
        value,
        status,
        iterations=run.solution.iterations,
        message=message,
    )
    if run.solution.status not in SOLVED:
        return point
    metrics = run.results
    fidelity = {metric: metrics.fidelity.value(metric) for metric in COSTS}
    measures = numbers_of(metrics.coriolis, fidelity, metrics.felt, metrics.limits.modified)
    return replace(point, cost=run.solution.cost, **measures)


def mean_weight(r2: Floats) -> float:
    """Return the one weight of all joints, or the mean, without rounding where equal."""
    return float(r2[0]) if np.all(r2 == r2[0]) else float(r2.mean())


def numbers_of(
    coriolis: CrossCoupling,
    fidelity: Mapping[MetricKey, float | None],
    felt: Felt,
    modified: Mapping[Joint, JointLoad],
) -> dict[str, Any]:
    """Return the numbers of a point, by its fields.

    Parameters
    ----------
    coriolis, felt
        Sections of the metrics.
    fidelity : mapping
        By ``COSTS``.
    modified : mapping
        How the modified motion loads each joint.
    """
    turning = felt.turning
    return {
        "objective_reduction": coriolis.objective.reduction,
        **{f"{part}_reduction": coriolis.reduction(part) for part in PARTS},
        **{key: fidelity[key] for key in COSTS},
        "seat_angular_acceleration_rms_before_rad_s2": turning.rms.before,
        "seat_angular_acceleration_rms_rad_s2": turning.rms.after,
        "seat_angular_acceleration_peak_before_rad_s2": turning.peak.before,
        "seat_angular_acceleration_peak_rad_s2": turning.peak.after,
        "limits_ok": all(load.ok for load in modified.values()),
    }


def _outcome(run: Run) -> tuple[str, str]:
    """Return the status of a run, its verification included, and a sentence."""
    failed = [check for check in run.checks if not check.ok]
    if run.solution.status in SOLVED and failed:
        return "unverified", f"verification failed: {'; '.join(map(str, failed))}"
    return run.solution.status, run.solution.message
