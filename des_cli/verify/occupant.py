"""The bounds on what the occupant gets, measured on a motion as its tables play it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import OccupantBounds
from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.verify.felt import Felt

OCCUPANT_TOLERANCE = 1e-9
"""Excess over a bound that rounding alone may make, relative to the bound or to one."""


def check_occupant(bounds: OccupantBounds, motion: Motion, felt: Felt) -> list[Check]:
    """Measure a motion against the bounds that there are.

    Parameters
    ----------
    bounds : OccupantBounds
    motion : Motion
    felt : Felt
        At its states.
    """
    return [
        Check(f"occupant.{key}", f"excess of the occupant's {name}", excess, OCCUPANT_TOLERANCE)
        for key, name, excess in (
            (key, name, float(np.max(values)))
            for key, name, values in excesses(bounds, motion, felt)
        )
    ]


def excesses(
    bounds: OccupantBounds, motion: Motion, felt: Felt
) -> Iterator[tuple[str, str, Floats]]:
    """Yield key, name and excess at each state, (2 (n - 1),), of every bound.

    The excess is in units of the bound, or of the unit where the bound is below it.
    """
    for component, name, (least, most) in zip(
        felt.g, ("gx", "gy", "gz"), (bounds.gx, bounds.gy, bounds.gz), strict=True
    ):
        over = [
            (sign * component - bound) / max(1.0, abs(bound))
            for sign, bound in ((1.0, most), (-1.0, -least))
            if np.isfinite(bound)
        ]
        if over:
            yield name, name.capitalize(), np.asarray(np.max(over, axis=0))
    if np.isfinite(bounds.g_onset):
        onset = np.max(_onset(motion, felt), axis=0)
        yield "onset", "G onset", (np.tile(onset, 2) - bounds.g_onset) / max(1.0, bounds.g_onset)
    most = bounds.angular_acceleration
    if np.isfinite(most):
        size = np.sqrt(np.sum(felt.turning**2, axis=0))
        yield "angular_acceleration", "angular acceleration", (size - most) / max(1.0, most)


def _onset(motion: Motion, felt: Felt) -> Floats:
    """Return the change of G from sample to sample over the step, (3, n - 1) [g/s].

    At a sample counts what is felt after it: a jump there is then part of the change.
    """
    count = len(motion.step)
    samples = np.concatenate([felt.g[:, :count], felt.g[:, -1:]], axis=1)
    return np.asarray(np.abs(np.diff(samples, axis=1)) / motion.step)
