"""The study's equations as printed, for the DES alone.

The solvers use the general chain; these closed forms show a user the study's
own quantities and check the chain independently. ``s1`` is sin(theta1), ``c1``
its cosine, ``sy`` and ``st`` stand for the seat's yaw and pitch. Components are
along the ground axes i0, j0, k0 unless said otherwise.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat


def closed_form_transform(
    lengths: Mapping[str, float], seat: Seat, angles: Floats, *, misprint: bool = False
) -> Floats:
    """Return T_0^17 by (10a)-(10L).

    Parameters
    ----------
    lengths : mapping of str to float
        L2, Lx, Ly, Lz, Lt [m].
    seat : Seat
    angles : (..., 3) array
        [rad]
    misprint : bool
        Take (10h) as printed, with -Lz s1 for its last term instead of -L2 s1.

    Returns
    -------
    (..., 4, 4) array
    """
    (s1, c1), (s2, c2), (s3, c3) = _sines(angles)
    ssy, csy = np.sin(seat.yaw), np.cos(seat.yaw)
    sst, cst = np.sin(seat.pitch), np.cos(seat.pitch)
    l2, lx, ly, lz, lt = (lengths[name] for name in ("L2", "Lx", "Ly", "Lz", "Lt"))

    t11 = (
        s1 * c2 * ssy * cst
        + s1 * s2 * c3 * sst
        - s1 * s2 * s3 * csy * cst
        + c1 * s3 * sst
        + c1 * c3 * csy * cst
    )
    t12 = -s1 * c2 * csy - s1 * s2 * s3 * ssy + c1 * c3 * ssy
    t13 = (
        -s1 * c2 * ssy * sst
        + s1 * s2 * c3 * cst
        + s1 * s2 * s3 * csy * sst
        + c1 * s3 * cst
        - c1 * c3 * csy * sst
    )
    t14 = (
        s1 * c2 * lt * ssy * sst
        - lz * s1 * c2
        - s1 * s2 * c3 * lt * cst
        - s1 * s2 * s3 * lt * csy * sst
        - s1 * s2 * ly * s3
        - c1 * s3 * lt * cst
        + c1 * lx * s3
        + c1 * lt * csy * sst * c3
        + c1 * ly * c3
        + c1 * l2
        + lx * c3 * s1 * s2
    )
    t21 = (
        c1 * c2 * ssy * cst
        + c1 * s2 * c3 * sst
        - c1 * s2 * s3 * csy * cst
        - s1 * s3 * sst
        - s1 * c3 * csy * cst
    )
    t22 = -c1 * c2 * csy - c1 * s2 * s3 * ssy - s1 * c3 * ssy
    t23 = (
        -c1 * c2 * ssy * sst
        + c1 * s2 * c3 * cst
        + c1 * s2 * s3 * csy * sst
        - s1 * s3 * cst
        + s1 * c3 * csy * sst
    )
    t24 = (
        c1 * c2 * lt * ssy * sst
        - c1 * c2 * lz
        - c1 * s2 * c3 * lt * cst
        + c1 * s2 * c3 * lx
        - c1 * s2 * lt * csy * sst * s3
        - c1 * s2 * ly * s3
        + s1 * s3 * lt * cst
        - s1 * lx * s3
        - s1 * lt * sst * c3 * csy
        - ly * s1 * c3
        - (lz if misprint else l2) * s1
    )
    t31 = s2 * ssy * cst - c2 * c3 * sst + c2 * s3 * csy * cst
    t32 = -s2 * csy + c2 * s3 * ssy
    t33 = -s2 * ssy * sst - c2 * c3 * cst - c2 * s3 * csy * sst
    t34 = (
        s2 * lt * ssy * sst
        - s2 * lz
        + c2 * c3 * lt * cst
        - c2 * c3 * lx
        + c2 * s3 * lt * csy * sst
        + c2 * ly * s3
    )
    return _matrix(
        [
            [t11, t12, t13, t14],
            [t21, t22, t23, t24],
            [t31, t32, t33, t34],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def closed_form_ground_jacobian(angles: Floats) -> Floats:
    """Return J_in, whose derivative gives (16)-(18), (..., 3 component, 3 joint)."""
    (s1, c1), (s2, c2), _ = _sines(angles)
    return _matrix([[0.0, c1, -s1 * c2], [0.0, -s1, -c1 * c2], [-1.0, 0.0, -s2]])


def seat_turn(seat: Seat) -> Floats:
    """Return M(seat), the constant rotation with ``J2 = M J_in``, (3, 3)."""
    ssy, csy = np.sin(seat.yaw), np.cos(seat.yaw)
    sst, cst = np.sin(seat.pitch), np.cos(seat.pitch)
    return np.array(
        [
            [-sst, -csy * cst, -ssy * cst],
            [0.0, -ssy, csy],
            [-cst, csy * sst, ssy * sst],
        ]
    )


def report_jacobian(angles: Floats, seat: Seat) -> Floats:
    """Return J2 as (32) prints it.

    It is the ground Jacobian in constant axes that are turned by the seat's
    angles, not the body-axis Jacobian that the study calls it.

    Parameters
    ----------
    angles : (..., 3) array
        [rad]
    seat : Seat

    Returns
    -------
    (..., 3 component, 3 joint) array
    """
    (s1, c1), (s2, c2), _ = _sines(angles)
    ssy, csy = np.sin(seat.yaw), np.cos(seat.yaw)
    sst, cst = np.sin(seat.pitch), np.cos(seat.pitch)
    return _matrix(
        [
            [
                ssy * cst,
                -sst * c1 + csy * cst * s1,
                s1 * c2 * sst + c1 * c2 * csy * cst + s2 * ssy * cst,
            ],
            [-csy, s1 * ssy, c1 * c2 * ssy - csy * s2],
            [
                -ssy * sst,
                -c1 * cst - s1 * csy * sst,
                s1 * c2 * cst - c1 * c2 * csy * sst - s2 * ssy * sst,
            ],
        ]
    )


def closed_form_body_jacobian(angles: Floats, seat: Seat) -> Floats:
    """Return the true body-axis (frame 17) Jacobian, (..., 3 component, 3 joint)."""
    _, (s2, c2), (s3, c3) = _sines(angles)
    ssy, csy = np.sin(seat.yaw), np.cos(seat.yaw)
    sst, cst = np.sin(seat.pitch), np.cos(seat.pitch)
    return _matrix(
        [
            [
                -s2 * ssy * cst - c2 * s3 * csy * cst + c2 * c3 * sst,
                s3 * sst + c3 * csy * cst,
                -ssy * cst,
            ],
            [s2 * csy - c2 * s3 * ssy, c3 * ssy, csy],
            [
                s2 * ssy * sst + c2 * s3 * csy * sst + c2 * c3 * cst,
                s3 * cst - c3 * csy * sst,
                ssy * sst,
            ],
        ]
    )


def closed_form_coriolis(angles: Floats, rates: Floats) -> Floats:
    """Return (AB3, BB3, CB3) by (22)-(24), (..., 3) [rad/s^2]."""
    (s1, c1), (s2, c2), _ = _sines(angles)
    d1, d2, d3 = np.moveaxis(np.asarray(rates), -1, 0)
    ab3 = -d2 * d1 * s1 - d3 * d1 * c1 * c2 + d3 * d2 * s1 * s2
    bb3 = -d2 * d1 * c1 + d3 * d1 * s1 * c2 + d3 * d2 * c1 * s2
    cb3 = -d3 * d2 * c2
    return np.stack([ab3, bb3, cb3], axis=-1)


def closed_form_angular_acceleration(
    angles: Floats, rates: Floats, accelerations: Floats
) -> Floats:
    """Return (A3, B3, C3) by (16)-(18), (..., 3) [rad/s^2]."""
    (s1, c1), (s2, c2), _ = _sines(angles)
    a1, a2, a3 = np.moveaxis(np.asarray(accelerations), -1, 0)
    noncoriolis = [a2 * c1 - a3 * s1 * c2, -a2 * s1 - a3 * c1 * c2, -a1 - a3 * s2]
    return np.stack(noncoriolis, axis=-1) + closed_form_coriolis(angles, rates)


def _sines(angles: Floats) -> list[tuple[Floats, Floats]]:
    """Sine and cosine of each joint angle."""
    angles = np.asarray(angles)
    return [(np.sin(angles[..., joint]), np.cos(angles[..., joint])) for joint in range(3)]


def _matrix(rows: list[list[Floats | float]]) -> Floats:
    """Stack elements, each a number or an array over samples, into matrices."""
    elements = np.broadcast_arrays(*(element for row in rows for element in row))
    stacked = np.stack(elements, axis=-1)
    return stacked.reshape((*stacked.shape[:-1], len(rows), len(rows[0])))
