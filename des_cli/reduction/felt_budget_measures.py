"""Measures of what the seat feels through the accelerations of the joints.

They couple neighbours in time: an acceleration belongs to an interval.
"""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from des_cli.kinematics.coriolis import coriolis, coriolis_derivatives
from des_cli.kinematics.seat import PILOT_SIGNS
from des_cli.model.arrays import Floats
from des_cli.model.metric import UNFELT_ANGULAR_ACCELERATION
from des_cli.model.motion import Shortfall
from des_cli.reduction.transcription import Transcription
from des_cli.solver.program import Expansion, Measure, Rows
from des_cli.units import STANDARD_GRAVITY_M_S2


class IntervalDeviation(Measure):
    """int |v - v_reference|^2 of a vector v(theta, theta', theta''), over its budget squared.

    Parameters
    ----------
    grid : Transcription
    budget : float
        For the root mean square, in the vector's unit, or relative to ||v_reference|| [1].
    relative : bool
    """

    def __init__(self, grid: Transcription, budget: float, *, relative: bool) -> None:
        self.grid = grid
        self.prepare()
        reference = grid.problem.reference
        self.half = 0.5 * reference.step
        self.target = self._on_sides(
            reference.angle, reference.rate_start, reference.rate_end, reference.acceleration
        )
        if grid.problem.shortfall is not None:
            self.target = self.target + self.missing(grid.problem.shortfall)
        size = float(reference.step.sum())
        if relative:
            size = float(self.half @ np.sum(self.target**2, axis=(1, 2)))
        self.weight = self.half / (budget**2 * max(size, 1e-300))

    @abstractmethod
    def prepare(self) -> None:
        """Take from the grid's problem what the vector needs."""

    @abstractmethod
    def missing(self, shortfall: Shortfall) -> Floats:
        """Return what is asked for beyond the reference, (n - 1, 2, 3)."""

    @abstractmethod
    def vector(self, angle: Floats, rate: Floats, acceleration: Floats) -> Floats:
        """Return the vector, (k, 3), of joint states, (k, 3) each."""

    @abstractmethod
    def derivatives(
        self, angle: Floats, rate: Floats, acceleration: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return d vector / d angle, / d rate and / d acceleration, (k, 3, 3) each."""

    def value(self, x: Floats) -> float:
        """Return the value of an iterate."""
        return float(self.weight @ np.sum(self.off(x) ** 2, axis=(1, 2)))

    def _on_sides(self, angle: Floats, start: Floats, end: Floats, acceleration: Floats) -> Floats:
        """Return the vector at start and end of each interval, (n - 1, 2, 3)."""
        return np.stack(
            [
                self.vector(angle[:-1], start, acceleration),
                self.vector(angle[1:], end, acceleration),
            ],
            axis=1,
        )

    def off(self, x: Floats) -> Floats:
        """Return the vector less its target at both ends of each interval, (n - 1, 2, 3)."""
        points = self.grid.points
        rate = self.grid.rates.value(points.gather(x))
        start, end = rate[points.start], rate[points.end]
        acceleration = (end - start) / (2.0 * self.half[:, None])
        return self._on_sides(x[:, :3], start, end, acceleration) - self.target

    def slopes(self, x: Floats) -> list[list[Floats]]:
        """Return at start and end of each interval the derivatives in x_k and x_{k+1}."""
        points = self.grid.points
        rate, slope = self.grid.rates.expand(points.gather(x))
        ends = (rate[points.start], rate[points.end])
        slopes = (slope[points.start], slope[points.end])
        per_step = 1.0 / (2.0 * self.half)
        acceleration = (ends[1] - ends[0]) * per_step[:, None]
        found = []
        for side, angle in enumerate((x[:-1, :3], x[1:, :3])):
            by_angle, by_rate, by_acceleration = self.derivatives(angle, ends[side], acceleration)
            change = by_acceleration * per_step[:, None, None]
            blocks = [-change @ slopes[0], change @ slopes[1]]
            blocks[side] = blocks[side] + by_rate @ slopes[side]
            blocks[side][:, :, :3] += by_angle
            found.append(blocks)
        return found

    def expand(self, x: Floats) -> Expansion:
        """Expand the value; the Hessian is that of Gauss and Newton."""
        n, width = self.grid.n, x.shape[1]
        off = self.off(x)
        gradient, hessian = np.zeros((n, width)), np.zeros((n, width, width))
        across = np.zeros((n - 1, width, width))
        weight = 2.0 * self.weight
        for side, (left, right) in enumerate(self.slopes(x)):
            miss = (weight[:, None] * off[:, side])[:, None, :]
            gradient[:-1] += (miss @ left)[:, 0]
            gradient[1:] += (miss @ right)[:, 0]
            heavy = [np.swapaxes(b * weight[:, None, None], 1, 2) for b in (left, right)]
            hessian[:-1] += heavy[0] @ left
            hessian[1:] += heavy[1] @ right
            across += heavy[0] @ right
        value = float(self.weight @ np.sum(off**2, axis=(1, 2)))
        return Expansion(value, gradient, hessian, across)


class SeatGDeviation(IntervalDeviation):
    """||G - G_reference||, the specific force in seat axes [g]."""

    def prepare(self) -> None:
        """Take the chain's forms, and gravity."""
        chain = self.grid.problem.chain
        self.up = self.grid.problem.gravity * np.array([0.0, 0.0, 1.0])
        self.frame = chain.transform
        self.frame_turn = self.frame.gradient()
        self.reach, self.curl = chain.position_gradient, chain.position_hessian
        self.twist = self.curl.gradient()

    def missing(self, shortfall: Shortfall) -> Floats:
        """Return the specific force that is asked for and not made [g]."""
        return np.asarray(shortfall.seat_g * PILOT_SIGNS)

    def vector(self, angle: Floats, rate: Floats, acceleration: Floats) -> Floats:
        """Return the specific force [g]."""
        products = rate[:, :, None] * rate[:, None, :]
        force = np.einsum("kjc,kj->kc", self.reach(angle), acceleration)
        force += np.einsum("kijc,kij->kc", self.curl(angle), products) + self.up
        frame = self.frame(angle)[:, :3, :3]
        return np.asarray(np.einsum("kcs,kc->ks", frame, force) / STANDARD_GRAVITY_M_S2)

    def derivatives(
        self, angle: Floats, rate: Floats, acceleration: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return d force / d angle, / d rate and / d acceleration, (k, 3, 3) each [g]."""
        products = rate[:, :, None] * rate[:, None, :]
        frame, turned = self.frame(angle)[:, :3, :3], self.frame_turn(angle)[:, :, :3, :3]
        reach, curl, twist = self.reach(angle), self.curl(angle), self.twist(angle)
        force = np.einsum("kjc,kj->kc", reach, acceleration)
        force += np.einsum("kijc,kij->kc", curl, products) + self.up
        moved = np.einsum("kajc,kj->kac", curl, acceleration)
        moved += np.einsum("kaijc,kij->kac", twist, products)
        by_angle = np.einsum("kacs,kc->ksa", turned, force) + np.einsum(
            "kcs,kac->ksa", frame, moved
        )
        by_rate = 2.0 * np.einsum("kcs,kijc,kj->ksi", frame, curl, rate, optimize=True)
        by_acceleration = np.einsum("kcs,kjc->ksj", frame, reach)
        return (
            by_angle / STANDARD_GRAVITY_M_S2,
            by_rate / STANDARD_GRAVITY_M_S2,
            by_acceleration / STANDARD_GRAVITY_M_S2,
        )


class SeatAccelerationDeviation(IntervalDeviation):
    """||dW/dt - (dW/dt)_reference||, the total angular acceleration in seat axes [rad/s^2]."""

    def prepare(self) -> None:
        """Take the joints' axes."""
        self.axes = self.grid.problem.chain.seat_axes
        self.turn = self.axes.gradient()

    def missing(self, shortfall: Shortfall) -> Floats:
        """Return the angular acceleration that is asked for and not made [rad/s^2]."""
        return shortfall.seat_angular_acceleration

    def vector(self, angle: Floats, rate: Floats, acceleration: Floats) -> Floats:
        """Return the sum of the Euler terms and the Coriolis vector."""
        euler = (acceleration[:, None, :] @ self.axes(angle))[:, 0]
        return np.asarray(euler + coriolis(self.grid.problem.chain, angle, rate, "seat"))

    def derivatives(
        self, angle: Floats, rate: Floats, acceleration: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return d vector / d angle, / d rate and / d acceleration, (k, 3, 3) each."""
        _, by_angle, by_rate = coriolis_derivatives(self.grid.problem.chain, angle, rate, "seat")
        turned = (acceleration[:, None, None, :] @ self.turn(angle))[:, :, 0]  # (k, angle, axis)
        return by_angle + np.swapaxes(turned, 1, 2), by_rate, np.swapaxes(self.axes(angle), 1, 2)


class SeatAccelerationSize(SeatAccelerationDeviation):
    """||dW/dt|| over ||(dW/dt)_reference||, squared: how much more the seat is turned at all."""

    def __init__(self, grid: Transcription, budget: float) -> None:
        super().__init__(grid, budget, relative=True)
        self.target = np.zeros_like(self.target)
        least = UNFELT_ANGULAR_ACCELERATION**2 * float(2.0 * np.sum(self.half))
        self.weight = np.minimum(self.weight, self.half / (budget**2 * least))


class SeatAccelerationRows(Rows):
    """|dW/dt|^2 at both ends of every interval over the largest of the reference's, squared.

    Parameters
    ----------
    grid : Transcription
    most : float
        Largest ratio of the peaks [1].
    """

    def __init__(self, grid: Transcription, most: float) -> None:
        super().__init__(np.arange(grid.n - 1))
        self.vectors = SeatAccelerationSize(grid, 1.0)
        reference = SeatAccelerationDeviation(grid, 1.0, relative=False).target
        peak = float(np.max(np.sum(reference**2, axis=2)))
        self.scale = 1.0 / (most**2 * max(peak, UNFELT_ANGULAR_ACCELERATION**2))

    def value(self, x: Floats) -> Floats:
        """Return the squares over their bound, (n - 1, 2)."""
        return np.asarray(self.scale * np.sum(self.vectors.off(x) ** 2, axis=2))

    def jacobian(self, x: Floats) -> tuple[Floats, ...]:
        """Return the derivatives in x_k and x_{k+1}."""
        slopes = self.vectors.slopes(x)
        along = 2.0 * self.scale * self.vectors.off(x)
        blocks = [
            [along[:, side, None, :] @ slopes[side][ahead] for side in (0, 1)] for ahead in (0, 1)
        ]
        return tuple(np.concatenate(sides, axis=1) for sides in blocks)
