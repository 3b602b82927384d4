"""Measures of fidelity that a budget can be set on, with their derivatives.

Each is the square of a metric over the square of its budget, so that the budget
is one and the square is smooth where the metric itself has a kink.
"""

from __future__ import annotations

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.model.arrays import Floats
from des_cli.model.metric import MetricKey
from des_cli.reduction.transcription import Measure, Transcription
from des_cli.solver.program import Expansion
from des_cli.units import STANDARD_GRAVITY_M_S2


class JointDeviation(Measure):
    """||theta - Theta|| / ||Theta||, squared.

    Parameters
    ----------
    grid : Transcription
    budget : float
    """

    def __init__(self, grid: Transcription, budget: float) -> None:
        self.wanted = grid.problem.desired.angle
        size = float(grid.weight @ np.sum(self.wanted**2, axis=1))
        self.weight = grid.weight / (budget**2 * max(size, 1e-300))

    def value(self, x: Floats) -> float:
        """Return the value of an iterate."""
        return float(self.weight @ np.sum((x[:, :3] - self.wanted) ** 2, axis=1))

    def expand(self, x: Floats) -> Expansion:
        """Expand the value; it is quadratic."""
        n, width = x.shape
        gradient, hessian = np.zeros((n, width)), np.zeros((n, width, width))
        gradient[:, :3] = 2.0 * self.weight[:, None] * (x[:, :3] - self.wanted)
        hessian[:, :3, :3] = 2.0 * self.weight[:, None, None] * np.eye(3)
        return Expansion(self.value(x), gradient, hessian)


class FactorDeviation(Measure):
    """Mean of (1 - u)^2, over its budget (the metric is a square already)."""

    def __init__(self, grid: Transcription, budget: float) -> None:
        self.weight = grid.weight / (budget * grid.weight.sum() * grid.m)

    def value(self, x: Floats) -> float:
        """Return the value of an iterate."""
        return float(self.weight @ np.sum((1.0 - x[:, 3:]) ** 2, axis=1))

    def expand(self, x: Floats) -> Expansion:
        """Expand the value; it is quadratic."""
        n, width = x.shape
        gradient, hessian = np.zeros((n, width)), np.zeros((n, width, width))
        gradient[:, 3:] = 2.0 * self.weight[:, None] * (x[:, 3:] - 1.0)
        hessian[:, 3:, 3:] = 2.0 * self.weight[:, None, None] * np.eye(width - 3)
        return Expansion(self.value(x), gradient, hessian)


class SeatRateDeviation(Measure):
    """||W - W_desired|| / ||W_desired|| in seat axes, squared.

    Parameters
    ----------
    grid : Transcription
    budget : float
    """

    def __init__(self, grid: Transcription, budget: float) -> None:
        self.grid = grid
        axes = grid.problem.chain.seat_axes
        self.axes, self.turn, self.bend = axes, axes.gradient(), axes.gradient().gradient()
        self.wanted = self._spin(grid.desired)
        size = float(grid.points.weight @ np.sum(self.wanted**2, axis=1))
        self.weight = grid.points.weight / (budget**2 * max(size, 1e-300))

    def _spin(self, x: Floats) -> Floats:
        here = self.grid.points.gather(x)
        rate = self.grid.rates.value(here)
        return np.asarray((rate[:, None, :] @ self.axes(here[:, :3]))[:, 0])

    def value(self, x: Floats) -> float:
        """Return the value of an iterate."""
        return float(self.weight @ np.sum((self._spin(x) - self.wanted) ** 2, axis=1))

    def expand(self, x: Floats) -> Expansion:
        """Expand the value with its exact Hessian."""
        grid, here = self.grid, self.grid.points.gather(x)
        rate, slope = grid.rates.expand(here)
        axes, turn, bend = (form(here[:, :3]) for form in (self.axes, self.turn, self.bend))
        jacobian = np.swapaxes(axes, 1, 2) @ slope
        jacobian[:, :, :3] += np.swapaxes((rate[:, None, None, :] @ turn)[:, :, 0], 1, 2)
        off = self._spin(x) - self.wanted
        bent = np.zeros((len(here), here.shape[1], here.shape[1]))
        cross = (turn @ off[:, None, :, None])[..., 0] @ slope  # (q, angle, 3 + m)
        bent[:, :3, :] += cross
        bent[:, :, :3] += np.swapaxes(cross, 1, 2)
        bent[:, :3, :3] += np.einsum("kabjc,kj,kc->kab", bend, rate, off, optimize=True)
        through_rates = grid.rates.bend(here, (axes @ off[:, :, None])[:, :, 0])
        if through_rates is not None:
            bent += through_rates
        scale = 2.0 * self.weight
        return Expansion(
            float(self.weight @ np.sum(off**2, axis=1)),
            grid.points.scatter(scale[:, None] * (off[:, None, :] @ jacobian)[:, 0], grid.n),
            grid.points.scatter(
                scale[:, None, None] * (np.swapaxes(jacobian, 1, 2) @ jacobian), grid.n
            ),
            bend=grid.points.scatter(scale[:, None, None] * bent, grid.n),
        )


class SeatGDeviation(Measure):
    """||G - G_desired||, squared, over a size times the budget squared.

    Parameters
    ----------
    grid : Transcription
    budget : float
        [g] for the root mean square, or relative to ||G_desired||.
    gravity : float
        [m/s^2]
    relative : bool
    """

    def __init__(
        self, grid: Transcription, budget: float, gravity: float, *, relative: bool
    ) -> None:
        self.grid = grid
        chain: Chain = grid.problem.chain
        self.up = gravity * np.array([0.0, 0.0, 1.0])
        self.frame = chain.transform
        self.frame_turn = self.frame.gradient()
        self.reach, self.curl = chain.position_gradient, chain.position_hessian
        self.twist = self.curl.gradient()
        step = grid.problem.desired.step
        self.half = 0.5 * step
        self.wanted = self._sides(grid.desired)
        size = step.sum()
        if relative:
            size = float(self.half @ np.sum(self.wanted**2, axis=(1, 2)))
        self.weight = self.half / (budget**2 * max(size, 1e-300))

    def _force(self, angle: Floats, rate: Floats, acceleration: Floats) -> Floats:
        """Return the specific force in seat axes [g]."""
        products = rate[:, :, None] * rate[:, None, :]
        pull = np.einsum("kjc,kj->kc", self.reach(angle), acceleration)
        pull += np.einsum("kijc,kij->kc", self.curl(angle), products) + self.up
        frame = self.frame(angle)[:, :3, :3]
        return np.asarray(np.einsum("kcs,kc->ks", frame, pull) / STANDARD_GRAVITY_M_S2)

    def _sides(self, x: Floats) -> Floats:
        """Return the force at start and end of each interval, (n - 1, 2, 3)."""
        points = self.grid.points
        rate = self.grid.rates.value(points.gather(x))
        start, end = rate[points.start], rate[points.end]
        acceleration = (end - start) / (2.0 * self.half[:, None])
        return np.stack(
            [
                self._force(x[:-1, :3], start, acceleration),
                self._force(x[1:, :3], end, acceleration),
            ],
            axis=1,
        )

    def value(self, x: Floats) -> float:
        """Return the value of an iterate."""
        return float(self.weight @ np.sum((self._sides(x) - self.wanted) ** 2, axis=(1, 2)))

    def expand(self, x: Floats) -> Expansion:
        """Expand the value; the Hessian is that of Gauss and Newton."""
        points, n = self.grid.points, self.grid.n
        rate, slope = self.grid.rates.expand(points.gather(x))
        ends = (rate[points.start], rate[points.end])
        slopes = (slope[points.start], slope[points.end])
        per_step = 1.0 / (2.0 * self.half)
        acceleration = (ends[1] - ends[0]) * per_step[:, None]
        off = self._sides(x) - self.wanted
        width = x.shape[1]
        gradient, hessian = np.zeros((n, width)), np.zeros((n, width, width))
        across = np.zeros((n - 1, width, width))
        weight = 2.0 * self.weight
        for side, angle in enumerate((x[:-1, :3], x[1:, :3])):
            by_angle, by_rate, by_acceleration = self._derivatives(angle, ends[side], acceleration)
            change = by_acceleration * per_step[:, None, None]
            blocks = [-change @ slopes[0], change @ slopes[1]]
            blocks[side] = blocks[side] + by_rate @ slopes[side]
            blocks[side][:, :, :3] += by_angle
            left, right = blocks
            miss = (weight[:, None] * off[:, side])[:, None, :]
            gradient[:-1] += (miss @ left)[:, 0]
            gradient[1:] += (miss @ right)[:, 0]
            heavy = [np.swapaxes(block * weight[:, None, None], 1, 2) for block in blocks]
            hessian[:-1] += heavy[0] @ left
            hessian[1:] += heavy[1] @ right
            across += heavy[0] @ right
        value = float(self.weight @ np.sum(off**2, axis=(1, 2)))
        return Expansion(value, gradient, hessian, across)

    def _derivatives(
        self, angle: Floats, rate: Floats, acceleration: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return d force / d angle, / d rate and / d acceleration, (k, 3, 3) each [g]."""
        products = rate[:, :, None] * rate[:, None, :]
        frame, turned = self.frame(angle)[:, :3, :3], self.frame_turn(angle)[:, :, :3, :3]
        reach, curl, twist = self.reach(angle), self.curl(angle), self.twist(angle)
        pull = np.einsum("kjc,kj->kc", reach, acceleration)
        pull += np.einsum("kijc,kij->kc", curl, products) + self.up
        moved = np.einsum("kajc,kj->kac", curl, acceleration)
        moved += np.einsum("kaijc,kij->kac", twist, products)
        by_angle = np.einsum("kacs,kc->ksa", turned, pull) + np.einsum("kcs,kac->ksa", frame, moved)
        by_rate = 2.0 * np.einsum("kcs,kijc,kj->ksi", frame, curl, rate, optimize=True)
        by_acceleration = np.einsum("kcs,kjc->ksj", frame, reach)
        return (
            by_angle / STANDARD_GRAVITY_M_S2,
            by_rate / STANDARD_GRAVITY_M_S2,
            by_acceleration / STANDARD_GRAVITY_M_S2,
        )


class AttitudeDeviation(Measure):
    """The largest angle between the seat's attitude and the desired one.

    A maximum is not smooth: the price is on the mean of the eighth power of the
    chord between the attitudes, and what is spent is the largest chord itself.

    Parameters
    ----------
    grid : Transcription
    budget : float
        [deg]
    """

    def __init__(self, grid: Transcription, budget: float) -> None:
        self.grid = grid
        self.frame = grid.problem.chain.transform
        self.turn = self.frame.gradient()
        self.bend = self.turn.gradient()
        self.wanted = self.frame(grid.problem.desired.angle)[:, :3, :3]
        # |R - R_desired|^2 is 8 sin^2(angle / 2)
        self.per_chord = 1.0 / (8.0 * np.sin(0.5 * np.radians(budget)) ** 2)
        self.weight = grid.weight / grid.weight.sum()

    def _chord(self, x: Floats) -> tuple[Floats, Floats]:
        """Return R - R_desired, and its squared norm over that of the budget."""
        off = self.frame(x[:, :3])[:, :3, :3] - self.wanted
        return off, np.sum(off**2, axis=(1, 2)) * self.per_chord

    def spent(self, x: Floats) -> float:
        """Return the largest squared chord over that of the budget."""
        return float(np.max(self._chord(x)[1]))

    def value(self, x: Floats) -> float:
        """Return the value of an iterate."""
        return float(self.weight @ self._chord(x)[1] ** 4)

    def expand(self, x: Floats) -> Expansion:
        """Expand the value with its exact Hessian."""
        n, width = x.shape
        off, chord = self._chord(x)
        turned = self.turn(x[:, :3])[:, :, :3, :3]
        bent = self.bend(x[:, :3])[..., :3, :3]
        slope = 2.0 * self.per_chord * np.einsum("kaij,kij->ka", turned, off)
        square = 2.0 * self.per_chord * np.einsum("kaij,kbij->kab", turned, turned, optimize=True)
        curve = 2.0 * self.per_chord * np.einsum("kabij,kij->kab", bent, off, optimize=True)
        first = 4.0 * self.weight * chord**3
        second = 12.0 * self.weight * chord**2
        gradient = np.zeros((n, width))
        hessian, bend = np.zeros((n, width, width)), np.zeros((n, width, width))
        gradient[:, :3] = first[:, None] * slope
        hessian[:, :3, :3] = (
            second[:, None, None] * slope[:, :, None] * slope[:, None, :]
            + first[:, None, None] * square
        )
        bend[:, :3, :3] = first[:, None, None] * curve
        return Expansion(self.value(x), gradient, hessian, bend=bend)


def measure_of(grid: Transcription, metric: MetricKey, budget: float) -> Measure:
    """Return the measure that belongs to a metric of ``fidelity`` and its budget."""
    gravity = grid.problem.gravity
    match metric:
        case "joint_deviation_relative":
            return JointDeviation(grid, budget)
        case "joint_deviation_relative_squared":
            return JointDeviation(grid, float(np.sqrt(budget)))
        case "mean_square_one_minus_p":
            return FactorDeviation(grid, budget)
        case "seat_rate_deviation_relative":
            return SeatRateDeviation(grid, budget)
        case "seat_g_deviation_relative":
            return SeatGDeviation(grid, budget, gravity, relative=True)
        case "seat_g_rms_error_g":
            return SeatGDeviation(grid, budget, gravity, relative=False)
        case "attitude_error_max_deg":
            return AttitudeDeviation(grid, budget)
    raise ValueError(f"no budget on {metric} with factors on the rates")
