"""An asked G as users write it: onsets, commands, columns, and what is wrong with them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from des_cli.errors import ProfileError
from des_cli.kinematics.smoothing import smooth_command
from des_cli.model.profile import GCommand, Profile
from des_cli.profiles_in.load import load_profile

ONSETS = """\
format: des-coriolis/1
name: run
g:
  gz_g:
    - {hold_g: 1.4, hold_s: 5}
    - {to_g: 9, onset_g_s: 0.1, hold_s: 10}
    - {to_g: 1.4, onset_g_s: 0.5, hold_s: 5}
"""


def load(text: str, *settings: str) -> Profile:
    return load_profile("-", stdin=text.encode(), settings=settings)


def command_of(profile: Profile) -> GCommand:
    assert isinstance(profile.command, GCommand)
    return profile.command


def problems_of(text: str, *settings: str) -> list[str]:
    with pytest.raises(ProfileError) as caught:
        load(text, *settings)
    return [str(problem) for problem in caught.value.complaints]


def test_onsets_make_ramps_holds_and_their_times() -> None:
    profile = load(ONSETS)
    t, asked = profile.t, command_of(profile)
    assert (t[0], t[-1]) == (0.0, 111.2)
    assert np.diff(t).max() == pytest.approx(0.02)
    corners = ((0, 1.4), (5, 1.4), (81, 9), (91, 9), (106.2, 1.4), (111.2, 1.4))
    expected = np.interp(t, *np.array(corners).T)
    np.testing.assert_allclose(asked.start[:, 2], expected[:-1], atol=1e-12)
    np.testing.assert_allclose(asked.end[:, 2], expected[1:], atol=1e-12)
    assert not asked.start[:, :2].any()
    assert {5.0, 81.0, 91.0, 106.2} <= set(t)


def test_the_time_section_says_what_it_wants_to() -> None:
    profile = load(ONSETS + "time: {start_s: -5, step_ms: 50, stop_min: 2}\n")
    assert (profile.t[0], profile.t[1], profile.t[-1]) == (-5.0, -4.95, 120.0)
    command = command_of(profile)
    assert command.end[-1, 2] == 1.4
    assert command.start[profile.t[:-1] == 0.0, 2] == pytest.approx(1.4)
    short = load(ONSETS + "time: {stop_s: 43}\n")
    assert command_of(short).end[-1, 2] == pytest.approx(5.2)


def test_components_are_commands_like_any_other() -> None:
    text = ONSETS + '  gx_g: "0.2*sin(t)"\n  gy_g: [{from_s: 0, to_s: 200, value: 0.1}]\n'
    profile = load(text)
    command = command_of(profile)
    np.testing.assert_allclose(command.start[:, 0], 0.2 * np.sin(profile.t[:-1]), atol=1e-15)
    assert set(command.start[:, 1]) == {0.1}
    stepped = command_of(
        load(
            "format: des-coriolis/1\ntime: {stop_s: 2}\n"
            "g: {gz_g: [{from_s: 0, to_s: 1, value: 2}, {from_s: 1, to_s: 2, value: 3}]}\n"
        )
    )
    assert (stepped.end[49, 2], stepped.start[50, 2]) == (2.0, 3.0)


def test_rates_beside_the_g() -> None:
    command = command_of(load(ONSETS + '  p_deg_s: "t"\n  washout_s: 3\n'))
    assert command.washout == 3.0
    assert command.rates is not None
    assert command.rates.end[0, 0] == pytest.approx(np.radians(0.02))
    assert command.rates.middle[0, 0] == pytest.approx(np.radians(0.01))
    assert not command.rates.start[:, 1:].any()
    assert command_of(load(ONSETS)).rates is None


@pytest.mark.parametrize(
    ("lines", "place", "words"),
    [
        ("gz: 3", "g.gz", "did you mean"),
        ("gz_g: 3", "", "time is missing"),
        ("washout_s: 3", "g.washout_s", "washes out nothing"),
        ("washout_s: 3", "g", "asks for no G"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(lines: str, place: str, words: str) -> None:
    found = problems_of(f"format: des-coriolis/1\ng:\n  {lines}\n")
    assert any(place in problem and words in problem for problem in found), found


def test_beyond_any_machine_and_beside_other_commands() -> None:
    (found,) = problems_of("format: des-coriolis/1\ntime: {stop_s: 5}\ng: {gz_g: 'exp(t)'}\n")
    assert "beyond 100 g at t = 4.6" in found
    both = problems_of(ONSETS + "joints: {arm_rpm: 1, fork_deg: 0, cab_deg: 0}\n")
    assert any("keep one of them" in problem for problem in both)
    (found,) = problems_of(ONSETS + "initial: {arm_deg: 3, cab_deg: 4}\n")
    assert "the cab starts where the first G asks" in found
    (found,) = problems_of(ONSETS + "time: {stop_s: -1}\n")
    assert "time.stop_s: must be greater than 0 s" in found


def test_joints_still_need_their_times() -> None:
    text = "format: des-coriolis/1\njoints: {arm_rpm: 1, fork_deg: 0, cab_deg: 0}\n"
    (found,) = problems_of(text + "time: {stop_s: 1, step_s: 0.1}\n")
    assert "the first time is missing: give start_s" in found


def test_columns_of_a_csv_file() -> None:
    profile = load("t_s,gz_g,gx_g,p_deg_s\n0,1.4,0,0\n1,3,0.1,10\n1.01,3,0.1,10\n")
    command = command_of(profile)
    # rows a second apart are filled in by a straight line
    assert len(profile.t) == 52
    np.testing.assert_allclose(command.start[:, 2], np.interp(profile.t, [0, 1], [1.4, 3])[:-1])
    assert command.end[-1, 0] == pytest.approx(0.1)
    assert command.rates is not None
    assert command.rates.end[-1, 0] == pytest.approx(np.radians(10))


@pytest.mark.parametrize(
    ("header", "words"),
    [
        ("t_s,gz", "gz is a G and needs its unit in the name"),
        ("gz_g,gx_g", "a column is missing: t_s"),
        ("t_s,gz_g,arm_rpm", "both joint commands (arm) and G (gz)"),
        ("t_s,gz_g,r_deg_s", "no joint is left for r"),
    ],
)
def test_what_is_wrong_with_columns(header: str, words: str) -> None:
    row = ",".join(["1"] * len(header.split(",")))
    problems = problems_of(f"{header}\n{row}\n")
    assert any(words in problem for problem in problems), problems


def test_the_washout_of_recorded_rates_is_set_below_samples(tmp_path: Path) -> None:
    table = "t_s,gz_g,p_deg_s\n0,1.4,0\n1,3,10\n2,3,10\n"
    assert command_of(load(table)).washout == 2.0
    assert command_of(load(table, "samples.washout_ms=500")).washout == 0.5
    (tmp_path / "log.csv").write_text(table)
    path = tmp_path / "log.yaml"
    path.write_text("format: des-coriolis/1\nsamples: {file: log.csv, washout_s: 0.7}\n")
    assert command_of(load_profile(path)).washout == 0.7
    with pytest.raises(ProfileError, match="washout_s: washes out nothing: the samples are no G"):
        load("t_s,gz_g\n0,1.4\n1,3\n", "samples.washout_s=1")
    with pytest.raises(ProfileError, match="such as washout_s, is below samples"):
        load(table, "g.washout_s=0.5")


CORNERS = "t_s,gz_g\n0,1.3\n5,1.3\n5.1,1.33\n5.2,1.36\n5.3,1.39\n20,1.39\n"


def test_no_long_line_between_corners_of_g_is_a_gap_unless_gaps_are_asked_for() -> None:
    profile = load(CORNERS)
    assert (profile.t[-1], profile.remarks) == (20.0, ())
    (found,) = problems_of(CORNERS, "gap=refuse")[1:]
    assert "a gap of 14.7 s" in found
    assert len(load(CORNERS, "gap=bridge").remarks) == 2


def test_a_step_between_two_rows_of_g_stays_one() -> None:
    table = "t_s,gz_g\n0,1.3\n5,1.3\n{},4\n20,4\n"
    profile = load(table.format(5.001))
    step = np.flatnonzero(profile.t == 5.0)[0]
    assert profile.t[step + 1] == 5.001
    assert command_of(profile).end[step, 2] == pytest.approx(4.0)
    (found,) = problems_of(table.format(5.000001))
    assert "for a step there, move this row to t = 5.02 s" in found
    (found,) = problems_of("t_s,gz_g\n0,1.3\n5,1.3\n5.000001,4\n5.01,4\n20,4\n")
    assert found.endswith("remove one of the two rows")


def test_resampled_rows_of_g_stay_joined_by_straight_lines() -> None:
    table = "t_s,gz_g,p_deg_s\n0,1.3,0\n10,4,10\n20,1.3,0\n"
    profile = load(table, "resample={step_s: 0.05}")
    command = command_of(profile)
    slope = (command.end - command.start)[:, 2] / np.diff(profile.t)
    np.testing.assert_allclose(np.abs(slope), 0.27, atol=1e-9)
    assert command.rates is not None
    expected = np.radians(np.interp(profile.t, [0, 10, 20], [0, 10, 0]))
    np.testing.assert_allclose(command.rates.start[:, 0], expected[:-1], atol=1e-12)


def test_a_recorded_g_is_trimmed_resampled_and_smoothed() -> None:
    t = np.arange(0.0, 10.001, 0.05)
    gz = 2.0 + 0.3 * np.sin(0.5 * t)
    rows = "".join(f"{a:.2f},{b:.6f}\n" for a, b in zip(t, gz, strict=True))
    table = "t_s,gz_g\n" + rows
    profile = load(table, "trim={from_s: 2, to_s: 8}", "resample={step_s: 0.02}")
    assert (profile.t[0], profile.t[-1]) == (2.0, 8.0)
    expected = 2.0 + 0.3 * np.sin(0.5 * profile.t[:-1])
    np.testing.assert_allclose(command_of(profile).start[:, 2], expected, atol=1e-3)
    smooth = smooth_command(profile.t, profile.command, 2.0)
    assert isinstance(smooth, GCommand)
    np.testing.assert_allclose(smooth.start[:, 2], expected, atol=2e-3)
    with pytest.raises(ProfileError, match="an asked G"):
        load(table, "axes={p: x, q: -y, r: -z}")
