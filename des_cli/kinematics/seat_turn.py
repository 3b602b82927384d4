"""How what the pilot feels changes when the seat is fixed otherwise in the cab."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from des_cli.kinematics.chain import row_transform, shift_along_z
from des_cli.kinematics.twist import SeatMotion, cross, cross_from_right, seen_from
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, Machine, Seat


@dataclass(frozen=True, eq=False)
class SeatTurn:
    """The derivative of everything along seat axes by one angle of the seat's fixing.

    Turning the seat is one more joint beyond the cab. With its screw axis xi along seat
    axes, every twist V changes by the bracket [V, xi] and every vector u by u x xi.

    Parameters
    ----------
    twist : (6, 6) array
        ``dV = twist V`` per radian.
    vector : (3, 3) array
        ``du = vector u`` per radian.
    """

    twist: Floats
    vector: Floats

    def of(self, seat: SeatMotion) -> SeatMotion:
        """Return the derivative, which has the same form, but for the force (`mixed_force`)."""
        forms = seat.forms.changed(self.twist, self.vector)
        return SeatMotion(forms, seat.functions, seat.rate, seat.acceleration)


def mixed_force(seat: SeatMotion, turned: SeatMotion) -> Floats:
    """Return the derivative of the force by a turn of the seat, (3, m) [m/s^2 per rad].

    The force is quadratic in the twist, ``omega x v``, so that its derivative mixes both.
    """
    return np.asarray(
        turned.twist_rate[3:]
        + turned.gravity[0]
        + cross(seat.twist[:3], turned.twist[3:])
        + cross(turned.twist[:3], seat.twist[3:])
    )


def mixed_force_slope(seat: SeatMotion, turned: SeatMotion) -> Floats:
    """Return the derivatives of `mixed_force` by all variables, (8, 3, m)."""
    slope = turned.twist_rate_slope[:, 3:].copy()
    plain, by = seat.twist_slope, turned.twist_slope
    slope[:5] += cross(plain[:, :3], turned.twist[3:]) + cross(seat.twist[:3], by[:, 3:])
    slope[:5] += cross(by[:, :3], seat.twist[3:]) + cross(turned.twist[:3], plain[:, 3:])
    slope[0] += turned.gravity[1]
    slope[1] += turned.gravity[2]
    return slope


def seat_turns(machine: Machine, seat: Seat) -> dict[str, SeatTurn]:
    """Return the derivatives by ``seat_yaw`` and ``seat_pitch``, outermost in the chain last.

    A machine may have neither row; what has none is left out.
    """
    turns: dict[str, SeatTurn] = {}
    beyond = np.eye(4)
    fixed = {"seat_yaw": seat.yaw, "seat_pitch": seat.pitch}
    for row in reversed(machine.rows):
        if row.variable not in fixed:
            beyond = row_transform(row, 0.0) @ beyond
            if row.variable in JOINTS:
                break
            continue
        beyond = shift_along_z(row.d) @ beyond
        axis = np.zeros(6)
        axis[2] = row.sign
        xi = seen_from(beyond) @ axis
        turn = _bracket(xi)
        turns[row.variable] = SeatTurn(turn, turn[:3, :3])
        beyond = row_transform(replace(row, d=0.0), fixed[row.variable]) @ beyond
    return dict(reversed(turns.items()))


def _bracket(xi: Floats) -> Floats:
    """Return the matrix of V -> [V, xi] = (omega x xi_omega; omega x xi_v + v x xi_omega)."""
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = matrix[3:, 3:] = cross_from_right(xi[:3])
    matrix[3:, :3] = cross_from_right(xi[3:])
    return matrix
