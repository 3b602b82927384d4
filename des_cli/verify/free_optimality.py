"""Cost and optimality of a free motion, from the motion alone.

At an optimum no smooth change that keeps the limits lowers the cost, except by spending
more of a budget that is spent already: along every direction

    slope of the objective + sum_i lambda_i slope of budget i = 0,     lambda_i >= 0,

with multipliers that are the same for all directions, and zero for a budget of which
something is left.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.profile import Reduction
from des_cli.model.run import Check
from des_cli.verify.budgets import integrand, keeps_budgets, spent_budgets
from des_cli.verify.claim import STILL, Claim
from des_cli.verify.directions import coarseness, find_directions
from des_cli.verify.felt import Felt
from des_cli.verify.integrals import Running, integral
from des_cli.verify.multipliers import least_residual
from des_cli.verify.occupant import check_occupant
from des_cli.verify.slopes import slopes_along, slopes_by_seat

COST_TOLERANCE = 1e-9
"""Relative difference of the recomputed cost."""

OPTIMALITY_TOLERANCE, MOST_TOLERANCE = 2e-2, 0.3
"""Slope that may be left, relative to the desired motion's or the solution's own: of all
directions together, in the root of the sum of squares. A method minimises over smooth
motions, with a little weight on their jerk, and its table is these in steps. Measured on
optima of the built-in maneuvers it is 2e-5 to 5e-3, and 0.01 to 0.08 where the steps are
0.1 s; a motion that leaves half of its budgets has 0.7 to 1. With coarse steps the
tolerance grows, to MOST_TOLERANCE: of 270 random maneuvers one had 0.11 at 27 ms and
one 0.29 at 183 ms."""

BLEND = 0.1
"""Weight of the felt error in the objective ``blend``: a second copy on purpose, for what a
method minimises is a part of what is checked."""


def check_cost(claim: Claim) -> list[Check]:
    """Sum up the costs anew, and compare the modified motion with the desired one."""
    solution, least = claim.solution, STILL * claim.duration
    checks = []
    for key, name, told, felt in (
        ("cost", "relative error of the cost", solution.cost, claim.after),
        (
            "cost.unreduced",
            "relative error of the cost of the motion asked for",
            solution.cost_unreduced,
            claim.before,
        ),
    ):
        found = 0.5 * _cost(claim, felt)
        error = abs(told - found) / max(found, least)
        checks.append(Check(key, name, error, COST_TOLERANCE))
    reduced = claim.reduced
    if _desired_is_allowed(reduced):
        desired, modified = (
            integral(claim, partial(_objective, claim.reduction), felt, reduced.before)
            for felt in (claim.executable, claim.after)
        )
        rise = (modified - desired) / max(desired, least)
        name = "rise of the objective over the desired motion's"
        checks.append(Check("objective.rise", name, rise, COST_TOLERANCE))
    return checks


def check_optimality(claim: Claim) -> list[Check]:
    """Test the first-order conditions.

    Nothing is tested where limits hold everything, nor where there was no cross-coupling
    to reduce: such a maneuver is passed through.
    """
    if _cost(claim, claim.before) <= STILL * claim.duration:
        return []
    functions: list[Running] = [partial(_objective, claim.reduction)]
    functions += [partial(integrand, budget.metric) for budget in spent_budgets(claim)]
    directions = find_directions(claim)
    slopes = slopes_along(claim, claim.modified, claim.chain, directions, functions)
    scales = slopes_along(claim, claim.desired, claim.chain_before, directions, functions[:1])
    for angle in ("yaw", "pitch"):
        if f"seat_{angle}" in claim.reduction.optimise:
            by_seat = slopes_by_seat(claim, claim.modified, claim.chain, angle, functions)
            scale = slopes_by_seat(claim, claim.desired, claim.chain_before, angle, functions[:1])
            slopes, scales = np.vstack([slopes, by_seat]), np.vstack([scales, scale])
    if not len(slopes):
        return []
    residual = least_residual(slopes[:, 0], slopes[:, 1:])
    size = max(*np.linalg.norm([scales[:, 0], slopes[:, 0]], axis=1), STILL * claim.duration)
    value = float(np.linalg.norm(residual)) / size
    name = "slope of the objective at the optimum, relative to its own or the desired motion's"
    cure = "its steps are coarse: sample the profile finer" if coarseness(claim) > 1.0 else ""
    return [Check("optimality", name, value, _tolerance(claim), cure)]


def _tolerance(claim: Claim) -> float:
    """Return the slope that may be left at the steps of the table."""
    return min(OPTIMALITY_TOLERANCE * coarseness(claim), MOST_TOLERANCE)


def _desired_is_allowed(claim: Claim) -> bool:
    """Return whether the desired motion keeps the budgets and the occupant's bounds."""
    if not keeps_budgets(claim, claim.executable):
        return False
    if not claim.enforced:
        return True
    bounds = claim.profile.machine.occupant
    return all(check.ok for check in check_occupant(bounds, claim.desired, claim.executable))


def _cost(claim: Claim, felt: Felt) -> float:
    """Return int c' R1 c dt [rad^2/s^3 times the weight]."""
    return integral(claim, lambda here, _: _weighted(claim.reduction, here), felt, felt)


def _weighted(reduction: Reduction, felt: Felt) -> Floats:
    """Return c' R1 c, (m,) [rad^2/s^4 times the weight]."""
    cross = felt.cross_ground if reduction.axes == "report" else felt.cross
    return np.asarray(np.sum((reduction.r1 @ cross) * cross, axis=0))


def _objective(reduction: Reduction, felt: Felt, before: Felt) -> Floats:
    """Return what a free motion minimises the integral of, (m,)."""
    if reduction.objective == "coriolis":
        return _weighted(reduction, felt)
    # felt error: from the total angular acceleration without its cross-coupling
    off = felt.turning - (before.turning - before.cross)
    error = np.trace(reduction.r1) / 3.0 * np.sum(off**2, axis=0)
    if reduction.objective == "felt":
        return np.asarray(error)
    return np.asarray(_weighted(reduction, felt) + BLEND * error)
