"""Inequalities on an iterate that are local in time.

Every inequality is scaled so that its bounds are -1 and 1; the method in
``interior`` treats them all alike. The machine's limits hold between samples
too: with the acceleration constant over each interval, bounds on the rates at
the samples and on their change over the intervals are bounds everywhere, and an
angle's bound is drawn in where its parabola can bulge beyond the samples.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from des_cli.model.arrays import Flags, Floats, Indices
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
    An angle that no factor changes has no row: it may stand at its limit.

    Parameters
    ----------
    machine : Machine
    desired : Motion
        Inside the limits.
    unknowns : int
        3 + m.
    fixed : (n, 3) array of bool
        Angles that no factor changes.
    """

    def __init__(self, machine: Machine, desired: Motion, unknowns: int, fixed: Flags) -> None:
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
            sides.append(
                np.maximum(limit - _next_to(beyond), np.minimum(sign * at, angle[bounded]))
            )
        most, least = sides[0], -sides[1]
        self._middle, half = 0.5 * (most + least), 0.5 * (most - least)
        self._bounded, self._per_half = bounded, 1.0 / half
        self._per_half[fixed[:, bounded]] = 0.0
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


class RateSums(Rows):
    """Weighted sums of a joint's rates at neighbouring samples: rates, accelerations, jerks.

    Parameters
    ----------
    rates : Rates
        With one point at each sample.
    weights : sequence of (q, r) array
        Of the rates at samples k, k + 1, ..., over the limit.
    joints : (r,) int array
        Whose rates they are.
    """

    def __init__(self, rates: Rates, weights: Sequence[Floats], joints: Indices) -> None:
        super().__init__(np.arange(len(weights[0])))
        self.rates, self.weights, self.joints = rates, weights, joints

    def _ahead(self) -> Iterator[tuple[Floats, slice]]:
        """Pair the weights with the samples that they are of."""
        n = len(self.node)
        return ((weight, slice(i, i + n)) for i, weight in enumerate(self.weights))

    def value(self, x: Floats) -> Floats:
        """Return the sums over their limits."""
        rate = self.rates.value(x)[:, self.joints]
        return np.asarray(sum(weight * rate[at] for weight, at in self._ahead()))

    def jacobian(self, x: Floats) -> tuple[Floats, ...]:
        """Return the derivatives in x_k, x_{k+1}, ..."""
        slope = self.rates.expand(x)[1][:, self.joints]
        return tuple(weight[:, :, None] * slope[at] for weight, at in self._ahead())

    def curvature(self, x: Floats, multiplier: Floats) -> Floats | None:
        """Return the curvature of the rates along the multipliers."""
        total = np.zeros((len(x), 3))
        for weight, at in self._ahead():
            total[at, self.joints] += weight * multiplier
        return self.rates.curvature(x, total)


def _rate_rows(machine: Machine, rates: Rates, desired: Motion, kept: bool) -> RateSums:
    """Return the rows of rates at samples; a first rate that is kept needs none."""
    limit = np.array([limit.rate for limit in machine.limits])
    most = np.clip(np.abs(desired.rate), limit * (1.0 - MARGIN), limit)
    weight = 1.0 / most
    if kept:
        weight[0] = 0.0
    return RateSums(rates, [weight], np.arange(3))


def _acceleration_rows(machine: Machine, rates: Rates, step: Floats) -> RateSums:
    """Return the rows of accelerations over intervals."""
    limit = np.array([limit.acceleration for limit in machine.limits]) * (1.0 - MARGIN)
    weight = 1.0 / (limit * step[:, None])
    return RateSums(rates, [-weight, weight], np.arange(3))


def _jerk_rows(machine: Machine, rates: Rates, step: Floats) -> RateSums:
    """Return the rows of jerks between intervals, of the joints that have a limit."""
    limit = np.array([limit.jerk for limit in machine.limits]) * (1.0 - MARGIN)
    joints = np.flatnonzero(np.isfinite(limit))
    apart = 0.5 * (step[1:] + step[:-1])[:, None] * limit[joints]
    first, last = 1.0 / (step[:-1, None] * apart), 1.0 / (step[1:, None] * apart)
    return RateSums(rates, [first, -first - last, last], joints)


def limit_rows(
    machine: Machine, rates: Rates, desired: Motion, pinned: Flags, fixed: Flags
) -> tuple[Rows, ...]:
    """Return the machine's limits on rates, accelerations, angles and jerks.

    Parameters
    ----------
    machine : Machine
    rates : Rates
        Of a motion without rate steps: one point at each sample.
    desired : Motion
        Inside the limits.
    pinned : (n, 3 + m) array of bool
        Angles and factors that are not looked for.
    fixed : (n, 3) array of bool
        Angles that no factor changes.
    """
    step = desired.step
    rows = (
        _rate_rows(machine, rates, desired, bool(np.all(pinned[0]))),
        _acceleration_rows(machine, rates, step),
        AngleRows(machine, desired, pinned.shape[1], fixed),
    )
    smooth = any(np.isfinite(limit.jerk) for limit in machine.limits) and len(step) > 1
    return (*rows, _jerk_rows(machine, rates, step)) if smooth else rows
