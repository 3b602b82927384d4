"""A maneuver of all joints, its reduction, and plain sums over it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.profile import JointCommands, Profile, Reduction
from des_cli.model.run import Run
from des_cli.pipeline import reduce_profile
from des_cli.study.closed_forms import closed_form_coriolis, closed_form_transform

WEIGHTS = Reduction(control="scalar", axes="seat", limits="warn", ends="free", budget=())


def sway(intervals=300):
    """A maneuver of all joints, whose cab turns back at once half-way: its rate steps."""
    t = np.linspace(0.0, 6.0, intervals + 1)
    first = t < 3.0 - 1e-9
    cab_rate = np.where(first, -0.06, 0.05)[:-1]
    fork_rate = -0.5 * np.sin(0.9 * t)
    position = np.stack(
        [0.5 / 0.9 * (np.cos(0.9 * t) - 1.0), 0.3 + np.where(first, -0.06 * t, 0.05 * t - 0.33)],
        axis=1,
    )
    command = JointCommands(
        arm_rate=0.8 - 0.1 * np.cos(t),
        position=position,
        rate_start=np.stack([fork_rate[:-1], cab_rate], axis=1),
        rate_end=np.stack([fork_rate[1:], cab_rate], axis=1),
    )
    reduction = replace(WEIGHTS, control="per-joint", r2=np.full(3, 0.2))
    return Profile("sway", t, command, DES, reduction=reduction, sha256="ab" * 32)


@cache
def reduced_sway() -> Run:
    """Its reduction, one for all tests."""
    return reduce_profile(sway())


def integral(motion, sides):
    """Trapezoids of values at both ends of every interval."""
    total = 0.0
    for k, h in enumerate(np.diff(motion.t)):
        total = total + 0.5 * h * (sides[k, 0] + sides[k, 1])
    return total


def on_sides(motion):
    """Angles and rates at both ends of every interval, (n - 1, 2, 3) each."""
    angle = np.stack([motion.angle[:-1], motion.angle[1:]], axis=1)
    return angle, np.stack([motion.rate_start, motion.rate_end], axis=1)


def frames(motion):
    """R_0^17 by the closed forms of (10)."""
    angle = on_sides(motion)[0]
    return closed_form_transform(DES.lengths, Seat(), angle)[..., :3, :3]


def coriolis_parts(motion):
    """Each part of the Coriolis vector by (22)-(24), on sides."""
    report = closed_form_coriolis(*on_sides(motion))
    seat = np.einsum("ksij,ksi->ksj", frames(motion), report)
    parts = dict(zip(("ab3", "bb3", "cb3"), np.moveaxis(report, -1, 0), strict=True))
    parts |= dict(zip(("seat_x", "seat_y", "seat_z"), np.moveaxis(seat, -1, 0), strict=True))
    return parts | {"vector": np.linalg.norm(report, axis=-1)}
