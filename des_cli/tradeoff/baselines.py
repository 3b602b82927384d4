"""What simpler means reach: the study's sweep, and one constant factor on all rates.

They follow the desired motion of the optima, and are measured as these are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from des_cli.kinematics.response import respond, respond_as_requested
from des_cli.model.motion import DesiredMotion, Motion
from des_cli.model.profile import Profile
from des_cli.model.response import Response
from des_cli.model.tradeoff import BASELINE, SOLVED, TradePoint
from des_cli.pipeline import Prepared, prepare_profile
from des_cli.reduction.baseline import objective_reduction
from des_cli.reduction.executable import nearest_executable
from des_cli.reduction.fidelity import Deviation
from des_cli.reduction.limits import find_violations
from des_cli.reduction.problem import Problem, pose_problem
from des_cli.reduction.study_law import sweep
from des_cli.results.coriolis import coriolis_metrics
from des_cli.results.felt import felt_metrics
from des_cli.results.joints import joint_metrics
from des_cli.study.backward_forward import follow
from des_cli.tradeoff.point import COSTS, mean_weight, numbers_of

CONSTANT_FACTORS = (0.99, 0.98, 0.95, 0.9, 0.85, 0.8, 0.7)
"""Constant p of the baseline; its joint deviation is about 1 - p."""


def baseline_points(
    profile: Profile, weights: Sequence[float] = (), prepared: Prepared | None = None
) -> list[TradePoint]:
    """Return the points of the study's sweep and of constant factors.

    Parameters
    ----------
    profile : Profile
        Its desired motion, made executable if it enforces limits, its axes and
        its r1 are taken; the factor is a scalar and phi is on the desired motion,
        as in the study.
    weights : sequence of float
        r2 of the study's law. Without one, the profile's.
    prepared : Prepared, optional
        The desired motion, where that is made already.
    """
    comparison = _Comparison.of(profile, (prepared or prepare_profile(profile)).asked)
    problem = comparison.problem
    points = [
        _study_point(replace(comparison, problem=replace(problem, r2=np.array([r2]))), r2)
        for r2 in weights or (mean_weight(profile.reduction.r2),)
    ]
    ones = np.ones((len(problem.desired.t), 1))
    for p in CONSTANT_FACTORS:
        measures = comparison.measure(follow(problem.desired, p * ones))
        points.append(TradePoint("constant-p", "scalar", "p", p, BASELINE, **measures))
    return points


@dataclass(frozen=True)
class _Comparison:
    """What the motion of a baseline is measured against.

    Parameters
    ----------
    profile : Profile
    asked : DesiredMotion
    before : Response
        Of what the profile asks for.
    problem : Problem
        The study's with one factor, along the executable motion and without limits.
    """

    profile: Profile
    asked: DesiredMotion
    before: Response
    problem: Problem

    @classmethod
    def of(cls, profile: Profile, asked: DesiredMotion) -> _Comparison:
        """Pose the study's problem of a profile along its desired motion."""
        desired = asked.motion
        if profile.reduction.limits == "enforce":
            executable, trouble = nearest_executable(profile.machine, desired)
            desired = desired if trouble else executable
        study = replace(
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
        problem = pose_problem(replace(profile, reduction=study), desired, asked.record)
        before = respond_as_requested(profile.machine, profile.seat, asked)
        return cls(profile, asked, before, problem)

    def measure(self, motion: Motion) -> dict[str, Any]:
        """Return the numbers of a motion's point."""
        machine, record, chain = self.profile.machine, self.asked.motion, self.problem.chain
        after = respond(machine, self.profile.seat, motion)
        deviation = Deviation(
            record,
            motion,
            self.before,
            after,
            (chain, chain),
            shortfall=self.asked.shortfall,
        )
        objective = objective_reduction(self.problem, motion)
        return numbers_of(
            coriolis_metrics(record.step, self.before, after, objective),
            {metric: deviation.value(metric) for metric in COSTS},
            felt_metrics(record, self.before, after),
            joint_metrics(
                machine, motion, "modified", find_violations(machine, motion, "modified")
            ),
        )


def _study_point(comparison: _Comparison, r2: float) -> TradePoint:
    """Return the point of the study's single sweep, without numbers where it ran away."""
    swept = sweep(comparison.problem)
    point = TradePoint(
        "report-sweep",
        "scalar",
        "r2",
        r2,
        BASELINE,
        iterations=swept.iterations,
        message=swept.message,
    )
    if swept.status not in SOLVED:
        return replace(point, status=swept.status)
    return replace(point, cost=swept.cost, **comparison.measure(swept.modified))
