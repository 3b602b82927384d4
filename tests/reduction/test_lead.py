"""Leads: from rest to the maneuver and back, smooth, inside the limits, or a sufficient time."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.reduction.executable import nearest_executable
from des_cli.reduction.lead import add_leads
from des_cli.reduction.limits import find_violations


@pytest.fixture(scope="module")
def maneuver(cobra):
    """The Cobra inside the limits: the arm turns at both ends, and gains speed."""
    return nearest_executable(DES, cobra(500))[0]


@pytest.mark.parametrize(("lead_in", "lead_out"), [(4.0, 3.0), (5.0, 0.0), (0.0, 2.51)])
def test_the_maneuver_keeps_its_times_angles_and_rates(maneuver, lead_in, lead_out):
    led = add_leads(DES, maneuver, lead_in, lead_out)
    assert led.trouble == ""
    motion = led.motion
    first = int(np.searchsorted(motion.t, maneuver.t[0]))
    inside = slice(first, first + len(maneuver.t))
    np.testing.assert_array_equal(motion.t[inside], maneuver.t)
    np.testing.assert_allclose(motion.angle[inside], maneuver.angle, rtol=0, atol=1e-15)
    intervals = slice(first, first + len(maneuver.t) - 1)
    np.testing.assert_array_equal(motion.rate_start[intervals], maneuver.rate_start)
    np.testing.assert_array_equal(motion.rate_end[intervals], maneuver.rate_end)
    assert motion.t[0] == pytest.approx(maneuver.t[0] - lead_in)
    assert motion.t[-1] == pytest.approx(maneuver.t[-1] + lead_out)
    # about the maneuver's own step, never a longer one
    assert np.diff(motion.t).max() <= np.diff(maneuver.t).max() * (1.0 + 1e-9)


def test_without_leads_nothing_changes(maneuver):
    led = add_leads(DES, maneuver, 0.0, 0.0)
    assert led.motion is maneuver
    assert led.trouble == ""


def test_it_starts_and_ends_at_rest_and_joins_rate_and_acceleration(maneuver):
    motion = add_leads(DES, maneuver, 4.0, 3.0).motion
    assert np.abs(maneuver.rate_start[0]).max() > 0.5  # it has somewhere to come from
    for rate in (motion.rate_start[0], motion.rate_end[-1]):
        np.testing.assert_array_equal(rate, 0.0)
    # at rest it has no acceleration either, to first order in the step
    joints = np.array([limit.acceleration for limit in DES.limits])
    for acceleration in (motion.acceleration[0], motion.acceleration[-1]):
        assert (np.abs(acceleration) < 0.05 * joints).all()
    # no rate steps anywhere, and the acceleration goes on where the lead meets the maneuver
    assert np.abs(motion.rate_step).max() == 0.0
    step = float(np.diff(maneuver.t).max())
    for time, inner in ((maneuver.t[0], 0), (maneuver.t[-1], -1)):
        join = int(np.searchsorted(motion.t, time))
        jump = motion.acceleration[join] - motion.acceleration[join - 1]
        jerk = [limit.jerk for limit in DES.limits]
        assert (np.abs(jump) <= np.multiply(jerk, step)).all()
        own = motion.acceleration[join if inner == 0 else join - 1]
        np.testing.assert_array_equal(own, maneuver.acceleration[inner])


def test_angles_are_the_integrals_of_the_rates(maneuver):
    motion = add_leads(DES, maneuver, 4.0, 3.0).motion
    moved = 0.5 * np.diff(motion.t)[:, None] * (motion.rate_start + motion.rate_end)
    np.testing.assert_allclose(np.diff(motion.angle, axis=0), moved, rtol=0, atol=1e-9)


def test_every_limit_is_kept(maneuver):
    assert find_violations(DES, maneuver, "modified") == ()
    assert find_violations(DES, add_leads(DES, maneuver, 4.0, 3.0).motion, "modified") == ()


def part_of(motion, first, last):
    """A maneuver that begins and ends in the midst of another."""
    return Motion(
        motion.t[first : last + 1],
        motion.angle[first : last + 1],
        motion.rate_start[first:last],
        motion.rate_end[first:last],
    )


@pytest.mark.parametrize("last", [500, 451, 402, 353, 304])
@pytest.mark.parametrize(("name", "leads"), [("lead_in_s", (1, 0)), ("lead_out_s", (0, 1))])
def test_too_short_a_lead_is_told_with_a_time_that_suffices(maneuver, name, leads, last):
    motion = part_of(maneuver, 500 - last, last)
    trouble = add_leads(DES, motion, *(0.1 * lead for lead in leads)).trouble
    found = re.fullmatch(rf"{name}: in 0.1 s the (.+) cannot .+; in (\S+) s it can", trouble)
    assert found
    assert "arm" in found[1]
    told = float(found[2])
    enough = add_leads(DES, motion, *(told * lead for lead in leads))
    assert enough.trouble == ""
    assert find_violations(DES, enough.motion, "modified") == ()
    # and it is not far from the shortest
    assert add_leads(DES, motion, *(0.97 * told * lead for lead in leads)).trouble


def test_a_joint_that_no_lead_brings_to_rest_is_told(maneuver):
    # The fork's angle is all but used up where it still turns: any lead goes on through it.
    turning = part_of(maneuver, 0, 125)
    reach = float(np.abs(turning.angle[:, 1]).max()) + 1e-3
    tight = replace(DES.limits[1], angle=reach)
    machine = replace(DES, limits=(DES.limits[0], tight, DES.limits[2]))
    assert find_violations(machine, turning, "modified") == ()
    trouble = add_leads(machine, turning, 0.0, 3.0).trouble
    assert trouble.startswith("lead_out_s: in 3 s the fork cannot keep its limits (")
    assert trouble.endswith("; no lead does")
    assert "modified fork angle" in trouble
