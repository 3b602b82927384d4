"""The nearest motion to a desired one that the machine can execute, as a spline.

A convex problem over control points: inside the limits, jerk included, nearest to the
desired angles and rates,

    minimise 1/2 int (theta - Theta)^2 + tau^2 (theta' - Theta')^2 dt.

It rounds the corner where a desired rate steps, instead of leaving it to a factor that
would slow every joint for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from des_cli.model.arrays import Floats, frozen
from des_cli.model.machine import JOINTS, JointLimits, Machine
from des_cli.model.motion import Motion
from des_cli.reduction.free.limit_rows import LimitRows
from des_cli.reduction.limits import find_violations, largest_angle, measure_peaks
from des_cli.reduction.reference import sample_motion
from des_cli.solver.band import SymmetricBand
from des_cli.solver.quadratic import minimise_quadratic
from des_cli.solver.spline import FEWEST_INTERVALS, ORDER, Ends, SplineGrid

KNOT_STEP, LONGEST_KNOT_STEP = 0.04, 0.08
"""Time between knots [s], and in a long maneuver: a joint needs half a second from standstill to
its full acceleration. Knots 10 ms apart change the reductions of the built-in maneuvers by less
than 0.002 % of the cross-coupling, and from 80 ms by less than 0.004 %."""

MANY_KNOTS = 1000
"""Knots from which they stand farther apart, as far as `LONGEST_KNOT_STEP`."""

FEWEST_KNOTS = 50
"""Knots of a short maneuver, unless its table has fewer rows."""

TAU = 0.05
"""Time [s] that weighs a rate error against an angle error: about what the DES's
cab needs to round a corner."""

SMOOTHING = 1e-9
"""Weight [s^6] on the squared jerk: it determines what the data do not."""

CLEAR = 1e-3
"""Relative distance from rate, acceleration and jerk limits, so that the reduction starts
from inside them."""

CLEAR_ANGLE = 1e-6
"""The same from angle limits."""

NO_ROOM = 2e-3
"""Relative distance from a limit within which a start that admits no motion is to blame."""

CORNER = 0.5
"""Share of the acceleration and jerk limits at which a corner is rounded for factors on the
rates, unless the desired motion asks for more elsewhere. A corner that is rounded at the
limit itself leaves a scalar factor no room: it would have to stay at one or below, for
every joint, wherever one joint turns a corner."""

TABLE_ROUNDS = 5
"""Fits until a table keeps the angle limits."""

STRAIGHT = 1e-4
"""Difference of an angle [rad] from the integral of its rates that is the quadrature's
alone: a motion that keeps its limits is then left as it is."""


@dataclass(frozen=True)
class ExecutableSpline:
    """A motion that keeps the limits, or the nearest miss.

    Parameters
    ----------
    grid : SplineGrid
    control : (n, 3) array
        [rad]
    trouble : str
        Empty, or why no motion keeps the limits.
    """

    grid: SplineGrid
    control: Floats
    trouble: str = ""


def knot_grid(t: Floats, multiple: int = 1, *, finer: int = 1) -> SplineGrid:
    """Return a grid of knots for a table's times: what the motion needs, not its rows.

    Parameters
    ----------
    t : (m,) array
        [s]
    multiple : int
        The number of intervals is a multiple of it, for coarser grids inside it.
    finer : int
        How many times as many knots as that there are.
    """
    duration = float(t[-1] - t[0])
    rows = len(t) - 1
    step = min(max(duration / MANY_KNOTS, KNOT_STEP), LONGEST_KNOT_STEP) / finer
    needed = max(int(np.ceil(duration / step - 1e-9)), FEWEST_KNOTS)
    count = max(min(needed, rows), FEWEST_INTERVALS)
    count = multiple * max(1, -(-count // multiple))
    return SplineGrid(float(t[0]), duration / count, count)


def fit_executable(
    grid: SplineGrid, desired: Motion, limits: Sequence[JointLimits], ends: Ends
) -> ExecutableSpline:
    """Return the spline nearest to a motion inside limits.

    Parameters
    ----------
    grid : SplineGrid
        Over the whole motion.
    desired : Motion
    limits : sequence of JointLimits
        For arm, fork, cab; infinite where there is none.
    ends : Ends
        Where value or rate equal the desired ones.
    """
    base = _through_ends(grid, desired, ends)
    hessian, linear = _least_squares(grid, desired, base)
    eased = [
        replace(
            limit,
            angle=limit.angle * (1.0 - CLEAR_ANGLE),
            rate=limit.rate * (1.0 - CLEAR),
            acceleration=limit.acceleration * (1.0 - CLEAR),
            jerk=limit.jerk * (1.0 - CLEAR),
        )
        for limit in limits
    ]
    outcome = minimise_quadratic(hessian, linear, LimitRows(grid, base, eased, ends), ends)
    trouble = ""
    # what turns at its limit and slows down must have turned faster before
    too_fast = ends.start_rate & (np.abs(desired.rate_start[0]) > [limit.rate for limit in eased])
    if not outcome.feasible or np.any(too_fast):
        trouble = _start_trouble(desired, limits) or (
            "no motion near the desired one keeps the limits: the search for it ended with "
            f"the limits off by {outcome.infeasibility:.1e} (relative)"
        )
    return ExecutableSpline(grid, base + outcome.x, trouble)


def fit_for_table(
    grid: SplineGrid, t: Floats, desired: Motion, limits: Sequence[JointLimits], ends: Ends
) -> tuple[ExecutableSpline, tuple[JointLimits, ...]]:
    """Return the nearest spline whose table keeps the angle limits too.

    The angles of a table with few rows, the integrals of rates that are linear between
    them, are not quite the spline's: where they leave a limit it is drawn in.

    Parameters
    ----------
    grid, desired, limits, ends
        As for `fit_executable`.
    t : (m,) array
        Times of the table [s].

    Returns
    -------
    spline : ExecutableSpline
    limits : tuple of JointLimits
        As they were drawn in.
    """
    drawn = tuple(limits)
    for _ in range(TABLE_ROUNDS):
        found = fit_executable(grid, desired, drawn, ends)
        reach = largest_angle(sample_spline(found, t))
        excess = reach - np.array([limit.angle for limit in limits])
        if found.trouble or np.all(excess <= 0.0):
            break
        drawn = tuple(
            replace(limit, angle=limit.angle - 2.0 * max(float(e), 0.0))
            for limit, e in zip(drawn, excess, strict=True)
        )
    return found, drawn


def nearest_executable(machine: Machine, desired: Motion) -> tuple[Motion, str]:
    """Return the nearest motion inside the machine's limits for factors on its rates.

    Parameters
    ----------
    machine : Machine
    desired : Motion
        It may break limits and its rates may step.

    Returns
    -------
    motion : Motion
        Its angles are the integrals of its rates, which do not step.
    trouble : str
        Empty, or why there is none; the motion then is not inside.
    """
    straight = integrate_rates(desired.t, desired.angle[0], desired.rate)
    near = np.max(np.abs(straight.angle - desired.angle)) <= STRAIGHT
    broken = find_violations(machine, desired, "desired")
    if near and not broken and not find_violations(machine, straight, "desired"):
        return straight, ""
    ends = start_kept(rates=False)
    grid = knot_grid(desired.t)
    found, _ = fit_for_table(grid, desired.t, desired, _eased(machine, desired), ends)
    return sample_spline(found, desired.t), found.trouble


def start_kept(*, rates: bool) -> Ends:
    """Return the ends of a motion that starts where the desired one does."""
    yes, no = np.ones(3, dtype=bool), np.zeros(3, dtype=bool)
    return Ends(yes, yes if rates else no, no, no, no)


def sample_spline(spline: ExecutableSpline, t: Floats) -> Motion:
    """Return a spline as a table plays it: rates linear between the samples.

    Means of accelerations and jerks never exceed what they are means of, so that the
    table keeps every limit on these and on the rates that the spline keeps. Its angles
    are off by a twelfth of the squared step times the change of the acceleration.
    """
    first = spline.grid.values(spline.control, t[:1])[0]
    return integrate_rates(t, first, frozen(spline.grid.values(spline.control, t, 1)))


def integrate_rates(t: Floats, first: Floats, rate: Floats) -> Motion:
    """Return the motion from given angles with rates that are linear between samples."""
    angle = np.empty_like(rate)
    angle[0] = 0.0
    increment = angle[1:]
    np.add(rate[:-1], rate[1:], out=increment)
    increment *= 0.5 * np.diff(t)[:, None]
    np.cumsum(increment, axis=0, out=increment)
    angle += first
    return Motion(t, frozen(angle), rate[:-1], rate[1:])


def _through_ends(grid: SplineGrid, desired: Motion, ends: Ends) -> Floats:
    """Return the control points of the cubic that has the desired values at both ends.

    Without conditions at the end it is the straight line from the start.
    """
    first, rate = desired.angle[0], desired.rate_start[0]
    time = (grid.greville - grid.start)[:, None]
    if not (np.any(ends.end_value) or np.any(ends.end_rate)):
        return np.asarray(first + rate * time)
    span, h = grid.duration, grid.step
    rise = desired.angle[-1] - first
    last = desired.rate_end[-1]
    square = (3.0 * rise / span - 2.0 * rate - last) / span
    cube = (rate + last - 2.0 * rise / span) / span**2
    # control points of powers of time: their polar forms at a knot and its neighbours
    return np.asarray(
        first + rate * time + square * (time**2 - h**2 / 3.0) + cube * time * (time**2 - h**2)
    )


def _least_squares(grid: SplineGrid, desired: Motion, base: Floats) -> tuple[SymmetricBand, Floats]:
    """Return the quadratic cost of a deviation from the base: Hessian and linear part."""
    k, h = grid.intervals, grid.step
    nodes, weight = np.polynomial.legendre.leggauss(4)
    u, weight = 0.5 * (nodes + 1.0), 0.5 * h * weight
    value, slope = grid.basis(u, 0), grid.basis(u, 1)
    square = (value.T * weight) @ value + TAU**2 * (slope.T * weight) @ slope
    hessian = SymmetricBand(grid.points, len(JOINTS))
    for b in range(ORDER):
        for a in range(b, ORDER):
            hessian.data[b : b + k, :, len(JOINTS) * (a - b)] += square[a, b]
    hessian.add_differences(np.full((k, len(JOINTS)), SMOOTHING * h), 3, h)
    t = grid.start + h * (np.arange(k)[:, None] + u)
    angle, rate, _ = sample_motion(desired, t.reshape(-1))
    off_angle = angle.reshape(k, -1, 3) - grid.at_fractions(base, u, 0)
    off_rate = rate.reshape(k, -1, 3) - grid.at_fractions(base, u, 1)
    linear = np.zeros((grid.points, len(JOINTS)))
    for a in range(ORDER):
        linear[a : a + k] += np.einsum("g,kgj->kj", weight * value[:, a], off_angle)
        linear[a : a + k] += TAU**2 * np.einsum("g,kgj->kj", weight * slope[:, a], off_rate)
    return hessian, linear


def _eased(machine: Machine, desired: Motion) -> list[JointLimits]:
    """Return the limits within which corners are rounded for factors on the rates."""
    peaks = measure_peaks(desired)
    return [
        replace(limit, acceleration=_between(a, limit.acceleration), jerk=_between(j, limit.jerk))
        for limit, a, j in zip(machine.limits, peaks.acceleration, peaks.jerk, strict=True)
    ]


def _between(peak: float, limit: float) -> float:
    """Return what a corner is rounded at: what is needed elsewhere, at least CORNER."""
    return limit if np.isinf(limit) else float(np.clip(peak, CORNER * limit, limit))


def _start_trouble(desired: Motion, limits: Sequence[JointLimits]) -> str:
    """Say where the start itself is beyond a limit."""
    for j, (joint, limit) in enumerate(zip(JOINTS, limits, strict=True)):
        for what, value, bound, unit in (
            ("is", abs(float(desired.angle[0, j])), limit.angle, "rad"),
            ("turns with", abs(float(desired.rate_start[0, j])), limit.rate, "rad/s"),
        ):
            if value > bound:
                return (
                    f"the {joint} {what} {value:.4g} {unit} at the start, outside its limit of "
                    f"{bound:.4g} {unit}, at t = {desired.t[0]:g} s; start it inside"
                )
            if value > bound * (1.0 - NO_ROOM):
                return (
                    f"the {joint} {what} {value:.7g} {unit} at the start, at its limit of "
                    f"{bound:.7g} {unit}, which leaves a motion no room; start it farther inside, "
                    f"or hold the {joint}"
                )
    return ""
