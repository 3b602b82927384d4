"""A free motion: budgets, bounds for the occupant and leads, each broken by itself."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.onset import largest_onset
from des_cli.kinematics.response import respond_on
from des_cli.model.machine import OccupantBounds
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion
from des_cli.reduction.fidelity import Deviation
from des_cli.verify.occupant import excesses
from tests.support.free_case import RATE, G, with_rates


@pytest.mark.parametrize(
    "metric",
    [
        G,
        RATE,
        "joint_deviation_relative",
        "joint_deviation_relative_squared",
        "seat_g_deviation_relative",
        "seat_angular_acceleration_deviation_relative",
        "seat_angular_acceleration_rms_error_rad_s2",
        "attitude_error_max_deg",
    ],
)
def test_a_budget_that_is_overspent_by_little(case, metric):
    chain = chain_of(DES, case.seat)
    measured = Deviation.between(
        case.asked, case.solution.modified, (chain, chain), DES.gravity
    ).value(metric)
    for share, broken in ((1.0 + 1e-7, False), (1.0 - 1e-7, True)):
        budget = (Budget(metric, share * measured),)
        assert (f"budget.{metric}" in case.failed(budget=budget)) is broken


def test_budgets_are_on_the_motion_that_was_asked_for(case):
    # the cab's rate steps in what was asked for, and not in the executable motion
    own = case.value(f"budget.{G}")
    assert own == pytest.approx(0.0, abs=1e-3)
    assert case.value(f"budget.{G}", asked=case.desired) != pytest.approx(own, abs=1e-4)


OCCUPANT = {
    "occupant.gx": ("gx", 0),
    "occupant.gy": ("gy", 1),
    "occupant.gz": ("gz", 2),
}


@pytest.mark.parametrize("key", OCCUPANT)
@pytest.mark.parametrize("side", ["least", "most"])
def test_a_component_of_g_beyond_its_bound_at_one_sample(case, key, side):
    name, axis = OCCUPANT[key]
    chain = chain_of(DES, case.seat)
    values = respond_on(chain, DES.gravity, case.solution.modified).seat_g[..., axis]
    for slack, broken in ((1e-6, False), (-1e-6, True)):
        bounds = (-np.inf, float(values.max()) + slack)
        if side == "least":
            bounds = (float(values.min()) - slack, np.inf)
        machine = replace(DES, occupant=OccupantBounds(**{name: bounds}))
        assert (key in case.failed(machine=machine)) is broken
        assert key not in {c.key for c in case.checks(machine=machine, limits="check")}


def test_onset_and_angular_acceleration_beyond_their_bounds(case):
    motion = case.solution.modified
    response = respond_on(chain_of(DES, case.seat), DES.gravity, motion)
    onset = float(np.max(largest_onset(motion.t, response.seat_g)))
    turning = float(np.max(np.linalg.norm(response.seat_angular_acceleration, axis=-1)))
    for share, broken in ((1.0 + 1e-6, False), (1.0 - 1e-6, True)):
        for key, bounds in (
            ("occupant.onset", OccupantBounds(g_onset=share * onset)),
            (
                "occupant.angular_acceleration",
                OccupantBounds(angular_acceleration=share * turning),
            ),
        ):
            assert (key in case.failed(machine=replace(DES, occupant=bounds))) is broken


def led(motion, seconds, last=0.0):
    """A motion that comes from rest in so many seconds, with the cosine's rates, (n, 3)."""
    t = np.concatenate([motion.t[0] - seconds + np.arange(0.0, seconds, 0.04), motion.t])
    share = 0.5 - 0.5 * np.cos(np.pi * (t - t[0])[:, None] / seconds)
    count = len(t) - len(motion.t)
    rate = np.vstack([motion.rate_start[0] * share[:count] + last, motion.rate])
    found = with_rates(t, np.zeros(3), rate)
    angle = found.angle + (motion.angle[0] - found.angle[count])
    angle[count:] = motion.angle
    return replace(found, angle=angle)


def test_a_table_with_a_lead(case):
    motion, lead = case.solution.modified, {"lead_in": 4.0, "limits": "warn"}
    assert case.failed(commands=led(motion, 4.0), **lead) == set()
    # faster than the machine may, though the maneuver itself is not
    failed = case.failed(commands=led(motion, 0.4), lead_in=0.4)
    assert {"limits.arm.acceleration", "limits.arm.jerk"} <= failed
    assert all(key.startswith("limits.") for key in failed)
    assert case.failed(commands=led(motion, 4.0), lead_in=5.0, limits="warn") == {"leads.length"}
    assert case.failed(commands=led(motion, 4.0, last=2e-9), **lead) == {"leads.rest"}
    table = led(motion, 4.0)
    angle = table.angle.copy()
    angle[150:, 0] += 1e-8
    failed = case.failed(commands=replace(table, angle=angle), **lead)
    assert failed == {"leads.maneuver", "dynamics.angles"}
    cut = led(replace_end(motion), 4.0)
    assert "leads.maneuver" in case.failed(commands=cut, **lead)
    angle[3, 1] = np.nan
    assert case.failed(commands=replace(table, angle=angle), **lead) == {"finite"}


def replace_end(motion):
    """The motion without its last interval."""
    return Motion(motion.t[:-1], motion.angle[:-1], motion.rate_start[:-1], motion.rate_end[:-1])


def test_onset_is_over_a_tenth_of_a_second_whatever_the_steps():
    # a ramp of 3 g/s, with a step of 0.01 g at a sample beside which another is very near
    t = np.array([0.0, 0.1, 0.2, 0.20001, 0.3, 0.4])
    motion = with_rates(t, np.zeros(3), np.zeros((6, 3)))
    g = np.zeros((3, 2 * 5))
    g[2] = 3.0 * np.concatenate([t[:-1], t[1:]])
    g[2, 3:5] += 0.01
    g[2, 7:] += 0.01
    felt = SimpleNamespace(g=g, turning=np.zeros((3, 10)))
    ((key, _, excess),) = excesses(OccupantBounds(g_onset=1.0), motion, felt)
    assert key == "onset"
    assert np.max(excess) == pytest.approx(3.1 - 1.0, abs=1e-6)
    assert np.min(excess) == pytest.approx(3.0 - 1.0, abs=1e-6)
