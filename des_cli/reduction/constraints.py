"""Inequalities on an iterate that are local in time.

Every inequality is scaled so that its bounds are -1 and 1; the method in
``interior`` treats them all alike. The machine's limits hold between samples
too: with the acceleration constant over each interval, bounds on the rates at
the samples and on their change over the intervals are bounds everywhere, and an
angle's bound is drawn in where its parabola can bulge beyond the samples.
"""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import Machine
from des_cli.model.motion import Motion
from des_cli.reduction.rates import Rates
from des_cli.solver.program import Rows

MARGIN = 1e-6
"""Relative distance that the solver keeps from a machine limit: room for the rounding of
whoever differentiates a table of positions twice."""


class AngleRows(Rows):
    """Angles inside their limits, at samples and between them.

    Between two samples an angle is a parabola. Where the rate changes its sign it goes
    beyond both ends, by at most ``acceleration h^2 / 8``, upwards where the rate falls
    and downwards where it rises: on that side the bound of the two samples is drawn in,
    though never inside the desired angle, which keeps the limit with its parabola.

    Parameters
    ----------
    machine : Machine
    desired : Motion
        Inside the limits.
    unknowns : int
        3 + m.
    """

    def __init__(self, machine: Machine, desired: Motion, unknowns: int) -> None:
        super().__init__(np.arange(len(desired.t)))
        angle = np.array([limit.angle for limit in machine.limits])
        bounded = np.flatnonzero(np.isfinite(angle))
        limit = angle[bounded] * (1.0 - MARGIN)
        acceleration = np.array([limit.acceleration for limit in machine.limits])[bounded]
        bulge = acceleration * desired.step[:, None] ** 2 / 8.0
        at = desired.angle[:, bounded]
        sides = []
        for sign in (1.0, -1.0):
            start, end = sign * desired.rate_start[:, bounded], sign * desired.rate_end[:, bounded]
            beyond = np.where((start > 0.0) & (end < 0.0), bulge, 0.0)
            sides.append(np.maximum(limit - _next_to(beyond), np.minimum(sign * at, limit)))
        most, least = sides[0], -sides[1]
        self._middle, half = 0.5 * (most + least), 0.5 * (most - least)
        self._bounded, self._per_half = bounded, 1.0 / half
        self._jacobian = np.zeros((len(self.node), len(bounded), unknowns))
        self._jacobian[:, np.arange(len(bounded)), bounded] = self._per_half

    def value(self, x: Floats) -> Floats:
        """Return the angles from the middle of their bounds, over half of their distance."""
        return np.asarray((x[:, self._bounded] - self._middle) * self._per_half)

    def jacobian(self, x: Floats) -> tuple[Floats, ...]:
        """Return the constant coefficients."""
        return (self._jacobian,)


def _next_to(intervals: Floats) -> Floats:
    """Return the largest value of the intervals next to each sample, (n, k) of (n - 1, k)."""
    edge = np.zeros((1, intervals.shape[1]))
    return np.maximum(np.vstack([intervals, edge]), np.vstack([edge, intervals]))


class RateRows(Rows):
    """Joint rates inside their limits, at samples.

    Parameters
    ----------
    machine : Machine
    rates : Rates
        With one point at each sample.
    step : (n - 1,) array
        [s]
    """

    def __init__(self, machine: Machine, rates: Rates, step: Floats) -> None:
        super().__init__(np.arange(len(step) + 1))
        self.rates = rates
        self.per_rate = 1.0 / (np.array([limit.rate for limit in machine.limits]) * (1.0 - MARGIN))

    def value(self, x: Floats) -> Floats:
        """Return the rates over their limits."""
        return self.rates.value(x) * self.per_rate

    def jacobian(self, x: Floats) -> tuple[Floats, ...]:
        """Return the derivative in x_k."""
        return (self.rates.expand(x)[1] * self.per_rate[:, None],)

    def curvature(self, x: Floats, multiplier: Floats) -> Floats | None:
        """Return the rates' curvature along the multipliers."""
        return self.rates.bend(x, multiplier * self.per_rate)


class AccelerationRows(Rows):
    """Joint accelerations inside their limits, over intervals.

    Parameters
    ----------
    machine : Machine
    rates : Rates
        With one point at each sample.
    step : (n - 1,) array
        [s]
    """

    def __init__(self, machine: Machine, rates: Rates, step: Floats) -> None:
        super().__init__(np.arange(len(step)))
        self.rates = rates
        limit = np.array([limit.acceleration for limit in machine.limits]) * (1.0 - MARGIN)
        self.per_change = 1.0 / (limit * step[:, None])

    def value(self, x: Floats) -> Floats:
        """Return the accelerations over their limits."""
        return np.diff(self.rates.value(x), axis=0) * self.per_change

    def jacobian(self, x: Floats) -> tuple[Floats, ...]:
        """Return the derivatives in x_k and x_{k+1}."""
        slope = self.rates.expand(x)[1]
        each = self.per_change[:, :, None]
        return -slope[:-1] * each, slope[1:] * each

    def curvature(self, x: Floats, multiplier: Floats) -> Floats | None:
        """Return the curvature of both ends' rates along the multipliers."""
        push = multiplier * self.per_change
        pull = np.zeros((len(x), 3))
        pull[1:] += push
        pull[:-1] -= push
        return self.rates.bend(x, pull)


class JerkRows(Rows):
    """Changes of the acceleration from one interval to the next, of joints that have a limit.

    Parameters
    ----------
    machine : Machine
    rates : Rates
        With one point at each sample.
    step : (n - 1,) array
        [s]
    """

    def __init__(self, machine: Machine, rates: Rates, step: Floats) -> None:
        super().__init__(np.arange(len(step) - 1))
        limit = np.array([limit.jerk for limit in machine.limits]) * (1.0 - MARGIN)
        self.rates, self.joints = rates, np.flatnonzero(np.isfinite(limit))
        apart = 0.5 * (step[1:] + step[:-1])[:, None] * limit[self.joints]
        first, last = 1.0 / (step[:-1, None] * apart), 1.0 / (step[1:, None] * apart)
        self.share = (first, -first - last, last)
        """Coefficients of the rates at samples k, k + 1 and k + 2, (n - 2, joints)."""

    def value(self, x: Floats) -> Floats:
        """Return the jerks over their limits."""
        rate = self.rates.value(x)[:, self.joints]
        n = len(self.node)
        return np.asarray(sum(c * rate[i : i + n] for i, c in enumerate(self.share)))

    def jacobian(self, x: Floats) -> tuple[Floats, ...]:
        """Return the derivatives in x_k, x_{k+1} and x_{k+2}."""
        slope = self.rates.expand(x)[1][:, self.joints]
        n = len(self.node)
        return tuple(c[:, :, None] * slope[i : i + n] for i, c in enumerate(self.share))

    def curvature(self, x: Floats, multiplier: Floats) -> Floats | None:
        """Return the curvature of the three rates along the multipliers."""
        weight = np.zeros((len(x), 3))
        n = len(self.node)
        for i, c in enumerate(self.share):
            weight[i : i + n, self.joints] += c * multiplier
        return self.rates.bend(x, weight)


def limit_rows(machine: Machine, rates: Rates, desired: Motion, unknowns: int) -> tuple[Rows, ...]:
    """Return the machine's limits on rates, accelerations, angles and jerks.

    Parameters
    ----------
    machine : Machine
    rates : Rates
        Of a motion without rate steps: one point at each sample.
    desired : Motion
        Inside the limits.
    unknowns : int
        3 + m.
    """
    step = desired.step
    rows = (
        RateRows(machine, rates, step),
        AccelerationRows(machine, rates, step),
        AngleRows(machine, desired, unknowns),
    )
    smooth = any(np.isfinite(limit.jerk) for limit in machine.limits) and len(step) > 1
    return (*rows, JerkRows(machine, rates, step)) if smooth else rows
