"""The total angular acceleration of the seat, by differences along a motion."""

from __future__ import annotations

import numpy as np

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.orientation import body_jacobian
from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion


def angular_acceleration(motion: Motion) -> Floats:
    """Return dW/dt in seat axes on sides: the derivative of J theta' along the motion."""
    chain, h = chain_of(DES, Seat()), 1e-5
    acceleration = motion.acceleration[:, None, :]

    def spin(s: float) -> Floats:
        angle = motion.angle_sides + s * motion.rate_sides + 0.5 * s**2 * acceleration
        rate = motion.rate_sides + s * acceleration
        return np.asarray((body_jacobian(chain, angle) @ rate[..., None])[..., 0])

    return np.asarray((spin(h) - spin(-h)) / (2.0 * h))
