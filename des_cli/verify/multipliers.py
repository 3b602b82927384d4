"""Nonnegative multipliers by least squares, for a handful of budgets."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from des_cli.model.arrays import Floats


def least_residual(slope: Floats, by_budget: Floats) -> Floats:
    """Return ``slope + by_budget lambda`` for the lambda >= 0 that makes it least.

    Every set of positive multipliers is tried; with few budgets these are few sets.

    Parameters
    ----------
    slope : (d,) array
        Of the cost, along each direction.
    by_budget : (d, b) array
        Of each budget.

    Returns
    -------
    (d,) array
    """
    best = slope
    scale = np.maximum(np.linalg.norm(by_budget, axis=0), 1e-300)
    columns = by_budget / scale
    for count in range(1, columns.shape[1] + 1):
        for chosen in combinations(range(columns.shape[1]), count):
            some = columns[:, chosen]
            found = np.linalg.lstsq(some, -slope, rcond=None)[0]
            residual = slope + some @ found
            if np.all(found >= 0.0) and residual @ residual < best @ best:
                best = residual
    return np.asarray(best)
