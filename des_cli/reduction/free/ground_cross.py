"""The cross-coupling vector in the study's axes as a cost of a free motion.

Along i0, j0, k0 its components depend on the arm's and the fork's angle and on the
rates, not on the cab's angle: the study weighs one of them, BB3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.kinematics.coriolis import (
    PAIRS,
    coriolis_pairs,
    coriolis_pairs_gradient,
    coriolis_pairs_hessian,
)
from des_cli.model.arrays import Floats

GROUND_VARIABLES = ((0, 0), (0, 1), (1, 0), (1, 1), (1, 2))
"""Order and joint of the variables: the angles of arm and fork, the rates."""

_COUNT = len(GROUND_VARIABLES)
_PAIR = {
    pair: index
    for index, pair in enumerate((k, n) for k in range(_COUNT) for n in range(k, _COUNT))
}


@dataclass(frozen=True, eq=False)
class GroundCross:
    """``sum |root c|^2`` of the vector in ground axes.

    Parameters
    ----------
    chain : Chain
    root : (3, 3) array
        A square root of the weight.
    """

    chain: Chain
    root: Floats

    def residual(self, z: Floats) -> Floats:
        """Return the residuals at points, (3, m), of variables (5, m)."""
        pairs = coriolis_pairs(self.chain, _angles(z), "report")
        return np.asarray(self.root @ np.einsum("mpc,pm->cm", pairs, _products(z)))

    def slope(self, z: Floats) -> Floats:
        """Return the derivatives of the residuals by the variables, (5, 3, m)."""
        pairs = coriolis_pairs(self.chain, _angles(z), "report")
        turned = coriolis_pairs_gradient(self.chain, _angles(z), "report")
        slope = np.empty((_COUNT, 3, z.shape[1]))
        slope[:2] = np.einsum("mapc,pm->acm", turned[:, :2], _products(z))
        slope[2:] = np.einsum("mpc,rpm->rcm", pairs, _product_slopes(z))
        return np.asarray(np.einsum("rc,kcm->krm", self.root, slope))

    def curvature(self, z: Floats, residual: Floats) -> Floats:
        """Return ``residual' d2 residual``, its upper triangle, (15, m)."""
        angles, multiplier = _angles(z), self.root.T @ residual
        along = np.einsum("mpc,cm->pm", coriolis_pairs(self.chain, angles, "report"), multiplier)
        turned = coriolis_pairs_gradient(self.chain, angles, "report")[:, :2]
        second = coriolis_pairs_hessian(self.chain, angles, "report")[:, :2, :2]
        hessian = np.zeros((len(_PAIR), z.shape[1]))
        by_angles = np.einsum("mabpc,cm,pm->abm", second, multiplier, _products(z), optimize=True)
        by_both = np.einsum(
            "mapc,cm,rpm->arm", turned, multiplier, _product_slopes(z), optimize=True
        )
        for a in range(2):
            for b in range(a, 2):
                hessian[_PAIR[a, b]] = by_angles[a, b]
            for r in range(3):
                hessian[_PAIR[a, 2 + r]] = by_both[a, r]
        for index, (j, k) in enumerate(PAIRS):
            hessian[_PAIR[2 + j, 2 + k]] = along[index]
        return hessian


def squares_of(slope: Floats) -> Floats:
    """Return ``slope' slope``, its upper triangle, (15, m)."""
    return np.stack([np.sum(slope[k] * slope[n], axis=0) for k, n in _PAIR])


def _angles(z: Floats) -> Floats:
    """Return joint angles, (m, 3); the cab's does not matter."""
    return np.stack([z[0], z[1], np.zeros_like(z[0])], axis=1)


def _products(z: Floats) -> Floats:
    """Return the rate products of the pairs, (3, m)."""
    rate = z[2:]
    return np.stack([rate[j] * rate[k] for j, k in PAIRS])


def _product_slopes(z: Floats) -> Floats:
    """Return the derivatives of the products by the rates, (3 rate, 3 pair, m)."""
    rate = z[2:]
    slopes = np.zeros((3, len(PAIRS), z.shape[1]))
    for index, (j, k) in enumerate(PAIRS):
        slopes[j, index], slopes[k, index] = rate[k], rate[j]
    return slopes
