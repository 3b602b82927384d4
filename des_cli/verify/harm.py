"""What of a ride a pilot would rather not have, measured from the rows of a command table.

The same is told of the solution by ``results.worse``. Here it is found anew, from what a
machine is going to play: a table that starts elsewhere, or shakes its occupant, is found
also where everything before it was wrong.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.command_table import CommandTable
from des_cli.model.felt import G_AXES, LEAST_START_ANGLE, LEAST_START_RATE, PEAK_SHARE, SHARE, Felt
from des_cli.model.machine import Machine, Seat
from des_cli.model.metric import UNFELT_ANGULAR_ACCELERATION
from des_cli.model.notice import Notice
from des_cli.verify.table import LEAST_ROWS, Ride, ride_of

LEAST_JUMP = 0.1
"""Growth of a jump of G [g] that is told: it is felt as a knock."""

STARTS = (
    ("arm", "rad/s", LEAST_START_RATE),
    ("fork", "rad", LEAST_START_ANGLE),
    ("cab", "rad", LEAST_START_ANGLE),
)
"""What a row says of each joint, its unit, and how much of a difference is worth telling."""


def find_harms(
    table: CommandTable, desired: CommandTable, machine: Machine, seat: Seat, told: Felt
) -> list[Notice]:
    """Return what the rows of a maneuver do to the occupant that the desired motion does not.

    Both are measured alike, by divided differences: a step of a rate counts in both.

    Parameters
    ----------
    table : CommandTable
        Of the maneuver, without leads.
    desired : CommandTable
        Rows that would play the desired motion.
    machine, seat : Machine, Seat
    told : Felt
        The metrics, for the onset of G that is told.

    Returns
    -------
    list of Notice
        ``turning`` and ``g-jump``, those that there are.
    """
    if len(table.t) < LEAST_ROWS or len(desired.t) < LEAST_ROWS:
        return []
    ride, before = ride_of(table, machine, seat), ride_of(desired, machine, seat)
    return [*_turning(ride, before), *_jump(ride, before, told)]


def find_start(start: Floats, table: CommandTable, freed: Collection[str] = ()) -> Iterator[Notice]:
    """Say where a maneuver does not start as its profile does, by the notice ``start``.

    Parameters
    ----------
    start : (3,) array
        The arm's rate [rad/s], fork and cab [rad].
    table : CommandTable
        Of the maneuver, without leads.
    freed : collection of str
        Constants that were to be found, ``fork_start``: these may differ.
    """
    told = [
        f"{joint} {off:+.3g} {unit}"
        for joint, unit, off, least in start_offsets(start, table)
        if abs(off) > least and f"{joint}_start" not in freed
    ]
    if told:
        yield Notice("start", f"the table does not start where the profile does: {', '.join(told)}")


def start_offsets(start: Floats, table: CommandTable) -> list[tuple[str, str, float, float]]:
    """Compare the first row with where a machine or a profile begins.

    Parameters
    ----------
    start : (3,) array
        The arm's rate [rad/s], fork and cab [rad]; what is not a number is not known.
    table : CommandTable

    Returns
    -------
    list of (joint, unit, offset, least)
        Of what is known; ``least`` is the offset that is worth telling.
    """
    off = table.values[0, 1:] - start
    return [
        (joint, unit, float(value), least)
        for (joint, unit, least), value in zip(STARTS, off, strict=True)
        if np.isfinite(value)
    ]


def _turning(ride: Ride, before: Ride) -> Iterator[Notice]:
    grown = [
        f"{name} {was:.3g} -> {found:.3g}"
        for name, was, found, share in (
            ("rms", before.turning_rms, ride.turning_rms, SHARE),
            ("peak", before.turning_peak, ride.turning_peak, PEAK_SHARE),
        )
        if found - was > max(share * was, UNFELT_ANGULAR_ACCELERATION)
    ]
    if grown:
        what = "the table turns the seat harder than the desired motion: total angular acceleration"
        yield Notice("turning", f"{what} {', '.join(grown)} rad/s^2")


def _jump(ride: Ride, before: Ride, told: Felt) -> Iterator[Notice]:
    onset = float(np.linalg.norm([told.seat_g[axis].onset.after or 0.0 for axis in G_AXES]))
    found, was = _largest_jump(ride, onset), _largest_jump(before, onset)
    if found - was > LEAST_JUMP:
        what = "the G of the table jumps where that of the desired motion does not"
        yield Notice("g-jump", f"{what}, by {found:.2g} g against {was:.2g} g")


def _largest_jump(ride: Ride, onset: float) -> float:
    """Return the largest change of G beside what an onset [g/s] explains [g].

    A step of an acceleration at a row shows in the divided differences on both sides of it:
    so the change is taken over two intervals.
    """
    mean = ride.mean_g
    change = np.linalg.norm(mean[:, 2:] - mean[:, :-2], axis=0)
    return float(np.max(change - onset * (ride.t[2:] - ride.t[:-2]), initial=0.0))
