"""Every maneuver that is shipped: it loads from anywhere and keeps the machine's limits."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from des_cli.kinematics.commanded_motion import make_desired
from des_cli.kinematics.response import respond
from des_cli.model.profile import BodyRates, JointCommands, Reduction
from des_cli.profiles_in.builtin import builtin_profiles
from des_cli.profiles_in.load import load_profile
from des_cli.reduction.desired import find_desired

NAMES = [profile.name for profile in builtin_profiles()]
COBRAS = {"cobra", "cobra_felt", "cobra_table3"}


def test_the_shipped_maneuvers_are_these() -> None:
    assert {
        "barrel_roll", "climbing_turn_rates", "cobra", "cobra_felt", "cobra_table3",
        "flight_log", "g_air_combat", "g_flight", "g_gradual_onset", "g_rapid_onset",
        "gradual_onset", "post_stall_reversal", "rapid_onset", "rolling_spin",
        "slalom",
    } <= set(NAMES)  # fmt: skip
    assert sorted(NAMES) == NAMES


@pytest.mark.parametrize("profile", builtin_profiles(), ids=NAMES)
def test_each_says_in_one_line_what_it_shows(profile) -> None:  # type: ignore[no-untyped-def]
    assert profile.path.is_file()
    assert 20 < len(profile.summary) < 110
    assert profile.summary.isprintable()
    assert profile.summary.endswith(".")


@pytest.mark.parametrize("name", NAMES)
def test_each_loads_by_its_name_from_any_folder(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    profile = load_profile(name)
    assert profile.name == name
    assert len(profile.t) >= 300


@pytest.mark.parametrize("name", NAMES)
def test_each_is_a_maneuver_with_coriolis_within_the_limits(name: str) -> None:
    profile = load_profile(name)
    desired = find_desired(profile)
    motion = desired.motion
    response = respond(profile.machine, profile.seat, motion)
    assert np.abs(response.coriolis_seat).max() > 0.05
    assert not desired.damped.any()
    for joint, limit in enumerate(profile.machine.limits):
        assert np.abs(motion.angle[:, joint]).max() <= limit.angle
        assert np.abs(motion.rate_sides[..., joint]).max() <= limit.rate
        assert np.abs(motion.acceleration[:, joint]).max() <= limit.acceleration
        if name not in COBRAS:
            assert np.abs(motion.rate_step[:, joint]).max() < 1e-6


def test_a_file_of_that_name_does_not_stand_for_the_built_in_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "cobra").write_text("t_s,arm_rpm,fork_deg,cab_deg\n0,1,2,3\n1,2,3,4\n")
    monkeypatch.chdir(tmp_path)
    assert len(load_profile("./cobra").t) == 2
    assert len(load_profile(Path("cobra")).t) == 2
    built_in = load_profile("cobra")
    assert len(built_in.t) == 1001
    what = "cobra is the built-in profile; the file of this name here is ./cobra"
    assert what in built_in.remarks


def test_every_kind_of_input_has_an_example() -> None:
    kinds = {profile.path.suffix for profile in builtin_profiles()}
    assert kinds == {".yaml", ".csv"}
    assert isinstance(load_profile("slalom").command, JointCommands)
    assert isinstance(load_profile("climbing_turn_rates").command, BodyRates)
    assert isinstance(load_profile("barrel_roll").command, BodyRates)
    assert "samples:" in (builtin_profiles()[NAMES.index("flight_log")]).path.read_text()


def test_the_felt_cobra_is_the_studys_maneuver_with_what_a_silent_profile_gets() -> None:
    felt, study = load_profile("cobra_felt"), load_profile("cobra")
    for each in fields(Reduction):
        ours, silent = (getattr(r, each.name) for r in (felt.reduction, Reduction()))
        assert np.array_equal(ours, silent), each.name
    motion, theirs = make_desired(felt).motion, make_desired(study).motion
    for name in ("t", "angle", "rate_start", "rate_end"):
        np.testing.assert_array_equal(getattr(motion, name), getattr(theirs, name))


def test_the_gradual_onset_is_0_1_g_a_second_along_the_spine() -> None:
    profile = load_profile("gradual_onset")
    motion = make_desired(profile).motion
    g = respond(profile.machine, profile.seat, motion).seat_g[:, 0, 2]
    # The seat sits a little outside the gimbals' centre, hence the six percent.
    np.testing.assert_allclose(g, 1.4 + 0.1 * motion.t[:-1], rtol=0.07)


def test_table_3_has_the_rates_that_the_study_prints() -> None:
    profile = load_profile("cobra_table3")
    command, t = profile.command, profile.t
    assert isinstance(command, JointCommands)
    arm = np.where(t < 5, 2.5 - 0.24 * t, 1.3 + 0.24 * (t - 5))
    np.testing.assert_allclose(command.arm_rate, arm, rtol=1e-14)
    fork = -(np.pi**2) / 15 * np.sin(np.pi * t[:-1] / 5)
    np.testing.assert_allclose(command.rate_start[:, 0], fork, atol=1e-14)
    np.testing.assert_allclose(command.rate_start[:, 1], np.where(t[:-1] < 5, -0.105, 0.105))
