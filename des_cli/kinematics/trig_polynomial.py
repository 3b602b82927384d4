"""Trigonometric polynomials of degree one in each of three joint angles.

A revolute joint enters a chain through ``Rot_z(theta)``, whose elements are
1, cos(theta) and sin(theta) times constants. Positions, directions and
Jacobians of the chain are therefore sums of products of these, and so are
all their partial derivatives: with the coefficients computed once, any of them
is evaluated for a million samples by one matrix product, exactly.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from des_cli.model.arrays import Floats

BLOCK = 1024
"""Samples evaluated at a time: 27 rows of this length stay in a core's cache, and
the product with 9 columns stays below the size (2**18 multiplications) at which
OpenBLAS starts threads, which on a busy machine cost more than they save."""


@dataclass(frozen=True, eq=False)
class TrigPolynomial:
    """``f(theta) = sum_abc coefficient[a, b, c] e_a(theta1) e_b(theta2) e_c(theta3)``.

    The basis ``e`` is (1, cos, sin).

    Parameters
    ----------
    coefficient : (3, 3, 3, ...) array
        The trailing axes are those of the value.
    """

    coefficient: Floats

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of one value."""
        return self.coefficient.shape[3:]

    @cached_property
    def joints(self) -> tuple[int, ...]:
        """The joints whose angle the value depends on."""
        return tuple(
            joint for joint in range(3) if np.any(np.moveaxis(self.coefficient, joint, 0)[1:])
        )

    @cached_property
    def matrix(self) -> Floats:
        """Coefficients against ``basis``, (3**m, size of a value) for m active joints."""
        used = tuple(slice(None) if joint in self.joints else 0 for joint in range(3))
        return self.coefficient[used].reshape(3 ** len(self.joints), math.prod(self.shape))

    def derivative(self, joint: int) -> TrigPolynomial:
        """Return the partial derivative with respect to a joint angle."""
        given = np.moveaxis(self.coefficient, joint, 0)
        # d/dtheta (k0 + kc cos + ks sin) = ks cos - kc sin; adding 0 keeps -0 out
        turned = np.stack([np.zeros_like(given[0]), given[2], 0.0 - given[1]])
        return TrigPolynomial(np.moveaxis(turned, 0, joint))

    def gradient(self) -> TrigPolynomial:
        """Return all three partial derivatives, as a new first axis of the value."""
        return stack([self.derivative(joint) for joint in range(3)])

    def __call__(self, angles: Floats) -> Floats:
        """Evaluate at joint angles.

        Parameters
        ----------
        angles : (..., 3) array
            [rad]; complex angles give the analytic continuation.

        Returns
        -------
        (..., *shape) array
        """
        angles = np.asarray(angles)
        flat = angles.reshape(-1, 3)
        values = np.empty(
            (len(flat), self.matrix.shape[1]), dtype=np.result_type(flat.dtype, np.float64)
        )
        for start in range(0, len(flat), BLOCK):
            block = slice(start, start + BLOCK)
            np.matmul(basis(flat[block], self.joints).T, self.matrix, out=values[block])
        return values.reshape(angles.shape[:-1] + self.shape)


def stack(polynomials: Sequence[TrigPolynomial]) -> TrigPolynomial:
    """Join polynomials of one shape along a new first axis of the value."""
    return TrigPolynomial(np.stack([each.coefficient for each in polynomials], axis=3))


def basis(angles: Floats, joints: tuple[int, ...]) -> Floats:
    """Evaluate the products of 1, cos and sin of the angles of some joints.

    Parameters
    ----------
    angles : (n, 3) array
        [rad]
    joints : tuple of int
        m of them; the last one's index runs fastest.

    Returns
    -------
    (3**m, n) array
    """
    products = np.ones((1, len(angles)))
    for joint in joints:
        theta = angles[:, joint]
        factor = np.stack([np.ones_like(theta, dtype=np.float64), np.cos(theta), np.sin(theta)])
        products = (products[:, None] * factor).reshape(-1, len(angles))
    return products
