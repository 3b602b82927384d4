"""What the joints do, beside their limits."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machine import JOINTS
from des_cli.model.machines import DES
from des_cli.pipeline import reduce_profile
from tests.support.sway import reduced_sway, sway


@pytest.fixture
def run():
    return reduced_sway()


def test_jerk_and_sign_changes(run):
    for which, motion in (("desired", run.asked.motion), ("modified", run.solution.modified)):
        for j, joint in enumerate(JOINTS):
            found = run.metrics["limits"][which][joint]
            middle = 0.5 * (motion.t[1:] + motion.t[:-1])
            slope = np.diff(motion.acceleration[:, j]) / np.diff(middle)
            smooth = np.abs(motion.rate_start[1:, j] - motion.rate_end[:-1, j]) < 1e-9
            assert smooth.all() == (joint != "cab")
            assert found["jerk_peak_rad_s3"] == pytest.approx(np.abs(slope[smooth]).max())
            assert found["acceleration_sign_changes"] == changes(
                motion.acceleration[:, j], 0.01 * DES.limits[j].acceleration
            )
    # a cosine's rate: its acceleration is a sine, up and down within 6 s
    assert run.metrics["limits"]["desired"]["arm"]["acceleration_sign_changes"] == 1


def changes(values, least):
    last, count = 0.0, 0
    for value in values:
        if abs(value) > least:
            count += last * value < 0.0
            last = value
    return count


def test_a_machine_without_a_jerk_limit_has_none():
    limits = tuple(replace(limit, jerk=math.inf) for limit in DES.limits)
    profile = replace(sway(60), machine=replace(DES, limits=limits))
    found = reduce_profile(profile).metrics["limits"]["modified"]
    assert all(found[joint]["jerk_limit_rad_s3"] is None for joint in JOINTS)
    limits = tuple(replace(limit, jerk=7.5) for limit in DES.limits)
    profile = replace(profile, machine=replace(DES, limits=limits))
    found = reduce_profile(profile).metrics["limits"]["modified"]
    assert all(found[joint]["jerk_limit_rad_s3"] == 7.5 for joint in JOINTS)


def test_the_time_at_the_acceleration_limit(run):
    motion = run.solution.modified
    for j, joint in enumerate(JOINTS):
        full = np.abs(motion.acceleration[:, j]) >= 0.99 * DES.limits[j].acceleration
        share = sum(motion.step[full]) / 6.0
        found = run.metrics["limits"]["modified"][joint]["at_acceleration_limit"]
        assert found == pytest.approx(share)


def test_limits(run):
    for which, motion in (("desired", run.desired), ("modified", run.solution.modified)):
        for j, joint in enumerate(JOINTS):
            found = run.metrics["limits"][which][joint]
            peak = max(np.abs(motion.rate_start[:, j]).max(), np.abs(motion.rate_end[:, j]).max())
            assert found["rate_peak_rad_s"] == pytest.approx(peak)
            assert found["rate_limit_rad_s"] == DES.limits[j].rate
            assert found["acceleration_limit_rad_s2"] == DES.limits[j].acceleration
            named = {(v.motion, v.joint) for v in run.violations}
            assert found["ok"] is ((which, joint) not in named)
    # the cab turns back at once, which no limit admits
    assert run.metrics["limits"]["desired"]["cab"]["ok"] is False
