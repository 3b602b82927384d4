"""Lines at their times, by a clock that a test sets."""

from __future__ import annotations

import gc
from collections.abc import Iterator

import pytest

from des_cli.feed.lateness import Lateness
from des_cli.feed.pace import SystemClock, feed


class HandClock:
    """Goes on by what is slept, by each look at it, and by what a test adds."""

    def __init__(self, oversleep: int = 0) -> None:
        self.time = 1_000_000
        self.oversleep = oversleep
        self.slept: list[float] = []

    def now(self) -> int:
        self.time += 100
        return self.time

    def sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        self.time += round(seconds * 1e9) + self.oversleep


def lines(count: int) -> Iterator[bytes]:
    return (b"%d\n" % number for number in range(count))


def test_each_line_is_sent_at_its_time_and_not_before() -> None:
    clock, sent = HandClock(), []
    feed(lines(50), 130.0, lambda line: sent.append((line, clock.time)), Lateness(), clock)
    assert [line for line, _ in sent] == list(lines(50))
    start = sent[0][1]
    for number, (_, at) in enumerate(sent):
        due = start + number * 1e9 / 130.0
        assert due - 200 <= at <= due + 400


def test_it_sleeps_until_shortly_before() -> None:
    clock = HandClock()
    feed(lines(3), 100.0, lambda line: None, Lateness(), clock)
    assert [round(seconds, 4) for seconds in clock.slept] == [0.0097, 0.0097]


def test_a_delay_is_made_up_and_no_line_left_out() -> None:
    clock, sent, late = HandClock(), [], Lateness()

    def send(line: bytes) -> None:
        sent.append((line, clock.time))
        if line == b"3\n":
            clock.time += 25_000_000

    feed(lines(10), 100.0, send, late, clock)
    assert [line for line, _ in sent] == list(lines(10))
    start = sent[0][1]
    assert [at - start >= number * 1e7 - 200 for number, (_, at) in enumerate(sent)] == [True] * 10
    assert sent[9][1] - start < 9e7 + 1e3
    assert late.quantile(1.0) == pytest.approx(0.025, abs=1e-4)
    assert late.quantile(0.5) < 1e-5


def test_waking_late_is_told() -> None:
    late = Lateness()
    feed(lines(20), 100.0, lambda line: None, late, HandClock(oversleep=2_000_000))
    assert len(late) == 20
    assert late.quantile(0.99) == pytest.approx(0.0017, abs=1e-5)


def test_what_ends_it_leaves_the_lateness_of_what_was_sent() -> None:
    late = Lateness()

    def send(line: bytes) -> None:
        if line == b"5\n":
            raise BrokenPipeError

    with pytest.raises(BrokenPipeError):
        feed(lines(10), 100.0, send, late, HandClock())
    assert len(late) == 5
    assert gc.isenabled()


def test_garbage_is_not_collected_meanwhile() -> None:
    seen = []
    feed(lines(3), 100.0, lambda line: seen.append(gc.isenabled()), Lateness(), HandClock())
    assert seen == [False] * 3
    assert gc.isenabled()


def test_no_lines_are_no_feed() -> None:
    late = Lateness()
    feed(iter(()), 100.0, lambda line: None, late, HandClock())
    assert str(late) == "0 rows"


def test_the_clock_of_the_system_goes_on() -> None:
    clock = SystemClock()
    before = clock.now()
    clock.sleep(0.001)
    assert clock.now() - before >= 1_000_000
