"""A convex quadratic program over control points, from a start that may break its limits.

    minimise  1/2 x' Q x - b' x     subject to  |v_i(x)| <= b_i

by Mehrotra's predictor-corrector method (Nocedal and Wright, Numerical Optimization,
section 16.6). Q and the rows are banded; so is the system of every step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.solver.band import BandCholesky, SymmetricBand
from des_cli.solver.spline import Ends

FEASIBLE = 1e-9
"""Excess over a limit at the end, relative to the limit."""

OPTIMAL = 1e-6
"""First-order conditions and gap at the end, relative to b and to the cost. The result is a
start and a replacement for what cannot be executed: more digits mean nothing."""

ROOM = 0.1
"""Share of its limit that a slack starts with at least."""

MAX_ITERATIONS = 80

FRACTION = 0.995
"""Of the way to the nearest boundary that a step takes."""

SHIFTS = (0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6)
"""Relative shifts of the diagonal, tried in turn where the system is singular to rounding."""


class Rows(Protocol):
    """Linear rows over control points."""

    bounds: Floats

    def value(self, deviation: Floats) -> Floats:
        """Return the rows' values, (m,)."""

    def change(self, deviation: Floats) -> Floats:
        """Return what a deviation changes of them."""

    def adjoint(self, multiplier: Floats) -> Floats:
        """Return the transposed rows times multipliers, (n, d)."""

    def add_to(self, band: SymmetricBand, stiffness: Floats) -> None:
        """Add ``rows' diag(stiffness) rows`` to a band."""


@dataclass(frozen=True)
class QuadraticOutcome:
    """Where the method ended.

    Parameters
    ----------
    x : (n, d) array
    feasible : bool
    infeasibility : float
        Largest excess over a limit, relative to the limit.
    iterations : int
    """

    x: Floats
    feasible: bool
    infeasibility: float
    iterations: int


def minimise_quadratic(
    hessian: SymmetricBand, linear: Floats, rows: Rows, ends: Ends
) -> QuadraticOutcome:
    """Minimise a convex quadratic cost inside limits.

    Parameters
    ----------
    hessian : SymmetricBand
        Positive definite over what the ends leave free.
    linear : (n, d) array
    rows : Rows
    ends : Ends
    """
    return _Search(hessian, linear, rows, ends).run()


class _Search:
    def __init__(self, hessian: SymmetricBand, linear: Floats, rows: Rows, ends: Ends) -> None:
        self.hessian, self.linear, self.rows, self.ends = hessian, linear, rows, ends
        self.unit = max(float(np.max(np.abs(linear), initial=0.0)), 1e-300)
        self.x = self._solve(self._factorise(np.zeros_like(rows.bounds)), linear)
        self.size = max(abs(self._cost()), 1e-300)

    def run(self) -> QuadraticOutcome:
        bounds = np.tile(self.rows.bounds, 2)
        true = self._slack()
        if np.all(true > 0.0):
            return QuadraticOutcome(self.x, True, 0.0, 0)
        slack = np.maximum(true, ROOM * bounds)
        mu = 1e-2 * self.size / len(slack)
        dual = mu / slack
        m = len(self.rows.bounds)
        off = 1.0
        for number in range(1, MAX_ITERATIONS + 1):
            gradient = self.hessian.times(self.x) - self.linear
            force = gradient + self.rows.adjoint(dual[:m] - dual[m:])
            missing = self._slack() - slack
            gap = float(slack @ dual)
            off = float(np.max(np.abs(missing) / bounds, initial=0.0))
            residual = float(np.max(np.abs(self.ends.reduce(force)), initial=0.0)) / self.unit
            if off < FEASIBLE and residual < OPTIMAL and gap < OPTIMAL * self.size:
                break
            stiffness = dual / slack
            factor = self._factorise(stiffness[:m] + stiffness[m:])

            def step(target: Floats) -> tuple[Floats, Floats, Floats]:
                push = target / slack - stiffness * missing
                move = self._solve(factor, -gradient - self.rows.adjoint(push[:m] - push[m:]))
                rows = self.rows.change(move)
                change = missing + np.concatenate([-rows, rows])
                return move, change, target / slack - dual - stiffness * change

            _, change, dual_change = step(np.zeros_like(slack))
            ahead = (slack + _longest(slack, change) * change) @ (
                dual + _longest(dual, dual_change) * dual_change
            )
            centring = min(1.0, (ahead / gap) ** 3) * gap / len(slack)
            move, change, dual_change = step(centring - change * dual_change)
            length = min(1.0, FRACTION * _longest(slack, change))
            self.x = self.x + length * move
            slack = slack + length * change
            dual = dual + min(1.0, FRACTION * _longest(dual, dual_change)) * dual_change
        worst = float(np.max(-self._slack() / bounds, initial=0.0))
        return QuadraticOutcome(self.x, worst <= FEASIBLE, worst, number)

    def _slack(self) -> Floats:
        value = self.rows.value(self.x)
        return np.concatenate([self.rows.bounds - value, self.rows.bounds + value])

    def _cost(self) -> float:
        return float(np.sum(self.x * (0.5 * self.hessian.times(self.x) - self.linear)))

    def _factorise(self, stiffness: Floats) -> BandCholesky:
        band = self.hessian.copy()
        self.rows.add_to(band, stiffness)
        for shift in SHIFTS:
            shifted = band.copy()
            shifted.data[:, :, 0] *= 1.0 + shift
            factor = BandCholesky.of(shifted.reduced(self.ends))
            if factor is not None:
                return factor
        raise ValueError("the quadratic cost is not convex")

    def _solve(self, factor: BandCholesky, right: Floats) -> Floats:
        reduced = self.ends.reduce(right)
        solved = factor.solve(reduced.reshape(-1, 1))[:, 0]
        return self.ends.full(solved.reshape(right.shape))


def _longest(values: Floats, change: Floats) -> float:
    """Return the step to the nearest boundary, at most 1/FRACTION."""
    worst = float(np.min(change / values, initial=0.0))
    return min(1.0 / FRACTION, -1.0 / worst) if worst < 0.0 else 1.0 / FRACTION
