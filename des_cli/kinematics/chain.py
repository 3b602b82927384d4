"""The Denavit-Hartenberg chain of a machine: T_0^17, joint axes, J1 and the 6x3 J.

The rows of the table collapse into four constant transforms around the three
joint rotations::

    T_0^17 = C0 Rot_z(s1 theta1) C1 Rot_z(s2 theta2) C2 Rot_z(s3 theta3) C3      (9)

with the joint signs s = +1 or -1. Ground frame: z0 up, the arm along +x0 at
theta = 0. Seat frame (17): x forward, y right, z down. The joint axes w_k carry
their joint's sign, so that the angular velocity is ``W = sum_k w_k theta_k'``.
Lengths are in metres, angles in radians; angles have the shape ``(..., 3)``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Literal, TypeAlias

import numpy as np

from des_cli.kinematics.trig_polynomial import TrigPolynomial
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, DHRow, Machine, Seat

Frame: TypeAlias = Literal["ground", "seat"]

_QUARTER_TURN_TOLERANCE = 1e-15
"""In quarter turns: how near to a multiple an angle counts as one. Double
rounding of k pi/2 stays below it, so zeros of the machine are exact zeros."""


@dataclass(frozen=True, eq=False)
class Chain:
    """A machine's chain with the seat in place; made by ``chain_of``.

    Parameters
    ----------
    constants : tuple of four (4, 4) arrays
        C0, C1, C2, C3, read-only [m].
    signs : tuple of int
        +1 or -1 for arm, fork, cab.
    """

    constants: tuple[Floats, Floats, Floats, Floats]
    signs: tuple[int, int, int]

    @cached_property
    def transform(self) -> TrigPolynomial:
        """T_0^17, value (4, 4)."""
        return TrigPolynomial(self._product(3))

    @cached_property
    def position(self) -> TrigPolynomial:
        """Origin of frame 17 in the ground frame, value (3,) [m]."""
        return TrigPolynomial(self.transform.coefficient[..., :3, 3])

    @cached_property
    def position_gradient(self) -> TrigPolynomial:
        """Partial derivatives of the position, value (3 joint, 3 component) [m/rad]."""
        return self.position.gradient()

    @cached_property
    def position_hessian(self) -> TrigPolynomial:
        """Second partials of the position, value (3 joint, 3 joint, 3 component)."""
        return self.position_gradient.gradient()

    @cached_property
    def ground_axes(self) -> TrigPolynomial:
        """Signed joint axes in the ground frame, value (3 joint, 3 component)."""
        frames = [self._product(joint) for joint in range(3)]
        axes = [s * frame[..., :3, 2] for s, frame in zip(self.signs, frames, strict=True)]
        return TrigPolynomial(np.stack(axes, axis=3))

    @cached_property
    def seat_axes(self) -> TrigPolynomial:
        """Signed joint axes in frame 17, value (3 joint, 3 component)."""
        # As a row vector, w_k is z C_k Rz_k+1 C_k+1 ... C3: its own joint and
        # those before it do not move it.
        axes = []
        for joint, sign in enumerate(self.signs):
            row = np.zeros((3, 3, 3, 1, 3))
            row[0, 0, 0] = sign * self.constants[joint + 1][2, :3]
            for outer in range(joint + 1, 3):
                row = _append(row, outer, self._step(outer)[:, :3, :3])
            axes.append(row[..., 0, :])
        return TrigPolynomial(np.stack(axes, axis=3))

    @cached_property
    def joint_origins(self) -> TrigPolynomial:
        """A point on each joint axis in the ground frame, value (3 joint, 3) [m]."""
        return TrigPolynomial(
            np.stack([self._product(joint)[..., :3, 3] for joint in range(3)], axis=3)
        )

    def _product(self, joints: int) -> Floats:
        """Coefficients of ``C0 Rz1 C1 ... Rz_joints C_joints``, (3, 3, 3, 4, 4)."""
        product = np.zeros((3, 3, 3, 4, 4))
        product[0, 0, 0] = self.constants[0]
        for joint in range(joints):
            product = _append(product, joint, self._step(joint))
        return product

    def _step(self, joint: int) -> Floats:
        """Coefficients of ``Rot_z(sign theta) C`` against (1, cos, sin), (3, 4, 4)."""
        parts = np.zeros((3, 4, 4))
        parts[0, 2, 2] = parts[0, 3, 3] = 1.0
        parts[1, 0, 0] = parts[1, 1, 1] = 1.0
        parts[2, 0, 1], parts[2, 1, 0] = -self.signs[joint], self.signs[joint]
        return parts @ self.constants[joint + 1]


def chain_of(machine: Machine, seat: Seat) -> Chain:
    """Collapse a machine's Denavit-Hartenberg rows around its joints.

    Parameters
    ----------
    machine : Machine
    seat : Seat

    Returns
    -------
    Chain
        The same object for equal rows and seat, so that what is derived from
        it is derived once.

    Raises
    ------
    ValueError
        If arm, fork and cab do not stand in the rows once each in this order.
    """
    return _collapse(machine.rows, seat)


@lru_cache(maxsize=64)
def _collapse(rows: tuple[DHRow, ...], seat: Seat) -> Chain:
    found = tuple(row.variable for row in rows if row.variable in JOINTS)
    if found != JOINTS:
        raise ValueError(f"joints {found}, expected {JOINTS} once each in this order")
    fixed = {None: 0.0, "seat_yaw": seat.yaw, "seat_pitch": seat.pitch}
    constants, signs = [np.eye(4)], []
    for row in rows:
        turn = 0.0 if row.variable in JOINTS else row.sign * fixed[row.variable]
        constants[-1] = constants[-1] @ _rot_x(row.alpha) @ _shift(0, row.a)
        constants[-1] = constants[-1] @ _rot_z(row.offset + turn)
        if row.variable in JOINTS:
            signs.append(row.sign)
            constants.append(np.eye(4))
        constants[-1] = constants[-1] @ _shift(2, row.d)
    for constant in constants:
        constant.flags.writeable = False
    c0, c1, c2, c3 = constants
    return Chain((c0, c1, c2, c3), (signs[0], signs[1], signs[2]))


def transform(chain: Chain, angles: Floats) -> Floats:
    """Return T_0^17 of (9), seat frame to ground frame, (..., 4, 4) [m]."""
    return chain.transform(angles)


def seat_rotation(chain: Chain, angles: Floats) -> Floats:
    """Return R_0^17, whose columns are the seat's x, y, z in ground axes, (..., 3, 3)."""
    return transform(chain, angles)[..., :3, :3]


def seat_position(chain: Chain, angles: Floats) -> Floats:
    """Return the origin of frame 17 in the ground frame, (..., 3) [m]."""
    return chain.position(angles)


def joint_axes(chain: Chain, angles: Floats, frame: Frame = "ground") -> Floats:
    """Return the signed unit vectors w_k of the joints.

    In ground axes ``dw_k/dtheta_j = w_j x w_k`` for j < k and 0 otherwise; in
    seat axes ``dw_k/dtheta_m = w_k x w_m`` for m > k and 0 otherwise.

    Parameters
    ----------
    chain : Chain
    angles : (..., 3) array
        [rad]
    frame : {"ground", "seat"}
        The axes that the components are taken along.

    Returns
    -------
    (..., 3 joint, 3 component) array
    """
    return (chain.ground_axes if frame == "ground" else chain.seat_axes)(angles)


def joint_origins(chain: Chain, angles: Floats) -> Floats:
    """Return a point on each joint axis in the ground frame, (..., 3 joint, 3) [m]."""
    return chain.joint_origins(angles)


def linear_jacobian(chain: Chain, angles: Floats) -> Floats:
    """Return J1 of (12): seat velocity in ground axes ``V = J1 theta'``.

    Column k is ``w_k x (p - o_k)``.

    Returns
    -------
    (..., 3 component, 3 joint) array
        [m/rad]
    """
    return chain.position_gradient(angles).swapaxes(-1, -2)


def jacobian(chain: Chain, angles: Floats) -> Floats:
    """Return the 6x3 manipulator Jacobian J of (14).

    Returns
    -------
    (..., 6, 3 joint) array
        J1 [m/rad] over the angular Jacobian; both along ground axes. The
        study's J2 (32) is the lower half in other, constant axes.
    """
    angular = joint_axes(chain, angles).swapaxes(-1, -2)
    return np.concatenate([linear_jacobian(chain, angles), angular], axis=-2)


def position_second_partials(chain: Chain, angles: Floats) -> Floats:
    """Return the second partials p_ij of the seat position in ground axes.

    ``p_ij = w_i x (w_j x (p - o_j))`` for i <= j, symmetric.

    Returns
    -------
    (..., 3 joint i, 3 joint j, 3 component) array
        [m/rad^2]
    """
    return chain.position_hessian(angles)


def row_transform(row: DHRow, turn: float) -> Floats:
    """Return A_i of one row with its variable at an angle [rad], (4, 4) [m]."""
    angle = row.offset + (row.sign * turn if row.variable else 0.0)
    placed: Floats = _rot_x(row.alpha) @ _shift(0, row.a) @ _rot_z(angle)
    return placed @ shift_along_z(row.d)


def shift_along_z(distance: float) -> Floats:
    """Return the transform that shifts along z, (4, 4) [m]."""
    return _shift(2, distance)


def _append(product: Floats, joint: int, step: Floats) -> Floats:
    """Multiply the coefficients of a product, (3, 3, 3, r, c), by a joint's step."""
    before = np.moveaxis(product, joint, 0)[0]  # the only part that is filled so far
    return np.moveaxis(before @ step[:, None, None], 0, joint)


def _cos_sin(angle: float) -> tuple[float, float]:
    """Cosine and sine, exact at multiples of a quarter turn."""
    quarters = angle / (math.pi / 2)
    nearest = round(quarters)
    if abs(quarters - nearest) <= _QUARTER_TURN_TOLERANCE * max(1, abs(nearest)):
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[nearest % 4]
    return math.cos(angle), math.sin(angle)


def _rot_x(angle: float) -> Floats:
    c, s = _cos_sin(angle)
    return np.array([[1.0, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])


def _rot_z(angle: float) -> Floats:
    c, s = _cos_sin(angle)
    return np.array([[c, -s, 0.0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def _shift(axis: int, length: float) -> Floats:
    matrix = np.eye(4)
    matrix[axis, 3] = length
    return matrix
