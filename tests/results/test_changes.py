"""What the steps from the record to the motion that is reduced cost."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.machine import JOINTS, JointLimits
from des_cli.model.metric import ANGULAR_ACCELERATION_ERROR, ATTITUDE_ERROR, SEAT_G_ERROR
from des_cli.model.motion import DesiredMotion, GOffset, Motion, Shortfall
from des_cli.results.changes import condition_metrics, executable_metrics
from tests.support.sway import coriolis_parts, integral, reduced_sway, sway

PROFILE = sway(60)
ASKED = make_desired(PROFILE)
RECORD = ASKED.motion
OFFSET = GOffset(0.1, 0.2, 1.0, 0.5, 0.4)


def slowed(share: float) -> Motion:
    """The record with a fork that moves less."""
    keep = np.array([1.0, share, 1.0])
    start = RECORD.angle[0]
    return Motion(
        RECORD.t,
        start + keep * (RECORD.angle - start),
        keep * RECORD.rate_start,
        keep * RECORD.rate_end,
    )


def short(offset: GOffset | None) -> DesiredMotion:
    """The record, short of a constant G-vector of 0.5 g and turned by 0.2 rad about x."""
    sides = (len(RECORD.t) - 1, 2, 3)
    missing = Shortfall(
        seat_rate=np.zeros(sides),
        seat_angular_acceleration=np.broadcast_to([0.0, 0.6, 0.8], sides),
        seat_g=np.broadcast_to([0.3, 0.0, -0.4], sides),
        attitude=np.broadcast_to([0.2, 0.0, 0.0], (len(RECORD.t), 3)),
    )
    return replace(ASKED, shortfall=missing, g_offset=offset)


def test_a_motion_that_is_not_replaced_costs_nothing() -> None:
    run = reduced_sway()
    assert run.metrics["executable"] == {
        "replaced": False,
        "breaks_limits": True,  # its cab's rate steps, and limits are only warned of
        "joint_change_relative": 0.0,
        "joint_change_max_rad": dict.fromkeys(JOINTS, 0.0),
        "seat_rate_deviation_relative": 0.0,
        "seat_g_rms_error_g": 0.0,
        "seat_angular_acceleration_rms_error_rad_s2": 0.0,
        "attitude_error_max_deg": 0.0,
        "coriolis_reduction": 0.0,
    }
    assert run.metrics["changes"] == {"damping": None, "machine": None, "smoothing": None}


@pytest.mark.parametrize(("offset", "step"), [(None, "damping"), (OFFSET, "machine")])
def test_a_shortfall_is_the_machine_s_where_g_is_asked_and_damping_elsewhere(
    offset: GOffset | None, step: str
) -> None:
    changes = condition_metrics(PROFILE, short(offset), RECORD)
    found = getattr(changes, step)
    assert [changes.damping, changes.machine, changes.smoothing].count(None) == 2
    assert found.value(SEAT_G_ERROR) == pytest.approx(0.5)
    assert found.value(ANGULAR_ACCELERATION_ERROR) == pytest.approx(1.0)
    assert found.value(ATTITUDE_ERROR) == pytest.approx(np.degrees(0.2))
    # the joints make what they make: nothing of them, or of their cross-coupling, is changed
    assert found.joint_change_relative == 0.0
    assert found.joint_change_max_rad == dict.fromkeys(JOINTS, 0.0)
    assert found.coriolis_reduction == 0.0


def test_smoothing_is_measured_from_the_record_to_its_target() -> None:
    target = slowed(0.9)
    changes = condition_metrics(PROFILE, ASKED, target)
    assert (changes.damping, changes.machine) == (None, None)
    found = changes.smoothing
    assert found is not None
    # the fork sinks by 0.5 / 0.9 (1 - cos) rad: a tenth of twice that at the most
    assert found.joint_change_max_rad == pytest.approx(
        {"arm": 0.0, "fork": 0.1 / 0.9, "cab": 0.0}, rel=1e-3
    )
    energies = [integral(RECORD, coriolis_parts(each)["vector"] ** 2) for each in (RECORD, target)]
    assert found.coriolis_reduction == pytest.approx(1.0 - energies[1] / energies[0], rel=1e-9)


def test_a_replaced_motion_is_told_with_its_cost() -> None:
    still = condition_metrics(PROFILE, ASKED, slowed(0.9)).smoothing
    found = executable_metrics(PROFILE, RECORD, slowed(0.9))
    assert found.replaced
    assert found.change == still


def test_whether_limits_are_broken_is_told_of_what_was_to_be_made() -> None:
    wide, turning = JointLimits(np.inf, 1e3, 1e3), np.array([0.1, 0.0, 0.0])
    rate = np.tile(turning, (60, 1))
    calm = Motion(RECORD.t, RECORD.t[:, None] * turning, rate, rate)
    free = replace(PROFILE, machine=replace(PROFILE.machine, limits=(wide,) * 3))
    # no limit admits the step of the record's cab rate
    assert executable_metrics(free, RECORD, calm).breaks_limits
    assert not executable_metrics(free, calm, RECORD).breaks_limits
    assert not executable_metrics(free, calm, calm).replaced
