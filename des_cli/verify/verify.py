"""Whether a solution is what it claims to be, from the motion alone.

No code is shared with the methods that find one; the package says what is. What the seat
does is evaluated anew by ``felt``, limits, ends and budgets are measured on the motion as
its tables play it, costs are summed anew, and first-order conditions are tested by finite
differences along directions that no method saw.
"""

from __future__ import annotations

import numpy as np

from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.model.solution import Solution
from des_cli.reduction.problem import Problem
from des_cli.verify import factors, free_optimality
from des_cli.verify.budgets import check_budgets
from des_cli.verify.claim import Claim
from des_cli.verify.ends import (
    check_ends,
    check_factors,
    check_hold,
    check_integral,
    check_times,
)
from des_cli.verify.factors_optimality import check_optimality
from des_cli.verify.leads import check_leads
from des_cli.verify.limits import check_limits
from des_cli.verify.occupant import check_occupant
from des_cli.verify.stopping import check_stopping
from des_cli.verify.told import check_told


def verify(claim: Claim) -> tuple[Check, ...]:
    """Check what is claimed of a solution.

    Parameters
    ----------
    claim : Claim
        The reduction of its profile says which checks apply.

    Returns
    -------
    tuple of Check
        Each with a key of its own. Values that are not finite, or other sample times,
        end the checks.
    """
    first = [_finite(claim.solution, claim.table)]
    if first[0].ok:
        first.append(check_times(claim))
    if not all(check.ok for check in first):
        return tuple(first)
    own = _of_free(claim) if claim.posed is None else _of_factors(claim, claim.posed)
    return (
        *first,
        _ended(claim.solution),
        *check_limits(claim),
        *check_leads(claim),
        *check_stopping(claim),
        *check_ends(claim),
        *check_hold(claim),
        *own,
        *([] if claim.told is None else check_told(claim, claim.told)),
    )


def _finite(solution: Solution, table: Motion) -> Check:
    """Count the values that are not finite."""
    motions = (solution.modified, table)
    numbers = (
        *(v for m in motions for v in (m.t, m.angle, m.rate_start, m.rate_end)),
        solution.control,
        solution.adjoint,
        np.array([solution.cost, solution.cost_unreduced, solution.optimality]),
    )
    bad = sum(int(np.sum(~np.isfinite(values))) for values in numbers)
    return Check("finite", "count of values that are not finite", float(bad), 0.0)


def _ended(solution: Solution) -> Check:
    """Count what a method may not say of a solution that is to be released."""
    wrong = (
        not solution.usable,
        solution.optimality < 0.0,
        solution.iterations != len(solution.log),
    )
    name = "count of what cannot be: how the method ended, its residual, its iterations"
    return Check("solution", name, float(sum(wrong)), 0.0)


def _of_free(claim: Claim) -> list[Check]:
    return [
        check_integral(claim),
        *check_factors(claim),
        *_occupant(claim),
        *check_budgets(claim),
        *free_optimality.check_cost(claim),
        *free_optimality.check_optimality(claim.reduced),
    ]


def _of_factors(claim: Claim, problem: Problem) -> list[Check]:
    reduction = claim.reduction
    checks = [
        *factors.check_dynamics(claim, problem),
        *factors.check_cost(claim, problem),
    ]
    if reduction.method == "zero":
        checks.append(factors.check_zero(claim, problem))
    elif reduction.algorithm == "optimum":
        checks += check_budgets(claim)
        if problem.jacobian == "desired" and not factors.is_still(claim, problem):
            checks.append(check_optimality(claim.reduced, problem))
    return checks


def _occupant(claim: Claim) -> list[Check]:
    if not claim.enforced:
        return []
    return check_occupant(claim.profile.machine.occupant, claim.modified, claim.after)
