"""Logs of an attitude alone: what the seat does against scipy's rotations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from des_cli.errors import ProfileError
from des_cli.kinematics.chain import chain_of, seat_rotation
from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.profile import BodyRates, Profile
from des_cli.profiles_in.load import load_profile

START = ["initial.arm_deg=20", "initial.fork_deg=10", "initial.cab_deg=-30"]
ORDERS = ["zyx", "xyz", "yzx"]


def tumbling(t: np.ndarray) -> Rotation:
    """One turn and more about the body's x, while it sways about the others."""
    angles = np.column_stack(
        [0.3 * t, 0.4 * np.sin(0.5 * t), 0.7 * t + 0.3 * np.sin(t) + 0.8],
    )
    return Rotation.from_euler("ZYX", angles)


def quaternion_log(t: np.ndarray, turn: Rotation, names: str = "q0,q1,q2,q3") -> str:
    """Print to eight digits, as recorders do, with signs that flip."""
    sign = np.random.default_rng(7).choice([-1.0, 1.0], len(t))[:, None]
    rows = np.column_stack([t, sign * turn.as_quat()[:, [3, 0, 1, 2]]])
    return f"t_s,{names}\n" + "".join(",".join(f"{x:.8g}" for x in row) + "\n" for row in rows)


def euler_log(t: np.ndarray, turn: Rotation, order: str) -> str:
    angles = turn.as_euler(order.upper(), degrees=True)
    by_axis = [angles[:, order.index(axis)] for axis in "xyz"]
    rows = np.column_stack([t, *by_axis])
    return "t_s,roll_deg,pitch_deg,yaw_deg\n" + "".join(
        ",".join(f"{x:.7f}" for x in row) + "\n" for row in rows
    )


def load(text: str, *settings: str, columns: dict[str, str] | None = None) -> Profile:
    return load_profile("-", stdin=text.encode(), settings=[*START, *settings], columns=columns)


def problems_of(text: str, *settings: str) -> list[str]:
    with pytest.raises(ProfileError) as caught:
        load(text, *settings)
    return [str(problem) for problem in caught.value.complaints]


def seat_error_deg(profile: Profile, t: np.ndarray, turn: Rotation) -> float:
    """Return the largest angle between the seat's attitude and the log's, from the first row."""
    asked = make_desired(profile)
    assert not np.any(asked.damped), "the machine can do it"
    seat = seat_rotation(chain_of(profile.machine, profile.seat), asked.motion.angle)
    seat = Rotation.from_matrix(seat[np.isin(asked.motion.t, t)])
    off = (seat[0].inv() * seat).inv() * (turn[0].inv() * turn)
    return float(np.degrees(np.max(off.magnitude())))


@pytest.mark.parametrize("hz", [50, 5])
def test_the_seat_turns_as_a_log_of_quaternions(hz: int) -> None:
    t = np.round(np.arange(0, 12 * hz) / hz, 6)
    turn = tumbling(t)
    profile = load(quaternion_log(t, turn))
    assert isinstance(profile.command, BodyRates)
    assert seat_error_deg(profile, t, turn) <= 0.05
    error = make_desired(profile).recorded_attitude_error
    assert error is not None
    assert np.degrees(error) <= 0.01
    inserted = len(profile.t) - len(t)
    if inserted:
        assert f"{inserted} rows were inserted between the {len(t)} recorded" in profile.remarks[0]
    else:
        assert profile.remarks == ()


@pytest.mark.parametrize("order", ORDERS)
def test_the_seat_turns_as_a_log_of_euler_angles(order: str) -> None:
    t = np.round(np.arange(0, 300) / 50, 6)
    turn = tumbling(t)
    profile = load(euler_log(t, turn, order), f"samples.euler={order}")
    assert seat_error_deg(profile, t, turn) <= 0.05


def test_the_order_of_euler_angles_matters() -> None:
    t = np.round(np.arange(0, 300) / 50, 6)
    turn = tumbling(t)
    assert seat_error_deg(load(euler_log(t, turn, "zyx"), "samples.euler=xyz"), t, turn) > 1.0


def test_euler_angles_in_a_yaml_profile_need_their_order_there(tmp_path) -> None:
    t = np.arange(0, 50) / 25
    (tmp_path / "log.csv").write_text(euler_log(t, tumbling(t), "zyx"))
    head = "format: des-coriolis/1\nsamples: {file: log.csv"
    (tmp_path / "a.yaml").write_text(f"{head}, euler: zyx}}\n")
    assert isinstance(load_profile(tmp_path / "a.yaml").command, BodyRates)
    (tmp_path / "b.yaml").write_text(f"{head}}}\n")
    with pytest.raises(ProfileError, match="are an attitude only in an order: give --euler zyx"):
        load_profile(tmp_path / "b.yaml")
    (tmp_path / "c.yaml").write_text(f"{head}, euler: zxz}}\n")
    with pytest.raises(ProfileError, match="must be xyz, xzy, yxz, yzx, zxy or zyx, is 'zxz'"):
        load_profile(tmp_path / "c.yaml")


def test_quaternions_may_be_named_by_their_letters() -> None:
    t = np.arange(0, 100) / 25
    turn = tumbling(t)
    ours, theirs = (load(quaternion_log(t, turn, n)) for n in ("q0,q1,q2,q3", "qw,qx,qy,qz"))
    np.testing.assert_array_equal(ours.command.start, theirs.command.start)
    assert "q0 is given twice: q0 and qw" in problems_of("t_s,q0,qw,q1,q2,q3\n")[0]


def test_where_rates_are_recorded_the_attitude_is_only_compared_with() -> None:
    text = "t_s,p_rad_s,q_rad_s,r_rad_s,q0,q1,q2,q3\n0,0,0,0,1,0,0,0\n1,0,0,0,0.96,0.28,0,0\n"
    profile = load(text)
    np.testing.assert_array_equal(profile.command.middle, [[0, 0, 0]])
    assert make_desired(profile).recorded_attitude_error == pytest.approx(2 * np.arcsin(0.28))
    alone = load(text, columns={"q0": "q0"})
    np.testing.assert_allclose(alone.command.middle, [[2 * np.arcsin(0.28), 0, 0]], atol=1e-9)


def test_euler_angles_beside_rates_are_compared_with_where_their_order_is_known() -> None:
    text = "t_s,p_rad_s,q_rad_s,r_rad_s,roll_deg,pitch_deg,yaw_deg\n0,0,0,0,0,0,0\n1,0,0,0,9,0,0\n"
    assert load(text).command.attitude is None
    error = make_desired(load(text, "samples.euler=zyx")).recorded_attitude_error
    assert error == pytest.approx(np.radians(9))


def rows(*cells: Sequence[object]) -> str:
    lines = ("t_s,q0,q1,q2,q3", *(",".join(map(str, row)) for row in cells))
    return "\n".join(lines) + "\n"


def test_rows_without_an_attitude_are_left_out_and_counted() -> None:
    profile = load(rows((0, 1, 0, 0, 0), (1, "", "", "", ""), (2, 0.8, 0.6, 0, 0)))
    np.testing.assert_array_equal(profile.t, [0, 2])
    assert profile.remarks == ("1 of 3 rows have no attitude and were left out",)
    lines = problems_of(rows((0, 1, 0, 0, 0), (1, "", "", "", "")))
    assert lines == ["<stdin>: has an attitude in 1 of 2 rows, two are needed"]


def test_a_row_that_was_trimmed_away_may_hold_anything() -> None:
    text = rows((0, 0.1, 0, 0, 0), (1, 1, 0, 0, 0), (2, 0.8, 0.6, 0, 0), (3, 0.7, 0, 0, 0))
    assert "<stdin>:2: " in problems_of(text)[0]
    assert "<stdin>:5: " in problems_of(text, "trim.from_s=1")[0]
    np.testing.assert_array_equal(load(text, "trim={from_s: 1, to_s: 2}").t, [1, 2])


def test_a_turn_that_may_have_gone_either_way_is_refused() -> None:
    (line,) = problems_of(rows((0, 1, 0, 0, 0), (0.5, 0, 1, 0, 0), (1, 0, 1, 0, 0)))
    assert line == (
        "<stdin>: the attitude turns by 180° from t = 0 to 0.5 s (1 such step): beyond 90° "
        "a record does not tell which way; record more often"
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("t_s,q0,q1,q2\n0,1,0,0\n", "a column is missing: q3"),
        ("t_s,roll_deg,yaw_deg\n0,1,0\n", "a column is missing: pitch_rad or pitch_deg"),
        ("q0,q1,q2,q3\n1,0,0,0\n", "a column is missing: t_s"),
        (rows((0, 1, 0, 0, 0), (1, 0.5, 0, 0, 0)), ":3: q0..q3: the attitude's norm is 0.5, not 1"),
    ],
)
def test_an_attitude_that_is_none_is_refused_in_words(text: str, words: str) -> None:
    assert words in problems_of(text)[0]
