"""What the description of a machine may hold, and the small texts in its rows."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pydantic_core import PydanticCustomError

from des_cli.profiles_in.machine_schema import (
    JointLimits,
    MachineSection,
    Occupant,
    Row,
    split_angle,
    split_signed_length,
)
from tests.support.schemas import accepted, refused


@pytest.mark.parametrize(
    ("text", "sign", "name"),
    [("Lx", 1.0, "Lx"), ("-Lx", -1.0, "Lx"), (" + R_2 ", 1.0, "R_2"), ("- H", -1.0, "H")],
)
def test_a_named_length_has_a_sign(text: str, sign: float, name: str) -> None:
    assert split_signed_length(text) == (sign, name)


@pytest.mark.parametrize("text", ["", "-", "2*Lx", "Lx + Ly", "2L", "--Lx", "L" * 21, "Lx\n+1"])
def test_anything_else_is_no_named_length(text: str) -> None:
    with pytest.raises(PydanticCustomError, match="must be a named length such as Lx or -Lx"):
        split_signed_length(text)


@pytest.mark.parametrize(
    ("text", "variable", "sign", "offset"),
    [
        ("arm", "arm", 1, 0.0),
        ("-arm", "arm", -1, 0.0),
        ("- seat_yaw - pi/4", "seat_yaw", -1, -math.pi / 4),
        ("+cab+1.5", "cab", 1, 1.5),
        ("fork + pi/2 - 1", "fork", 1, math.pi / 2 - 1),
        (" seat_pitch ", "seat_pitch", 1, 0.0),
        ("pi/3", None, 1, math.pi / 3),
        ("-2*pi", None, 1, -2 * math.pi),
    ],
)
def test_an_angle_is_a_joint_with_its_sign_an_offset_in_radians_or_both(
    text: str, variable: str | None, sign: int, offset: float
) -> None:
    assert split_angle(text)[:2] == (variable, sign)
    assert split_angle(text)[2] == pytest.approx(offset)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("cba", "must be arm, fork, cab, seat_yaw, seat_pitch (with - before), an angle"),
        ("arms", "must be arm, fork"),
        ("pi/2 + arm", "must be arm, fork"),
        ("arm + t", "must be arm, fork"),
        ("arm + fork", "must be arm, fork"),
        ("", "must be arm, fork"),
        ("cab pi", "must be a joint, an angle, or their sum"),
        ("cab * 2", "must be a joint, an angle, or their sum"),
        ("cab + 1/0", "holds an angle that is no plain number"),
        ("1e6", "holds an angle that is no plain number"),
        ("-1e6", "holds an angle that is no plain number"),
    ],
)
def test_anything_else_is_no_angle(text: str, words: str) -> None:
    with pytest.raises(PydanticCustomError) as caught:
        split_angle(text)
    assert words in caught.value.message()
    assert repr(text) in caught.value.message()


def test_a_length_or_an_angle_of_a_row_is_a_number_with_its_unit_or_a_name() -> None:
    row = accepted(Row, "{alpha_deg: 90, a_ft: 10, d: -Lx, theta: fork + pi/2}")
    assert (row.si("alpha"), row.si("a")) == pytest.approx((math.pi / 2, 3.048))
    assert (row.a, row.d, row.theta) == (None, "-Lx", "fork + pi/2")
    (line,) = refused(Row, "{a_m: 1, a: Lx}")
    assert "the length a is given twice: a_m and a; keep one" in line


def test_a_limit_is_a_number_with_its_unit_or_says_that_there_is_none() -> None:
    limits = accepted(JointLimits, "{angle: endless, rate_rpm: 30, jerk_deg_s3: 90}")
    assert (limits.angle, limits.jerk, limits.given("acceleration")) == ("endless", None, None)
    assert (limits.si("rate"), limits.si("jerk")) == pytest.approx((math.pi, math.pi / 2))
    assert accepted(JointLimits, "{jerk: unlimited}").jerk == "unlimited"


def test_a_bound_of_g_may_be_open_at_one_end() -> None:
    occupant = accepted(Occupant, "{gx_g: [-4, 8], gz_g: [null, 9]}")
    assert (occupant.gx_g, occupant.gy_g, occupant.gz_g) == ([-4.0, 8.0], None, [None, 9.0])
    assert accepted(Occupant, "{gz_g: [1, null]}").gz_g == [1.0, None]


@pytest.mark.parametrize(
    ("section", "text", "place", "words"),
    [
        (JointLimits, "{rate_rpm: .nan}", "rate_rpm", "finite number"),
        (JointLimits, "{rate_rpm: -30}", "rate_rpm", "greater than 0"),
        (JointLimits, "{rate_rpm: 2e6}", "rate_rpm", "at most 1e+06"),
        (JointLimits, "{rate_hz: 30}", "rate_hz", "needs its unit"),
        (JointLimits, "{angle: turning}", "angle", "must be endless"),
        (JointLimits, "{jerk: 3}", "jerk", "must be unlimited"),
        (JointLimits, "{jerk_s3: 3}", "jerk_s3",
         "needs its unit in the key: jerk_rad_s3, jerk_deg_s3 or jerk"),
        (JointLimits, "{jerk: unlimited, jerk_rad_s3: 2}", "f.yaml:1:1", "is given twice"),
        (Occupant, "{gy_g: [1, -1]}", "gy_g", "the least below the most"),
        (Occupant, "{gy_g: [1, 1]}", "gy_g", "the least below the most"),
        (Occupant, "{gy_g: [null, null]}", "gy_g", "bounds nothing"),
        (Occupant, "{gy_g: [1]}", "gy_g", "at least 2 items"),
        (Occupant, "{gy_g: [1, 2, 3]}", "gy_g", "at most 2 items"),
        (Occupant, "{gy_g: 1}", "gy_g", "must be a list"),
        (Occupant, "{gy_g: [-.inf, 1]}", "gy_g[0]", "finite number"),
        (Occupant, "{gy: [-1, 1]}", "gy", "did you mean gy_g?"),
        (Occupant, "{g_onset_g_s: 0}", "g_onset_g_s", "greater than 0"),
        (Occupant, "{seat_angular_acceleration: 1}", "seat_angular_acceleration",
         "needs its unit in the key"),
        (MachineSection, "{gravity_g: 0}", "gravity_g", "must be greater than 0"),
        (MachineSection, "{lengths_ft: {L2: -1}}", "lengths_ft.L2", "must be at least 0"),
        (MachineSection, "{lengths_yd: {L2: 1}}", "lengths_yd",
         "needs its unit in the key: lengths_m"),
        (MachineSection, "{lengths_ft: {L2: 1}, lengths_m: {L2: 1}}", "f.yaml:1:1",
         "is given twice"),
        (MachineSection, "{rows: [1, 2, 3]}", "rows[0]", "must be a mapping"),
        (MachineSection, "{rows: [{}, {}]}", "rows", "at least 3 items"),
        (MachineSection, "{rows: [{}, {}, {a: 2*Lx}]}", "rows[2].a", "must be a named length"),
        (MachineSection, "{rows: [{}, {theta: cba}, {}]}", "rows[1].theta", "must be arm, fork"),
        (MachineSection, "{name: ''}", "name", "must not be empty"),
        (MachineSection, "{fork_axis: vertical}", "fork_axis", "must be radial or tangential"),
    ],
)  # fmt: skip
def test_a_mistake_is_named_where_it_stands(
    section: Any, text: str, place: str, words: str
) -> None:
    lines = refused(section, text)
    assert any(f"{place}: " in line and words in line for line in lines), lines
