"""What simpler means make of the same problem: the study's sweep, and a constant p.

A reduction means little without them: slowing everything down by one factor
already takes most of the Coriolis away.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.kinematics.coriolis_along import weighted_square
from des_cli.model.arrays import Floats
from des_cli.model.motion import Motion
from des_cli.model.sides import in_pieces
from des_cli.reduction.fidelity import angle_deviation, joint_deviation
from des_cli.reduction.problem import Problem
from des_cli.reduction.study_law import RUNAWAY
from des_cli.study.backward_forward import adjoint_along, factors_of, follow

RAN_AWAY = 100.0
"""Growth of the weighted Coriolis beyond which the study's sweep is no baseline."""

NOTHING = 1e-24
"""Integral of the squared weighted Coriolis that is rounding, and cannot be reduced."""

MOST_SECANTS, CLOSE = 60, 1e-14
"""Evaluations of a constant factor's energy at the most, and how close its bracket gets."""


@dataclass(frozen=True, slots=True)
class Baselines:
    """Reductions of the weighted Coriolis int c' R1 c, and their price in the joints.

    A reduction is None where the desired motion makes no weighted Coriolis; what
    the sweep reaches is None where it runs away.
    """

    reduction: float | None
    sweep_reduction: float | None
    sweep_deviation: float | None
    constant_p: float
    constant_deviation: float


def compare(problem: Problem, modified: Motion, chain: Chain | None = None) -> Baselines:
    """Set a modified motion beside the study's sweep and the constant factor that equals it.

    Parameters
    ----------
    problem : Problem
        The study's, along the executable motion; reductions are relative to its reference.
    modified : Motion
    chain : Chain, optional
        With the seat as the modified motion has it, where it was turned.

    Returns
    -------
    Baselines
    """
    desired = problem.desired
    before = weighted_energy(problem, problem.reference)
    turned = problem if chain is None else replace(problem, chain=chain)
    after = weighted_energy(turned, modified)
    swept = _sweep_once(problem)
    swept_energy = np.inf if swept is None else weighted_energy(problem, swept)
    if swept_energy > RAN_AWAY * before:
        swept = None
    slowed = _Slowed(problem)
    p = _constant_factor(slowed, before, after) if before > after else 1.0
    return Baselines(
        reduction=relative_reduction(before, after),
        sweep_reduction=None if swept is None else relative_reduction(before, swept_energy),
        sweep_deviation=None if swept is None else joint_deviation(desired, swept),
        constant_p=p,
        constant_deviation=angle_deviation(desired, slowed.angle(p)),
    )


def objective_reduction(problem: Problem, modified: Motion) -> float | None:
    """Return the reduction of int c' R1 c by a motion, None where there is nothing to reduce."""
    before = weighted_energy(problem, problem.reference)
    return relative_reduction(before, weighted_energy(problem, modified))


def relative_reduction(before: float, after: float) -> float | None:
    """Return 1 - after / before, None where there was nothing before."""
    return None if before <= NOTHING else 1.0 - after / before


def _sweep_once(problem: Problem) -> Motion | None:
    """Return the motion of the study's law with one factor, or None where it runs away."""
    desired = problem.desired
    with np.errstate(over="ignore", invalid="ignore"):
        adjoint = adjoint_along(desired, problem.chain, problem.axes, problem.r1)
        factors = factors_of(desired, adjoint, np.array([problem.r2.sum()]))
    return follow(desired, factors) if np.max(np.abs(factors)) < RUNAWAY else None


def weighted_energy(problem: Problem, motion: Motion) -> float:
    """Return int c' R1 c dt of a motion."""
    return weighted_square(problem.chain, motion, problem.axes, problem.r1)


class _Slowed:
    """The motions of one constant factor on the desired rates."""

    def __init__(self, problem: Problem) -> None:
        self.problem, desired = problem, problem.desired
        # The arm is commanded by its rate: its angle is what that integrates to.
        rise = 0.5 * desired.step * (desired.rate_start[:, 0] + desired.rate_end[:, 0])
        self.rise = desired.angle - desired.angle[0]
        np.cumsum(rise, out=self.rise[1:, 0])

    def angle(self, p: float, samples: slice = slice(None)) -> Floats:
        """Return the angles of a factor at samples, (n, 3) [rad]."""
        return np.asarray(self.problem.desired.angle[0] + p * self.rise[samples])

    def energy(self, p: float) -> float:
        """Return the weighted energy of a factor."""
        desired, energy = self.problem.desired, 0.0
        for part in in_pieces(len(desired.step)):
            samples = slice(part.start, part.stop + 1)
            rates = (p * desired.rate_start[part], p * desired.rate_end[part])
            motion = Motion(desired.t[samples], self.angle(p, samples), *rates)
            energy += weighted_energy(self.problem, motion)
        return energy


def _constant_factor(slowed: _Slowed, before: float, after: float) -> float:
    """Return a constant p below one whose weighted energy is that of a solution.

    The energy is p^4 times what changes slowly with p: its fourth root is close to a
    line, on which a secant that keeps a bracket (Anderson and Bjoerck, BIT 13, 1973)
    arrives after a few evaluations.
    """

    def excess(p: float) -> float:
        return float(slowed.energy(p) ** 0.25 - after**0.25)

    low, high = 0.0, 1.0
    at_low, at_high = float(-(after**0.25)), float(before**0.25 - after**0.25)
    for _ in range(MOST_SECANTS):
        if at_low == 0.0 or high - low <= CLOSE:
            return low
        p = (low * at_high - high * at_low) / (at_high - at_low)
        if not low < p < high:
            return min(max(p, low), high)
        at_p = excess(p)
        if abs(at_p) <= CLOSE * before**0.25:
            return p
        if at_p > 0.0:
            share = 1.0 - at_p / at_high
            high, at_high, at_low = p, at_p, at_low * (share if share > 0.0 else 0.5)
        else:
            share = 1.0 - at_p / at_low
            low, at_low, at_high = p, at_p, at_high * (share if share > 0.0 else 0.5)
    return 0.5 * (low + high)
