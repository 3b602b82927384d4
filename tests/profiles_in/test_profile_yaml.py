"""Whole profiles: the Cobra, units, segments, and middles."""

from __future__ import annotations

import numpy as np

from des_cli.model.machines import DES
from des_cli.model.profile import BodyRates, JointCommands
from des_cli.profiles_in.load import load_profile
from tests.support.cobra import cobra_intervals
from tests.support.profiles import SMALL, load


def test_the_cobra_is_the_study_s_equations_34_to_37() -> None:
    profile = load_profile("cobra")
    command, t = profile.command, profile.t
    assert isinstance(command, JointCommands)
    assert (profile.name, profile.machine, len(t)) == ("cobra", DES, 1001)
    angle, start, end = cobra_intervals(t)
    np.testing.assert_allclose(command.arm_rate[:-1], start[:, 0], rtol=1e-14)
    np.testing.assert_allclose(command.position, angle[:, 1:], rtol=1e-14, atol=1e-14)
    # The cab's rate steps at t = 5 s; the interval on either side keeps its own.
    assert t[500] == 5.0
    np.testing.assert_allclose(command.rate_start, start[:, 1:], rtol=1e-13, atol=1e-14)
    np.testing.assert_allclose(command.rate_end, end[:, 1:], rtol=1e-13, atol=1e-14)
    np.testing.assert_allclose(profile.initial_angle, [0, 0, np.pi / 6], atol=1e-15)
    reduction = profile.reduction
    assert (reduction.axes, reduction.control, reduction.limits) == ("report", "scalar", "warn")
    np.testing.assert_array_equal(reduction.r1, np.diag([0, 2, 0]))
    np.testing.assert_array_equal(reduction.r2, 1)


def test_any_unit_of_the_table_gives_the_same_profile() -> None:
    other = """\
format: des-coriolis/1
name: small
time: {start_ms: 0, stop_min: 0.03333333333333333, step_us: 500000}
joints: {arm_deg_s: 57.29577951308232, fork_rad: "pi/18*t", cab_rad: "pi/36"}
"""
    a, b = load(SMALL), load(other)
    np.testing.assert_allclose(a.t, b.t, rtol=1e-14)
    assert isinstance(a.command, JointCommands)
    assert isinstance(b.command, JointCommands)
    np.testing.assert_allclose(a.command.arm_rate, b.command.arm_rate, rtol=1e-14)
    np.testing.assert_allclose(a.command.position, b.command.position, rtol=1e-14)


def test_body_rates_have_exact_middles() -> None:
    text = """\
format: des-coriolis/1
time: {start_s: 0, stop_s: 1, step_s: 0.25}
initial: {arm_deg: 10, fork_deg: 20, cab_rad: 1}
body_rates: {p_deg_s: "exp(t)", q_rad_s: 0.5, r_rpm: [{from_s: 0, to_s: 1, value: "t**3"}]}
"""
    profile = load(text)
    assert isinstance(profile.command, BodyRates)
    middle = 0.5 * (profile.t[:-1] + profile.t[1:])
    for times, values in (
        (profile.t[:-1], profile.command.start),
        (middle, profile.command.middle),
        (profile.t[1:], profile.command.end),
    ):
        want = [np.radians(np.exp(times)), 0.5 + 0 * times, times**3 * np.pi / 30]
        np.testing.assert_allclose(values, np.column_stack(want), rtol=1e-14)
    assert profile.command.attitude is None
    np.testing.assert_allclose(profile.initial_angle, [*np.radians([10, 20]), 1])
    assert profile.name == "stdin"
