"""Conditioning of a record: trim, axes, resample, smooth."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from des_cli.errors import ProfileError
from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.profile import BodyRates, JointCommands, Profile
from des_cli.profiles_in.load import load_profile

HZ = 50
T = np.arange(0, 201) / HZ


def table(header: str, *columns: np.ndarray) -> str:
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return header + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows)


RATES = table(
    "t_s,p_rad_s,q_rad_s,r_rad_s", T, 0.1 * np.sin(T), 0.2 * np.cos(T), 0.05 + 0.3 * np.sin(2 * T)
)
JOINTS = table("t_s,arm_rad_s,fork_rad,cab_rad", T, 1 + 0 * T, 0.3 * np.sin(T), 0.1 * T)


def load(text: str, *settings: str) -> Profile:
    return load_profile("-", stdin=text.encode(), settings=settings)


def problem_of(text: str, *settings: str) -> str:
    with pytest.raises(ProfileError) as caught:
        load(text, *settings)
    (problem,) = caught.value.complaints
    return str(problem)


def at_samples(profile: Profile) -> np.ndarray:
    assert isinstance(profile.command, BodyRates)
    return np.concatenate([profile.command.start, profile.command.end[-1:]])


def test_trim_keeps_the_rows_between_two_times() -> None:
    whole = load(RATES)
    profile = load(RATES, "trim={from_s: 0.99, to_ms: 2000}")
    np.testing.assert_array_equal(profile.t, T[50:101])
    np.testing.assert_array_equal(at_samples(profile), at_samples(whole)[50:101])
    assert profile.remarks == ("trim: 51 of 201 rows kept, 1 to 2 s",)
    assert load(RATES, "trim.from_s=3").t[0] == 3.0
    assert load(RATES, "trim.from_s=0").remarks == ()


def test_axes_turn_rates_and_attitude_to_the_seat_s_axes() -> None:
    # p = y, q = -x, r = z: a proper rotation that is no diagonal
    profile = load(RATES, "axes={p: y, q: -x, r: z}")
    recorded = at_samples(load(RATES))
    want = np.column_stack([recorded[:, 1], -recorded[:, 0], recorded[:, 2]])
    np.testing.assert_array_equal(at_samples(profile), want)


def test_axes_turn_an_attitude_as_they_turn_its_rates() -> None:
    rates = load(RATES)
    turned = [Rotation.identity()]
    for k in range(len(T) - 1):
        turned.append(turned[-1] * Rotation.from_rotvec(rates.command.middle[k] / HZ))
    attitude = Rotation.concatenate(turned).as_quat()
    columns = [line.split(",") for line in RATES.splitlines()[1:]]
    both = table(
        "t_s,p_rad_s,q_rad_s,r_rad_s,q1,q2,q3,q0",
        *np.array(columns, dtype=float).T,
        *attitude.T,
    )
    settings = ("axes={p: y, q: -x, r: z}", "initial.fork_deg=10")
    compared = make_desired(load(both, *settings)).recorded_attitude_error
    assert compared is not None
    assert compared < 1e-4
    alone = load(table("t_s,q1,q2,q3,q0", T, *attitude.T), settings[0])
    want = at_samples(load(RATES, settings[0]))
    np.testing.assert_allclose(at_samples(alone)[5:-5], want[5:-5], atol=2e-4)


@pytest.mark.parametrize(
    ("axes", "words"),
    [
        ("{p: x, q: y, r: -z}", "axes: is a reflection, which no turn of the body makes"),
        ("{p: y, q: x, r: z}", "axes: is a reflection"),
        ("{p: x, q: x, r: z}", "axes: must name each of x, y and z once"),
        ("{p: x, q: -w, r: z}", "axes.q: must be x, y, z, -x, -y or -z, is '-w'"),
    ],
)
def test_axes_that_are_no_turn_are_refused(axes: str, words: str) -> None:
    assert words in problem_of(RATES, f"axes={axes}")


def test_resampling_follows_the_motion_on_an_even_grid() -> None:
    uneven = np.sort(np.concatenate([T, T[:-1:5] + 0.007]))
    text = table("t_s,arm_rad_s,fork_rad,cab_rad", uneven, np.cos(uneven), np.sin(uneven), uneven)
    profile = load(text, "resample.step_ms=16")
    t = profile.t
    np.testing.assert_allclose(t, 0.016 * np.arange(251), atol=1e-12)
    command = profile.command
    assert isinstance(command, JointCommands)
    np.testing.assert_allclose(command.arm_rate, np.cos(t), atol=2e-4)
    want = np.column_stack([np.sin(t), t])
    np.testing.assert_allclose(command.position, want, atol=2e-4)
    assert profile.remarks == ("resample: 241 rows made 251, one every 0.016 s",)


def test_resampling_does_not_swing_beyond_a_step_of_the_record() -> None:
    step = np.where(T < 2, 0.0, 0.5)
    text = table("t_s,p_rad_s,q_rad_s,r_rad_s", T, step, 0 * T, 0 * T)
    p = at_samples(load(text, "resample.step_s=0.003"))[:, 0]
    assert p.min() == 0.0
    assert p.max() == 0.5


def test_a_longer_step_is_told_with_what_is_lost() -> None:
    (remark,) = load(RATES, "resample.step_s=0.15").remarks
    assert remark.startswith("resample: 201 rows made 27, one every 0.15 s, to 3.9 of 4 s;")
    assert "usual step is 0.02 s: what is faster than 3.33 Hz is lost" in remark
    assert "smooth" in remark


def test_resampling_comes_after_the_trim() -> None:
    profile = load(RATES, "resample.step_s=0.5", "trim.from_s=1.02")
    np.testing.assert_allclose(profile.t, 1.02 + 0.5 * np.arange(6))
    assert [remark.partition(":")[0] for remark in profile.remarks] == ["trim", "resample"]


def test_an_attitude_is_resampled_along_the_shortest_turns() -> None:
    turn = Rotation.from_rotvec(np.column_stack([0.4 * T, 0 * T, 0 * T])).as_quat()
    turn[::2] *= -1
    text = table("t_s,q1,q2,q3,q0", T, *turn.T)
    profile = load(text, "resample.step_s=0.03")
    assert len(profile.t) == 134
    np.testing.assert_allclose(at_samples(profile), [[0.4, 0, 0]] * 134, atol=1e-9)


def test_the_smoothing_is_only_noted_for_the_record_stays_the_reference() -> None:
    profile = load(RATES, "smooth.cutoff_hz=2")
    assert profile.smooth_cutoff_hz == 2.0
    np.testing.assert_array_equal(at_samples(profile), at_samples(load(RATES)))
    assert load(RATES).smooth_cutoff_hz == math.inf


@pytest.mark.parametrize(
    ("text", "setting", "words"),
    [
        (RATES, "trim={from_s: 3.99}", "<stdin>: trim: leaves 1 of 201 rows, two are needed"),
        (RATES, "trim={from_s: 2, to_s: 1}", "trim.to_s: must be greater than from_s (2)"),
        (RATES, "trim={}", "trim: keeps everything: give from_s, to_s or both"),
        (RATES, "resample={}", "the time between samples is missing: give step_s"),
        (RATES, "resample.step_s=5", "resample.step_s: makes fewer than 2 samples: the record las"),
        (RATES, "resample.step_s=1e-9", "makes more than 1000000 samples"),
        (RATES, "resample.step_s=-1", "resample.step_s: must be greater than 0, is -1"),
        (RATES, "smooth.cutoff_hz=25", "smooth.cutoff_hz: 25 Hz is not below 25 Hz"),
        (RATES, "smooth.cutoff_hz=0.4", "smooth.cutoff_hz: a cutoff of 0.4 Hz needs a record of 5"),
        (
            RATES,
            "smooth={cutoff_hz: 2, order: 3}",
            "smooth.order: is not a key here; there are cut",
        ),
        (JOINTS, "axes={p: x, q: -y, r: -z}", "axes: is for body rates or an attitude; these are"),
    ],
)
def test_what_cannot_be_done_is_refused_in_words(text: str, setting: str, words: str) -> None:
    assert words in problem_of(text, setting)


def test_a_yaml_profile_conditions_its_samples(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text(RATES)
    path = tmp_path / "log.yaml"
    path.write_text(
        "format: des-coriolis/1\nsamples: {file: log.csv}\ntrim: {from_s: 1}\n"
        "axes: {p: x, q: -y, r: -z}\nresample: {step_s: 0.1}\nsmooth: {cutoff_hz: 1.5}\n"
    )
    profile = load_profile(path)
    assert (profile.t[0], len(profile.t), profile.smooth_cutoff_hz) == (1.0, 31, 1.5)
    np.testing.assert_allclose(at_samples(profile)[:, 1], -0.2 * np.cos(profile.t), atol=1e-4)
    assert len(profile.remarks) == 2


def test_expressions_are_not_conditioned_but_may_be_smoothed() -> None:
    text = (
        "format: des-coriolis/1\ntime: {start_s: 0, stop_s: 3, step_s: 0.1}\n"
        'body_rates: {p_rad_s: 0, q_rad_s: "0.1*sin(t)", r_rad_s: 0}\n'
    )
    assert problem_of(text, "trim.from_s=1") == (
        "--set trim.from_s=1: trim: is for samples; "
        "the commands below body_rates say by themselves what is flown"
    )
    assert load(text, "smooth.cutoff_hz=2").smooth_cutoff_hz == 2.0
