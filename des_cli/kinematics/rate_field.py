"""The joint rates that make a demanded seat rate: the field that body rates are integrated in."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.kinematics.orientation import (
    SINGULAR_VALUE_THRESHOLD,
    damped_inverse_rates,
)
from des_cli.model.arrays import Flags, Floats
from des_cli.model.machine import Machine

Triple: TypeAlias = tuple[float, float, float]

SURELY_REGULAR = 1.5 * SINGULAR_VALUE_THRESHOLD
"""Determinant above which nothing is damped: the axes are unit vectors, so the two
larger singular values have a product of at most 1.5."""


@dataclass(frozen=True)
class RateField:
    """Joint rates that make a seat rate, damped and inside the rate limits.

    Parameters
    ----------
    chain : Chain
    limit : (3,) array
        [rad/s]
    """

    chain: Chain
    limit: Floats

    @classmethod
    def of(cls, chain: Chain, machine: Machine) -> RateField:
        """Take the rate limits of a machine."""
        return cls(chain, np.array([joint.rate for joint in machine.limits]))

    def rates(self, jacobian: Floats, demand: Floats) -> tuple[Floats, Flags, Floats]:
        """Solve ``J theta' = W`` within the limits, vectorised.

        A joint that would pass its limit is held there, and the others are
        solved for what is left of the demand.

        Returns
        -------
        rates : (..., 3) array
        held : (...) array of bool
            Where anything was damped or held.
        residual : (..., 3) array
            ``W - J theta'`` [rad/s].
        """
        rates, damped, residual = damped_inverse_rates(jacobian, demand)
        at_limit = np.zeros(rates.shape, dtype=bool)
        for _ in range(3):  # each round holds at least one joint more
            over = ~at_limit & (np.abs(rates) > self.limit)
            if not np.any(over):
                break
            at_limit |= over
            fixed = np.where(at_limit, np.clip(rates, -self.limit, self.limit), 0.0)
            left = demand - np.asarray((jacobian @ fixed[..., None])[..., 0])
            movable = np.where(at_limit[..., None, :], 0.0, jacobian)
            rates = fixed + np.where(at_limit, 0.0, damped_inverse_rates(movable, left)[0])
        residual = demand - np.asarray((jacobian @ rates[..., None])[..., 0])
        return rates, damped | np.any(at_limit, axis=-1), residual

    def at(self, fork: float, cab: float, demand: Triple) -> tuple[Triple, float]:
        """Return the rates at one state, and the size of the determinant.

        In plain floats: a step of the integration needs four of these, one after
        the other, and numpy takes ten times as long over three numbers. Only what
        is near the singularity or over a limit goes through `rates`.

        Parameters
        ----------
        fork, cab : float
            [rad]; the body Jacobian does not depend on the arm's angle.
        demand : tuple of three floats
            [rad/s]
        """
        (a, b, c), (d, e, f), (g, h, i) = self._axes(fork, cab)
        x, y, z = demand
        # Cramer's rule: the rows of the adjugate are cross products of the axes.
        u, v, w = e * i - f * h, f * g - d * i, d * h - e * g
        determinant = a * u + b * v + c * w
        size = abs(determinant)
        if size > SURELY_REGULAR:
            arm = (x * u + y * v + z * w) / determinant
            u, v, w = h * c - i * b, i * a - g * c, g * b - h * a
            fork_rate = (x * u + y * v + z * w) / determinant
            u, v, w = b * f - c * e, c * d - a * f, a * e - b * d
            cab_rate = (x * u + y * v + z * w) / determinant
            most = self._limits
            if abs(arm) <= most[0] and abs(fork_rate) <= most[1] and abs(cab_rate) <= most[2]:
                return (arm, fork_rate, cab_rate), size
        jacobian = np.array([[a, d, g], [b, e, h], [c, f, i]])
        arm, fork_rate, cab_rate = self.rates(jacobian, np.array(demand))[0].tolist()
        return (arm, fork_rate, cab_rate), size

    @cached_property
    def _limits(self) -> list[float]:
        return [float(each) for each in self.limit]

    @cached_property
    def _coefficients(self) -> tuple[list[list[float]], list[list[float]], Triple]:
        """Of the axes along seat x, y, z, against products of (1, cos, sin).

        For the arm by (fork, cab), 9 each; for the fork by the cab, 3 each; the cab's
        axis is fixed in the seat.
        """
        k = self.chain.seat_axes.coefficient[0]
        arm = [k[:, :, 0, axis].ravel().tolist() for axis in range(3)]
        fork = [k[0, :, 1, axis].tolist() for axis in range(3)]
        x, y, z = k[0, 0, 2].tolist()
        return arm, fork, (x, y, z)

    def _axes(self, fork: float, cab: float) -> tuple[Triple, Triple, Triple]:
        """Return the axes of arm, fork and cab along x, y, z of the seat."""
        of_arm, of_fork, fixed = self._coefficients
        p, q = math.cos(fork), math.sin(fork)
        r, s = math.cos(cab), math.sin(cab)
        pr, ps, qr, qs = p * r, p * s, q * r, q * s
        k, l, m = of_arm  # noqa: E741
        n, o, t = of_fork
        return (
            (
                k[0] + k[1] * r + k[2] * s + k[3] * p + k[4] * pr + k[5] * ps
                + k[6] * q + k[7] * qr + k[8] * qs,
                l[0] + l[1] * r + l[2] * s + l[3] * p + l[4] * pr + l[5] * ps
                + l[6] * q + l[7] * qr + l[8] * qs,
                m[0] + m[1] * r + m[2] * s + m[3] * p + m[4] * pr + m[5] * ps
                + m[6] * q + m[7] * qr + m[8] * qs,
            ),
            (
                n[0] + n[1] * r + n[2] * s,
                o[0] + o[1] * r + o[2] * s,
                t[0] + t[1] * r + t[2] * s,
            ),
            fixed,
        )  # fmt: skip
