"""Rates beside a requested G: which of them fork and cab can follow, and for how long.

The same two joints make the direction of G, and roll and pitch rate. The classical answer
of motion cueing (Nahon and Reid 1990) is a washout: with w0 the seat's rate while only the
direction of G is followed and w the recorded one, the seat is to turn with ::

    w0 + H w,    H(s) = s^2 / (s + 1/T)^2                                           (G3)

so that it is turned, beside the direction of G, by the small rotation d with ::

    d'' + (2/T) d' + d/T^2 = w'                                                     (G4)

What is faster than the washout time T is felt as it was recorded, and what is slower gives
way to the direction of G. H is of second order: a steady rate, as the pitch rate of a long
turn, then leaves no tilt behind. The requested G is seen along axes that are turned by d.
"""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats


def washed_rotation(step: Floats, rates: Floats, washout: float) -> Floats:
    """Return the rotation d of (G4) at samples, (n, m) [rad].

    Parameters
    ----------
    step : (n - 1,) array
        [s]
    rates : (n - 1, 2, m) array
        w at both ends of every interval, linear between [rad/s].
    washout : float
        T [s].

    Notes
    -----
    As two filters of first order, ``a' = u - a/T``, ``b' = a - b/T`` and ``d = a - b/T``,
    each exact for what is linear over an interval; a is not, and its chord leaves an error
    of the second order in the step. They start where a steady u leaves them: d is zero.
    """
    pole = 1.0 / washout
    x = pole * step
    decay = np.exp(-x)
    # int_0^h exp(-pole (h - s)) ds, and the same of s/h
    whole = -np.expm1(-x) / pole
    ramp = np.where(x > 1e-4, (step - whole) / np.maximum(x, 1e-300), step * (0.5 - x / 6.0))
    rotation = np.zeros((len(step) + 1, rates.shape[2]))
    slow = washout * rates[0, 0]
    slower = washout * slow
    for k, (u0, u1) in enumerate(rates):
        after = decay[k] * slow + whole[k] * u0 + ramp[k] * (u1 - u0)
        slower = decay[k] * slower + whole[k] * slow + ramp[k] * (after - slow)
        slow = after
        rotation[k + 1] = slow - pole * slower
    return rotation


def seen_turned(rotation: Floats, vectors: Floats) -> Floats:
    """Return the components of vectors along axes that are turned by rotations, (n, 3).

    Parameters
    ----------
    rotation : (n, 3) array
        Rotation vectors [rad].
    vectors : (n, 3) array
    """
    angle = np.linalg.norm(rotation, axis=1, keepdims=True)
    axis = rotation / np.maximum(angle, 1e-300)
    along = axis * np.sum(axis * vectors, axis=1, keepdims=True)
    # Rodrigues' formula by the opposite angle: the axes turn, not the vector
    across = np.cross(axis, vectors)
    return np.asarray(along + np.cos(angle) * (vectors - along) - np.sin(angle) * across)
