"""CSV profiles: what is read, and what is said about everything else."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from des_cli.errors import ProfileError
from des_cli.model.profile import BodyRates, JointCommands
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.profile_csv import parse_samples

JOINTS = "t_s,arm_rpm,fork_deg,cab_deg\n"
RATES = "t_s,p_rad_s,q_rad_s,r_rad_s\n"


def problems_of(text: str | bytes, **columns: str) -> list[str]:
    data = text.encode() if isinstance(text, str) else text
    with pytest.raises(ProfileError) as caught:
        load_profile("-", stdin=data, columns=columns)
    return [str(problem) for problem in caught.value.complaints]


def test_joint_commands_are_read_in_their_units() -> None:
    text = "cab_rad,t_ms,arm_deg_s,fork_deg\n1,0,180,90\n2,500,90,-90\n1,2000,0,0\n"
    t, command = parse_samples(text, "x.csv", {})
    assert isinstance(command, JointCommands)
    np.testing.assert_allclose(t, [0, 0.5, 2])
    np.testing.assert_allclose(command.arm_rate, [np.pi, np.pi / 2, 0])
    np.testing.assert_allclose(command.position[:, 0], [np.pi / 2, -np.pi / 2, 0])
    np.testing.assert_array_equal(command.position[:, 1], [1, 2, 1])
    # The rate of a table is one at each sample, whichever interval asks.
    np.testing.assert_array_equal(command.rate_end[:-1], command.rate_start[1:])


def test_body_rates_are_read_with_the_recorded_attitude() -> None:
    text = (
        "t,p,q,r,q0,q1,q2,q3,temperature\n0,1,2,3,1,0,0,0,x\n1,2,3,4,0,0.9999,0,0,\n2,3,4,5,,,,,9\n"
    )
    names = {"t_s": "t", "p_rad_s": "p", "q_deg_s": "q", "r_rad_s": "r"}
    t, command = parse_samples(text, "x.csv", names)
    assert isinstance(command, BodyRates)
    np.testing.assert_array_equal(t, [0, 1, 2])
    np.testing.assert_allclose(command.start, [[1, np.radians(2), 3], [2, np.radians(3), 4]])
    np.testing.assert_allclose(command.end, [[2, np.radians(3), 4], [3, np.radians(4), 5]])
    np.testing.assert_allclose(command.middle[:, 0], [1.5, 2.5])
    assert command.attitude is not None
    np.testing.assert_array_equal(command.attitude[:2], [[1, 0, 0, 0], [0, 1, 0, 0]])
    assert np.isnan(command.attitude[2]).all()


def test_degrees_under_the_name_of_radians_are_read_as_they_are() -> None:
    rows = "".join(f"{k},0,{60 + k},-40\n" for k in range(5))
    remarks: list[str] = []
    _, command = parse_samples(RATES + rows, "x.csv", {}, remarks=remarks)
    assert isinstance(command, BodyRates)
    assert command.end[-1].tolist() == [0, 64, -40]
    assert len(remarks) == 1


def test_wrong_times_and_wrong_values_are_said_together() -> None:
    assert problems_of(JOINTS + "0,1,2,3\n0.3,1,1e12,3\n0.3,1,2,3\n") == [
        "<stdin>:4: t_s: 0.3 does not increase (previous 0.3); remove one of the two rows",
        "<stdin>:3: fork_deg: is beyond 1e+06 rad or rad/s (1 such cells)",
    ]


def test_clock_times_under_another_name_are_read_once_that_is_named() -> None:
    rows = "12:00:00.0,1,2,3\n12:00:00.5,1,2,3\n"
    t, _ = parse_samples("UTC,p_rad_s,q_rad_s,r_rad_s\n" + rows, "x.csv", {"t": "UTC"})
    assert t.tolist() == [0.0, 0.5]


def test_a_jump_that_no_joint_follows_is_told_by_its_line_and_time() -> None:
    fork = [0.1 * k + (25.0 if k >= 6 else 0.0) for k in range(12)]
    rows = "".join(f"{0.02 * k:.2f},3,{angle:.6g},5\n" for k, angle in enumerate(fork))
    remarks: list[str] = []
    parse_samples(JOINTS + rows, "x.csv", {}, remarks=remarks)
    assert remarks == [
        "line 8: fork_deg jumps from 0.5 to 25.6 deg at t = 0.12 s, which no joint follows: "
        "mend the record, or --trim it to one side"
    ]
    # Few rows far apart are a motion.
    parse_samples(JOINTS + "0,3,0,5\n1,3,0,5\n2,3,60,5\n9,3,60,5\n", "x.csv", {}, remarks=(t := []))
    assert t == []


def test_an_incomplete_attitude_is_left_out() -> None:
    _, command = parse_samples(RATES.replace("\n", ",q0,quality\n") + "0,1,2,3,1,5\n1,1,2,3,1,5\n",
                               "x.csv", {})  # fmt: skip
    assert isinstance(command, BodyRates)
    assert command.attitude is None


@pytest.mark.parametrize(
    "text",
    [
        JOINTS + "0,1,2,3\n1,2,3,4\n",
        JOINTS + "0,1,2,3\n1,2,3,4\n\n\n",
        "\ufeff" + JOINTS + "0,1,2,3\n1,2,3,4\n",
        (JOINTS + "0,1,2,3\n1,2,3,4\n").replace("\n", "\r\n"),
        (JOINTS + "0,1,2,3\n1,2,3,4\n").replace("\n", "\r"),
        't_s,"arm_rpm",fork_deg,cab_deg\n"0","1",2,3\n1,2,3,"4"\n',
        "t_s , arm_rpm,fork_deg, cab_deg\n 0, 1,2 ,3\n1,2,+3.0,4e0\n",
    ],
)
def test_the_ways_in_which_spreadsheets_write_are_read(text: str) -> None:
    profile = load_profile("-", stdin=text.encode())
    assert isinstance(profile.command, JointCommands)
    np.testing.assert_array_equal(profile.t, [0, 1])
    np.testing.assert_allclose(profile.command.position, np.radians([[2, 3], [3, 4]]))
    assert profile.name == "stdin"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (b"", "is empty"),
        (b"\n\n", "is empty"),
        (JOINTS.encode(), "has a header but no rows"),
        (JOINTS.encode() + b"0,1,2,3\n", "has one row"),
        (
            b"t_s,arm_rpm,arm_rpm,cab_deg\n0,1,2,3\n",
            "the column arm_rpm stands 2 times; rename all but one",
        ),
        (b"t_s,arm_rpm,,cab_deg\n0,1,2,3\n", "a column is missing: fork_rad or fork_deg"),
        (JOINTS.encode() + b"0,1,\x00,3\n", "holds a NUL byte"),
        (JOINTS.encode() + b"0,1,\xff,3\n", "fork_deg: must be a number, is 'ÿ'"),
        (JOINTS.encode("utf-16"), "is UTF-16 text; save it as UTF-8"),
        (b"t,arm,fork,cab\n0,1,2,3\n", "t is a time and needs its unit"),
        (b"t_s,arm_m,fork_deg,cab_deg\n0,1,2,3\n", "arm is a rate or an angle and needs its unit"),
        (b"t_s,arm_rpm,frok_deg,cab_deg\n0,1,2,3\n", "did you mean fork_deg?"),
        (b"t_s,arm_rpm,fork_deg\n0,1,2\n", "a column is missing: cab_rad or cab_deg"),
        (b"t_s,p_rad_s,q_rad_s\n0,1,2\n", "a column is missing: r_rad_s"),
        (b"t_s,t_ms,arm_rpm,fork_deg,cab_deg\n0,0,1,2,3\n", "t is given twice: t_s and t_ms"),
        (b"t_s\n0\n1\n", "has neither joint commands"),
        (b"t_s,fork_deg,p_rad_s\n0,1,2\n", "both joint commands"),
        (
            b"t_s,arm_rpm,fork_deg,cab_deg,p_rpm,q_rpm,r_rpm\n0,1,2,3,4,5,6\n",
            "choose with --column",
        ),
        (b'"t_s\n', "is not a CSV header"),
        (b"t_s," + b"x" * 200_000 + b"\n", "is not a CSV header"),
    ],
)
def test_a_bad_file_is_refused_in_words(text: bytes, words: str) -> None:
    lines = problems_of(text)
    assert any(words in line for line in lines), lines
    assert all(line.isprintable() and len(line) < 400 for line in lines)


def test_renaming_is_checked_against_the_file() -> None:
    text = "time,p_rad_s,q_rad_s,r_rad_s\n0,1,2,3\n1,1,2,3\n"
    assert load_profile("-", stdin=text.encode(), columns={"t_s": "time"}).t[1] == 1.0
    assert "did you mean time" in problems_of(text, t_s="tiem")[0]
    assert "needs its unit" in problems_of(text, t="time")[0]
    assert "named twice" in problems_of(text, t_s="time", t_ms="time")[0]
    # the file's own q_rad_s gives way to the named one, and p_rad_s is used up
    assert problems_of(text, t_s="time", q_rad_s="p_rad_s") == [
        "<stdin>:1: a column is missing: p_rad_s, p_deg_s or p_rpm"
    ]


def test_an_attitude_that_is_no_rotation_is_refused() -> None:
    text = RATES.replace("\n", ",q0,q1,q2,q3\n") + "0,1,2,3,1,0,0,0\n1,1,2,3,0.5,0,0,0\n"
    (line,) = problems_of(text)
    assert line == "<stdin>:3: q0..q3: the attitude's norm is 0.5, not 1 (1 such row)"


@settings(max_examples=150)
@given(st.binary(max_size=80), st.sampled_from([JOINTS, RATES, ""]))
def test_any_bytes_are_read_or_refused(data: bytes, header: str) -> None:
    lines = ["read"]
    try:
        load_profile("-", stdin=header.encode() + data)
    except ProfileError as error:
        lines = [str(problem) for problem in error.complaints]
    assert lines
    assert all(line.isprintable() for line in lines)


def test_a_file_gives_its_name_and_settings_change_the_rest(tmp_path: Path) -> None:
    path = tmp_path / "my log.csv"
    path.write_text(JOINTS + "0,1,2,3\n1,1,2,4\n")
    profile = load_profile(
        path, settings=["initial.arm_deg=90", "reduction.r2=0.2", "seat.yaw_deg=0", "machine=des"]
    )
    assert profile.name == "my log"
    np.testing.assert_allclose(profile.initial_angle, np.radians([90, 2, 3]))
    np.testing.assert_array_equal(profile.reduction.r2, [0.2, 0.2, 0.2])
    assert profile.seat.yaw == 0.0


def test_problems_of_the_table_and_of_the_settings_come_together() -> None:
    with pytest.raises(ProfileError) as caught:
        load_profile(
            "-", stdin=(JOINTS + "0,1,2,3\n").encode(), settings=["reduction.r2=-1", "time=3"]
        )
    lines = [str(problem) for problem in caught.value.complaints]
    assert len(lines) == 3
    assert any("one row" in line for line in lines)
    assert any("--set reduction.r2=-1: reduction.r2: must be greater than 0" in x for x in lines)
