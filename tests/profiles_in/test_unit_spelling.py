"""Units in headers: no spelling is worth a factor."""

import pytest

from des_cli.profiles_in.unit_spelling import HeaderName, read_name, unit_of
from des_cli.units import UNITS


@pytest.mark.parametrize(
    ("name", "stem", "suffix"),
    [
        ("P (deg/s)", "p", "deg_s"),
        ("p [rad/s]", "p", "rad_s"),
        ("p_dps", "p", "deg_s"),
        ("p_rad/s", "p", "rad_s"),
        ("P_DEG_S", "p", "deg_s"),
        ("p rad/s", "p", "rad_s"),
        ("p / (rad/s)", "p", "rad_s"),
        ("q (°/s)", "q", "deg_s"),
        ("q [deg·s-1]", "q", "deg_s"),
        ("r [rad s⁻¹]", "r", "rad_s"),
        ("R_RPM", "r", "rpm"),
        ("arm_rev/min", "arm", "rpm"),
        ("r (degrees per second)", "r", "deg_s"),
        ("Fork (°)", "fork", "deg"),
        ("Cab[rad]", "cab", "rad"),
        ("t_ns", "t", "ns"),
        ("time (us)", "t", "us"),
        ("Time [ms]", "t", "ms"),
        ("Time (µs)", "t", "us"),  # micro sign
        ("Time (μs)", "t", "us"),  # Greek letter
        ("timestamp [ns]", "t", "ns"),
        ("t/s", "t", "s"),
        ("time_sec", "t", "s"),
        ("gyro_x (°/s)", "gyro_x", "deg_s"),
        ("gyro_x_dps", "gyro_x", "deg_s"),
        ("w_RS_S_x [rad s^-1]", "w_RS_S_x", "rad_s"),
        ("arm rate (rpm)", "arm rate", "rpm"),
    ],
)
def test_names_are_taken_apart(name: str, stem: str, suffix: str) -> None:
    found = read_name(name)
    assert (found.stem, found.unit and found.unit.suffix) == (stem, suffix)


@pytest.mark.parametrize(
    "name",
    ["p_mrad_s", "p_mdps", "p (mrad/s)", "p_rads", "t_h", "time (days)", "p_krpm", "q_deg_min"],
)
def test_a_unit_that_is_not_known_is_not_taken_for_a_part_of_it(name: str) -> None:
    found = read_name(name)
    assert found.unit is None
    assert found.unit_text
    assert found.stem in ("p", "q", "t")


@pytest.mark.parametrize("name", ["t", "P", "q0", "quality", "gyro", "Temp (°C)", "p_"])
def test_names_without_a_unit(name: str) -> None:
    assert read_name(name).unit is None


def test_a_name_that_no_person_wrote_is_left_whole() -> None:
    name = "p " + "_ " * 60_000 + "(deg/s)"
    assert read_name(name) == HeaderName(name)
    assert unit_of(" " * 60_000 + "s") is None


def test_every_unit_of_the_table_is_read_as_itself_in_any_case() -> None:
    for unit in UNITS:
        assert unit_of(unit.suffix) == unit_of(unit.suffix.upper()) == unit
        assert read_name(f"x_{unit.suffix}").unit == unit
