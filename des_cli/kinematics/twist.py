"""The seat's twist and its time derivative, with derivatives in closed form.

A joint moves the seat by its screw axis. Along the seat's own axes, with the linear
part taken at the head, the axes of arm, fork and cab are 6-vectors S1(theta2, theta3),
S2(theta3) and S3 (angular part first), each of degree one in the sines and cosines of
the angles, for a rigid displacement acts on twists linearly. Then, with rates a, f, q::

    V  = S1 a + S2 f + S3 q                                    twist (omega; v)
    V' = S1 a' + S2 f' + S3 q' + a (f d2 S1 + q d3 S1) + f q d3 S2

What the pilot feels follows from these alone::

    W = omega          dW/dt = omega'          c = the angular part of the products in V'
    force = v' + omega x v + R' g z0

Nothing depends on the arm's angle, provided that the arm turns about the vertical.
Everything is an array with the component first and the point last, (6, m) for a twist,
so that one matrix product with the basis (1, c2, s2) x (1, c3, s3) gives all axes and
all their derivatives at m points.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.kinematics.trig_polynomial import TrigPolynomial
from des_cli.model.arrays import Floats

VARIABLES = 8
"""theta2, theta3, the three rates, the three accelerations: what the motion of the seat
depends on, in the order of every variable axis."""

ANGLES, RATES, ACCELERATIONS = slice(0, 2), slice(2, 5), slice(5, 8)

_LOW = ((), (1,), (2,))
_HIGH = ((1, 1), (1, 2), (2, 2), (1, 1, 1), (1, 1, 2), (1, 2, 2), (2, 2, 2))
# places in the tables of the derivatives by (theta2, theta3)
_0, _2, _3 = range(3)
_22, _23, _33 = range(3)

_ROWS = ((0, 1, 2, 3, 4), (8, 9, 10, 11), (15, 16, 17), (21, 22), (26,))
"""Where the pairs of the first five variables stand in the upper triangle of all eight."""

_VERTICAL = 1e-12
"""Largest change of gravity along seat axes per radian of the arm, relative to gravity."""


@dataclass(frozen=True, eq=False)
class SeatMotion:
    """The seat's motion at m points, and its derivatives, computed when they are asked for.

    Parameters
    ----------
    forms : SeatForms
    functions : (9, m) array
        The basis at the points.
    rate, acceleration : (3, m) array
        Of the joints [rad/s], [rad/s^2].
    """

    forms: SeatForms
    functions: Floats
    rate: Floats
    acceleration: Floats

    def moving(self, points: slice, rate: Floats, acceleration: Floats) -> SeatMotion:
        """Return the motion at some of the points, with other rates and accelerations.

        What depends on the angles alone is evaluated here, once for all that are asked for.
        """
        other = SeatMotion(self.forms, self.functions[:, points], rate, acceleration)
        for name in ("arm", "fork", "gravity"):
            # Where a cached property keeps its value.
            other.__dict__[name] = getattr(self, name)[..., points]
        return other

    @cached_property
    def arm(self) -> Floats:
        """S1 and its first derivatives by theta2 and theta3, (3, 6, m)."""
        return self._table(self.forms.arm)

    @cached_property
    def arm_beyond(self) -> Floats:
        """Derivatives of S1 by 22, 23, 33, 222, 223, 233 and 333, (7, 6, m)."""
        return self._table(self.forms.arm_beyond)

    @cached_property
    def fork(self) -> Floats:
        """S2 and its first derivative by theta3, (2, 6, m)."""
        return self._table(self.forms.fork)

    @cached_property
    def fork_beyond(self) -> Floats:
        """Second and third derivative of S2 by theta3, (2, 6, m)."""
        return self._table(self.forms.fork_beyond)

    @cached_property
    def gravity(self) -> Floats:
        """Gravity's reaction R' g z0 and its first derivatives, (3, 3, m) [m/s^2]."""
        return self._table(self.forms.gravity, 3)

    @cached_property
    def gravity_beyond(self) -> Floats:
        """Its derivatives by 22, 23 and 33, (3, 3, m)."""
        return self._table(self.forms.gravity_beyond, 3)

    @property
    def cab(self) -> Floats:
        """S3, (6, 1)."""
        return self.forms.cab

    def _table(self, coefficients: Floats, size: int = 6) -> Floats:
        values = coefficients @ self.functions[: coefficients.shape[1]]
        return np.asarray(values.reshape(-1, size, values.shape[1]))

    @cached_property
    def twist(self) -> Floats:
        """V, (6, m) [rad/s; m/s]."""
        a, f, q = self.rate
        return np.asarray(self.arm[_0] * a + self.fork[0] * f + self.cab * q)

    @cached_property
    def products(self) -> Floats:
        """The rate products in V', (6, m); their angular part is c."""
        a, f, q = self.rate
        spun = self.arm[_2] * f + self.arm[_3] * q
        return np.asarray(spun * a + self.fork[1] * (f * q))

    @cached_property
    def twist_rate(self) -> Floats:
        """V', (6, m) [rad/s^2; m/s^2]."""
        a, f, q = self.acceleration
        linear = self.arm[_0] * a + self.fork[0] * f + self.cab * q
        return np.asarray(linear + self.products)

    @cached_property
    def force(self) -> Floats:
        """Specific force along x, y, z of the seat, gravity included, (3, m) [m/s^2]."""
        omega, v = self.twist[:3], self.twist[3:]
        return np.asarray(self.twist_rate[3:] + cross(omega, v) + self.gravity[_0])

    @cached_property
    def twist_slope(self) -> Floats:
        """Derivatives of V by theta2, theta3 and the rates, (5, 6, m)."""
        a, f, _ = self.rate
        slope = np.empty((5, *self.twist.shape))
        np.multiply(self.arm[_2], a, out=slope[0])
        np.multiply(self.arm[_3], a, out=slope[1])
        slope[1] += self.fork[1] * f
        slope[2], slope[3], slope[4] = self.arm[_0], self.fork[0], self.cab
        return slope

    @cached_property
    def products_slope(self) -> Floats:
        """Derivatives of the rate products by theta2, theta3 and the rates, (5, 6, m)."""
        a, f, q = self.rate
        arm, fork, beyond = self.arm, self.fork, self.arm_beyond
        slope = np.empty((5, *self.twist.shape))
        af, aq = a * f, a * q
        slope[0] = beyond[_22] * af + beyond[_23] * aq
        slope[1] = beyond[_23] * af + beyond[_33] * aq + self.fork_beyond[0] * (f * q)
        slope[2] = arm[_2] * f + arm[_3] * q
        slope[3] = arm[_2] * a + fork[1] * q
        slope[4] = arm[_3] * a + fork[1] * f
        return slope

    @cached_property
    def twist_rate_slope(self) -> Floats:
        """Derivatives of V' by all variables, (8, 6, m)."""
        a, f, _ = self.acceleration
        slope = np.empty((VARIABLES, *self.twist.shape))
        slope[:5] = self.products_slope
        slope[0] += self.arm[_2] * a
        slope[1] += self.arm[_3] * a
        slope[1] += self.fork[1] * f
        slope[5], slope[6], slope[7] = self.arm[_0], self.fork[0], self.cab
        return slope

    @cached_property
    def force_slope(self) -> Floats:
        """Derivatives of the force by all variables, (8, 3, m)."""
        omega, v = self.twist[:3], self.twist[3:]
        slope = self.twist_rate_slope[:, 3:].copy()
        by = self.twist_slope
        slope[:5] += cross(by[:, :3], v) + cross(omega, by[:, 3:])
        slope[0] += self.gravity[_2]
        slope[1] += self.gravity[_3]
        return slope

    def curvature(
        self, omega: Floats | None, products: Floats, rate: Floats | None, force: Floats | None
    ) -> Floats:
        """Return the second derivatives of a weighted sum of the seat's quantities.

        Parameters
        ----------
        omega, products, rate, force : (3, m) array or None
            Multipliers of W, c, dW/dt and the force; None for zero.

        Returns
        -------
        (36, m) array
            The upper triangle of the Hessian by all variables, row by row.
        """
        m = self.rate.shape[1]
        zero = np.zeros((3, m))
        on_force = zero if force is None else force
        along = zero if rate is None else rate
        on_twist = np.empty((6, m))
        on_twist[:3] = cross(self.twist[3:], on_force)
        if omega is not None:
            on_twist[:3] += omega
        on_twist[3:] = cross(on_force, self.twist[:3])
        on_products = np.concatenate([products + along, on_force])
        on_rate = np.concatenate([along, on_force])
        first, second = self.arm[_2:], self.arm_beyond[: _33 + 1]
        # multipliers times the axes' derivatives: 2, 3; 22, 23, 33; and 222 ... 333
        v, v2 = _contract(first, on_twist), _contract(second, on_twist)
        r, r2 = _contract(first, on_rate), _contract(second, on_rate)
        p, p2 = _contract(first, on_products), _contract(self.arm_beyond, on_products)
        fork_1, fork_2 = self.fork[1:], self.fork_beyond
        fork_v = np.concatenate([_contract(fork_1, on_twist), _contract(fork_2[:1], on_twist)])
        fork_r = np.concatenate([_contract(fork_1, on_rate), _contract(fork_2[:1], on_rate)])
        fork_p = np.concatenate([_contract(fork_1, on_products), _contract(fork_2, on_products)])
        a, f, q = self.rate
        a2, f2, _ = self.acceleration
        af, aq, fq = a * f, a * q, f * q
        h = np.zeros((VARIABLES * (VARIABLES + 1) // 2, m))
        h[0] = a * v2[0] + a2 * r2[0] + af * p2[3] + aq * p2[4]  # theta2 theta2
        h[1] = a * v2[1] + a2 * r2[1] + af * p2[4] + aq * p2[5]  # theta2 theta3
        h[2] = v[0] + f * p2[0] + q * p2[1]
        h[3] = a * p2[0]
        h[4] = a * p2[1]
        h[5] = r[0]
        h[8] = a * v2[2] + a2 * r2[2] + af * p2[5] + aq * p2[6]  # theta3 theta3
        h[8] += f * fork_v[1] + f2 * fork_r[1] + fq * fork_p[2]
        h[9] = v[1] + f * p2[1] + q * p2[2]
        h[10] = fork_v[0] + a * p2[1] + q * fork_p[1]
        h[11] = a * p2[2] + f * fork_p[1]
        h[12] = r[1]
        h[13] = fork_r[0]
        h[16] = p[0]  # arm rate, fork rate
        h[17] = p[1]
        h[22] = fork_p[0]
        if force is not None:
            h[0] += np.sum(force * self.gravity_beyond[_22], axis=0)
            h[1] += np.sum(force * self.gravity_beyond[_23], axis=0)
            h[8] += np.sum(force * self.gravity_beyond[_33], axis=0)
            by = self.twist_slope
            turned = cross(by[:, 3:], force)
            for k, row in enumerate(
                ((0, 1, 2, 3, 4), (8, 9, 10, 11), (15, 16, 17), (21, 22), (26,))
            ):
                both = np.einsum("cm,lcm->lm", by[k, :3], turned[k:])
                both += np.einsum("cm,lcm->lm", turned[k], by[k:, :3])
                h[list(row)] += both
        return h


@dataclass(frozen=True, eq=False)
class SeatForms:
    """Coefficients from which the seat's motion is evaluated, against the basis.

    Parameters
    ----------
    arm, arm_beyond : (18, 9), (42, 9) array
        S1 with its first derivatives, and the higher ones.
    fork, fork_beyond : (12, 3), (12, 3) array
    cab : (6, 1) array
    gravity, gravity_beyond : (9, 9), (9, 9) array
    vertical : bool
        Whether the arm turns about the vertical, as all of this supposes.
    """

    arm: Floats
    arm_beyond: Floats
    fork: Floats
    fork_beyond: Floats
    cab: Floats
    gravity: Floats
    gravity_beyond: Floats
    vertical: bool

    def at(self, z: Floats) -> SeatMotion:
        """Return the motion at points.

        Parameters
        ----------
        z : (8, m) array
            theta2, theta3, rates, accelerations [rad, rad/s, rad/s^2].
        """
        cosine, sine = np.cos(z[ANGLES]), np.sin(z[ANGLES])
        functions = np.empty((9, z.shape[1]))
        functions[0], functions[1], functions[2] = 1.0, cosine[1], sine[1]
        np.multiply(functions[:3], cosine[0], out=functions[3:6])
        np.multiply(functions[:3], sine[0], out=functions[6:])
        return SeatMotion(self, functions, z[RATES], z[ACCELERATIONS])

    def changed(self, twist: Floats, vector: Floats) -> SeatForms:
        """Return the forms with every twist and every vector along seat axes mapped.

        Parameters
        ----------
        twist : (6, 6) array
        vector : (3, 3) array
        """
        arm, arm_beyond, fork, fork_beyond = (
            _mapped(twist, table)
            for table in (self.arm, self.arm_beyond, self.fork, self.fork_beyond)
        )
        gravity, beyond = (_mapped(vector, t) for t in (self.gravity, self.gravity_beyond))
        cab = twist @ self.cab
        return SeatForms(arm, arm_beyond, fork, fork_beyond, cab, gravity, beyond, self.vertical)


@lru_cache(maxsize=64)
def seat_forms(chain: Chain, gravity: float) -> SeatForms:
    """Return the forms of a chain under a gravity [m/s^2] along -z0."""
    arm, fork, cab = (_screw(chain, joint) for joint in range(3))
    up = TrigPolynomial(gravity * chain.transform.coefficient[..., 2, :3])
    turning = np.max(np.abs(up.derivative(0).coefficient))
    return SeatForms(
        arm=_table(arm, _LOW),
        arm_beyond=_table(arm, _HIGH),
        fork=_in_theta3(_table(fork, ((), (2,)))),
        fork_beyond=_in_theta3(_table(fork, ((2, 2), (2, 2, 2)))),
        cab=cab.coefficient[0, 0, 0][:, None],
        gravity=_table(up, _LOW),
        gravity_beyond=_table(up, _HIGH[:3]),
        vertical=bool(turning <= _VERTICAL * max(gravity, 1.0)),
    )


def _in_theta3(table: Floats) -> Floats:
    """Return the part of a table against (1, c3, s3)."""
    return np.ascontiguousarray(table[:, :3])


def _mapped(matrix: Floats, table: Floats) -> Floats:
    """Return a table whose blocks of components are mapped by a matrix."""
    blocks = table.reshape(-1, len(matrix), table.shape[1])
    return np.ascontiguousarray((matrix @ blocks).reshape(table.shape))


def _screw(chain: Chain, joint: int) -> TrigPolynomial:
    """Return a joint's screw axis along seat axes, value (6,): angular, then linear [m]."""
    coefficient = np.zeros((3, 3, 3, 6))
    axis = np.zeros(6)
    axis[2] = chain.signs[joint]
    coefficient[0, 0, 0] = seen_from(chain.constants[joint + 1]) @ axis
    for outer in range(joint + 1, 3):
        steps = np.zeros((3, 6, 6))  # against (1, cos, sin)
        for at in (0, 3):
            steps[0, at + 2, at + 2] = 1.0
            steps[1, at, at] = steps[1, at + 1, at + 1] = 1.0
            steps[2, at, at + 1], steps[2, at + 1, at] = chain.signs[outer], -chain.signs[outer]
        steps = seen_from(chain.constants[outer + 1]) @ steps
        before = np.moveaxis(coefficient, outer, 0)[0]
        coefficient = np.moveaxis(np.einsum("sij,...j->s...i", steps, before), 0, outer)
    return TrigPolynomial(coefficient)


def seen_from(transform: Floats) -> Floats:
    """Return the 6x6 matrix that takes a twist to the frame that a transform places."""
    turn = transform[:3, :3].T
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = matrix[3:, 3:] = turn
    matrix[3:, :3] = turn @ cross_from_right(transform[:3, 3])
    return matrix


def cross_from_right(p: Floats) -> Floats:
    """Return the matrix of omega -> omega x p."""
    x, y, z = p
    return np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])


def _table(polynomial: TrigPolynomial, orders: tuple[tuple[int, ...], ...]) -> Floats:
    """Return the coefficients of derivatives against (1, c2, s2) x (1, c3, s3)."""
    rows = []
    for joints in orders:
        derivative = polynomial
        for joint in joints:
            derivative = derivative.derivative(joint)
        rows.append(np.moveaxis(derivative.coefficient[0], -1, 0).reshape(-1, 9))
    return np.ascontiguousarray(np.concatenate(rows))


def cross(one: Floats, other: Floats) -> Floats:
    """Return the cross product of vectors whose component is the last axis but one."""
    product = np.empty(np.broadcast_shapes(one.shape, other.shape))
    x1, y1, z1 = one[..., 0, :], one[..., 1, :], one[..., 2, :]
    x2, y2, z2 = other[..., 0, :], other[..., 1, :], other[..., 2, :]
    np.subtract(y1 * z2, z1 * y2, out=product[..., 0, :])
    np.subtract(z1 * x2, x1 * z2, out=product[..., 1, :])
    np.subtract(x1 * y2, y1 * x2, out=product[..., 2, :])
    return product


def _contract(table: Floats, multiplier: Floats) -> Floats:
    return np.asarray(np.einsum("tcm,cm->tm", table, multiplier))
