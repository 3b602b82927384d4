"""Points of the trade-off between Coriolis reduction and deviation, each by itself.

An optimum is a run of the pipeline. The baselines, the study's sweep and constant
factors, follow the same desired motion, so that all points are measured alike.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import groupby, pairwise
from typing import Any

import numpy as np

from des_cli.kinematics.response import respond, respond_as_asked
from des_cli.model.arrays import Floats
from des_cli.model.motion import DesiredMotion, Motion
from des_cli.model.profile import Profile
from des_cli.model.run import Run
from des_cli.model.solution import Iteration, Solution
from des_cli.model.stage import OnStage, untold
from des_cli.model.tradeoff import BASELINE, SOLVED, TradePoint
from des_cli.pipeline import reduce_profile
from des_cli.reduction.baseline import compare
from des_cli.reduction.desired import find_desired
from des_cli.reduction.executable import nearest_executable
from des_cli.reduction.limits import find_violations
from des_cli.reduction.problem import Problem, pose_problem
from des_cli.reduction.report_sweep import sweep
from des_cli.reduction.transcription import Transcription
from des_cli.results.metrics import Measured, measure

CONSTANT_FACTORS = (0.99, 0.98, 0.95, 0.9, 0.85, 0.8, 0.7)
"""Constant p of the baseline; its joint deviation is about 1 - p."""

SLACK = 1e-3
"""Reduction that one point may have less than a tighter one before it is worth a word:
the regularisation beside a budget costs less than that."""


def trade_point(
    profile: Profile,
    on_iteration: Callable[[Iteration], None] | None = None,
    on_stage: OnStage = untold,
) -> TradePoint:
    """Reduce a profile and return its point on the trade-off curve.

    Parameters
    ----------
    profile : Profile
        With a budget, or a weight r2, which is what the point is named after.
    on_iteration : callable, optional
        Called with each line of the solver's log.
    on_stage : callable, optional
        Called with what is done next.

    Raises
    ------
    UsageError
        If the reduction asks for things that exclude each other.
    """
    run = reduce_profile(profile, on_iteration=on_iteration, on_stage=on_stage)
    wanted = profile.reduction
    swept, value = (
        (wanted.budget[0].metric, wanted.budget[0].most)
        if wanted.budget
        else ("r2", _weight(wanted.r2))
    )
    status, message = _outcome(run)
    point = TradePoint(
        "optimum",
        wanted.control,
        swept,
        value,
        status,
        iterations=run.solution.iterations,
        message=message,
    )
    if run.solution.status not in SOLVED:
        return point
    return replace(point, cost=run.solution.cost, **_measures(run.metrics))


def baseline_points(profile: Profile, weights: Sequence[float] = ()) -> list[TradePoint]:
    """Return the points of the study's sweep and of constant factors.

    Parameters
    ----------
    profile : Profile
        Its desired motion, made executable if it enforces limits, its axes and
        its r1 are taken; the factor is a scalar and phi is on the desired motion,
        as in the study.
    weights : sequence of float
        r2 of the study's law. Without one, the profile's.
    """
    asked = find_desired(profile)
    desired = asked.motion
    if profile.reduction.limits == "enforce":
        desired, trouble = nearest_executable(profile.machine, desired)
        desired = asked.motion if trouble else desired
    wanted = replace(
        profile.reduction,
        control="scalar",
        algorithm="report-sweep",
        method="minimum",
        jacobian="desired",
        hold=frozenset(),
        ends="free",
        limits="warn",
        budget=(),
    )
    profile = replace(profile, reduction=wanted)
    problem = pose_problem(profile, desired, asked.record)
    points = []
    for r2 in weights or (_weight(wanted.r2),):
        weighed = replace(problem, r2=np.array([r2]))
        points.append(_study_point(profile, asked, weighed, r2))
    for p in CONSTANT_FACTORS:
        measures = _measure(profile, asked, problem, _constant(problem, p))
        points.append(TradePoint("constant-p", "scalar", "p", p, BASELINE, **measures))
    return points


def doubts(points: Sequence[TradePoint]) -> list[str]:
    """Name the points that cannot be the best there is.

    A larger budget allows all that a smaller one does, and three equal factors are
    a scalar: a point with less reduction than one that it contains is a local minimum.
    """
    usable = [p for p in points if p.solved and p.objective_reduction is not None]
    budgets = sorted((p for p in usable if p.swept != "r2"), key=lambda p: (p.control, p.value))
    found = []
    for _, curve in groupby(budgets, key=lambda p: p.control):
        for tight, loose in pairwise(curve):
            if _reduction(loose) < _reduction(tight) - SLACK:
                found.append(
                    f"{_name(loose)} takes off less than {_name(tight)}: a local minimum, "
                    "not the best there is"
                )
    scalars = {(p.swept, p.value): p for p in usable if p.control == "scalar"}
    for point in usable:
        scalar = scalars.get((point.swept, point.value))
        if point.control == "scalar" or scalar is None:
            continue
        if point.swept != "r2":
            worse = _reduction(point) < _reduction(scalar) - SLACK
        else:
            worse = (point.cost or 0.0) > (scalar.cost or 0.0) * (1.0 + 1e-6)
        if worse:
            found.append(f"{_name(point)} is worse than {_name(scalar)}: a local minimum")
    return found


def _weight(r2: Floats) -> float:
    """Return the one weight of all joints, or the mean, without rounding where equal."""
    return float(r2[0]) if np.all(r2 == r2[0]) else float(r2.mean())


def _name(point: TradePoint) -> str:
    return f"{point.control} at {point.swept} = {point.value:g}"


def _reduction(point: TradePoint) -> float:
    assert point.objective_reduction is not None
    return point.objective_reduction


def _outcome(run: Run) -> tuple[str, str]:
    """Return the status of a run, its verification included, and a sentence."""
    failed = [check for check in run.checks if not check.ok]
    if run.solution.status in SOLVED and failed:
        words = (f"{c.name} is {c.value:.3g}, tolerance {c.tolerance:.3g}" for c in failed)
        return "unverified", f"verification failed: {'; '.join(words)}"
    return run.solution.status, run.solution.message


def _study_point(profile: Profile, asked: DesiredMotion, problem: Problem, r2: float) -> TradePoint:
    solution = sweep(problem)
    point = TradePoint(
        "report-sweep",
        "scalar",
        "r2",
        r2,
        BASELINE,
        iterations=solution.iterations,
        message=solution.message,
    )
    if solution.status not in SOLVED:
        return replace(point, status=solution.status)
    return replace(point, cost=solution.cost, **_measure(profile, asked, problem, solution))


def _constant(problem: Problem, p: float) -> Solution:
    """Return the motion of one constant factor as if it were a solution."""
    grid = Transcription(problem)
    control: Floats = np.full((grid.n, 1), p)
    x = grid.follow(control)
    modified: Motion = grid.motion(x)
    return Solution(
        status="converged",
        message=f"a constant factor p = {p:g}",
        control=control,
        modified=modified,
        adjoint=np.zeros((grid.n, 3)),
        cost=grid.cost(x),
        cost_unreduced=grid.cost(grid.desired),
        optimality=float("nan"),
        iterations=0,
    )


def _measure(
    profile: Profile, asked: DesiredMotion, problem: Problem, solution: Solution
) -> dict[str, Any]:
    """Measure a baseline as the pipeline measures an optimum."""
    before = respond_as_asked(profile.machine, profile.seat, asked)
    after = respond(profile.machine, profile.seat, solution.modified)
    violations = find_violations(profile.machine, solution.modified, "modified")
    against = compare(problem, solution.modified)
    return _measures(
        measure(
            Measured(
                profile=profile,
                asked=asked,
                target=asked.motion,
                desired=problem.desired,
                held=asked.record,
                seat=profile.seat,
                solution=solution,
                before=before,
                after=after,
                violations=violations,
                baselines=against,
            )
        )
    )


def _measures(metrics: Mapping[str, Any]) -> dict[str, Any]:
    """Return the numbers of a point from the metrics of a run."""
    parts = ("objective", "bb3", "vector", "seat_x", "seat_y", "seat_z")
    costs = (
        "joint_deviation_relative",
        "seat_rate_deviation_relative",
        "seat_g_rms_error_g",
        "seat_angular_acceleration_rms_error_rad_s2",
        "attitude_error_max_deg",
    )
    turning = metrics["felt"]["seat_angular_acceleration"]["magnitude"]
    return {
        **{f"{part}_reduction": metrics["coriolis"][part]["reduction"] for part in parts},
        **{key: metrics["fidelity"][key] for key in costs},
        **{
            f"seat_angular_acceleration_{kind}{column}_rad_s2": turning[f"{kind}_{when}_rad_s2"]
            for kind in ("rms", "peak")
            for column, when in (("_before", "before"), ("", "after"))
        },
        "limits_ok": all(joint["ok"] for joint in metrics["limits"]["modified"].values()),
    }
