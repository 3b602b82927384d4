"""Attitude of a body from its rates, without going through any joint."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.profile import BodyRates


def integrate_attitude(step: Floats, rates: BodyRates) -> Floats:
    """Integrate body rates to attitudes relative to the first one.

    ``R' = R [w]x`` by the fourth-order Magnus expansion on each interval, and a
    parallel prefix product over the intervals.

    Parameters
    ----------
    step : (n - 1,) array
        [s]
    rates : BodyRates

    Returns
    -------
    (n, 3, 3) array
        Body axes at each sample, as columns in the body axes of the first.
    """
    h = step[:, None]
    mean = (rates.start + 4.0 * rates.middle + rates.end) / 6.0
    turn = h * mean + h**2 / 12.0 * np.cross(rates.start, rates.end)
    product = np.concatenate([np.eye(3)[None], rotation(turn)])
    reach = 1
    while reach < len(product):
        product[reach:] = product[:-reach] @ product[reach:]
        reach *= 2
    return product


def rotation(vector: Floats) -> Floats:
    """Return the rotations of rotation vectors (..., 3) [rad], (..., 3, 3) (Rodrigues)."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    cross = np.zeros((*vector.shape[:-1], 3, 3))
    x, y, z = np.moveaxis(vector, -1, 0)
    cross[..., 0, 1], cross[..., 0, 2], cross[..., 1, 2] = -z, y, -x
    cross[..., 1, 0], cross[..., 2, 0], cross[..., 2, 1] = z, -y, x
    half = np.sinc(0.5 * angle / np.pi)  # sin(a/2) / (a/2), finite at zero
    return np.asarray(np.eye(3) + np.sinc(angle / np.pi) * cross + 0.5 * half**2 * cross @ cross)


def rotation_of_quaternion(quaternion: Floats) -> Floats:
    """Return the rotations of quaternions (w, x, y, z), (..., 3, 3); normalised first."""
    w, x, y, z = np.moveaxis(quaternion / np.linalg.norm(quaternion, axis=-1, keepdims=True), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def quaternion_product(one: Floats, other: Floats) -> Floats:
    """Return the quaternions (w, x, y, z) of turns by ``other``, then by ``one``, (..., 4)."""
    w, v = one[..., :1], one[..., 1:]
    u, z = other[..., :1], other[..., 1:]
    scalar = w * u - np.sum(v * z, axis=-1, keepdims=True)
    return np.concatenate([scalar, w * z + u * v + np.cross(v, z)], axis=-1)


def geodesic_angle(one: Floats, other: Floats) -> Floats:
    """Return the angle of the rotation between attitudes (..., 3, 3), (...) [rad].

    From the chord, ``|R1 - R2| = 2 sqrt(2) sin(angle / 2)`` in the Frobenius
    norm: exact for small angles, where the trace formula loses half the digits.
    """
    chord = np.linalg.norm(one - other, axis=(-2, -1)) / (2.0 * np.sqrt(2.0))
    return np.asarray(2.0 * np.arcsin(np.minimum(chord, 1.0)))


def rotation_vector(one: Floats, other: Floats) -> Floats:
    """Return the rotation from one attitude to another, in the axes of the first.

    ``one @ rotation(vector)`` is the other. The unit quaternion is the eigenvector of the
    largest eigenvalue of Bar-Itzhack's matrix (2000), which is regular at every angle, a
    half turn included.

    Parameters
    ----------
    one, other : (..., 3, 3) array

    Returns
    -------
    (..., 3) array
        [rad], no longer than pi.
    """
    turn = np.swapaxes(one, -1, -2) @ other
    matrix = np.zeros((*turn.shape[:-2], 4, 4))
    trace = np.trace(turn, axis1=-2, axis2=-1)
    matrix[..., 0, 0] = trace
    for x, (y, z) in enumerate(((1, 2), (2, 0), (0, 1))):
        axial = turn[..., z, y] - turn[..., y, z]
        matrix[..., 0, 1 + x] = matrix[..., 1 + x, 0] = axial
    matrix[..., 1:, 1:] = turn + np.swapaxes(turn, -1, -2) - trace[..., None, None] * np.eye(3)
    quaternion = np.linalg.eigh(matrix)[1][..., -1]
    quaternion = np.where(quaternion[..., :1] < 0.0, -quaternion, quaternion)
    axis = quaternion[..., 1:]
    sine = np.linalg.norm(axis, axis=-1)
    angle = 2.0 * np.arctan2(sine, quaternion[..., 0])
    return np.asarray(2.0 * axis / np.sinc(0.5 * angle / np.pi)[..., None])
