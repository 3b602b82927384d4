"""What a solution claims, for the verification: a profile round a motion or a problem."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, Machine, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.model.profile import JointCommands, Profile, Reduction
from des_cli.model.run import Check
from des_cli.model.solution import Solution
from des_cli.reduction.problem import Problem
from des_cli.verify.budgets import measure
from des_cli.verify.claim import Claim
from des_cli.verify.verify import verify
from tests.reduction.conftest import study_cost, study_motion


def profile_of(motion: Motion, reduction: Reduction, machine: Machine = DES) -> Profile:
    """A profile that asks for a motion, by joint commands."""
    command = JointCommands(
        arm_rate=motion.rate[:, 0],
        position=motion.angle[:, 1:],
        rate_start=motion.rate_start[:, 1:],
        rate_end=motion.rate_end[:, 1:],
    )
    return Profile("claim", motion.t, command, machine, seat=Seat(), reduction=reduction)


def solution_of(motion: Motion, control: Floats | None = None) -> Solution:
    """A motion as a solution that tells no cost, with factors (n, m) or without."""
    none = np.zeros((len(motion.t), 0))
    return Solution(
        status="converged",
        message="",
        control=none if control is None else control,
        modified=motion,
        adjoint=none,
        cost=0.0,
        cost_unreduced=0.0,
        optimality=0.0,
        iterations=0,
    )


def claim_of(
    modified: Motion,
    *,
    requested: Motion | None = None,
    desired: Motion | None = None,
    machine: Machine = DES,
    factors: Floats | None = None,
    further: dict[str, Any] | None = None,
    **options: Any,
) -> Claim:
    """The claim that a motion is a free one's solution, without budgets unless told.

    ``further`` goes to the claim, ``options`` to the reduction.
    """
    requested = requested or modified
    profile = profile_of(requested, Reduction(**{"budget": (), **options}), machine)
    solution = solution_of(modified, factors)
    return Claim(
        profile, requested, desired or requested, profile.seat, solution, **(further or {})
    )


def remade(problem: Problem, solution: Solution, control: Floats) -> Solution:
    """A solution of other factors, with its motion and cost by the study's closed forms."""
    x = study_motion(problem, control)
    factor = np.broadcast_to(control, (len(control), 3))
    motion = Motion(
        problem.desired.t,
        x[:, :3],
        factor[:-1] * problem.desired.rate_start,
        factor[1:] * problem.desired.rate_end,
    )
    cost = float(study_cost(problem, x))
    return replace(solution, control=control, modified=motion, cost=cost)


def claim_of_factors(problem: Problem, control: Floats, **options: Any) -> Claim:
    """The claim that factors solve a problem, with motion and costs by the closed forms."""
    desired = problem.desired
    ones = study_motion(problem, np.ones_like(control))
    solution = remade(problem, solution_of(desired), control)
    solution = replace(solution, cost_unreduced=float(study_cost(problem, ones)))
    claim = claim_of(desired, machine=problem.machine or DES, **{"limits": "warn", **options})
    return replace(claim, solution=solution, posed=problem)


def values_of(checks: Iterable[Check]) -> dict[str, float]:
    """What was measured, by key; no key twice."""
    checks = list(checks)
    values = {check.key: check.value for check in checks}
    assert len(values) == len(checks)
    return values


def failing(checks: Iterable[Check]) -> set[str]:
    """The keys of the checks that fail."""
    return {check.key for check in checks if not check.ok}


def checks_of_factors(
    problem: Problem, solution: Solution, reduction: Reduction
) -> tuple[Check, ...]:
    """Verify factors; ends, held joints and limits are those of the problem."""
    reduction = replace(
        reduction,
        ends=problem.ends,
        hold=frozenset(np.array(JOINTS)[problem.held].tolist()),
        limits="warn" if problem.machine is None else "enforce",
    )
    profile = profile_of(problem.desired, reduction, problem.machine or DES)
    desired = problem.desired
    return verify(Claim(profile, desired, desired, profile.seat, solution, problem))


def failed_of_factors(problem: Problem, solution: Solution, reduction: Reduction) -> list[str]:
    """The keys of the checks that fail."""
    return [c.key for c in checks_of_factors(problem, solution, reduction) if not c.ok]


def spent_of_factors(
    problem: Problem, solution: Solution, metric: str, requested: Motion | None = None
) -> float:
    """The value of a metric against the desired motion, or another, from the motions alone."""
    profile = profile_of(problem.desired, Reduction(), problem.machine or DES)
    desired = problem.desired
    claim = Claim(profile, requested or desired, desired, profile.seat, solution, problem)
    return measure(claim, metric, claim.after)
