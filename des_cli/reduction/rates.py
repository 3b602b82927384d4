"""The adapted joint rates ``theta' = u * phi`` and their derivatives.

phi = J^-1 W is taken either on the desired motion, where it is Theta' (the
study's simplification), or on the adapted one, where it follows the angles.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.model.arrays import Floats

DAMPING_BELOW = 0.4
"""|det J| below which the adapted inverse is damped: on the DES, 24 degrees from the
singularity. Nearer to it phi changes with the angles by more than 1 / 0.3 in each
second, and an optimum would be a matter of that and not of the Coriolis."""

DAMPING = 0.3
"""Damping factor on the singularity itself: the gain of the inverse is then at most 1 / 0.6."""

COMPLEX_STEP = 1e-30
"""Step [rad] of the derivative Im f(x + ih) / h (Squire and Trapp, SIAM Review 40, 1998): no
difference is taken, so that it may be as small as squares of it still are numbers."""


class Rates(Protocol):
    """Joint rates at the points of a transcription, as functions of an iterate there."""

    def value(self, x: Floats) -> Floats:
        """Return theta', (q, 3) [rad/s], of the iterate at the points, (q, 3 + m)."""

    def expand(self, x: Floats) -> tuple[Floats, Floats]:
        """Return theta' and d theta' / d x, (q, 3, 3 + m)."""

    def curvature(self, x: Floats, multiplier: Floats) -> Floats | None:
        """Return sum_j multiplier_j d2 theta_j' / dx dx, (q, 3 + m, 3 + m), or None if zero."""


class DesiredRates:
    """``theta' = u * Theta'``: linear in the factors.

    Parameters
    ----------
    rate : (q, 3) array
        Theta' at the points.
    joint : (3, m) array
        Which factor moves which joint.
    """

    def __init__(self, rate: Floats, joint: Floats) -> None:
        self.rate, self.joint = rate, joint
        free = np.zeros((len(rate), 3, 3))
        self._jacobian = np.concatenate([free, rate[:, :, None] * joint], axis=2)

    def value(self, x: Floats) -> Floats:
        """Return theta' at the points."""
        return np.asarray(self.rate * (x[:, 3:] @ self.joint.T))

    def expand(self, x: Floats) -> tuple[Floats, Floats]:
        """Return theta' and its constant Jacobian."""
        return self.value(x), self._jacobian

    def curvature(self, x: Floats, multiplier: Floats) -> None:
        """Return None: the rates are linear."""
        return None


class AdaptedRates:
    """``theta' = u * phi(theta)`` with ``phi = Theta' + J# (W - J Theta')`` on the adapted angles.

    ``J# = (J'J + l^2)^-1 J'`` with l = 0 while |det J| is large; seeking phi
    about Theta' makes the desired motion itself free of any damping.

    Parameters
    ----------
    chain : Chain
    angle, rate : (q, 3) array
        Theta and Theta' at the points.
    joint : (3, m) array
    """

    def __init__(self, chain: Chain, angle: Floats, rate: Floats, joint: Floats) -> None:
        self.chain, self.rate, self.joint = chain, rate, joint
        self.demand = _times(chain.ground_axes(angle).swapaxes(-1, -2), rate)

    def value(self, x: Floats) -> Floats:
        """Return theta' at the points."""
        return np.asarray(self._phi(x[:, :3])[0] * (x[:, 3:] @ self.joint.T))

    def expand(self, x: Floats) -> tuple[Floats, Floats]:
        """Return theta' and its Jacobian."""
        phi, slope = self._phi(x[:, :3])
        factor = x[:, 3:] @ self.joint.T
        jacobian = np.concatenate(
            [factor[:, :, None] * slope, phi[:, :, None] * self.joint], axis=2
        )
        return np.asarray(factor * phi), jacobian

    def curvature(self, x: Floats, multiplier: Floats) -> Floats:
        """Return the second derivatives of the rates times multipliers, (q, 3 + m, 3 + m)."""
        _, slope = self._phi(x[:, :3])
        factor = x[:, 3:] @ self.joint.T
        m = self.joint.shape[1]
        curvature = np.zeros((len(x), 3 + m, 3 + m))
        for a in range(3):
            turned = x[:, :3].astype(complex)
            turned[:, a] += 1j * COMPLEX_STEP
            second = self._phi(turned)[1].imag / COMPLEX_STEP
            curvature[:, a, :3] = np.einsum("kj,kj,kjb->kb", multiplier, factor, second)
        curvature[:, :3, 3:] = np.einsum("kj,kja,jm->kam", multiplier, slope, self.joint)
        curvature[:, 3:, :3] = curvature[:, :3, 3:].swapaxes(1, 2)
        return curvature

    def _phi(self, angle: Floats) -> tuple[Floats, Floats]:
        """Return phi and d phi_j / d theta_a, (q, 3, 3)."""
        axes = self.chain.ground_axes(angle)
        jacobian = axes.swapaxes(-1, -2)
        turn = self.chain.ground_axes.gradient()(angle)  # d w_k / d theta_a: (q, a, k, component)
        damping, slope = _damping(axes, turn)
        matrix = axes @ jacobian + damping[:, None, None] * np.eye(3)
        more = np.linalg.solve(
            matrix, _times(axes, self.demand - _times(jacobian, self.rate))[..., None]
        )[..., 0]
        phi = self.rate + more
        missing = self.demand - _times(jacobian, phi)
        # d(J'J + l^2) more + (J'J + l^2) d more = dJ' (W - J Theta') - J' dJ Theta'
        force = (
            np.einsum("kajc,kc->kja", turn, missing)
            - np.einsum("kjc,kaic,ki->kja", axes, turn, phi)
            - more[:, :, None] * slope[:, None, :]
        )
        return phi, np.linalg.solve(matrix, force)


def _damping(axes: Floats, turn: Floats) -> tuple[Floats, Floats]:
    """Return l^2 = DAMPING^2 (1 - (det / DAMPING_BELOW)^2)^2 and its gradient; else zero."""
    one, two, three = axes[:, 0], axes[:, 1], axes[:, 2]
    determinant = np.sum(one * np.cross(two, three), axis=1)
    slope = (
        np.sum(turn[:, :, 0] * np.cross(two, three)[:, None], axis=2)
        + np.sum(turn[:, :, 1] * np.cross(three, one)[:, None], axis=2)
        + np.sum(turn[:, :, 2] * np.cross(one, two)[:, None], axis=2)
    )
    inside = np.abs(determinant.real) < DAMPING_BELOW
    depth = np.where(inside, 1.0 - (determinant / DAMPING_BELOW) ** 2, 0.0)
    steep = -4.0 * DAMPING**2 * depth * determinant / DAMPING_BELOW**2
    return DAMPING**2 * depth**2, steep[:, None] * slope


def _times(matrix: Floats, vector: Floats) -> Floats:
    return np.asarray((matrix @ vector[..., None])[..., 0])
