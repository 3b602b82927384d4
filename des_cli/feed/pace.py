"""Lines sent at their times, by a clock that nobody sets.

A row waits until shortly before its time asleep, and for the rest awake: the system wakes a
process a tenth of a millisecond or so after it asked to be. A row is never left out: after a delay
rows follow one another until they are on time again.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from typing import Protocol

from des_cli.feed.lateness import Lateness

AWAKE = 0.0003
"""Last part of a wait [s] that is not slept."""

NANO = 1_000_000_000
"""Nanoseconds in a second."""


class Clock(Protocol):
    """What tells the time and lets it pass."""

    def now(self) -> int:
        """Return the time, which never goes back [ns]."""

    def sleep(self, seconds: float) -> None:
        """Wait for about so long [s]."""


class SystemClock:
    """The clock of the system that counts from its start."""

    def now(self) -> int:
        """Return the time [ns]."""
        return time.monotonic_ns()

    def sleep(self, seconds: float) -> None:
        """Wait for about so long [s]."""
        time.sleep(seconds)


def feed(
    lines: Iterator[bytes],
    hz: float,
    send: Callable[[bytes], None],
    lateness: Lateness,
    clock: Clock,
) -> None:
    """Send each line at its time.

    Parameters
    ----------
    lines : iterator of bytes
        The first is sent at once. Each is made before the wait for its time.
    hz : float
        Lines a second.
    send : callable
        Takes a line, and returns when it is out of the process.
    lateness : Lateness
        Gets how late each line was sent; whatever ends the feed, it holds those that were.
    clock : Clock
    """
    first = next(lines, None)
    if first is None:
        return
    with undisturbed_memory():
        start = clock.now()
        send(first)
        lateness.add(clock.now() - start)
        for number, line in zip(count(1), lines, strict=False):
            # Of the number, not of the row before: no error of a period adds up.
            due = start + round(number * NANO / hz)
            _wait(due, clock)
            send(line)
            lateness.add(clock.now() - due)


@contextmanager
def undisturbed_memory() -> Iterator[None]:
    """Keep the collector of garbage, which takes milliseconds, away for a while."""
    collects = gc.isenabled()
    gc.collect()
    gc.freeze()
    gc.disable()
    try:
        yield
    finally:
        gc.unfreeze()
        if collects:
            gc.enable()


def _wait(due: int, clock: Clock) -> None:
    asleep = (due - clock.now()) / NANO - AWAKE
    if asleep > 0.0:
        clock.sleep(asleep)
    while clock.now() < due:
        pass
