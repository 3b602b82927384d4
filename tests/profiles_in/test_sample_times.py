"""Times of samples keep their digits, whatever the epoch."""

from decimal import Decimal
from itertools import accumulate

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from des_cli.errors import ProfileError
from des_cli.profiles_in.profile_csv import parse_samples


def times(cells: list[str], unit: str = "s", **how: str) -> tuple[np.ndarray, list[str]]:
    remarks: list[str] = []
    comma = ";" if how else ","
    rows = "".join(comma.join([cell, "1", "2", "3"]) + "\n" for cell in cells)
    text = comma.join([f"t_{unit}", "p_rpm", "q_rpm", "r_rpm"]) + "\n" + rows
    return parse_samples(text, "x.csv", {}, remarks=remarks, **how)[0], remarks


def test_nanoseconds_of_an_epoch_have_exact_steps() -> None:
    first = 1403636579758555392
    t, remarks = times([str(first + 5_000_000 * k) for k in range(1000)], "ns")
    np.testing.assert_array_equal(t, np.arange(1000) * 5 / 1000)
    assert remarks == ["times are counted from the first, 1403636579758555392 ns"]
    # in doubles these are 5000192 and 4999936 ns apart by the digits of the file
    t, _ = times(["1403636579758555392", "1403636579763555584", "1403636579768555520"], "ns")
    np.testing.assert_array_equal(t, [0, 0.005000192, 0.010000128])


@given(
    st.integers(10**6, 10**12),
    # of like size: a step many times the others would be a gap
    st.lists(st.integers(200, 999), min_size=1, max_size=5),
    st.sampled_from([1, 10**3, 10**6]),
    st.sampled_from([("s", 1), ("ms", 1000), ("us", 10**6), ("ns", 10**9)]),
)
def test_large_times_are_as_far_apart_as_their_digits_say(
    seconds: int, steps: list[int], scale: int, unit: tuple[str, int]
) -> None:
    nanoseconds = [*accumulate([seconds * 10**9, *(scale * step for step in steps)])]
    cells = [f"{Decimal(n) * unit[1] / 10**9:f}" for n in nanoseconds]
    t, _ = times(cells, unit[0])
    expected = [(n - nanoseconds[0]) / 10**9 for n in nanoseconds]
    np.testing.assert_array_equal(t, expected)


def test_large_times_with_a_decimal_comma() -> None:
    t, remarks = times(["1700000000,25", "1700000000,255"], separator=";", decimal=",")
    np.testing.assert_array_equal(t, [0, 0.005])
    assert remarks == ["times are counted from the first, 1700000000,25 s"]


def test_other_times_stay_as_they_are() -> None:
    t, remarks = times(["604799.5", "604800"])
    np.testing.assert_array_equal(t, [604799.5, 604800])
    assert remarks == []


def test_a_clock_is_read_whatever_the_unit_of_the_name() -> None:
    t, remarks = times(["23:59:59.9", "0:00:00.4"], "ns")
    np.testing.assert_array_equal(t, [0, 0.5])
    assert remarks == [
        "times are counted from the first, 23:59:59.9",
        "the clock starts anew 1 time: the time goes on",
    ]


@pytest.mark.parametrize(
    ("cells", "problem"),
    [
        (["0:00:01", "2"], "x.csv:3: t_s: 2 is not written as the first time, 0:00:01"),
        (["1", "0:00:02"], "x.csv:3: t_s: 0:00:02 is not written as the first time, 1"),
        (["0:01", "0:02"], "x.csv:2: t_s: 0:01 may be minutes and seconds or hours and minutes"),
        (["0:00:01", "0:00:01"], "x.csv:3: t_s: 0:00:01 does not increase (previous 0:00:01)"),
        (
            ["0.30000000000000004", "0.3"],
            "t_s: 0.3 does not increase (previous 0.30000000000000004)",
        ),
    ],
)
def test_what_is_wrong_with_times_is_said_with_all_their_digits(
    cells: list[str], problem: str
) -> None:
    with pytest.raises(ProfileError) as caught:
        times(cells)
    (line,) = map(str, caught.value.complaints)
    assert problem in line
