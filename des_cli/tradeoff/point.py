"""A point of the trade-off between Coriolis reduction and deviation: one reduction."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.metric import MetricKey
from des_cli.model.profile import Profile
from des_cli.model.run import Run
from des_cli.model.solution import Iteration
from des_cli.model.stage import OnStage, untold
from des_cli.model.tradeoff import SOLVED, TradePoint
from des_cli.pipeline import Prepared, reduce_profile

PARTS = ("objective", "bb3", "vector", "seat_x", "seat_y", "seat_z")
"""Parts of the Coriolis vector whose reduction a point has."""

COSTS: tuple[MetricKey, ...] = (
    "joint_deviation_relative",
    "seat_rate_deviation_relative",
    "seat_g_rms_error_g",
    "seat_angular_acceleration_rms_error_rad_s2",
    "attitude_error_max_deg",
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
    metrics = run.metrics
    measures = numbers_of(
        metrics["coriolis"], metrics["fidelity"], metrics["felt"], metrics["limits"]["modified"]
    )
    return replace(point, cost=run.solution.cost, **measures)


def mean_weight(r2: Floats) -> float:
    """Return the one weight of all joints, or the mean, without rounding where equal."""
    return float(r2[0]) if np.all(r2 == r2[0]) else float(r2.mean())


def numbers_of(
    coriolis: Mapping[str, Any],
    fidelity: Mapping[str, Any],
    felt: Mapping[str, Any],
    joints: Mapping[str, Any],
) -> dict[str, Any]:
    """Return the numbers of a point, by its fields.

    Parameters
    ----------
    coriolis, fidelity, felt : mapping
        Sections of the metrics.
    joints : mapping
        The section ``limits`` of the modified motion.
    """
    turning = felt["seat_angular_acceleration"]["magnitude"]
    return {
        **{f"{part}_reduction": coriolis[part]["reduction"] for part in PARTS},
        **{key: fidelity[key] for key in COSTS},
        **{
            f"seat_angular_acceleration_{kind}{column}_rad_s2": turning[f"{kind}_{when}_rad_s2"]
            for kind in ("rms", "peak")
            for column, when in (("_before", "before"), ("", "after"))
        },
        "limits_ok": all(joint["ok"] for joint in joints.values()),
    }


def _outcome(run: Run) -> tuple[str, str]:
    """Return the status of a run, its verification included, and a sentence."""
    failed = [check for check in run.checks if not check.ok]
    if run.solution.status in SOLVED and failed:
        words = (f"{c.name} is {c.value:.3g}, tolerance {c.tolerance:.3g}" for c in failed)
        return "unverified", f"verification failed: {'; '.join(words)}"
    return run.solution.status, run.solution.message
