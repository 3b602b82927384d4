"""What a profile asks of the seat, where its joint motion does not make all of it."""

from __future__ import annotations

from dataclasses import replace
from itertools import accumulate

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.motion import Shortfall
from des_cli.model.profile import BodyRates, Command, GCommand
from des_cli.verify.felt import Felt
from des_cli.verify.rotations import exponential


def as_requested(felt: Felt, command: Command | None, missing: Shortfall | None) -> Felt:
    """Return what is felt of a joint motion with what was asked for beyond it.

    Recorded rates and a requested G are taken from the profile itself, whatever became of them.

    Parameters
    ----------
    felt : Felt
        Of the joint motion that the profile asks for, at the states of `SeatChain.along`.
    command : Command, optional
        Of the profile; without it the shortfall tells all.
    missing : Shortfall or None
    """
    if missing is None:
        return felt
    turning = felt.turning + _states(missing.seat_angular_acceleration)
    rate = felt.rate + _states(missing.seat_rate)
    g = felt.g + _states(missing.seat_g)
    if isinstance(command, BodyRates):
        rate = np.concatenate([command.start, command.end]).T
    if isinstance(command, GCommand):
        g = np.concatenate([command.start, command.end]).T
    attitudes = replace(felt.attitudes, turn=missing.attitude)
    return replace(felt, rate=rate, turning=turning, g=g, attitudes=attitudes)


def _states(sides: Floats) -> Floats:
    """Return values on sides at the starts of all intervals, then at their ends, (3, m)."""
    return np.concatenate([sides[:, 0], sides[:, 1]]).T


def turned(step: Floats, rates: BodyRates) -> Floats:
    """Return the attitudes of recorded rates relative to the first, (3, 3, n), one by one.

    What an interval turns by is its fourth-order Magnus expansion: that defines the attitude
    between two rows, where the rate is a parabola.
    """
    h = step[:, None]
    mean = (rates.start + 4.0 * rates.middle + rates.end) / 6.0
    turns = exponential(h * mean + h**2 / 12.0 * np.cross(rates.start, rates.end))
    product = accumulate(np.moveaxis(turns, 2, 0), np.matmul, initial=np.eye(3))
    return np.stack(list(product), axis=-1)
