"""Times of day and dates: seconds since the first one, against the standard library."""

from datetime import datetime, timedelta, timezone

import pytest
from hypothesis import given
from hypothesis import strategies as st

from des_cli.profiles_in.clock import ClockError, is_clock, seconds_of

ZONES = st.integers(-14 * 60, 14 * 60).map(lambda m: timezone(timedelta(minutes=m)))
MOMENTS = st.datetimes(datetime(1970, 1, 1), datetime(2100, 1, 1), timezones=ZONES)


@given(st.lists(MOMENTS, min_size=1, max_size=5), st.sampled_from("T "))
def test_dates_with_zones_are_as_far_apart_as_the_library_says(
    moments: list[datetime], border: str
) -> None:
    seconds, turns = seconds_of([moment.isoformat(border) for moment in moments])
    exact = [(moment - moments[0]) / timedelta(microseconds=1) / 1e6 for moment in moments]
    assert seconds == pytest.approx(exact, rel=1e-15, abs=1e-12)
    assert turns == 0


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        (["2024-05-01T12:00:00.123Z", "2024-05-01T12:00:00.128Z"], [0, 0.005]),
        (["2024-02-28 23:59:59", "2024-03-01 00:00:00"], [0, 86401]),
        (["2024/05/01 12:00", "2024/05/01 12:01"], [0, 60]),
        (["2024-05-01T12:00:00+0200", "2024-05-01T10:00:01Z"], [0, 1]),
        (["12:00:00.123456789", "12:00:00.123456790"], [0, 1e-9]),
        (["9:59:59,5", "10:00:00,25"], [0, 0.75]),
        (["01:02.5", "01:03.0"], [0, 0.5]),
        (["0:59.9", "1:00.0", "1:01"], [0, 0.1, 1.1]),
    ],
)
def test_each_way_of_writing(cells: list[str], expected: list[float]) -> None:
    assert all(is_clock(cell) for cell in cells)
    assert seconds_of(cells) == (expected, 0)


def test_a_clock_goes_on_after_midnight_and_after_the_hour() -> None:
    assert seconds_of(["23:59:59.9", "00:00:00.1", "23:00:00.0", "1:00:00.0"]) == (
        [0, 0.2, 82800.1, 90000.1],
        2,
    )
    assert seconds_of(["59:59.5", "00:00.5"]) == ([0, 1], 1)
    # a time that only falls back a little is left to whoever asks for increasing times
    assert seconds_of(["12:00:01", "12:00:00"]) == ([0, -1], 0)


@pytest.mark.parametrize(
    ("cells", "row", "words"),
    [
        (["12:00:00", "01:02.5"], 1, "is not written as the first time, 12:00:00"),
        (["2024-05-01T12:00:00", "2024-05-01T12:00:00Z"], 1, "is not written as the first time"),
        (["01:02", "01:03"], 0, "minutes and seconds or hours and minutes"),
        (["2024-05-01T12:00:00", "2024-02-30T12:00:00"], 1, "is no date of the calendar"),
    ],
)
def test_what_is_not_clear_is_refused(cells: list[str], row: int, words: str) -> None:
    with pytest.raises(ClockError, match=words) as caught:
        seconds_of(cells)
    assert caught.value.row == row


@pytest.mark.parametrize(
    "cell", ["", "1.5", "12", "12:60:00", "1:2:3:4", "2024-05-01", "a:b", "12:00:00 pm", "1e3:00"]
)
def test_what_is_no_time(cell: str) -> None:
    assert not is_clock(cell)
