"""An independent check of a solution, before anything is named as output.

Nothing here is shared with the solvers. The Coriolis vector is taken as what it
is, the change of the angular velocity at constant joint rates, by a complex
step through the chain; the dynamics are integrated anew; the cost is summed
anew; limits and budgets are measured on the motion; and the first-order
conditions are tested by finite differences of that cost along directions that
the solver never saw.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from des_cli.kinematics.chain import joint_axes, seat_rotation
from des_cli.kinematics.orientation import ground_jacobian
from des_cli.kinematics.response import respond_on
from des_cli.model.arrays import Flags, Floats
from des_cli.model.machine import JOINTS, Machine
from des_cli.model.metric import MetricKey
from des_cli.model.motion import Motion
from des_cli.model.profile import Reduction
from des_cli.model.run import Check
from des_cli.model.solution import Solution
from des_cli.reduction.problem import Problem

DYNAMICS_TOLERANCE = 1e-8
"""Largest gap between the motion and the integral of its factors [rad, rad/s]."""

COST_TOLERANCE = 1e-9
"""Relative difference of the recomputed cost."""

TINY_COST = 1e-6
"""Least cost to be relative to, as a share of what standing still would cost: a desired
motion without Coriolis costs nothing, and rounding is no error of it."""

OPTIMALITY_TOLERANCE = 1e-5
"""Largest slope of the cost along a test direction, relative to the largest slope
that the desired motion has along any of them."""

BOUND_TOLERANCE = 1e-9
"""Relative excess over a limit or a budget that rounding alone may make."""

TIGHT = 1.0 - 1e-3
"""Share of a limit above which it may hold a factor: nearer, the solver's barrier pushes."""

DIFFERENCE_STEP = 1e-4
"""Half step of the central difference; the cost is quartic in it, so that its
truncation error is of the order of 1e-8."""

BUDGET_STEP = 1e-6
"""The same for what a budget's price is on, which may be of the eighth power."""

COMPLEX_STEP = 1e-30
"""A complex step has no cancellation, so that it may be this small."""

REGULAR = 0.45
"""|det J| above which the adapted inverse is undamped, so that plain inversion must agree."""

DIRECTIONS = 12
SEED = 20_240_229


def verify(problem: Problem, solution: Solution, wanted: Reduction) -> tuple[Check, ...]:
    """Check a solution.

    Parameters
    ----------
    problem : Problem
        As it was solved.
    solution : Solution
    wanted : Reduction
        What the profile asks for: which checks apply.

    Returns
    -------
    tuple of Check
    """
    modified = solution.modified
    numbers = (modified.angle, modified.rate_start, modified.rate_end, solution.control)
    bad = sum(int(np.sum(~np.isfinite(values))) for values in numbers)
    checks = [Check("count of values that are not finite", float(bad), 0.0)]
    if bad:
        return tuple(checks)
    optimum = wanted.algorithm == "optimum"
    checks += _dynamics(problem, solution)
    cost = _cost(problem, solution.control, modified)
    least = TINY_COST * float(np.sum(problem.r2)) * float(modified.t[-1] - modified.t[0])
    error = abs(cost - solution.cost) / max(abs(solution.cost), least)
    checks.append(Check("relative error of the cost", error, COST_TOLERANCE))
    if problem.machine is not None:
        checks += _limits(problem.machine, modified)
    if optimum and wanted.method == "zero":
        checks.append(_zero(problem, modified, wanted))
    elif optimum:
        rise = solution.cost - solution.cost_unreduced
        worse = max(0.0, rise) / max(solution.cost_unreduced, least)
        checks.append(Check("excess of the cost over the desired motion's", worse, COST_TOLERANCE))
        for metric, budget in ((b.metric, b.most) for b in wanted.budget):
            spent = spent_budget(problem, modified, solution.control, metric) / budget
            checks.append(
                Check(f"excess over the budget on {metric}", spent - 1.0, BOUND_TOLERANCE)
            )
        if problem.jacobian == "desired":
            checks.append(_optimality(problem, solution, wanted))
    return tuple(checks)


def coriolis_by_complex_step(problem: Problem, angle: Floats, rate: Floats) -> Floats:
    """Return c = d(J theta')/dt at constant theta', (..., 3), in the problem's axes."""
    ahead = joint_axes(problem.chain, angle + 1j * COMPLEX_STEP * rate, "ground")
    c = np.sum(ahead.imag / COMPLEX_STEP * rate[..., :, None], axis=-2)
    if problem.axes == "seat":
        turned = seat_rotation(problem.chain, angle)
        c = np.sum(turned * c[..., :, None], axis=-2)
    return np.asarray(c)


def spent_budget(problem: Problem, modified: Motion, control: Floats, metric: str) -> float:
    """Return the value of a fidelity metric, from the motions alone."""
    desired = problem.desired
    step = np.diff(desired.t)

    def norm(values: Floats) -> float:
        return float(np.sqrt(0.5 * np.sum(step * np.sum(values**2, axis=(1, 2)))))

    def share(off: Floats, whole: Floats) -> float:
        return norm(off) / max(norm(whole), 1e-150)

    if metric.startswith("joint_deviation_relative"):
        ratio = share(modified.angle_sides - desired.angle_sides, desired.angle_sides)
        return ratio * ratio if metric.endswith("squared") else ratio
    if metric == "mean_square_one_minus_p":
        idle = np.stack([control[:-1], control[1:]], axis=1) - 1.0
        return float(norm(idle) ** 2 / np.sum(step) / control.shape[1])
    if metric == "attitude_error_max_deg":
        return float(np.max(_attitude_error(problem, modified)))
    before, after = (
        respond_on(problem.chain, problem.gravity, motion) for motion in (desired, modified)
    )
    if metric == "seat_rate_deviation_relative":
        return share(after.seat_rate - before.seat_rate, before.seat_rate)
    if metric == "seat_g_rms_error_g":
        return norm(after.seat_g - before.seat_g) / float(np.sqrt(np.sum(step)))
    return share(after.seat_g - before.seat_g, before.seat_g)


def _attitude_error(problem: Problem, modified: Motion) -> Floats:
    """Return the angle between the seat's attitudes at each sample [deg]."""
    wanted, made = (
        seat_rotation(problem.chain, motion.angle) for motion in (problem.desired, modified)
    )
    trace = np.sum(wanted * made, axis=(1, 2))
    return np.asarray(np.degrees(np.arccos(np.clip(0.5 * (trace - 1.0), -1.0, 1.0))))


def _dynamics(problem: Problem, solution: Solution) -> list[Check]:
    """Compare angles with their integrated rates, and rates with the factors."""
    desired, modified = problem.desired, solution.modified
    factor = np.broadcast_to(solution.control, (len(desired.t), 3))
    angle = _integrate(problem, factor, modified.rate_start, modified.rate_end)
    if problem.jacobian == "desired":
        off = [
            modified.rate_start - factor[:-1] * desired.rate_start,
            modified.rate_end - factor[1:] * desired.rate_end,
        ]
    else:
        off = [
            _adapted_gap(problem, modified.angle[at], factor[at], made, at, wanted)
            for at, made, wanted in (
                (slice(None, -1), modified.rate_start, desired.rate_start),
                (slice(1, None), modified.rate_end, desired.rate_end),
            )
        ]
    return [
        Check(
            "gap between angles and integrated rates [rad]",
            float(np.max(np.abs(modified.angle - angle))),
            DYNAMICS_TOLERANCE,
        ),
        Check(
            "gap between rates and factors [rad/s]",
            float(max(np.max(np.abs(values), initial=0.0) for values in off)),
            DYNAMICS_TOLERANCE,
        ),
    ]


def _integrate(problem: Problem, factor: Floats, start: Floats, end: Floats) -> Floats:
    """Integrate joint rates to angles, (n, 3)."""
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
    problem: Problem, angle: Floats, factor: Floats, made: Floats, at: slice, wanted: Floats
) -> Floats:
    """Return made - u * J(theta)^-1 J(Theta) Theta' where J is well conditioned."""
    here = ground_jacobian(problem.chain, angle)
    regular = np.abs(np.linalg.det(here)) > REGULAR
    there = ground_jacobian(problem.chain, problem.desired.angle[at])
    w = (there @ wanted[:, :, None])[regular]
    phi = np.linalg.solve(here[regular], w)[:, :, 0]
    return np.asarray(made[regular] - factor[regular] * phi)


def _cost(problem: Problem, control: Floats, motion: Motion) -> float:
    """Return J of factors (n, m) and their motion, by its definition."""
    desired = problem.desired
    total = 0.0
    step = np.diff(desired.t)
    for at, rate in (
        (slice(None, -1), motion.rate_start),
        (slice(1, None), motion.rate_end),
    ):
        c = coriolis_by_complex_step(problem, motion.angle[at], rate)
        running = np.sum((c @ problem.r1) * c, axis=1)
        running += np.sum(problem.r2 * (1.0 - control[at]) ** 2, axis=1)
        running += np.sum(problem.tracking * (desired.angle[at] - motion.angle[at]) ** 2, axis=1)
        total += 0.25 * float(np.sum(step * running))
    return total


def _limits(machine: Machine, motion: Motion) -> list[Check]:
    """Measure the motion against every limit, as the relative excess."""
    step = np.diff(motion.t)[:, None]
    rate = np.maximum(np.abs(motion.rate_start).max(axis=0), np.abs(motion.rate_end).max(axis=0))
    acceleration = np.abs(motion.rate_end - motion.rate_start) / step
    jump = np.abs(motion.rate_start[1:] - motion.rate_end[:-1])
    checks = []
    for j, (joint, limit) in enumerate(zip(JOINTS, machine.limits, strict=True)):
        worst = max(
            float(np.max(np.abs(motion.angle[:, j]))) / limit.angle,
            float(rate[j]) / limit.rate,
            float(acceleration[:, j].max()) / limit.acceleration,
            1.0 + float(jump[:, j].max(initial=0.0)) / limit.rate,
        )
        checks.append(Check(f"excess of the {joint} over its limits", worst - 1.0, BOUND_TOLERANCE))
    return checks


def _zero(problem: Problem, motion: Motion, wanted: Reduction) -> Check:
    """Measure the components that are to vanish, at samples and between them."""
    chosen = np.diag(wanted.r1) > 0.0
    step = motion.step[:, None]
    middle = motion.angle[:-1] + step / 8.0 * (3.0 * motion.rate_start + motion.rate_end)
    largest = max(
        float(np.max(np.abs(coriolis_by_complex_step(problem, angle, rate)[:, chosen])))
        for angle, rate in (
            (motion.angle[:-1], motion.rate_start),
            (middle, 0.5 * (motion.rate_start + motion.rate_end)),
            (motion.angle[1:], motion.rate_end),
        )
    )
    return Check("largest Coriolis component that was to vanish", largest, wanted.tolerance)


def _optimality(problem: Problem, solution: Solution, wanted: Reduction) -> Check:
    """Test the first-order conditions along directions.

    The directions change no factor that a limit holds: along them the cost has no
    slope, or, with a budget, the same multiple of what the budget's metric has.
    """
    control, ones = solution.control, np.ones_like(solution.control)
    free = _free(problem, solution.modified, control.shape)
    there = 0.0
    of_cost, of_metric = [], []
    for direction in _directions(problem, control.shape):
        there = max(there, abs(_slope(problem, ones, direction)))
        direction = _keeping_ends(problem, direction * free)
        of_cost.append(_slope(problem, control, direction))
        of_metric.append(_slope_of_budget(problem, control, direction, wanted))
    cost, metric = np.array(of_cost), np.array(of_metric)
    price = max(0.0, -float(cost @ metric) / max(float(metric @ metric), 1e-300))
    here = float(np.max(np.abs(cost + price * metric)))
    floor = float(np.ptp(problem.desired.t) * np.min(problem.r2)) * 1e-3
    name = "relative slope of the cost at the optimum"
    return Check(name, here / max(there, floor), OPTIMALITY_TOLERANCE)


def _free(problem: Problem, motion: Motion, shape: tuple[int, ...]) -> Flags:
    """Return the factors that can move both ways, (n, m)."""
    free = np.tile(~problem.held if shape[1] == 3 else np.ones(3, dtype=bool), (shape[0], 1))
    if problem.machine is not None:
        rate, acceleration, angle = (
            np.array([getattr(limit, name) for limit in problem.machine.limits])
            for name in ("rate", "acceleration", "angle")
        )
        fastest = np.maximum(np.abs(motion.rate_start), np.abs(motion.rate_end))
        tight = (fastest > TIGHT * rate) | (np.abs(motion.acceleration) > TIGHT * acceleration)
        free[:-1] &= ~tight
        free[1:] &= ~tight
        free &= ~_now_or_later(np.abs(motion.angle) > TIGHT * angle)
    if problem.ends != "free":
        free[0] = False
    if problem.ends == "match-both":
        free[-1] = False
    return np.asarray(free if shape[1] == 3 else free.all(axis=1, keepdims=True))


def _now_or_later(tight: Flags) -> Flags:
    """Return where a flag is set or will be: an angle depends on every factor before it."""
    return np.asarray(np.logical_or.accumulate(tight[::-1], axis=0)[::-1])


def _keeping_ends(problem: Problem, direction: Floats) -> Floats:
    """Return the part of a direction that leaves the last angles alone, if they must match."""
    if problem.ends != "match-both":
        return direction
    desired = problem.desired
    half = 0.5 * np.diff(desired.t)[:, None]
    missed = np.diff(desired.angle, axis=0) - half * (desired.rate_start + desired.rate_end)
    missed[:, 0] = 0.0
    reach = np.zeros_like(desired.angle)  # d theta(tf) / d u_k, joint by joint
    reach[:-1] += half * desired.rate_start + 0.5 * missed
    reach[1:] += half * desired.rate_end + 0.5 * missed
    reach = reach * (direction != 0.0)
    if direction.shape[1] == 1:
        amounts = np.linalg.lstsq(reach.T @ reach, reach.T @ direction, rcond=None)[0]
        return np.asarray(direction - reach @ amounts)
    size = np.maximum(np.sum(reach**2, axis=0), 1e-300)
    return np.asarray(direction - reach * (np.sum(reach * direction, axis=0) / size))


def _slope_of_budget(
    problem: Problem, control: Floats, direction: Floats, wanted: Reduction
) -> float:
    """Return the slope of what a budget's price is on, 0 where there is no budget."""
    for metric, budget in ((b.metric, b.most) for b in wanted.budget):
        ahead, behind = (
            _priced(problem, _motion(problem, moved), moved, metric, budget)
            for moved in (
                control + BUDGET_STEP * direction,
                control - BUDGET_STEP * direction,
            )
        )
        return (ahead - behind) / (2.0 * BUDGET_STEP)
    return 0.0


def _priced(
    problem: Problem, motion: Motion, control: Floats, metric: MetricKey, budget: float
) -> float:
    """Return a smooth form of a metric over its budget: its square; of a maximum, a mean."""
    if metric != "attitude_error_max_deg":
        return (spent_budget(problem, motion, control, metric) / budget) ** 2
    sine = np.sin(np.radians(0.5 * _attitude_error(problem, motion)))
    power = (sine / np.sin(np.radians(0.5 * budget))) ** 8
    return float(np.sum(0.5 * motion.step * (power[:-1] + power[1:])))


def _directions(problem: Problem, shape: tuple[int, ...]) -> Iterator[Floats]:
    """Yield smooth changes of the factors of size one, always the same ones."""
    generator = np.random.default_rng(SEED)
    time = (problem.desired.t - problem.desired.t[0]) / np.ptp(problem.desired.t)
    for index in range(DIRECTIONS):
        if index % 2:  # a bump somewhere, of some width
            bump = np.exp(-(((time - generator.uniform()) / generator.uniform(0.02, 0.3)) ** 2))
            direction = bump[:, None] * generator.normal(size=shape[1])
        else:  # a wave over the whole motion
            waves = np.cos(np.pi * np.arange(12) * time[:, None])
            direction = waves @ generator.normal(size=(12, shape[1]))
        yield direction / np.max(np.abs(direction))


def _motion(problem: Problem, control: Floats) -> Motion:
    """Return the motion of factors along the desired rates."""
    factor = np.broadcast_to(control, (len(control), 3))
    start, end = factor[:-1] * problem.desired.rate_start, factor[1:] * problem.desired.rate_end
    return Motion(problem.desired.t, _integrate(problem, factor, start, end), start, end)


def _slope(problem: Problem, control: Floats, direction: Floats) -> float:
    ahead, behind = (
        _cost(problem, moved, _motion(problem, moved))
        for moved in (control + DIFFERENCE_STEP * direction, control - DIFFERENCE_STEP * direction)
    )
    return (ahead - behind) / (2.0 * DIFFERENCE_STEP)
