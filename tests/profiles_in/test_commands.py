"""Commands written as expressions, sampled: times, sides, joints of segments and refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.model.profile import BodyRates as Rates
from des_cli.model.profile import JointCommands
from des_cli.profiles_in import commands
from des_cli.profiles_in.commands import check_commands, read_commands, read_time
from des_cli.profiles_in.findings import Findings
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.schema import BodyRates, Joints, Time
from des_cli.profiles_in.yaml_nodes import parse_yaml
from tests.support.profiles import SMALL, load, problems_of

GRID = (0.0, 2.0, 0.5)


def read(text: str) -> tuple[tuple[Floats, Any] | None, list[str]]:
    """What a section of commands makes on the grid, and what is said against it."""
    findings = Findings(parse_yaml(text, "f.yaml"))
    ((name, section),) = findings.root.plain().items()
    model = Joints if name == "joints" else BodyRates
    found = read_commands(model.model_validate(section), name, GRID, findings)
    return found, [str(complaint) for complaint in findings.complaints]


def made(text: str) -> tuple[Floats, Any]:
    found, said = read(text)
    assert said == []
    assert found is not None
    return found


def refused(text: str) -> list[str]:
    found, said = read(text)
    assert found is None
    return said


def time_of(text: str, **default: float) -> tuple[tuple[float, float, float] | None, list[str]]:
    findings = Findings(parse_yaml(f"time: {text}", "f.yaml"))
    section = Time.model_validate(findings.root.plain()["time"])
    return read_time(section, findings, default), [str(each) for each in findings.complaints]


def test_times_are_in_seconds_and_what_is_not_given_is_the_default() -> None:
    assert time_of("{start_s: -1, stop_min: 2, step_ms: 20}") == ((-1.0, 120.0, 0.02), [])
    assert time_of("{stop_s: 3}", start=1.0, stop=9.0, step=0.1) == ((1.0, 3.0, 0.1), [])


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("{}", [
            f"time: the {title} is missing: give {stem}_s, {stem}_ms, {stem}_us, {stem}_ns or "
            f"{stem}_min"
            for stem, title in (
                ("start", "first time"), ("stop", "last time"), ("step", "time between samples")
            )
        ]),
        ("{start_s: 2, stop_ms: 2000, step_s: -1}", [
            "time.stop_ms: must be greater than start_s (2)",
            "time.step_s: must be greater than 0",
        ]),
        ("{start_s: 0, stop_s: 1000001, step_s: 1}",
         ["time.step_s: makes more than 1000000 samples; give a longer step, or --max-rows"]),
        ("{start_s: 1e17, stop_s: 1.0000000000000008e17, step_s: 1}",
         ["time.step_s: is too short to tell times of this size apart"]),
        ("{start_s: 0, stop_s: 1e308, step_s: 1e307}", ["time.stop_s: lasts longer than 1e+07 s"]),
        ("{start_s: 0, stop_s: 5e-324, step_s: 5e-324}", ["time.step_s: must be at least 1e-09 s"]),
    ],
)  # fmt: skip
def test_times_that_make_no_grid_are_refused(text: str, lines: list[str]) -> None:
    found, said = time_of(text)
    assert found is None
    assert [each.split(": ", 1)[1] for each in said] == lines


def test_a_default_start_is_told_in_seconds() -> None:
    found, said = time_of("{stop_s: -1}", start=0.5, stop=9.0, step=0.1)
    assert found is None
    assert said[0].endswith("time.stop_s: must be greater than 0.5 s")


def test_an_arm_is_a_velocity_and_fork_and_cab_are_positions_with_their_rates() -> None:
    t, command = made("joints: {arm_rpm: 30*t, fork_deg: 90*t**2, cab_rad: 2}")
    np.testing.assert_array_equal(t, [0.0, 0.5, 1.0, 1.5, 2.0])
    np.testing.assert_allclose(command.arm_rate, np.pi * t)
    assert command.arm_start is None
    np.testing.assert_allclose(command.position, np.column_stack([np.pi / 2 * t**2, 2 + 0 * t]))
    np.testing.assert_allclose(command.rate_start[:, 0], np.pi * t[:-1])
    np.testing.assert_allclose(command.rate_end[:, 0], np.pi * t[1:])
    assert not command.rate_start[:, 1].any()


def test_an_arm_s_angle_gives_its_start_and_at_a_kink_the_mean_of_both_rates() -> None:
    _, command = made("joints: {arm_deg: '30 + 60*max(t - 1, 0)', fork_deg: 0, cab_deg: 0}")
    assert command.arm_start == pytest.approx(np.pi / 6)
    np.testing.assert_allclose(command.arm_rate, np.pi / 3 * np.array([0, 0, 0.5, 1, 1]))
    t, command = made("joints: {arm_rad: t**2, fork_deg: 0, cab_deg: 0}")
    np.testing.assert_allclose(command.arm_rate, 2 * t)


def test_a_velocity_may_step_where_a_position_may_not() -> None:
    step = "[{from_s: 0, to_s: 1, value: 6}, {from_s: 1, to_s: 2, value: 12}]"
    _, command = made(f"joints: {{arm_deg_s: {step}, fork_deg: 0, cab_deg: 0}}")
    np.testing.assert_allclose(np.degrees(command.arm_rate), [6, 6, 12, 12, 12])
    for key, other in (("fork_deg", "arm_rpm: 0"), ("arm_deg", "fork_deg: 0")):
        (line,) = refused(f"joints: {{{other}, cab_deg: 0, {key}: {step}}}")
        assert f"joints.{key}[1].value: the position jumps at t = 1 s from 6 to 12 deg" in line
    (line,) = refused("joints: {arm_rpm: 0, fork_rad: 0, cab_rad: sign(t - 1)}")
    assert "joints.cab_rad: the position jumps at t = 1 s from -1 to 1 rad" in line


def test_body_rates_may_step_and_have_their_middles() -> None:
    step = "[{from_s: 0, to_s: 0.7, value: t}, {from_s: 0.7, to_s: 2, value: -1}]"
    t, command = made(f"body_rates: {{p_rad_s: {step}, q_rpm: 30, r_deg_s: 180*t**2}}")
    assert isinstance(command, Rates)
    np.testing.assert_array_equal(t, [0.0, 0.5, 0.7, 1.0, 1.5, 2.0])
    np.testing.assert_allclose(command.end[:, 0], [0.5, 0.7, -1, -1, -1])
    np.testing.assert_allclose(command.start[:, 0], [0.0, 0.5, -1, -1, -1])
    np.testing.assert_allclose(command.middle[:, 0], [0.25, 0.6, -1, -1, -1])
    np.testing.assert_allclose(command.middle[:, 1], np.pi)
    np.testing.assert_allclose(command.middle[:, 2], np.pi * (0.5 * (t[1:] + t[:-1])) ** 2)


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


def test_segments_must_start_with_the_profile() -> None:
    late = "[{from_s: 0.5, to_s: 2, value: 3}]"
    (line,) = problems_of(SMALL.replace('"10*t"', late))
    assert "starts at 0.5 s and leaves the time from 0 s uncovered" in line


def test_segments_must_reach_the_end() -> None:
    (line,) = refused(
        "joints: {arm_rpm: 1, fork_deg: [{from_s: 0, to_s: 1.9, value: 1}], cab_deg: 1}"
    )
    assert "joints.fork_deg[0]: ends at 1.9 s and leaves the time to 2 s uncovered" in line
    nearly = "[{from_s: 1e-10, to_s: 1.9999999999, value: 1}]"
    made(f"joints: {{arm_rpm: 1, fork_deg: {nearly}, cab_deg: 1}}")


def test_what_the_schema_refused_hides_no_other_command() -> None:
    section = {"arm_rpm": True, "fork_deg": "1/(t - 1)", "cab_deg": 1, "cab_rad": "1/t"}
    findings = Findings(parse_yaml("joints: {}", "f.yaml"))
    check_commands(Joints.measures, section, "joints", GRID, findings)
    (complaint,) = findings.complaints
    assert "joints.fork_deg" in complaint.where
    assert "no finite value at t = 1 s" in complaint.what


LONG = "t + t + t + t + t"


@pytest.mark.parametrize(
    "arm",
    [
        LONG,
        f"[{{from_s: 0, to_s: 1, value: {LONG}}}, {{from_s: 1, to_s: 2, value: 1}}]",
        f"[{{from_s: 0, to_s: 1, value: 1}}, {{from_s: 1, to_s: 2, value: {LONG}}}]",
    ],
)
def test_too_much_arithmetic_is_refused_wherever_it_stands(
    arm: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = f"joints: {{arm_rpm: {arm}, fork_deg: 0, cab_deg: 0}}"
    made(text)
    monkeypatch.setattr(commands, "MAX_WORK", 35)
    made("joints: {arm_rpm: t, fork_deg: 0, cab_deg: 0}")
    (line,) = refused(text)
    assert "joints: takes too much arithmetic; give a longer step" in line
