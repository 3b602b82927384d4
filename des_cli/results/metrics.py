"""What a reduction gained and what it cost: the content of ``metrics.json``."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from des_cli.kinematics.chain import chain_of
from des_cli.model.arrays import Floats
from des_cli.model.loads import Loads
from des_cli.model.machine import JOINTS, Joint, Seat
from des_cli.model.metric import METRICS
from des_cli.model.metrics import (
    Added,
    BaselineFacts,
    Constant,
    ConstantBaseline,
    Fidelity,
    Metrics,
    ProfileFacts,
    Singularity,
    SolverFacts,
    SweepBaseline,
)
from des_cli.model.motion import DesiredMotion, Motion, Record
from des_cli.model.profile import Profile
from des_cli.model.response import Response
from des_cli.model.run import Violation
from des_cli.model.solution import Solution
from des_cli.reduction.baseline import Baselines
from des_cli.reduction.fidelity import Deviation
from des_cli.results.asked_g import asked_g_metrics
from des_cli.results.changes import condition_metrics, executable_metrics
from des_cli.results.coriolis import coriolis_metrics
from des_cli.results.felt import felt_metrics, tilt_error
from des_cli.results.joints import joint_metrics
from des_cli.results.notices import find_notices


@dataclass(frozen=True)
class Measured:
    """Everything that the metrics are taken of.

    ``before`` and ``after`` are the responses of the motion that the profile asks
    for, the record, and of the modified one; ``target`` is what conditioning made of
    it, ``desired`` the executable motion that the solver started from, and ``held`` what
    budgets hold against.
    """

    profile: Profile
    asked: DesiredMotion
    target: Motion
    desired: Motion
    held: Record
    seat: Seat
    solution: Solution
    before: Response
    after: Response
    violations: tuple[Violation, ...]
    baselines: Baselines


def measure(run: Measured) -> Metrics:
    """Return the metrics of a run, with what is to be said of them."""
    modified = run.solution.modified
    metrics = Metrics(
        profile=_profile(run.profile),
        solver=_solver(run.profile, run.solution),
        parameters=_parameters(run),
        asked_g=asked_g_metrics(run.asked.g_offset),
        coriolis=coriolis_metrics(
            run.asked.motion.step, run.before, run.after, run.baselines.reduction
        ),
        fidelity=_fidelity(run),
        added=_added(run),
        felt=felt_metrics(run.asked.motion, run.before, run.after),
        changes=condition_metrics(run.profile, run.asked, run.target),
        executable=executable_metrics(run.profile, run.target, run.desired),
        baseline=BaselineFacts(
            SweepBaseline(run.baselines.sweep_reduction, run.baselines.sweep_deviation),
            ConstantBaseline(run.baselines.constant_p, run.baselines.constant_deviation),
        ),
        limits=Loads(
            joint_metrics(run.profile.machine, run.asked.motion, "desired", run.violations),
            joint_metrics(run.profile.machine, modified, "modified", run.violations),
        ),
        singularity=_singularity(run.asked),
        violations=tuple(str(violation) for violation in run.violations),
    )
    notices = find_notices(run.profile, run.asked, metrics)
    return replace(
        metrics,
        notices=tuple(notice.text for notice in notices),
        notice_names=tuple(notice.name for notice in notices),
    )


def _profile(profile: Profile) -> ProfileFacts:
    return ProfileFacts(
        name=profile.name,
        sha256=profile.sha256,
        samples=len(profile.t),
        duration_s=float(profile.t[-1] - profile.t[0]),
        machine=profile.machine.name,
    )


def _parameters(run: Measured) -> dict[str, Constant] | None:
    """Return the constants that were found together with the motion, before and after."""
    profile = run.profile
    first, last = run.asked.motion.angle[0], run.solution.modified.angle[0]
    constants = {
        "seat_yaw": (profile.seat.yaw, run.seat.yaw),
        "seat_pitch": (profile.seat.pitch, run.seat.pitch),
        "fork_start": (first[1], last[1]),
        "cab_start": (first[2], last[2]),
    }
    return {
        name: Constant(*(float(np.degrees(each)) for each in constants[name]))
        for name in profile.reduction.optimise
    } or None


def _solver(profile: Profile, solution: Solution) -> SolverFacts:
    reduction = profile.reduction
    return SolverFacts(
        method=reduction.method,
        algorithm=reduction.algorithm,
        control=reduction.control,
        axes=reduction.axes,
        jacobian=reduction.jacobian,
        r1=tuple(tuple(row) for row in reduction.r1.tolist()),
        r2=tuple(reduction.r2.tolist()),
        tracking=tuple(reduction.tracking.tolist()),
        limits=reduction.limits,
        ends=reduction.ends,
        objective=reduction.objective,
        optimise=tuple(reduction.optimise),
        budget={each.metric: each.most for each in reduction.budget} or None,
        allow_change=reduction.allow_change,
        status=solution.status,
        converged=solution.converged,
        iterations=solution.iterations,
        cost=solution.cost,
        cost_unreduced=solution.cost_unreduced,
        optimality=solution.optimality,
        message=solution.message,
    )


def _fidelity(run: Measured) -> Fidelity:
    """Return what the reduction cost: in the joints, and as the pilot feels it.

    Everything is measured against the record: the motion that the profile asks for.
    """
    record, modified = run.asked.motion, run.solution.modified
    before, after, step = run.before, run.after, record.step
    off = modified.angle - record.angle
    square = np.einsum("n,nj,nj->j", record.weight, off, off)
    machine = run.profile.machine
    chains = (chain_of(machine, run.profile.seat), chain_of(machine, run.seat))
    deviation = Deviation(
        record, modified, before, after, chains, run.solution.control, run.asked.shortfall
    )
    start_angle = _by_joint(modified.angle[0] - record.angle[0])
    start_rate = _by_joint(modified.rate_start[0] - record.rate_start[0])
    tilt_most, tilt_rms = tilt_error(step, before.seat_g, after.seat_g)
    return Fidelity(
        metrics={key: _number(deviation.value(key)) for key in METRICS},
        joint_rms_rad=_by_joint(np.sqrt(square / step.sum())),
        start_error={
            **{f"{joint}_rad": value for joint, value in start_angle.items()},
            **{f"{joint}_rad_s": value for joint, value in start_rate.items()},
        },
        end_error_rad=_by_joint(modified.angle[-1] - record.angle[-1]),
        end_error_rad_s=_by_joint(modified.rate_end[-1] - record.rate_end[-1]),
        tilt_error_max_deg=tilt_most,
        tilt_error_rms_deg=tilt_rms,
    )


def _added(run: Measured) -> Added | None:
    """Return what the reduction adds to what was changed of the record, and to its ride.

    None where nothing was changed: then ``fidelity`` and ``felt`` tell all of it.
    """
    if run.held == run.asked.record:
        return None
    machine, held = run.profile.machine, run.held
    chains = (chain_of(machine, run.profile.seat), chain_of(machine, run.seat))
    deviation = Deviation.between(
        held.motion,
        run.solution.modified,
        chains,
        machine.gravity,
        run.solution.control,
        held.shortfall,
    )
    return Added(
        budgets={
            budget.metric: _number(deviation.value(budget.metric))
            for budget in run.profile.reduction.budget
        },
        felt=felt_metrics(held.motion, deviation.before, run.after),
    )


def _number(value: float) -> float | None:
    """Return None for what is not a number: a free motion has no factors."""
    return None if np.isnan(value) else value


def _by_joint(values: Floats) -> dict[Joint, float]:
    return {joint: float(value) for joint, value in zip(JOINTS, values, strict=True)}


def _singularity(asked: DesiredMotion) -> Singularity:
    recorded = asked.recorded_attitude_error
    return Singularity(
        min_abs_cos_fork=float(np.min(np.abs(np.cos(asked.motion.angle[:, 1])))),
        min_singular_value=asked.least_singular_value,
        damped_samples=int(np.sum(asked.damped)),
        max_residual_rad_s=float(np.max(np.linalg.norm(asked.residual, axis=1))),
        integration_error_max_deg=float(np.degrees(asked.attitude_error)),
        recorded_attitude_error_max_deg=None if recorded is None else float(np.degrees(recorded)),
    )
