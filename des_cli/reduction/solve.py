"""Which method answers which request."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from des_cli.kinematics.chain import chain_of
from des_cli.model.machine import Seat
from des_cli.model.metric import FACTOR_DEVIATION, Budget
from des_cli.model.motion import DesiredMotion, Motion, Record
from des_cli.model.profile import Profile, Reduction
from des_cli.model.solution import Solution, Status
from des_cli.model.stage import OnStage, untold
from des_cli.reduction.budget import pose_budget, spend_budgets
from des_cli.reduction.change import Change
from des_cli.reduction.limits import steps_too_short
from des_cli.reduction.optimum import find_optimum
from des_cli.reduction.problem import Problem, pose_problem
from des_cli.reduction.search import Report, Search
from des_cli.reduction.study_law import sweep
from des_cli.reduction.zero import find_zero, pose_zero

MOST_ROUNDING = 3e-8
"""Share of a jerk limit that rounding may make where factors are looked for inside it. A jerk
is a second difference of them over the square of the step: with more than that the search
ends at a place that rounding picks."""


@dataclass(frozen=True)
class Found:
    """A modified motion and what it was found from.

    Parameters
    ----------
    desired : Motion
        What the profile asks for, or the nearest motion that the machine can execute
        where limits are enforced.
    seat : Seat
        As fixed in the modified motion.
    problem : Problem
        The study's problem along the desired motion.
    posed : Problem, optional
        That problem as it was solved: a budget and the zero method bring their own
        weights. None for a free motion, which solves another.
    solution : Solution
    budgets : tuple of Budget
        What the reduction may add to ``held``: those of the profile, or what smoothing
        leaves of them.
    held : Record
        What the budgets were kept against: the record, or what an allowed change made of it.
    """

    desired: Motion
    seat: Seat
    problem: Problem
    posed: Problem | None
    solution: Solution
    budgets: tuple[Budget, ...]
    held: Record


def find_motion(
    profile: Profile,
    requested: DesiredMotion,
    target: DesiredMotion,
    report: Report | None = None,
    on_stage: OnStage = untold,
) -> Found:
    """Find the modified motion that a profile asks for.

    Parameters
    ----------
    profile : Profile
        Consistent (``consistency.require_consistent``).
    requested : DesiredMotion
        What the profile asks for: the record.
    target : DesiredMotion
        What the motion begins from: the very same, or what conditioning made of it.
    report : callable, optional
        Called with each line of the solver's log.
    on_stage : callable, optional
        Called with what is done next.
    """
    on_stage("motion inside the limits")
    reduction, overspent = profile.reduction, ""
    record, held = requested.record, target.record
    free = moves_freely(reduction)
    if target is not requested:
        chain = chain_of(profile.machine, profile.seat)
        smoothing = Change.between(record, held, chain, profile.machine.gravity)
        left, overspent = smoothing.left(reduction, measured=free)
        profile = replace(profile, reduction=replace(reduction, budget=left))
    if overspent or not free:
        return _of_factors(profile, record, held, overspent, report, on_stage)
    # Methods are imported by who asks for them: start-up is paid by every run.
    from des_cli.reduction.free.method import find_free_motion
    from des_cli.reduction.free.task import FreeTask

    task = FreeTask.of(profile, held.motion, held.shortfall)
    if target is not requested:
        task = replace(task, record=record, most=reduction.budget_of_record)
    best = find_free_motion(task, report, on_stage)
    problem = pose_problem(profile, best.desired)
    return Found(best.desired, best.seat, problem, None, best.solution, best.budgets, best.held)


def _of_factors(
    profile: Profile,
    record: Record,
    held: Record,
    overspent: str,
    report: Report | None,
    on_stage: OnStage,
) -> Found:
    """Find factors on the desired rates, or say what stands against looking for any."""
    reduction, chain = profile.reduction, chain_of(profile.machine, profile.seat)
    desired, trouble = executable_motion(profile, held.motion)
    change = Change.between(record, Record(desired), chain, profile.machine.gravity)
    refusal = overspent or change.refusal(reduction)
    if reduction.allow_change is not None and not change.nothing:
        held = Record(desired)
    problem = pose_problem(profile, desired, held)
    if trouble or refusal:
        status: Status = "infeasible" if trouble else "changed"
        solution = Solution.refused(
            status, trouble or refusal, desired, controls=problem.controls, costates=3
        )
        return Found(desired, profile.seat, problem, problem, solution, reduction.budget, held)
    on_stage("factors on the desired rates")
    posed, solution = solve(problem, reduction, report)
    return Found(desired, profile.seat, problem, posed, solution, reduction.budget, held)


def moves_freely(reduction: Reduction) -> bool:
    """Return whether the joints move freely, or per joint within budgets.

    A motion per joint is a free one that stands still where the desired motion does,
    unless something is asked of the factors themselves.
    """
    of_factors = reduction.jacobian == "adapted" or any(
        budget.metric == FACTOR_DEVIATION for budget in reduction.budget
    )
    per_joint = reduction.control == "per-joint" and bool(reduction.budget) and not of_factors
    return reduction.control == "free" or per_joint


def executable_motion(profile: Profile, target: Motion) -> tuple[Motion, str]:
    """Return the motion that factors act on, and why there is none that keeps the limits."""
    if profile.reduction.limits != "enforce":
        return target, ""
    if trouble := steps_too_short(profile.machine, target, MOST_ROUNDING):
        return target, f"{trouble}, or let the joints move freely"
    from des_cli.reduction.executable import nearest_executable

    return nearest_executable(profile.machine, target)


def solve(
    problem: Problem, reduction: Reduction, report: Report | None = None
) -> tuple[Problem, Solution]:
    """Find factors on the desired rates by the method that a profile asks for.

    Parameters
    ----------
    problem : Problem
    reduction : Reduction
    report : callable, optional
        Called with each line of the solver's log.

    Returns
    -------
    problem : Problem
        As it was solved.
    solution : Solution
    """
    if reduction.algorithm == "report-sweep":
        return problem, sweep(problem, reduction.iterations)
    search = Search(reduction.max_iterations, report)
    if reduction.method == "zero":
        posed = pose_zero(problem)
        return posed, find_zero(posed, np.diag(problem.r1) > 0.0, reduction.tolerance, search)
    if reduction.budget:
        posed = pose_budget(problem)
        return posed, spend_budgets(posed, reduction.budget, search)
    return problem, find_optimum(problem, search)
