"""Checks of a solution with factors on the desired rates: dynamics, cost, zero, optimality."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS
from des_cli.model.run import Check
from des_cli.reduction.problem import Problem
from des_cli.verify.claim import STILL, Claim
from des_cli.verify.felt import Felt, SeatChain

DYNAMICS_TOLERANCE = 1e-8
"""Largest gap between the motion and the integral of its factors [rad, rad/s]."""

COST_TOLERANCE = 1e-9
"""Relative difference of the recomputed cost."""

TINY_COST = 1e-6
"""Least cost to be relative to, as a share of what standing still would cost: a desired
motion without cross-coupling costs nothing, and rounding is no error of it."""

REGULAR = 0.45
"""|det J| above which the adapted inverse is undamped, so that plain inversion must agree."""


def check_dynamics(claim: Claim, problem: Problem) -> list[Check]:
    """Compare angles with their integrated rates, and rates with the factors."""
    desired, modified = problem.desired, claim.modified
    factor = np.broadcast_to(claim.solution.control, (len(desired.t), 3))
    angle = integrated(problem, factor, modified.rate_start, modified.rate_end)
    if problem.jacobian == "desired":
        off = [
            modified.rate_start - factor[:-1] * desired.rate_start,
            modified.rate_end - factor[1:] * desired.rate_end,
        ]
    else:
        off = [
            _adapted_gap(claim, modified.angle[at], factor[at], rate, desired.angle[at], target)
            for at, rate, target in (
                (slice(None, -1), modified.rate_start, desired.rate_start),
                (slice(1, None), modified.rate_end, desired.rate_end),
            )
        ]
    return [
        Check(
            "dynamics.angles",
            "gap between angles and integrated rates [rad]",
            float(np.max(np.abs(modified.angle - angle))),
            DYNAMICS_TOLERANCE,
        ),
        Check(
            "dynamics.rates",
            "gap between rates and factors [rad/s]",
            float(max(np.max(np.abs(values), initial=0.0) for values in off)),
            DYNAMICS_TOLERANCE,
        ),
    ]


def check_cost(claim: Claim, problem: Problem) -> list[Check]:
    """Sum up both costs anew, and, of an optimum, compare them."""
    solution = claim.solution
    least = TINY_COST * float(np.sum(problem.r2)) * claim.duration
    ones = np.ones_like(solution.control)
    checks = []
    for key, name, told, control, felt in (
        ("cost", "", solution.cost, solution.control, claim.after),
        (
            "cost.unreduced",
            " of the desired motion",
            solution.cost_unreduced,
            ones,
            claim.executable,
        ),
    ):
        found = cost_of(claim, problem, control, felt)
        error = abs(told - found) / max(found, least)
        checks.append(Check(key, f"relative error of the cost{name}", error, COST_TOLERANCE))
    if claim.reduction.algorithm == "optimum" and claim.reduction.method == "minimum":
        rise = (solution.cost - solution.cost_unreduced) / max(solution.cost_unreduced, least)
        name = "rise of the cost over the desired motion's"
        checks.append(Check("cost.rise", name, rise, COST_TOLERANCE))
    return checks


def is_still(claim: Claim, problem: Problem) -> bool:
    """Return whether the desired motion makes no cross-coupling that there is to reduce."""
    c = cross_of(problem, claim.executable)
    return bool(claim.weight @ np.sum((problem.r1 @ c) * c, axis=0) <= STILL * claim.duration)


def check_zero(claim: Claim, problem: Problem) -> Check:
    """Measure the components that are to vanish, at samples and between them."""
    chosen = np.diag(claim.reduction.r1) > 0.0
    motion = claim.modified
    step = motion.step[:, None]
    middle = claim.chain.at(
        motion.angle[:-1] + step / 8.0 * (3.0 * motion.rate_start + motion.rate_end),
        0.5 * (motion.rate_start + motion.rate_end),
        motion.acceleration,
    )
    largest = max(
        float(np.max(np.abs(cross_of(problem, felt)[chosen]))) for felt in (claim.after, middle)
    )
    name = "largest component of the cross-coupling that was to vanish [rad/s^2]"
    return Check("zero", name, largest, claim.reduction.tolerance)


def cross_of(problem: Problem, felt: Felt) -> Floats:
    """Return the cross-coupling in the problem's axes, (3, m) [rad/s^2]."""
    return felt.cross if problem.axes == "seat" else felt.cross_ground


def cost_of(claim: Claim, problem: Problem, control: Floats, felt: Felt) -> float:
    """Return J of factors (n, m) and what is felt of their motion, by its definition."""
    c = cross_of(problem, felt)
    running = np.sum((problem.r1 @ c) * c, axis=0)
    target = np.concatenate([problem.desired.angle[:-1], problem.desired.angle[1:]]).T
    off = felt.angle - target
    running += problem.tracking @ off**2
    idle = (1.0 - control) ** 2 @ problem.r2
    running += np.concatenate([idle[:-1], idle[1:]])
    return 0.5 * float(claim.weight @ running)


def integrated(problem: Problem, factor: Floats, start: Floats, end: Floats) -> Floats:
    """Integrate joint rates to angles, (n, 3) [rad]."""
    desired = problem.desired
    step = np.diff(desired.t)[:, None]
    increment = 0.5 * step * (start + end)
    # Fork and cab are commanded by position: what the trapezoidal rule misses
    # of the desired increment belongs to the two factors alike.
    straight = 0.5 * step * (desired.rate_start + desired.rate_end)
    missed = np.diff(desired.angle, axis=0) - straight
    increment[:, 1:] += (0.5 * (factor[:-1] + factor[1:]) * missed)[:, 1:]
    return np.asarray(desired.angle[0] + np.vstack([np.zeros(3), np.cumsum(increment, axis=0)]))


def _adapted_gap(
    claim: Claim, angle: Floats, factor: Floats, rate: Floats, desired: Floats, target: Floats
) -> Floats:
    """Return rate - u * J(theta)^-1 J(Theta) Theta' where J is well conditioned."""
    found = jacobian(claim.chain, angle)
    regular = np.abs(np.linalg.det(found)) > REGULAR
    w = (jacobian(claim.chain, desired) @ target[:, :, None])[regular]
    phi = np.linalg.solve(found[regular], w)[:, :, 0]
    return np.asarray(rate[regular] - factor[regular] * phi)


def jacobian(chain: SeatChain, angle: Floats) -> Floats:
    """Return W along ground axes per unit rate of each joint, (n, 3, 3 joint)."""
    zero = np.zeros_like(angle)
    columns = [
        chain.at(angle, np.broadcast_to(unit, angle.shape), zero).rate_ground
        for unit in np.eye(len(JOINTS))
    ]
    return np.stack(columns, axis=-1).swapaxes(0, 1)
