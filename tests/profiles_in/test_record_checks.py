"""Times that stand still, numbers beyond any machine, and degrees under the name of radians."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pytest

from des_cli.errors import Complaint
from des_cli.model.profile import BodyRates
from des_cli.profiles_in.column_kinds import Column
from des_cli.profiles_in.csv_header import Header
from des_cli.profiles_in.csv_table import Rows
from des_cli.profiles_in.record_checks import (
    check_magnitudes,
    check_times,
    tell_doubtful_units,
    unfollowed_turning,
)
from des_cli.profiles_in.sample_times import SampleTimes
from des_cli.units import unit_named

HEADER = Header("x.csv", ["t_s", "p_rad_s", "q_rad_s", "r_rad_s"], "", 1)
TIME = Column("t", "t_s", "t_s", 0, unit_named("s"))


def column(stem: str, suffix: str, in_file: str = "") -> Column:
    name = f"{stem}_{suffix}"
    return Column(stem, name, in_file or name, 1, unit_named(suffix))


def rows_of(count: int) -> Rows:
    """Rows with a comment between each two."""
    return Rows(np.zeros((count, 4)), range(3, 3 + 2 * count, 2))


def complaints_of_times(t: Sequence[float], cells: list[str] | None = None) -> list[str]:
    complaints: list[Complaint] = []
    times = SampleTimes(np.array(t), np.array(t), cells)
    check_times(HEADER, TIME, times, rows_of(len(t)), complaints)
    return [str(complaint) for complaint in complaints]


def complaints_of_magnitudes(columns: Sequence[Column], values: Mapping[str, list[float]]) -> str:
    complaints: list[Complaint] = []
    by_stem = {stem: np.array(numbers) for stem, numbers in values.items()}
    rows = rows_of(len(by_stem["t"]))
    check_magnitudes(HEADER, columns, by_stem, rows, complaints)
    return "\n".join(map(str, complaints))


def remarks_on_units(columns: Sequence[Column], values: Mapping[str, list[float]]) -> list[str]:
    remarks: list[str] = []
    by_stem = {stem: np.array(numbers) for stem, numbers in values.items()}
    tell_doubtful_units(columns, by_stem, remarks)
    return remarks


def test_each_time_that_does_not_increase_is_named_with_its_line_and_cure() -> None:
    assert complaints_of_times([0, 0.5, 0.5, 0.25, 1]) == [
        "x.csv:7: t_s: 0.5 does not increase (previous 0.5); remove one of the two rows",
        "x.csv:9: t_s: 0.25 does not increase (previous 0.5); put the rows in order, or cut the "
        "file in two where its clock was set back",
    ]
    assert complaints_of_times([-1, 0, 1e-300]) == []


def test_a_time_is_repeated_as_the_file_has_it() -> None:
    (found,) = complaints_of_times([0, 0], ["12:00:00.50 ", "12:00:00.5"])
    assert "t_s: 12:00:00.5 does not increase (previous 12:00:00.50);" in found


@pytest.mark.parametrize(("late", "lines"), [(20, 20), (21, 21), (300, 21)])
def test_a_flood_of_times_is_counted(late: int, lines: int) -> None:
    found = complaints_of_times([0.0] * (late + 1))
    assert len(found) == lines
    if late > 20:
        assert found[-1] == f"x.csv: … and {late - 20} more times like these"


def test_one_row_is_no_motion() -> None:
    assert complaints_of_times([3]) == ["x.csv: has one row; a motion needs two or more"]


def test_a_command_beyond_any_machine_is_named_at_its_first_row_and_counted() -> None:
    columns = [
        TIME,
        column("fork", "deg", "tilt"),
        column("p", "rad_s"),
        Column("q0", "q0", "q0", 2),
    ]
    found = complaints_of_magnitudes(
        columns,
        {
            "t": [1e9, 2e9, 3e9, 4e9],
            "fork": [0, -1.1e6, 1e6, 2e6],
            "p": [1e6, -1e6, 0, 0],
            "q0": [1e7, np.nan, 1, 1],
        },
    )
    assert found == "x.csv:5: tilt: is beyond 1e+06 rad or rad/s (2 such cells)"


@pytest.mark.parametrize("suffix", ["g", "m_s2"])
def test_a_recorded_g_is_bounded_as_an_asked_one(suffix: str) -> None:
    values = np.array([1.0, 100.0, -100.01, 150.0]) * 9.81456
    found = complaints_of_magnitudes(
        [TIME, column("gz", suffix)], {"t": [0, 1, 2, 3], "gz": values.tolist()}
    )
    assert found == f"x.csv:7: gz_{suffix}: is beyond 100 g (2 such cells)"


def test_degrees_under_the_name_of_radians_are_asked_about_in_one_line() -> None:
    columns = [TIME, column("p", "rad_s"), column("q", "rad_s", "gyro y"), column("r", "rad_s")]
    values = {"t": [0.0, 1, 2], "p": [0.0, 0, 0], "q": [60.0, 61, -64.25], "r": [-40.0, 0, 0]}
    assert remarks_on_units(columns, values) == [
        "gyro y reaches 64.2 rad/s; is it in deg/s? --column 'q_deg_s=gyro y' reads it so"
    ]


@pytest.mark.parametrize(
    ("stem", "suffix", "values", "asked"),
    [
        ("arm", "rad_s", [30, 30, 0], True),
        ("arm", "rad_s", [20, 20, 20], False),
        ("arm", "rad_s", [0, 99, 0], False),
        ("arm", "rad", [30, 60, 90], False),
        ("r", "deg_s", [30, 30, 30], False),
        ("fork", "rad", [30, 30, 30], False),
    ],
)
def test_most_rows_of_a_rate_in_radians_must_be_beyond_reach(
    stem: str, suffix: str, values: list[float], asked: bool
) -> None:
    remarks = remarks_on_units([TIME, column(stem, suffix)], {"t": [0, 1, 2], stem: values})
    assert bool(remarks) is asked


def test_two_axes_together_reach_what_neither_does_on_most_rows() -> None:
    columns = [column("p", "rad_s"), column("q", "rad_s")]
    values = {"p": [50.0, 50, 0, 0, 0], "q": [0.0, 0, 50, 50, 0]}
    assert len(remarks_on_units(columns, values)) == 1


def test_times_of_another_unit_are_told_by_how_far_they_are_apart() -> None:
    for t in ([0.0, 1e300, 2e300], [0.0, 6e6, 1.2e7], [-1.7e308, 0.0, 1.7e308]):
        (line,) = complaints_of_times(t)
        assert line.endswith("s, longer than 1e+07 s: correct its unit")
    (line,) = complaints_of_times([0.0, 5e-324, 1e-323])
    assert line == "x.csv:5: t_s: a step of 4.94e-324 s is shorter than 1e-09 s: correct its unit"
    assert complaints_of_times([0.0, 5e6, 1e7]) == complaints_of_times([0.0, 2e-9, 4e-9]) == []


def test_turning_between_rows_that_nobody_recorded_is_told_with_the_step_it_takes() -> None:
    def turning(step: float, rate: float, rows: int = 3) -> str:
        t = step * np.arange(rows)
        rates = np.full((rows - 1, 3), [rate, 0.0, 0.0])
        return unfollowed_turning(t, BodyRates(rates, rates, rates))

    assert turning(10.0, 0.2) == ""
    assert turning(1.0, 0.99, rows=100_000) == ""
    assert turning(75.0, 2.0) == ""
    what = turning(76.0, 2.0)
    assert what.startswith("the body turns by up to 152 rad from one row to the next")
    assert "304 rad in all" in what
    assert "sample at least every 0.5 s" in what
    assert "rad in all" in turning(1.01, 1.0, rows=1000)
