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

FEASIBLE, ACCEPTED = 1e-9, 1e-7
"""Excess over a limit that the end aims at, relative to the limit, and that it may have where
rounding ends the search: long angles leave so much of a jerk."""

OPTIMAL = 1e-6
"""First-order conditions and gap at the end, relative to b and to the cost. The result is a
start and a replacement for what cannot be executed: more digits mean nothing."""

ROOM = 0.1
"""Share of its limit that a slack starts with at least."""

HOPELESS = 1e60
"""Relative size of a multiplier, of the inverse of a slack, or of the gap to the cost, beyond
which nothing can be inside: all of them would grow until they overflow."""

FAR, PENALTIES = 2.0, 14
"""Limited values, relative to their limits, from which on a start is calmed, and how many
penalties, each ten times the one before, are tried."""

MAX_ITERATIONS = 80
"""Steps at the most: a predictor-corrector method takes a few dozen, whatever the size."""

FRACTION = 0.995
"""Of the way to the nearest boundary that a step takes: the usual value (Nocedal and Wright,
Numerical Optimization, section 19.2)."""

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
        slack = self._slack()
        if np.all(slack > 0.0):
            return QuadraticOutcome(self.x, True, 0.0, 0)
        self.x = self._calmed()
        slack = np.maximum(self._slack(), ROOM * bounds)
        dual = 1e-2 * self.size / len(slack) / slack
        iterations, before = 0, np.inf
        while iterations < MAX_ITERATIONS:
            if np.min(slack / bounds) * HOPELESS < 1.0 or np.max(dual * bounds) > (
                HOPELESS * self.size
            ):
                break
            local = _Local(self, slack, dual)
            off = float(np.max(np.abs(local.missing) / bounds, initial=0.0))
            optimal = local.residual < OPTIMAL and local.gap < OPTIMAL * self.size
            ended = off < FEASIBLE or ACCEPTED > off > 0.5 * before
            if (optimal and ended) or local.gap > HOPELESS * self.size:
                break
            before = off
            iterations += 1
            _, change, dual_change = local.step(np.zeros_like(slack))
            ahead = (slack + _longest(slack, change) * change) @ (
                dual + _longest(dual, dual_change) * dual_change
            )
            centring = min(1.0, float(ahead / local.gap) ** 3) * local.gap / len(slack)
            move, change, dual_change = local.step(centring - change * dual_change)
            length = min(1.0, FRACTION * _longest(slack, change))
            self.x = self.x + length * move
            slack = slack + length * change
            dual = dual + min(1.0, FRACTION * _longest(dual, dual_change)) * dual_change
        worst = float(np.max(-self._slack() / bounds, initial=0.0))
        return QuadraticOutcome(self.x, worst <= ACCEPTED, worst, iterations)

    def _calmed(self) -> Floats:
        """Return a start that breaks no limit by far: noisy targets break some hundredfold.

        It minimises the cost and a penalty on the squares of the limited values, the
        smallest of a sequence that is large enough.
        """
        x, bounds = self.x, self.rows.bounds
        still = self.rows.value(np.zeros_like(x))
        weight = self.size / len(bounds)
        for _ in range(PENALTIES):
            if np.max(np.abs(self.rows.value(x)) / bounds) <= FAR:
                break
            stiffness = weight / bounds**2
            right = self.linear - self.rows.adjoint(stiffness * still)
            x = self._solve(self._factorise(stiffness), right)
            weight *= 10.0
        return x

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


class _Local:
    """The system of one iterate, factorised.

    ``missing`` is what the slacks lack to the true distances from the limits.
    """

    def __init__(self, search: _Search, slack: Floats, dual: Floats) -> None:
        self._search, self._slack, self._dual = search, slack, dual
        self._m = m = len(search.rows.bounds)
        self._gradient = search.hessian.times(search.x) - search.linear
        self.missing = search._slack() - slack
        self.gap = float(slack @ dual)
        force = self._gradient + search.rows.adjoint(dual[:m] - dual[m:])
        worst = float(np.max(np.abs(search.ends.reduce(force)), initial=0.0))
        self.residual = worst / search.unit
        self._stiffness = dual / slack
        self._factor: BandCholesky | None = None

    def step(self, target: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the step towards slack times multiplier at a target: x, slacks, multipliers."""
        search, m = self._search, self._m
        if self._factor is None:
            self._factor = search._factorise(self._stiffness[:m] + self._stiffness[m:])
        multiplier = target / self._slack - self._stiffness * self.missing
        force = self._gradient + search.rows.adjoint(multiplier[:m] - multiplier[m:])
        move = search._solve(self._factor, -force)
        rows = search.rows.change(move)
        change = self.missing + np.concatenate([-rows, rows])
        return move, change, target / self._slack - self._dual - self._stiffness * change


def _longest(values: Floats, change: Floats) -> float:
    """Return the step to the nearest boundary, at most 1/FRACTION."""
    worst = float(np.min(change / values, initial=0.0))
    return min(1.0 / FRACTION, -1.0 / worst) if worst < 0.0 else 1.0 / FRACTION
