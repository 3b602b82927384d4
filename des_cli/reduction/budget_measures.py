"""Measures of fidelity that a budget can be set on, with their derivatives.

Each is the square of a metric over the square of its budget, so that the budget
is one and the square is smooth where the metric itself has a kink. They compare
with the motion that the profile asks for, ``Problem.reference``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_DEVIATION,
    ANGULAR_ACCELERATION_ERROR,
    ANGULAR_ACCELERATION_RMS_RATIO,
    FACTOR_DEVIATION,
    JOINT_DEVIATION,
    JOINT_DEVIATION_SQUARED,
    SEAT_G_DEVIATION,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
    MetricKey,
)
from des_cli.reduction.felt_budget_measures import (
    SeatAccelerationDeviation,
    SeatAccelerationSize,
    SeatGDeviation,
)
from des_cli.reduction.points import Points
from des_cli.reduction.transcription import Transcription
from des_cli.solver.program import Expansion, Measure


class JointDeviation(Measure):
    """||theta - Theta|| / ||Theta||, squared.

    Parameters
    ----------
    grid : Transcription
    budget : float
        Largest ratio of the norms [1].
    """

    def __init__(self, grid: Transcription, budget: float) -> None:
        self.target = grid.problem.reference.angle
        size = float(grid.weight @ np.sum(self.target**2, axis=1))
        self.weight = grid.weight / (budget**2 * max(size, 1e-300))

    def value(self, x: Floats) -> float:
        """Return the value of an iterate."""
        return float(self.weight @ np.sum((x[:, :3] - self.target) ** 2, axis=1))

    def expand(self, x: Floats) -> Expansion:
        """Expand the value; it is quadratic."""
        n, width = x.shape
        gradient, hessian = np.zeros((n, width)), np.zeros((n, width, width))
        gradient[:, :3] = 2.0 * self.weight[:, None] * (x[:, :3] - self.target)
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
    """||W - W_reference|| / ||W_reference|| in seat axes, squared.

    Parameters
    ----------
    grid : Transcription
    budget : float
        Largest ratio of the norms [1].
    """

    def __init__(self, grid: Transcription, budget: float) -> None:
        self.grid = grid
        axes = grid.problem.chain.seat_axes
        self.axes, self.turn, self.turn_gradient = axes, axes.gradient(), axes.gradient().gradient()
        reference = grid.problem.reference
        rate, angle = reference.rate_sides, reference.angle_sides
        sides = (rate[..., None, :] @ axes(angle))[..., 0, :]
        if grid.problem.shortfall is not None:
            sides = sides + grid.problem.shortfall.seat_rate
        half = 0.5 * reference.step
        size = float(half @ np.sum(sides**2, axis=(1, 2)))
        scale = 1.0 / (budget**2 * max(size, 1e-300))
        self.weight = grid.points.weight * scale
        self.target, spread = mean_at_points(grid.points, half, sides)
        self.floor = spread * scale

    def _spin(self, x: Floats) -> Floats:
        state = self.grid.points.gather(x)
        rate = self.grid.rates.value(state)
        return np.asarray((rate[:, None, :] @ self.axes(state[:, :3]))[:, 0])

    def value(self, x: Floats) -> float:
        """Return the value of an iterate."""
        return self._value(self._spin(x) - self.target)

    def _value(self, off: Floats) -> float:
        return self.floor + float(self.weight @ np.sum(off**2, axis=1))

    def expand(self, x: Floats) -> Expansion:
        """Expand the value with its exact Hessian."""
        grid, state = self.grid, self.grid.points.gather(x)
        rate, slope = grid.rates.expand(state)
        axes, turn, second = (
            form(state[:, :3]) for form in (self.axes, self.turn, self.turn_gradient)
        )
        jacobian = np.swapaxes(axes, 1, 2) @ slope
        jacobian[:, :, :3] += np.swapaxes((rate[:, None, None, :] @ turn)[:, :, 0], 1, 2)
        off = self._spin(x) - self.target
        curvature = np.zeros((len(state), state.shape[1], state.shape[1]))
        cross = (turn @ off[:, None, :, None])[..., 0] @ slope  # (q, angle, 3 + m)
        curvature[:, :3, :] += cross
        curvature[:, :, :3] += np.swapaxes(cross, 1, 2)
        curvature[:, :3, :3] += np.einsum("kabjc,kj,kc->kab", second, rate, off, optimize=True)
        through_rates = grid.rates.curvature(state, (axes @ off[:, :, None])[:, :, 0])
        if through_rates is not None:
            curvature += through_rates
        scale = 2.0 * self.weight
        return Expansion(
            self._value(off),
            grid.points.scatter(scale[:, None] * (off[:, None, :] @ jacobian)[:, 0], grid.n),
            grid.points.scatter(
                scale[:, None, None] * (np.swapaxes(jacobian, 1, 2) @ jacobian), grid.n
            ),
            curvature=grid.points.scatter(scale[:, None, None] * curvature, grid.n),
        )


def mean_at_points(points: Points, half: Floats, sides: Floats) -> tuple[Floats, float]:
    """Return what values on the sides of intervals are at points, and what is lost by that.

    Where the reference steps and the iterate cannot, its two sides meet at one point:
    the squared distances to both are that to their mean, and a constant.

    Parameters
    ----------
    points : Points
    half : (n - 1,) array
        Half of each interval [s]: the weight of each of its sides.
    sides : (n - 1, 2, 3) array

    Returns
    -------
    mean : (q, 3) array
    spread : float
        Integral of the squared distance of the sides from the mean [their unit squared, s].
    """
    where = np.concatenate([points.start, points.end])
    heavy = np.concatenate([half, half])
    values = np.concatenate([sides[:, 0], sides[:, 1]])
    count = len(points.node)
    total = np.stack([np.bincount(where, heavy * v, count) for v in values.T], axis=1)
    mean = total / points.weight[:, None]
    spread = float(heavy @ np.sum((values - mean[where]) ** 2, axis=1))
    return mean, spread


def measure_of(grid: Transcription, metric: MetricKey, budget: float) -> Measure:
    """Return the measure that belongs to a metric of ``fidelity`` and its budget.

    Those that are a largest value over time are none: they bound each sample by itself, as
    ``AttitudeRows`` and ``SeatAccelerationRows``.
    """
    make = _MEASURES.get(metric)
    if make is None:
        raise ValueError(f"{metric} is no integral over the motion")
    return make(grid, budget)


_MEASURES: Mapping[MetricKey, Callable[[Transcription, float], Measure]] = MappingProxyType(
    {
        JOINT_DEVIATION: JointDeviation,
        JOINT_DEVIATION_SQUARED: lambda grid, most: JointDeviation(grid, float(np.sqrt(most))),
        FACTOR_DEVIATION: FactorDeviation,
        SEAT_RATE_DEVIATION: SeatRateDeviation,
        SEAT_G_DEVIATION: partial(SeatGDeviation, relative=True),
        SEAT_G_ERROR: partial(SeatGDeviation, relative=False),
        ANGULAR_ACCELERATION_DEVIATION: partial(SeatAccelerationDeviation, relative=True),
        ANGULAR_ACCELERATION_ERROR: partial(SeatAccelerationDeviation, relative=False),
        ANGULAR_ACCELERATION_RMS_RATIO: SeatAccelerationSize,
    }
)
