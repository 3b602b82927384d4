"""The command table with its leads: from rest to the maneuver and back to rest."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.verify.claim import Claim

LEAD_TOLERANCE = 1e-9
"""Largest difference of a time [s], an angle [rad] or a rate [rad/s] that is to be none."""


def check_leads(claim: Claim) -> list[Check]:
    """Compare the table with the maneuver in it, and its ends with rest and the leads' length.

    Nothing is checked where the table is the maneuver.
    """
    table, maneuver = claim.table, claim.modified
    if table is maneuver:
        return []
    reduction = claim.reduction
    early, late = maneuver.t[0] - table.t[0], table.t[-1] - maneuver.t[-1]
    lengths = np.array([early - reduction.lead_in, late - reduction.lead_out])
    at_rest = np.array([[reduction.lead_in], [reduction.lead_out]]) > 0.0
    rates = np.where(at_rest, (table.rate_start[0], table.rate_end[-1]), 0.0)
    return [
        _none("leads.length", "difference of the leads' lengths [s]", lengths),
        _none("leads.rest", "rates at rest [rad/s]", rates),
        _none("leads.maneuver", "change of the maneuver by its leads", _off(table, maneuver)),
    ]


def _off(table: Motion, maneuver: Motion) -> Floats:
    """Return times, angles and rates of a table minus those of the maneuver in it."""
    n = len(maneuver.t)
    first = int(np.searchsorted(table.t, maneuver.t[0] - LEAD_TOLERANCE))
    if first + n > len(table.t):
        return np.array([np.inf])
    samples, steps = slice(first, first + n), slice(first, first + n - 1)
    return np.concatenate(
        [
            table.t[samples] - maneuver.t,
            (table.angle[samples] - maneuver.angle).ravel(),
            (table.rate_start[steps] - maneuver.rate_start).ravel(),
            (table.rate_end[steps] - maneuver.rate_end).ravel(),
        ]
    )


def _none(key: str, name: str, off: Floats) -> Check:
    return Check(key, name, float(np.max(np.abs(off))), LEAD_TOLERANCE)
