"""The nearest motion to a desired one that the machine can execute.

A separate convex problem for each joint, solved together: angles and rates
that are linear between samples, inside the limits, nearest to the desired ones,

    minimise 1/2 int (theta - Theta)^2 + tau^2 (theta' - Theta')^2 dt.

It rounds the corner where a desired rate steps, instead of leaving it to a
factor that would slow every joint for it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from des_cli.model.arrays import Flags, Floats
from des_cli.model.machine import JOINTS, Machine
from des_cli.model.motion import Motion
from des_cli.reduction.constraints import limit_rows
from des_cli.reduction.limits import find_violations, measure_peaks
from des_cli.reduction.rates import DesiredRates
from des_cli.solver.interior import Outcome, minimise
from des_cli.solver.program import Expansion

TAU = 0.05
"""Time [s] that weighs a rate error against an angle error: about what the DES's
cab needs to round a corner."""

STRAIGHT = 1e-4
"""Difference of an angle [rad] from the integral of its rates that is the quadrature's
alone: a joint that keeps its limits is then left as it is."""

TOLERANCE = 1e-9
MAX_ITERATIONS = 200

CLEAR = 1e-3
"""Relative distance that the nearest motion keeps from rate and acceleration limits,
so that the reduction starts from inside them."""

CORNER = 0.5
"""Share of the acceleration limit at which a corner is rounded, unless the desired
motion asks for more elsewhere. A corner that is rounded at the limit itself leaves
the reduction no room: a scalar factor would have to stay at one or below, for
every joint, wherever one joint turns a corner."""


def nearest_executable(machine: Machine, desired: Motion) -> tuple[Motion, Outcome | None]:
    """Return the nearest motion inside the machine's limits, and how it was found.

    Parameters
    ----------
    machine : Machine
    desired : Motion
        It may break limits and its rates may step.

    Returns
    -------
    motion : Motion
        Its angles are the integrals of its rates, which do not step.
    outcome : Outcome, optional
        Not ``converged`` where no motion from the desired start keeps the limits;
        None where the desired motion keeps them itself.
    """
    straight = _straighten(desired)
    kept = _keeps(machine, desired, straight)
    if np.all(kept):
        return straight, None
    program = _Nearest(_eased(machine, desired), desired)
    start = np.hstack([desired.angle, program.rate])
    outcome = minimise(
        program, start, tolerance=TOLERANCE, max_iterations=MAX_ITERATIONS, barrier=1.0
    )
    rate = np.where(kept, desired.rate, outcome.x[:, 3:])
    return _integrate(desired, rate), outcome


def _integrate(desired: Motion, rate: Floats) -> Motion:
    """Return the motion from the desired start with rates that are linear between samples."""
    increment = np.cumsum(0.5 * desired.step[:, None] * (rate[:-1] + rate[1:]), axis=0)
    angle = desired.angle[0] + np.vstack([np.zeros(3), increment])
    return Motion(desired.t, angle, rate[:-1], rate[1:])


def _straighten(desired: Motion) -> Motion:
    """Return the desired motion with its rates linear between samples, and its angles theirs."""
    return _integrate(desired, desired.rate)


def _keeps(machine: Machine, desired: Motion, straight: Motion) -> Flags:
    """Return the joints, (3,), whose desired motion is executable as it stands."""
    broken = {
        violation.joint
        for motion in (desired, straight)
        for violation in find_violations(machine, motion, "desired")
    }
    near = np.max(np.abs(straight.angle - desired.angle), axis=0) <= STRAIGHT
    return np.asarray(near & np.array([joint not in broken for joint in JOINTS]))


def _eased(machine: Machine, desired: Motion) -> Machine:
    """Return the machine with its limits drawn in."""
    asked = measure_peaks(desired).acceleration
    arm, fork, cab = (
        replace(
            limit,
            angle=limit.angle * (1.0 - CLEAR * 1e-3),
            rate=limit.rate * (1.0 - CLEAR),
            acceleration=float(
                np.clip(peak, CORNER * limit.acceleration, (1.0 - CLEAR) * limit.acceleration)
            ),
        )
        for limit, peak in zip(machine.limits, asked, strict=True)
    )
    return replace(machine, limits=(arm, fork, cab))


class _Nearest:
    """The convex problem; its unknowns are the angles and the rates at each sample."""

    scale = 1.0
    budgets = ()

    def __init__(self, machine: Machine, desired: Motion) -> None:
        n = len(desired.t)
        self.desired = desired
        self.rate = desired.rate
        self.half = 0.5 * desired.step[:, None]
        self.weight = np.zeros(n)
        self.weight[:-1] += self.half[:, 0]
        self.weight[1:] += self.half[:, 0]
        self.pinned = np.zeros((n, 6), dtype=bool)
        self.pinned[0, :3] = True
        # a factor on a unit rate is a rate
        rates = DesiredRates(np.ones((n, 3)), np.eye(3))
        self.rows = limit_rows(machine, rates, desired.step, 6)
        self._hessian = self.weight[:, None, None] * np.diag([1.0] * 3 + [TAU**2] * 3)
        eye = np.broadcast_to(np.eye(3), (n - 1, 3, 3))
        half = self.half[:, :, None] * eye
        self._jacobian = (
            np.concatenate([-eye, -half], axis=2),
            np.concatenate([eye, -half], axis=2),
        )

    def _off(self, x: Floats) -> Floats:
        return x - np.hstack([self.desired.angle, self.rate])

    def cost(self, x: Floats) -> float:
        off = self._off(x)
        return 0.5 * float(np.einsum("ki,kij,kj->", off, self._hessian, off))

    def expand(self, x: Floats) -> Expansion:
        gradient = np.einsum("kij,kj->ki", self._hessian, self._off(x))
        return Expansion(self.cost(x), gradient, self._hessian)

    def defect(self, x: Floats) -> Floats:
        return np.asarray(np.diff(x[:, :3], axis=0) - self.half * (x[:-1, 3:] + x[1:, 3:]))

    def defect_jacobian(self, x: Floats) -> tuple[Floats, Floats]:
        return self._jacobian

    def defect_curvature(self, x: Floats, multiplier: Floats) -> None:
        return None
