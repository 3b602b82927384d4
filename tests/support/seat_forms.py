"""What a motion of the joints does to the seat, two ways that share no formula.

``by_closed_forms`` starts from the angular velocity in seat axes at the seat of the study
(yaw 90 degrees, pitch 0), with a, f, q the rates of arm, fork and cab::

    W = J_b theta',  J_b = [[-s2, 0, -1], [-c2 s3, c3, 0], [c2 c3, s3, 0]]
    c = (dJ_b/dt) theta',   dW/dt = J_b theta'' + c

Its columns are the axes of arm, fork and cab in seat axes, so they give the attitude
too. The gimbals' centre runs on a circle of radius L2; the seat is fixed to the cab, so
its acceleration is that of a point of a rigid body. Another seat is a constant turn N.

``by_chain`` multiplies the 17 transforms of Table 2, each a Taylor polynomial of second
order in time, and reads everything from the product.

Nothing of ``des_cli`` is used. Lengths are feet and 1 g is 32.2 ft/s^2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

L2, LX, LY, LZ, LT = 19.0, 3.90, 0.012, 0.012, 2.76
G = 32.2
YAW, PITCH = math.pi / 2, 0.0

# Table 2: alpha_{i-1}, a_{i-1}, d_i, theta_i; a text is a variable, "-" its negative.
HALF = math.pi / 2
TABLE_2: tuple[tuple[float, float, float, float | str], ...] = (
    (0.0, 0.0, 0.0, "-arm"),
    (0.0, L2, 0.0, 0.0),
    (0.0, 0.0, 0.0, HALF),
    (HALF, 0.0, 0.0, 0.0),
    (0.0, 0.0, 0.0, "fork"),
    (0.0, 0.0, 0.0, HALF),
    (-HALF, 0.0, 0.0, 0.0),
    (0.0, 0.0, 0.0, "cab"),
    (0.0, -LX, LZ, 0.0),
    (0.0, 0.0, 0.0, -HALF),
    (0.0, LY, 0.0, 0.0),
    (HALF, 0.0, 0.0, 0.0),
    (0.0, 0.0, 0.0, "-yaw"),
    (-HALF, 0.0, 0.0, 0.0),
    (0.0, 0.0, 0.0, "-pitch"),
    (HALF, 0.0, 0.0, 0.0),
    (0.0, 0.0, -LT, 0.0),
)


@dataclass(frozen=True)
class Felt:
    """The seat's state at n instants.

    Parameters
    ----------
    rate, cross, turning : (n, 3) array
        Angular velocity W [rad/s], Coriolis vector c and total angular acceleration dW/dt
        [rad/s^2], along x, y, z of the seat.
    g : (n, 3) array
        (Gx, Gy, Gz) in the pilot's signs: (fx, fy, -fz) of the specific force [g].
    attitude : (n, 3, 3) array
        Seat to ground.
    """

    rate: Floats
    cross: Floats
    turning: Floats
    g: Floats
    attitude: Floats


def seat_turn(yaw: float, pitch: float) -> Floats:
    """Return N: from the axes of the seat at yaw 90, pitch 0 to those of another seat."""
    sy, cy = math.sin(yaw - HALF), math.cos(yaw - HALF)
    sp, cp = math.sin(pitch), math.cos(pitch)
    about_z = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
    about_y = np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
    return np.asarray(about_y @ about_z)


def by_closed_forms(
    angle: Floats, rate: Floats, acceleration: Floats, yaw: float = YAW, pitch: float = PITCH
) -> Felt:
    """Return what is felt at joint states of shape (n, 3) [rad, rad/s, rad/s^2]."""
    (s1, s2, s3), (c1, c2, c3) = np.sin(angle).T, np.cos(angle).T
    (a, f, q), (a1, f1, q1) = rate.T, acceleration.T
    zero = np.zeros_like(a)

    def stack(*parts: Floats) -> Floats:
        return np.stack(parts, axis=-1)

    down, radial, tangential = (
        stack(-s2, -c2 * s3, c2 * c3),
        stack(zero, c3, s3),
        stack(-c2, s2 * s3, -s2 * c3),
    )
    w = stack(-s2 * a - q, -c2 * s3 * a + c3 * f, c2 * c3 * a + s3 * f)
    cross = stack(
        -c2 * f * a,
        (s2 * s3 * f - c2 * c3 * q) * a - s3 * q * f,
        (-s2 * c3 * f - c2 * s3 * q) * a + c3 * q * f,
    )
    turning = cross + stack(-s2 * a1 - q1, -c2 * s3 * a1 + c3 * f1, c2 * c3 * a1 + s3 * f1)

    turn = seat_turn(yaw, pitch)
    offset = np.array([-LZ, LY, LX]) + turn.T @ np.array([0.0, 0.0, -LT])
    centre = L2 * (a1[:, None] * tangential - (a**2)[:, None] * radial)
    force = centre - G * down + np.cross(turning, offset) + np.cross(w, np.cross(w, offset))

    ground = np.stack(
        [stack(c1, -s1, zero), stack(-s1, -c1, zero), stack(zero, zero, zero - 1.0)], axis=-1
    )
    in_seat = np.stack([radial, tangential, down], axis=-2)
    return Felt(
        rate=w @ turn.T,
        cross=cross @ turn.T,
        turning=turning @ turn.T,
        g=force @ turn.T / G * np.array([1.0, 1.0, -1.0]),
        attitude=ground @ in_seat @ turn.T,
    )


def transform(
    angle: Floats, rate: Floats, acceleration: Floats, yaw: float = YAW, pitch: float = PITCH
) -> tuple[Floats, Floats, Floats]:
    """Return T_0^17 and its first two derivatives by time, each (n, 4, 4)."""
    n = len(angle)
    variables = {
        name: (angle[:, i], rate[:, i], acceleration[:, i])
        for i, name in enumerate(("arm", "fork", "cab"))
    }
    still = np.zeros(n)
    variables |= {"yaw": (still + yaw, still, still), "pitch": (still + pitch, still, still)}
    product = (np.tile(np.eye(4), (n, 1, 1)), np.zeros((n, 4, 4)), np.zeros((n, 4, 4)))
    for twist, length, offset, turn in TABLE_2:
        if isinstance(turn, str):
            sign = -1.0 if turn.startswith("-") else 1.0
            joint = tuple(sign * each for each in variables[turn.removeprefix("-")])
        else:
            joint = (still + turn, still, still)
        link = _link(twist, length, offset, joint)
        # (A B)' = A'B + AB', (A B)'' = A''B + 2A'B' + AB''
        product = (
            product[0] @ link[0],
            product[1] @ link[0] + product[0] @ link[1],
            product[2] @ link[0] + 2 * product[1] @ link[1] + product[0] @ link[2],
        )
    return product


def _link(
    twist: float, length: float, offset: float, joint: tuple[Floats, ...]
) -> tuple[Floats, Floats, Floats]:
    """Return Rot_x(alpha) Trans_x(a) Rot_z(theta) Trans_z(d) and its two derivatives."""
    value, speed, growth = (each[:, None, None] for each in joint)
    s, c = np.sin(value), np.cos(value)
    plane = np.zeros((4, 4)) + np.diag([1.0, 1.0, 0.0, 0.0])
    quarter = np.zeros((4, 4))
    quarter[0, 1], quarter[1, 0] = -1.0, 1.0
    rest = np.diag([0.0, 0.0, 1.0, 1.0])
    lift = np.eye(4)
    lift[2, 3] = offset
    before = np.eye(4)
    before[1:3, 1:3] = [
        [math.cos(twist), -math.sin(twist)],
        [math.sin(twist), math.cos(twist)],
    ]
    before[0, 3] = length
    first = -s * plane + c * quarter
    second = -c * plane - s * quarter
    return (
        before @ (c * plane + s * quarter + rest) @ lift,
        before @ (speed * first) @ lift,
        before @ (growth * first + speed**2 * second) @ lift,
    )


def by_chain(
    angle: Floats, rate: Floats, acceleration: Floats, yaw: float = YAW, pitch: float = PITCH
) -> Felt:
    """Return what is felt at joint states of shape (n, 3), from the product of Table 2."""
    t0, t1, t2 = transform(angle, rate, acceleration, yaw, pitch)
    # without theta'' only the products of rates are left: c
    _, _, drift = transform(angle, rate, np.zeros_like(acceleration), yaw, pitch)
    rotation = t0[:, :3, :3]
    back = rotation.swapaxes(-1, -2)
    spin = back @ t1[:, :3, :3]
    lifted = t2[:, :3, 3] + np.array([0.0, 0.0, G])
    force = (back @ lifted[..., None])[..., 0]
    # R' = R [W], R'' = R ([W]^2 + [dW/dt])
    return Felt(
        rate=_vector(spin),
        cross=_vector(back @ drift[:, :3, :3] - spin @ spin),
        turning=_vector(back @ t2[:, :3, :3] - spin @ spin),
        g=force / G * np.array([1.0, 1.0, -1.0]),
        attitude=rotation,
    )


def _vector(skew: Floats) -> Floats:
    return np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=-1)
