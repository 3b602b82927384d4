"""The seat's motion by the 4 x 4 transforms of the rows, with their derivatives in time.

With ``T(t)`` the product of all rows, ``T'`` and ``T''`` follow from the product rule
alone: no angular velocity, no joint axis and no frame that turns is named.

    [W x] = R' R^T in the ground,  dW/dt the antisymmetric part of R'' R^T,  f = R^T (p'' + g z0)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, DHRow, Machine, Seat
from des_cli.units import STANDARD_GRAVITY_M_S2


class Motion(NamedTuple):
    """What a seat does, along its axes."""

    rate: Floats
    turning: Floats
    g: Floats
    rotation: Floats


def by_product_rule(
    machine: Machine, seat: Seat, angle: Floats, rate: Floats, acceleration: Floats
) -> Motion:
    """Evaluate one state, of three values each."""
    pose, first, second = np.eye(4), np.zeros((4, 4)), np.zeros((4, 4))
    fixed = {"seat_yaw": seat.yaw, "seat_pitch": seat.pitch}
    for row in machine.rows:
        theta, theta_1, theta_2 = row.offset, 0.0, 0.0
        if row.variable in JOINTS:
            j = JOINTS.index(row.variable)
            theta += row.sign * angle[j]
            theta_1, theta_2 = row.sign * rate[j], row.sign * acceleration[j]
        elif row.variable is not None:
            theta += row.sign * fixed[row.variable]
        link, slope, curve = (_row(row, theta, order) for order in range(3))
        link_1, link_2 = slope * theta_1, curve * theta_1**2 + slope * theta_2
        second = second @ link + 2.0 * first @ link_1 + pose @ link_2
        first = first @ link + pose @ link_1
        pose = pose @ link
    r, r_1, r_2 = pose[:3, :3], first[:3, :3], second[:3, :3]
    force = r.T @ (second[:3, 3] + [0.0, 0.0, machine.gravity]) / STANDARD_GRAVITY_M_S2
    turning = r_2 @ r.T
    return Motion(
        r.T @ _axial(r_1 @ r.T), r.T @ _axial(turning), force * np.array([1.0, 1.0, -1.0]), r
    )


def _row(row: DHRow, theta: float, order: int) -> Floats:
    """Return a row's transform, or its derivative by theta."""
    c, s = np.cos(theta + order * np.pi / 2.0), np.sin(theta + order * np.pi / 2.0)
    one = float(order == 0)
    turn = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, one, 0], [0, 0, 0, one]])
    ca, sa = np.cos(row.alpha), np.sin(row.alpha)
    tilt = np.array([[1, 0, 0, row.a], [0, ca, -sa, 0], [0, sa, ca, 0], [0, 0, 0, 1]])
    raised = np.eye(4)
    raised[2, 3] = row.d
    return np.asarray(tilt @ turn @ raised)


def _axial(matrix: Floats) -> Floats:
    """Return the vector of the antisymmetric part of a matrix."""
    odd = 0.5 * (matrix - matrix.T)
    return np.array([odd[2, 1], odd[0, 2], odd[1, 0]])
