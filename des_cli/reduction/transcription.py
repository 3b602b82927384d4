"""The reduction problem on the sample grid: cost, dynamics, and their derivatives.

Unknowns stand in one array ``x`` of shape (n, 3 + m): at each of the n samples
the adapted angles theta (3) and the factors u (m). Between samples the rates
are linear, so that

    theta_{k+1} = theta_k + h/2 (theta'_k + theta'_{k+1}) + d_k (u_k + u_{k+1}) / 2

with d_k what the trapezoidal rule misses of the desired increment: u = 1 returns
the desired motion exactly. The cost is the trapezoidal rule over the two sides of
every interval; a sample at which the desired rate steps counts once for each side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from des_cli.kinematics.coriolis import coriolis, coriolis_curvature, coriolis_derivatives
from des_cli.model.arrays import Flags, Floats
from des_cli.model.motion import Motion
from des_cli.reduction.constraints import limit_rows
from des_cli.reduction.points import Points
from des_cli.reduction.problem import Problem
from des_cli.reduction.rates import AdaptedRates, DesiredRates, Rates
from des_cli.solver.program import Expansion, Measure, Rows
from des_cli.study.backward_forward import follow


@dataclass(frozen=True)
class CoriolisForm:
    """The Coriolis vector at the points with its first derivatives in x.

    Parameters
    ----------
    value : (q, 3) array
    jacobian : (q, 3, 3 + m) array
    """

    value: Floats
    jacobian: Floats


class Transcription:
    """A problem on its grid.

    Parameters
    ----------
    problem : Problem
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        motion = problem.desired
        self.n = len(motion.t)
        self.m = problem.controls
        self.joint = np.ones((3, 1)) if self.m == 1 else np.eye(3)
        self.points = Points.of(motion)
        self.weight = self.points.scatter(self.points.weight, self.n)
        self.rates = self._rates()
        self._half = 0.5 * motion.step[:, None, None]
        straight = self._half[:, 0] * (motion.rate_start + motion.rate_end)
        missed = np.diff(motion.angle, axis=0) - straight
        # The arm is commanded by its velocity: its angle is what the table's
        # velocities integrate to, whatever the desired angle's quadrature was.
        missed[:, 0] = 0.0
        self._missed = 0.5 * missed[:, :, None] * self.joint
        self._linear_dynamics: tuple[Floats, Floats] | None = None
        self.desired = np.hstack([motion.angle, np.ones((self.n, self.m))])
        """The iterate of the desired motion, u = 1."""
        self.pinned = self._pins()
        self.rows: list[Rows] = []
        if problem.machine is not None:
            self.rows += limit_rows(problem.machine, self.rates, motion, self.pinned, self._fixed())
        self.offset = np.zeros((len(self.points.node), 3))
        """Added to the Coriolis vector at the points where the cost weighs it."""
        self.budgets: list[Measure] = []
        """Measures that stay at or below one."""
        self.scale = self._typical_size()

    def _rates(self) -> Rates:
        motion, points = self.problem.desired, self.points
        if self.problem.jacobian == "desired":
            return DesiredRates(points.rate, self.joint)
        angle = points.gather(motion.angle)
        return AdaptedRates(self.problem.chain, angle, points.rate, self.joint)

    def _pins(self) -> Flags:
        pinned = np.zeros((self.n, 3 + self.m), dtype=bool)
        pinned[0, :3] = True  # theta(t0) = Theta(t0)
        if self.m == 3:
            pinned[:, 3:] |= self.problem.held
        if self.problem.ends != "free":
            pinned[0] = True
        if self.problem.ends == "match-both":
            pinned[-1] = True
        return pinned

    def _fixed(self) -> Flags:
        """Return the angles that no factor changes, (n, 3): a factor on no rate has no effect."""
        desired = self.problem.desired
        fixed = np.zeros((self.n, 3), dtype=bool)
        fixed[0] = True
        if self.problem.jacobian == "desired":
            moved = np.any(desired.rate_sides != 0.0, axis=1)
            moved |= np.diff(desired.angle, axis=0) != 0.0
            fixed[1:] = ~np.logical_or.accumulate(moved, axis=0)
            fixed |= self.problem.held & (self.m == 3)
        return fixed

    # ------------------------------------------------------------------ dynamics
    def motion(self, x: Floats) -> Motion:
        """Return the motion of an iterate, with its rates on both sides of each sample."""
        rate = self.rates.value(self.points.gather(x))
        return Motion(
            t=self.problem.desired.t,
            angle=x[:, :3],
            rate_start=rate[self.points.start],
            rate_end=rate[self.points.end],
        )

    def defect(self, x: Floats) -> Floats:
        """Return the residual of the dynamics over each interval, (n - 1, 3) [rad]."""
        rate = self.rates.value(self.points.gather(x))
        increment = self._half[:, :, 0] * (rate[self.points.start] + rate[self.points.end])
        increment += ((x[:-1, 3:] + x[1:, 3:])[:, None, :] * self._missed).sum(axis=2)
        return np.asarray(np.diff(x[:, :3], axis=0) - increment)

    def defect_jacobian(self, x: Floats) -> tuple[Floats, Floats]:
        """Return d defect_k / d x_k and / d x_{k+1}, (n - 1, 3, 3 + m) each."""
        if self._linear_dynamics is not None:
            return self._linear_dynamics
        _, slope = self.rates.expand(self.points.gather(x))
        left = -self._half * slope[self.points.start]
        ahead = -self._half * slope[self.points.end]
        for block, sign in ((left, -1.0), (ahead, 1.0)):
            block[:, :, :3] += sign * np.eye(3)
            block[:, :, 3:] -= self._missed
        if self.problem.jacobian == "desired":
            self._linear_dynamics = left, ahead
        return left, ahead

    def defect_curvature(self, x: Floats, multiplier: Floats) -> Floats | None:
        """Return the second derivatives of multiplier' defect, (n, 3 + m, 3 + m), or None."""
        of_rates = np.zeros((len(self.points.node), 3))
        of_rates[self.points.start] -= self._half[:, :, 0] * multiplier
        of_rates[self.points.end] -= self._half[:, :, 0] * multiplier
        curvature = self.rates.curvature(self.points.gather(x), of_rates)
        return None if curvature is None else self.points.scatter(curvature, self.n)

    def follow(self, control: Floats) -> Floats:
        """Integrate factors (n, m) to an iterate on the dynamics of the desired Jacobian."""
        return np.hstack([follow(self.problem.desired, control).angle, control])

    # ------------------------------------------------------------------ cost
    def coriolis(self, x: Floats) -> Floats:
        """Return the Coriolis vector at the points, (q, 3) [rad/s^2]."""
        state, problem = self.points.gather(x), self.problem
        return coriolis(problem.chain, state[:, :3], self.rates.value(state), problem.axes)

    def cost(self, x: Floats) -> float:
        """Return J of an iterate."""
        return float(self.points.weight @ self._density(x, self.coriolis(x)))

    def _density(self, x: Floats, c: Floats) -> Floats:
        problem, state = self.problem, self.points.gather(x)
        off = state[:, :3] - self.points.gather(problem.desired.angle)
        weighed = c + self.offset
        density: Floats = 0.5 * (
            np.sum((weighed @ problem.r1) * weighed, axis=1)
            + (1.0 - state[:, 3:]) ** 2 @ problem.r2
            + off**2 @ problem.tracking
        )
        return density

    def coriolis_form(self, x: Floats) -> CoriolisForm:
        """Return the Coriolis vector at the points and its Jacobian."""
        state, problem = self.points.gather(x), self.problem
        rate, slope = self.rates.expand(state)
        value, by_angle, by_rate = coriolis_derivatives(
            problem.chain, state[:, :3], rate, problem.axes
        )
        jacobian = by_rate @ slope
        jacobian[:, :, :3] += by_angle
        return CoriolisForm(value, jacobian)

    def coriolis_curvature(self, x: Floats, multiplier: Floats) -> Floats:
        """Return sum_q multiplier_q d2 c_q / dx dx at the points, (q, 3 + m, 3 + m)."""
        state, problem = self.points.gather(x), self.problem
        rate, slope = self.rates.expand(state)
        angle_angle, angle_rate, rate_rate = coriolis_curvature(
            problem.chain, state[:, :3], rate, multiplier, problem.axes
        )
        cross = angle_rate @ slope  # (q, angle, 3 + m)
        curvature: Floats = np.swapaxes(slope, 1, 2) @ rate_rate @ slope
        curvature[:, :3, :3] += angle_angle
        curvature[:, :3, :] += cross
        curvature[:, :, :3] += np.swapaxes(cross, 1, 2)
        along_rates = (rate_rate @ rate[:, :, None])[:, :, 0]  # multiplier' dc/dtheta'
        through_rates = self.rates.curvature(state, along_rates)
        return curvature if through_rates is None else curvature + through_rates

    def expand(self, x: Floats) -> Expansion:
        """Expand the cost to second order.

        Parameters
        ----------
        x : (n, 3 + m) array
        """
        problem, points = self.problem, self.points
        form = self.coriolis_form(x)
        gradient, multiplier = self._point_gradient(x, form)
        hessian = np.swapaxes(form.jacobian, 1, 2) @ problem.r1 @ form.jacobian
        curvature = points.scatter(
            points.weight[:, None, None] * self.coriolis_curvature(x, multiplier), self.n
        )
        diagonal = np.concatenate([problem.tracking, problem.r2])
        hessian[:, np.arange(3 + self.m), np.arange(3 + self.m)] += diagonal
        return Expansion(
            cost=float(points.weight @ self._density(x, form.value)),
            gradient=points.scatter(points.weight[:, None] * gradient, self.n),
            hessian=points.scatter(points.weight[:, None, None] * hessian, self.n),
            curvature=curvature,
        )

    def _point_gradient(self, x: Floats, form: CoriolisForm) -> tuple[Floats, Floats]:
        """Return the running cost's gradient at the points, and R1 times what it weighs."""
        problem, state = self.problem, self.points.gather(x)
        multiplier = (form.value + self.offset) @ problem.r1
        gradient = (multiplier[:, None, :] @ form.jacobian)[:, 0]
        gradient[:, 3:] += (state[:, 3:] - 1.0) * problem.r2
        off = state[:, :3] - self.points.gather(problem.desired.angle)
        gradient[:, :3] += off * problem.tracking
        return gradient, multiplier

    def gradient(self, x: Floats) -> Floats:
        """Return dJ/dx at fixed neighbours, (n, 3 + m)."""
        density = self._point_gradient(x, self.coriolis_form(x))[0]
        return self.points.scatter(self.points.weight[:, None] * density, self.n)

    # ------------------------------------------------------------------ first order
    def reduced_gradient(self, x: Floats) -> Floats:
        """Return dJ/du with the angles following u, (n, m), for the desired Jacobian."""
        gradient = self.gradient(x)
        left, ahead = self.defect_jacobian(x)
        later = np.cumsum(gradient[:0:-1, :3], axis=0)[::-1]  # dJ/dtheta of all later samples
        reduced = gradient[:, 3:].copy()
        reduced[:-1] -= (later[:, None, :] @ left[:, :, 3:])[:, 0]
        reduced[1:] -= (later[:, None, :] @ ahead[:, :, 3:])[:, 0]
        return reduced

    def adjoint(
        self, x: Floats, multiplier: Floats, prices: Sequence[float] | Floats = ()
    ) -> Floats:
        """Return the costate of the angles at each sample, (n, 3).

        Parameters
        ----------
        x : (n, 3 + m) array
        multiplier : (n - 1, 3) array
            Of ``defect``: minus the costate between samples. Half a sample's
            weight of dJ/dtheta leads to the sample itself.
        prices : sequence of float
            Multipliers of the budgets.
        """
        gradient = self.gradient(x)
        for price, measure in zip(prices, self.budgets, strict=True):
            gradient += price * measure.expand(x).gradient
        force = gradient[:, :3] / self.weight[:, None]
        half = 0.5 * self.problem.desired.step[:, None]
        between = -multiplier  # of the interval's constraint, in the sign of (42) and (47)
        return np.vstack([between + half * force[:-1], between[-1:] - half[-1:] * force[-1:]])

    def _typical_size(self) -> float:
        """Return the size of dJ/du per unit time that the desired motion meets."""
        force = self.gradient(self.desired)[:, 3:] / self.weight[:, None]
        return float(max(np.max(np.abs(force)), np.max(self.problem.r2), 1e-12))
