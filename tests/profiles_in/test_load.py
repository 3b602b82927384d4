"""Whole profiles: the Cobra, every refusal in words, and where profiles come from."""

from __future__ import annotations

import json
import os
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from des_cli.errors import FileAccessError, ProfileError, UsageError
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.profile import BodyRates, JointCommands, Profile, Reduction
from des_cli.profiles_in.builtin import builtin_profiles
from des_cli.profiles_in.load import load_profile

SMALL = """\
format: des-coriolis/1
name: small
time: {start_s: 0, stop_s: 2, step_s: 0.5}
joints:
  arm_rad_s: 1
  fork_deg: "10*t"
  cab_deg: 5
"""


def load(text: str, *settings: str) -> Profile:
    return load_profile("-", stdin=text.encode(), settings=settings)


def problems_of(text: str, *settings: str) -> list[str]:
    with pytest.raises(ProfileError) as caught:
        load(text, *settings)
    return [str(problem) for problem in caught.value.problems]


def test_the_cobra_is_the_study_s_equations_34_to_37() -> None:
    profile = load_profile("cobra")
    command, t = profile.command, profile.t
    assert isinstance(command, JointCommands)
    assert (profile.name, profile.machine, len(t)) == ("cobra", DES, 1001)
    early = t < 5
    rpm, degree = 2 * np.pi / 60, np.pi / 180
    arm = np.where(early, 8.8 - 0.66 * t, 5.5 + 0.66 * (t - 5)) * rpm
    np.testing.assert_allclose(command.arm_rate, arm, rtol=1e-14)
    np.testing.assert_allclose(
        command.position[:, 0], -np.pi / 3 * (1 - np.cos(np.pi * t / 5)), atol=1e-14
    )
    cab = np.where(early, 30 - 2.5 * t, 5 + 2.5 * t) * degree
    np.testing.assert_allclose(command.position[:, 1], cab, rtol=1e-14)
    # The cab's rate steps at t = 5 s; the interval on either side keeps its own.
    assert t[500] == 5.0
    np.testing.assert_allclose(command.rate_end[:500, 1], -2.5 * degree, rtol=1e-13)
    np.testing.assert_allclose(command.rate_start[500:, 1], 2.5 * degree, rtol=1e-13)
    fork_rate = -np.pi / 3 * np.pi / 5 * np.sin(np.pi * t / 5)
    np.testing.assert_allclose(command.rate_start[:, 0], fork_rate[:-1], atol=1e-14)
    np.testing.assert_allclose(command.rate_end[:, 0], fork_rate[1:], atol=1e-14)
    np.testing.assert_allclose(profile.initial_angle, [0, 0, np.pi / 6], atol=1e-15)
    reduction = profile.reduction
    assert (reduction.axes, reduction.control, reduction.limits) == ("report", "scalar", "warn")
    np.testing.assert_array_equal(reduction.r1, np.diag([0, 2, 0]))
    np.testing.assert_array_equal(reduction.r2, 1)


def test_a_silent_profile_gets_the_defaults_of_the_model() -> None:
    profile = load(SMALL)
    plain = Reduction()
    assert profile.machine == DES
    assert profile.seat.yaw == np.pi / 2
    assert profile.reduction.axes == plain.axes
    np.testing.assert_array_equal(profile.reduction.r1, plain.r1)
    np.testing.assert_allclose(profile.initial_angle, [0, 0, np.radians(5)])


def test_every_key_of_the_reduction_reaches_the_model() -> None:
    section = """\
reduction: {method: zero, algorithm: report-sweep, control: per-joint, axes: report,
  jacobian: adapted, r1: [[2, 1, 0], [1, 3, 0], [0, 0, 0]], r2: [1, 2, 3], tracking: 0.5,
  limits: check, iterations: 3, max_iterations: 40, hold: [fork, cab], ends: match-both}
"""
    found = load(SMALL + section).reduction
    words = (found.method, found.algorithm, found.control, found.axes, found.jacobian, found.limits)
    assert words == ("zero", "report-sweep", "per-joint", "report", "adapted", "check")
    assert (found.iterations, found.max_iterations, found.ends) == (3, 40, "match-both")
    assert found.hold == {"fork", "cab"}
    np.testing.assert_array_equal(found.r1, [[2, 1, 0], [1, 3, 0], [0, 0, 0]])
    np.testing.assert_array_equal(found.r2, [1, 2, 3])
    np.testing.assert_array_equal(found.tracking, [0.5, 0.5, 0.5])


FELT = (
    Budget("seat_g_rms_error_g", 0.05),
    Budget("seat_rate_deviation_relative", 0.1),
    Budget("seat_angular_acceleration_rms_ratio", 1.05),
    Budget("seat_angular_acceleration_peak_ratio", 1.1),
)


@pytest.mark.parametrize(
    ("section", "budget"),
    [
        ("", FELT),
        ("{axes: report}", FELT),
        ("{control: scalar}", FELT[:3]),
        ("{budget: 0.1}", (Budget("joint_deviation_relative", 0.1),)),
        ("{budget: {seat_g_rms_error_g: 0.2}}", (Budget("seat_g_rms_error_g", 0.2),)),
        (
            "{budget: {attitude_error_max_deg: 5, seat_g_rms_error_g: 0.2}}",
            (Budget("attitude_error_max_deg", 5.0), Budget("seat_g_rms_error_g", 0.2)),
        ),
        ("{budget: 0.1, algorithm: report-sweep}", (Budget("joint_deviation_relative", 0.1),)),
        ("{r2: 1}", ()),
        ("{tracking: 1}", ()),
        ("{algorithm: report-sweep}", ()),
        ("{method: zero}", ()),
    ],
)
def test_weights_and_methods_without_a_budget_have_none(section: str, budget: tuple) -> None:
    text = SMALL + (f"reduction: {section}\n" if section else "")
    assert load(text).reduction.budget == budget


def test_a_silent_profile_is_fit_to_fly() -> None:
    found = load(SMALL).reduction
    words = (found.control, found.axes, found.limits, found.ends, found.objective, found.optimise)
    assert words == ("free", "seat", "enforce", "match-start", "coriolis", ())
    np.testing.assert_array_equal(found.r1, np.diag([2, 2, 2]))
    assert (found.lead_in, found.lead_out) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("section", "control", "ends"),
    [
        ("{r2: 1}", "scalar", "free"),
        ("{tracking: 1}", "scalar", "free"),
        ("{algorithm: report-sweep}", "scalar", "free"),
        ("{method: zero}", "per-joint", "free"),
        ("{method: zero, r2: 1}", "per-joint", "free"),
        ("{r2: 1, control: per-joint, ends: match-start}", "per-joint", "match-start"),
        ("{method: zero, control: scalar}", "scalar", "free"),
        ("{budget: 0.05}", "free", "match-start"),
        ("{budget: 0.05, control: scalar}", "scalar", "match-start"),
        ("{axes: report}", "free", "match-start"),
    ],
)
def test_the_problem_of_the_study_has_its_own_defaults(
    section: str, control: str, ends: str
) -> None:
    found = load(f"{SMALL}reduction: {section}\n").reduction
    assert (found.control, found.ends) == (control, ends)


def test_what_only_free_joints_can_do_reaches_the_model() -> None:
    section = """\
reduction: {objective: blend, optimise: [cab_start, seat_yaw], ends: match-rates,
  lead_in_ms: 2500, lead_out_min: 0.05}
"""
    found = load(SMALL + section).reduction
    assert (found.objective, found.ends) == ("blend", "match-rates")
    assert found.optimise == ("cab_start", "seat_yaw")
    assert (found.lead_in, found.lead_out) == (2.5, 3.0)


@pytest.mark.parametrize("name", ["cobra", "cobra_table3"])
def test_the_cobras_stay_the_problem_of_the_study(name: str) -> None:
    found = load_profile(name).reduction
    words = (found.method, found.algorithm, found.control, found.axes, found.ends, found.limits)
    assert words == ("minimum", "optimum", "scalar", "report", "free", "warn")
    assert found.budget == ()


def test_every_other_built_in_profile_leaves_its_reduction_to_the_defaults() -> None:
    others = [p.name for p in builtin_profiles() if not p.name.startswith("cobra")]
    assert len(others) > 5
    default = Reduction()
    for name in others:
        found = load_profile(name).reduction
        for field in fields(Reduction):
            np.testing.assert_array_equal(getattr(found, field.name), getattr(default, field.name))


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


def test_a_joint_of_segments_between_samples_becomes_a_sample() -> None:
    segments = """
    - {from_s: 0, to_ms: 700, value: "t"}
    - {from_s: 0.7, to_s: 2, value: "0.7 - (t - 0.7)"}
"""
    profile = load(SMALL.replace('"10*t"', segments))
    assert profile.t.tolist() == [0, 0.5, 0.7, 1, 1.5, 2]
    assert isinstance(profile.command, JointCommands)
    rates = np.degrees(profile.command.rate_start[:, 0])
    np.testing.assert_allclose(rates, [1, 1, -1, -1, -1], rtol=1e-12)


def test_segments_may_reach_beyond_the_time_that_is_flown() -> None:
    short = load_profile("cobra", settings=["time.stop_s=4", "time.start_s=1"])
    assert (short.t[0], short.t[-1]) == (1.0, 4.0)
    assert isinstance(short.command, JointCommands)
    np.testing.assert_allclose(np.degrees(short.command.position[-1, 1]), 20.0)


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


@pytest.mark.parametrize(
    ("old", "new", "place", "words"),
    [
        ("format: des-coriolis/1\n", "", "1:1: format", "is missing"),
        ("coriolis/1", "coriolis/9", "1:9: format", "must be des-coriolis/1"),
        ("name: small", "nam: small", "2:1: nam", "did you mean name?"),
        ("name: small", "name: a/b", "2:7: name", "a folder is named after it"),
        ("name: small", "name: ..", "2:7: name", "a folder is named after it"),
        ("name: small", "name: 5", "2:7: name", "must be text, is 5"),
        ("stop_s: 2", "stop: 2", "3:20: time.stop", "needs its unit in the key: stop_s"),
        ("stop_s: 2", "stop_s: 0", "3:28: time.stop_s", "must be greater than start_s (0)"),
        ("stop_s: 2", "stop_s: yes", "3:28: time.stop_s", "must be a number, is 'yes'"),
        ("stop_s: 2", "stop_s: true", "3:28: time.stop_s", "must be a number, is True"),
        ("stop_s: 2", "stop_s: '2'", "3:28: time.stop_s", "must be a number, is '2'"),
        ("stop_s: 2", "stop_s: .nan", "3:28: time.stop_s", "must be a finite number"),
        ("stop_s: 2", "stop_s: null", "3:28: time.stop_s", "must be a number"),
        ("step_s: 0.5", "step_s: 0", "3:39: time.step_s", "must be greater than 0"),
        ("step_s: 0.5", "step_s: 1e-9", "3:39: time.step_s", "more than 5000000 samples"),
        ("step_s: 0.5", "step_s: 1, step_ms: 2", "3:7: time", "is given twice"),
        ("time: {start_s: 0, stop_s: 2, step_s: 0.5}\n", "", "1:1", "time is missing"),
        ("fork_deg", "fork", "6:3: joints.fork", "fork_rad or fork_deg"),
        ("fork_deg", "fork_rpm", "6:3: joints.fork_rpm", "fork_rad or fork_deg"),
        ("fork_deg", "frok_deg", "6:3: joints.frok_deg", "did you mean fork_deg?"),
        ("  cab_deg: 5\n", "", "5:3: joints", "the cab's angle is missing"),
        ('"10*t"', "2^t", "6:13: joints.fork_deg", "a power is written **"),
        ('"10*t"', "[]", "6:13: joints.fork_deg", "at least one segment"),
        ('"10*t"', "true", "6:13: joints.fork_deg", "must be a number, an expression in t"),
        ('"10*t"', "1/(t-1)", "6:13: joints.fork_deg", "no finite value at t = 1 s"),
        ('"10*t"', "sign(t-1)", "6:13: joints.fork_deg", "jumps at t = 1 s from -1 to 1 deg"),
        ('"10*t"', "[{from_s: 0, to_s: 2}]", "6:14: joints.fork_deg[0].value", "is missing"),
        ("cab_deg: 5", "cab_deg: 5\nbody_rates: {p_rpm: 0, q_rpm: 0, r_rpm: 0}", "8:1: body_rates",
         "stands beside joints"),
        ("name: small", "initial: {cab_deg: 3}", "2:11: initial.cab_deg", "leave this out"),
        ("name: small", "reduction: {r1: [1, 2]}", "2:17: reduction.r1", "at least 3 items"),
        ("name: small", "reduction: {r1: [[1, 2, 0], [0, 1, 0], [0, 0, 1]]}",
         "2:17: reduction.r1", "must be symmetric: [0][1] is 2, [1][0] is 0"),
        ("name: small", "reduction: {r1: [[1, 2, 0], [2, 1, 0], [0, 0, 1]]}",
         "2:17: reduction.r1", "must be positive semidefinite"),
        ("name: small", "reduction: {r1: [1, -1, 0]}", "2:21: reduction.r1[1]", "at least 0"),
        ("name: small", "reduction: {r2: 0}", "2:17: reduction.r2", "must be greater than 0"),
        ("name: small", "reduction: {r2: [1, 2]}", "2:17: reduction.r2", "at least 3 items"),
        ("name: small", "reduction: {tracking: -1}", "2:23: reduction.tracking", "at least 0"),
        ("name: small", "reduction: {budget: 0}", "2:21: reduction.budget", "greater than 0"),
        ("name: small", "reduction: {budget: {g: 1}}", "2:22: reduction.budget.g", "must be joint"),
        ("name: small", "reduction: {budget: {}}", "2:21: reduction.budget", "at least 1 items"),
        ("name: small", "reduction: {budget: [1]}", "2:21: reduction.budget", "or metrics with"),
        ("name: small", "reduction: {budget: {seat_g_rms_error_g: 1, joint_deviation_relative: 1}}",
         "2:71: reduction.budget.joint_deviation_relative", "must be below 1"),
        ("name: small", "reduction: {budget: 1}", "2:21: reduction.budget", "must be below 1"),
        ("name: small", "reduction: {objective: feel}", "2:24: reduction.objective",
         "must be coriolis, blend or felt"),
        ("name: small", "reduction: {optimise: [seat_roll]}", "2:24: reduction.optimise[0]",
         "must be seat_yaw, seat_pitch, fork_start or cab_start"),
        ("name: small", "reduction: {optimise: [seat_yaw, seat_yaw]}",
         "2:34: reduction.optimise[1]", "names seat_yaw twice"),
        ("name: small", "reduction: {ends: match-end}", "2:19: reduction.ends",
         "must be free, match-start, match-rates or match-both"),
        ("name: small", "reduction: {lead_in: 2}", "2:13: reduction.lead_in", "needs its unit"),
        ("name: small", "reduction: {lead_in_s: 2, lead_in_ms: 2}", "2:12: reduction",
         "is given twice"),
        ("name: small", "reduction: {lead_out_s: -2}", "2:25: reduction.lead_out_s", "at least 0"),
        ("name: small", "reduction: {budget: 1, r2: 1, tracking: 1}", "2:21: reduction.budget",
         "stands instead of r2 and tracking"),
        ("name: small", "reduction: {tolerance: 0}", "2:24: reduction.tolerance", "greater than 0"),
        ("name: small", "reduction: {iterations: 1.5}", "2:25: reduction.iterations", "whole"),
        ("name: small", "reduction: {hold: [leg]}", "2:20: reduction.hold[0]", "arm, fork or cab"),
        ("name: small", "reduction: {method: minimun}", "2:21: reduction.method",
         "did you mean minimum?"),
        ("name: small", "reduction: 3", "2:12: reduction", "must be a mapping"),
        ("name: small", "machine: dse", "2:10: machine", "did you mean des?"),
        ("name: small", "machine: 3", "2:10: machine", "a machine's name"),
    ],
)  # fmt: skip
def test_a_mistake_is_named_where_it_stands(old: str, new: str, place: str, words: str) -> None:
    assert old in SMALL
    lines = problems_of(SMALL.replace(old, new))
    assert any(f"<stdin>:{place}: " in line and words in line for line in lines), lines
    assert all(line.isprintable() for line in lines)


@pytest.mark.parametrize(
    ("second", "place", "words"),
    [
        ("{from_s: 1, to_s: 1, value: 3}", "[1].to_s", "must be greater than from_s (1)"),
        ("{from_s: 1.5, to_s: 2, value: 3}", "[1].from_s", "leaves a gap"),
        ("{from_s: 0.5, to_s: 2, value: 3}", "[1].from_s", "leaves an overlap"),
        ("{from_s: 1, to_s: 1.5, value: 3}", "[1]", "leaves the time to 2 s uncovered"),
        ("{from_s: 1, to_s: 2, value: 4}", "[1].value", "jumps at t = 1 s from 3 to 4 deg"),
        ("{from_s: 1, to_s: 2, valeu: 3}", "[1].valeu", "did you mean value?"),
        ("{from: 1, to_s: 2, value: 3}", "[1].from", "needs its unit in the key: from_s"),
        ("{to_s: 2, value: 3}", "[1]", "the start of a segment is missing"),
        ("7", "[1]", "must be a mapping"),
    ],
)
def test_segments_must_join(second: str, place: str, words: str) -> None:
    segments = f"\n    - {{from_s: 0, to_s: 1, value: 3}}\n    - {second}\n"
    lines = problems_of(SMALL.replace('"10*t"', segments))
    assert len(lines) in (1, 2)
    assert any(f": joints.fork_deg{place}: " in line and words in line for line in lines), lines


def test_segments_must_start_with_the_profile() -> None:
    late = "[{from_s: 0.5, to_s: 2, value: 3}]"
    (line,) = problems_of(SMALL.replace('"10*t"', late))
    assert "starts at 0.5 s and leaves the time from 0 s uncovered" in line


def test_all_mistakes_come_at_once_in_the_order_of_the_file() -> None:
    text = """\
format: des-coriolis/1
nmae: x
machine: {base: dse}
initial: {fork_deg: 1}
time: {start_s: 0, stop_s: 2, step_s: 0.5}
joints: {arm_rpm: 1, fork_deg: "2 +", cab_deg: "log(t)"}
reduction: {r2: -1, r1: [[1, 2, 0], [0, 1, 0], [0, 0, 1]]}
"""
    lines = problems_of(text)
    assert [line.split(":")[1] for line in lines] == ["2", "3", "6", "6", "7"]
    # What the schema refuses hides nothing that can be checked without it.
    lines = problems_of(text.replace('"2 +"', "2").replace("-1", "1"))
    assert [line.split(":")[1] for line in lines] == ["2", "3", "6", "7"]
    assert "symmetric" in lines[-1]


@pytest.mark.parametrize(
    ("commands", "wrong"),
    [
        (
            'joints: {arm: 1, fork_deg: "1/(t - 1)", cab_deg: [{from_s: 0, to_s: 1, value: 2}]}',
            ["joints.arm", "joints.fork_deg", "joints.cab_deg[0]"],
        ),
        (
            'body_rates: {p_deg_s: "sqrt(-1)", q: 1, r_deg_s: [{from_s: 1, to_s: 2, value: 1}]}',
            ["body_rates.p_deg_s", "body_rates.q", "body_rates.r_deg_s[0]"],
        ),
        (
            "joints: {arm_rpm: 1, fork_deg: [{from_s: 0, to_s: 1, value: 1}], cab_deg: log(t)}",
            ["joints.fork_deg[0]", "joints.cab_deg"],
        ),
    ],
)
def test_a_wrong_command_hides_no_other(commands: str, wrong: list[str]) -> None:
    text = f"format: des-coriolis/1\ntime: {{start_s: 0, stop_s: 2, step_s: 0.5}}\n{commands}\n"
    assert [line.split(": ")[1] for line in problems_of(text)] == wrong


def test_a_flood_of_mistakes_is_counted() -> None:
    lines = problems_of(SMALL + "".join(f"key{k}: 1\n" for k in range(500)))
    assert len(lines) == 51
    assert lines[-1] == "… and 450 more problems"


@pytest.mark.parametrize("text", ["- 1\n- 2\n", "{}", "{a: 1}", "[]", "--- 5", "a: &a [*a]"])
def test_yaml_that_is_no_profile_is_refused(text: str) -> None:
    assert problems_of(text)


def test_samples_come_from_a_csv_beside_the_profile(tmp_path: Path) -> None:
    folder = tmp_path / "logs"
    folder.mkdir()
    (folder / "log.csv").write_text("t,p,q,r\n0,1,2,3\n1,2,3,4\n")
    path = folder / "run.yaml"
    path.write_text(
        "format: des-coriolis/1\n"
        "samples: {file: log.csv, columns: {t_s: t, p_rad_s: p, q_rad_s: q, r_deg_s: r}}\n"
    )
    profile = load_profile(path)
    assert profile.name == "run"
    assert isinstance(profile.command, BodyRates)
    np.testing.assert_allclose(profile.command.start, [[1, 2, np.radians(3)]])
    (folder / "log.csv").write_text("t,p,q,r\n0,1,2,3\n1,2,3,5\n")
    assert load_profile(path).sha256 != profile.sha256
    (folder / "log.csv").write_text("t,p,q,r\n0,1,2,x\n1,2,3,5\n")
    with pytest.raises(ProfileError, match=r"log\.csv:2: r: must be a number, is 'x'"):
        load_profile(path)
    (folder / "log.csv").unlink()
    with pytest.raises(FileAccessError, match=r"log\.csv: cannot be read: No such file"):
        load_profile(path)
    (folder / "log.csv").write_text("t,p,q,r\n0,1,2,3\n1,2,3,5\n")
    with pytest.raises(ProfileError, match="the times come from the samples"):
        load_profile(path, settings=["time={start_s: 0, stop_s: 1, step_s: 1}"])


def test_a_machine_file_is_found_from_the_profile_and_from_a_setting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    for folder, metres in ((here, 7), (there, 8)):
        folder.mkdir()
        (folder / "own.yaml").write_text(f"{{base: des, name: own, lengths_m: {{L2: {metres}}}}}\n")
    (there / "run.yaml").write_text(SMALL + "machine: own.yaml\n")
    monkeypatch.chdir(here)
    profile = load_profile(there / "run.yaml")
    assert profile.machine.lengths["L2"] == 8.0
    changed = load_profile(there / "run.yaml", settings=["machine=own.yaml"])
    assert changed.machine.lengths["L2"] == 7.0


def test_the_digest_tells_every_input_apart() -> None:
    digests = {
        load(SMALL).sha256,
        load(SMALL + "\n").sha256,
        load(SMALL, "reduction.r2=2").sha256,
        load(SMALL, "reduction.r2=3").sha256,
    }
    assert len(digests) == 4
    assert load(SMALL).sha256 == load(SMALL).sha256


def test_what_is_no_readable_file_is_said_to_be_none(tmp_path: Path) -> None:
    cases = [
        (tmp_path / "none.yaml", "no such file, and no built-in profile"),
        ("cobar", "did you mean cobra?"),
        (tmp_path, "is a folder"),
        ("a\0b", "no such file"),
        ("x" * 5000, "cannot be read"),
        ("/dev/null", "is a device"),
        ("-", "nothing was given on standard input"),
    ]
    for source, words in cases:
        with pytest.raises(FileAccessError) as caught:
            load_profile(source)
        assert words in str(caught.value)
        assert str(caught.value).isprintable()


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser reads every file")
def test_a_file_without_permission_is_named(tmp_path: Path) -> None:
    path = tmp_path / "closed.yaml"
    path.write_text(SMALL)
    path.chmod(0)
    with pytest.raises(FileAccessError, match="Permission denied"):
        load_profile(path)


def test_text_that_is_not_utf_8_is_named_by_its_line(tmp_path: Path) -> None:
    path = tmp_path / "latin.yaml"
    path.write_bytes(SMALL.encode() + b"# \xe9t\xe9\n")
    with pytest.raises(ProfileError, match=r"latin\.yaml:8: is not UTF-8 text \(byte 0xe9\)"):
        load_profile(path)


def test_files_of_other_endings_are_what_they_hold(tmp_path: Path) -> None:
    path = tmp_path / "profile.txt"
    path.write_text("\n# a maneuver\n" + SMALL)
    assert load_profile(path).name == "small"
    path.write_text("t_s,arm_rpm,fork_deg,cab_deg\n0,1,2,3\n1,2,3,4\n")
    assert load_profile(path).name == "profile"


def test_renaming_columns_of_a_yaml_profile_is_wrong_use() -> None:
    with pytest.raises(UsageError, match="renames columns of a CSV profile"):
        load_profile("cobra", columns={"t_s": "t"})


SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(10**20), 10**20),
    st.floats(),
    st.sampled_from(["t", "1/t", "des", "..", "a/b", "*", "\x1b[0m", "é", "{", "2^t", "9**9**9"]),
)
KEYS = st.sampled_from(
    [
        "format",
        "name",
        "machine",
        "seat",
        "initial",
        "time",
        "joints",
        "body_rates",
        "samples",
        "reduction",
        "arm_rpm",
        "fork_deg",
        "cab_deg",
        "cab",
        "start_s",
        "stop_s",
        "step_s",
        "from_s",
        "to_s",
        "value",
        "p_deg_s",
        "file",
        "columns",
        "base",
        "rows",
        "limits",
        "r1",
        "r2",
        "yaw_deg",
        "lengths_ft",
    ]
)
TREES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(KEYS, inner, max_size=4)),
    max_leaves=8,
)


@settings(max_examples=200, deadline=None)
@given(st.dictionaries(KEYS, TREES, max_size=4))
def test_any_tree_of_values_is_a_profile_or_refused(tree: dict[str, object]) -> None:
    overrides = [f"{key}={json.dumps(value)}" for key, value in tree.items()]
    lines = ["read"]
    try:
        load(SMALL, *overrides)
    except (ProfileError, FileAccessError) as error:
        lines = [str(problem) for problem in error.problems]
    assert lines
    assert all(line.isprintable() for line in lines)
