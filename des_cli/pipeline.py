"""The sequence for one profile: desired motion, problem, solution, check, metrics."""

from __future__ import annotations

from collections.abc import Callable

from des_cli.kinematics.desired import make_desired
from des_cli.kinematics.response import respond
from des_cli.metrics import Measured, measure
from des_cli.model.profile import Profile
from des_cli.model.run import Run
from des_cli.model.solution import Iteration
from des_cli.notices import find_notices
from des_cli.reduction.baseline import compare
from des_cli.reduction.consistency import require_consistent
from des_cli.reduction.limits import find_violations
from des_cli.reduction.problem import pose_problem
from des_cli.reduction.solve import make_executable, not_attempted, solve
from des_cli.reduction.verify import verify


def reduce_profile(
    profile: Profile, *, on_iteration: Callable[[Iteration], None] | None = None
) -> Run:
    """Reduce the Coriolis of one maneuver.

    Parameters
    ----------
    profile : Profile
    on_iteration : callable, optional
        Called with each line of the solver's log.

    Returns
    -------
    Run
        Also where the solver did not converge or a check failed:
        ``run.require_release()`` raises what stands against using it.

    Raises
    ------
    UsageError
        If the reduction asks for things that exclude each other.
    """
    wanted = profile.reduction
    require_consistent(wanted, profile.name)
    asked = make_desired(profile)
    desired, trouble = asked.motion, ""
    if wanted.limits == "enforce":
        desired, trouble = make_executable(profile.machine, asked.motion)
    problem = posed = pose_problem(profile, desired)
    if trouble:
        solution = not_attempted(problem, trouble)
    else:
        posed, solution = solve(problem, wanted, on_iteration)
    before = respond(profile.machine, profile.seat, asked.motion)
    after = respond(profile.machine, profile.seat, solution.modified)
    violations = find_violations(profile.machine, asked.motion, "desired") + find_violations(
        profile.machine, solution.modified, "modified"
    )
    measured = Measured(
        profile, asked, desired, solution, before, after, violations, compare(problem, solution)
    )
    metrics = measure(measured)
    metrics["notices"] = find_notices(asked, metrics)
    return Run(
        profile=profile,
        asked=asked,
        desired=desired,
        solution=solution,
        before=before,
        after=after,
        checks=verify(posed, solution, wanted) if solution.usable else (),
        violations=violations,
        metrics=metrics,
        notices=tuple(metrics["notices"]),
    )
