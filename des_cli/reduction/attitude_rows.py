"""A budget on the largest attitude error: a bound at each sample."""

from __future__ import annotations

import numpy as np

from des_cli.kinematics.attitude import rotation
from des_cli.kinematics.chain import Chain
from des_cli.model.arrays import Floats
from des_cli.model.motion import Shortfall
from des_cli.solver.program import Rows


class AttitudeRows(Rows):
    """The squared chord between the seat's attitude and the reference's, over its bound's.

    The chord of an angle a is 2 sin(a / 2), which grows with a and is smooth at zero;
    ``|R - R_reference|^2`` is twice its square.

    Parameters
    ----------
    chain : Chain
    reference : (n, 3) array
        Joint angles whose attitude is kept [rad].
    shortfall : Shortfall or None
        What is asked for beyond that.
    most : float
        Largest angle between the attitudes [deg].
    """

    def __init__(
        self, chain: Chain, reference: Floats, shortfall: Shortfall | None, most: float
    ) -> None:
        super().__init__(np.arange(len(reference)))
        self.frame = chain.transform
        self.turn = self.frame.gradient()
        self.turn_gradient = self.turn.gradient()
        self.target = self.frame(reference)[:, :3, :3]
        if shortfall is not None:
            self.target = self.target @ rotation(shortfall.attitude)
        self.per_chord = 1.0 / (8.0 * np.sin(0.5 * np.radians(most)) ** 2)

    def _off(self, x: Floats) -> Floats:
        return self.frame(x[:, :3])[:, :3, :3] - self.target

    def value(self, x: Floats) -> Floats:
        """Return the squared chord at each sample over its bound, (n, 1)."""
        return np.asarray(self.per_chord * np.sum(self._off(x) ** 2, axis=(1, 2))[:, None])

    def jacobian(self, x: Floats) -> tuple[Floats, ...]:
        """Return the derivative in x_k."""
        turned = self.turn(x[:, :3])[:, :, :3, :3]
        slope = np.zeros((len(x), 1, x.shape[1]))
        slope[:, 0, :3] = 2.0 * self.per_chord * np.einsum("kaij,kij->ka", turned, self._off(x))
        return (slope,)

    def curvature(self, x: Floats, multiplier: Floats) -> Floats:
        """Return the exact curvature."""
        turned = self.turn(x[:, :3])[:, :, :3, :3].reshape(len(x), 3, 9)
        second = self.turn_gradient(x[:, :3])[..., :3, :3].reshape(len(x), 9, 9)
        off = self._off(x).reshape(len(x), 9, 1)
        curvature = np.zeros((len(x), x.shape[1], x.shape[1]))
        curvature[:, :3, :3] = turned @ np.swapaxes(turned, 1, 2)
        curvature[:, :3, :3] += (second @ off).reshape(len(x), 3, 3)
        return np.asarray(2.0 * self.per_chord * multiplier[:, :, None] * curvature)
