"""A line on a terminal that says what is being done, rewritten while it lasts.

It appears once the work has taken a while, and is gone afterwards. A thread keeps its
seconds going through what tells nothing; whoever works only names the stages.
"""

from __future__ import annotations

import os
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, TextIO

from des_cli.cli.terminal import printable
from des_cli.signals import undisturbed

if TYPE_CHECKING:
    from types import TracebackType

    from des_cli.model.solution import Iteration

DELAY_S = 1.0
"""Work that is done before leaves no line."""

INTERVAL_S = 0.1
"""Time between two drawings at the least, and of the thread's."""

_ENDS = 32
"""Of so many tasks, at the most, the pace is taken: those that were done before took no time."""

_MINUTE, _HOUR, _DAY = 60.0, 3600.0, 86400.0

_ERASE = "\r\x1b[K"
_NARROW = 80
"""Columns of a terminal that does not tell."""


class StatusLine:
    """What is being done, for as long as the context lasts.

    Parameters
    ----------
    stream : text stream, optional
        A terminal; None shows nothing.
    total : int
        How many there are to do; of several the line counts those that are done.
    noun : str
        What they are, in the plural.
    clock : callable
        Seconds that only grow.
    """

    def __init__(
        self,
        stream: TextIO | None,
        *,
        total: int = 1,
        noun: str = "profiles",
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._stream, self._total, self._noun, self._clock = stream, total, noun, clock
        self._stage, self._step, self._done = "", -1, 0
        self._began, self._drawn = clock(), -float("inf")
        self._ends = deque([self._began], maxlen=_ENDS + 1)
        self._shown = False
        # whoever draws, erases or prints beside it holds it
        self._lock = threading.RLock()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._keep_going, daemon=True)

    def __enter__(self) -> StatusLine:
        """Begin to count the seconds."""
        self._began = self._clock()
        self._ends[0] = self._began
        if self._stream is not None:
            with undisturbed():  # what is kept waiting would come through this thread
                self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Take the line away, however the work ended."""
        self._over.set()
        if self._thread.is_alive():
            self._thread.join()
        with self.hidden():
            self._stream = None

    def stage(self, text: str) -> None:
        """Say what is done from now on."""
        with self._lock:
            self._stage, self._step = text, -1
            self._draw()

    def iteration(self, iteration: Iteration) -> None:
        """Say how many steps a solver has taken."""
        with self._lock:
            self._step = iteration.number
            self._draw()

    def advance(self) -> None:
        """Count one more that is done."""
        with self._lock:
            self._done += 1
            self._ends.append(self._clock())
            self._stage, self._step = "", -1
            self._draw()

    @contextmanager
    def hidden(self) -> Iterator[None]:
        """Keep the line away while something else is printed."""
        with self._lock:
            if self._shown:
                self._write(_ERASE)
                self._shown = False
            yield

    def _keep_going(self) -> None:
        while not self._over.wait(max(INTERVAL_S, 0.01)):
            with self._lock:
                self._draw()

    def _draw(self) -> None:
        """Draw the line if the work has lasted, and not too soon after the last time."""
        now = self._clock()
        if self._stream is None or now - self._began < DELAY_S or now - self._drawn < INTERVAL_S:
            return
        columns = columns_of(self._stream) or _NARROW
        self._write(_ERASE + printable(self._text(now))[: columns - 1])
        self._shown, self._drawn = True, now

    def _text(self, now: float) -> str:
        parts = []
        if self._total > 1:
            parts.append(f"{self._done} of {self._total} {self._noun} done")
        if self._stage:
            parts.append(self._stage)
        if self._step >= 0:
            parts.append(f"step {self._step}")
        parts.append(f"{now - self._began:.0f} s")
        if left := self._left(now):
            parts.append(f"about {left} left")
        return f"  {', '.join(parts)}"

    def _left(self, now: float) -> str:
        """Say how long the rest takes at the pace of what was done last, if that is known."""
        rest = self._total - self._done
        if not self._done or not rest:
            return ""
        pace = (self._ends[-1] - self._ends[0]) / (len(self._ends) - 1)
        seconds = self._ends[-1] + pace * rest - now
        return duration_words(seconds) if seconds >= 1.0 else ""

    def _write(self, text: str) -> None:
        """Write at once; a terminal that went away is no reason to stop working."""
        if self._stream is not None:
            with suppress(OSError, ValueError):
                self._stream.write(text)
                self._stream.flush()


def duration_words(seconds: float) -> str:
    """Say a duration in one unit, of which there are at least two.

    >>> [duration_words(seconds) for seconds in (2.4, 119, 121, 7100, 9000, 200_000)]
    ['2 s', '119 s', '2 min', '118 min', '2 h', '2 days']
    """
    for unit, word in ((_DAY, "days"), (_HOUR, "h"), (_MINUTE, "min")):
        if seconds >= 2.0 * unit:
            return f"{seconds / unit:.0f} {word}"
    return f"{seconds:.0f} s"


def columns_of(stream: TextIO | None) -> int | None:
    """Return how wide a terminal is, None of what is none or does not tell."""
    try:
        return os.get_terminal_size(stream.fileno()).columns or None if stream else None
    except (OSError, ValueError):
        return None


class ProgressLog(StatusLine):
    """What is being done, as messages for a program.

    Parameters
    ----------
    tell : callable
        Takes what is being done, and how many are done of how many.
    total, noun
        As of `StatusLine`.
    """

    def __init__(self, tell: Callable[..., None], *, total: int = 1, noun: str = "profiles"):
        super().__init__(None, total=total, noun=noun)
        self._tell = tell

    def stage(self, text: str) -> None:
        """Tell what is done from now on."""
        if text != self._stage:
            self._stage = text
            self._tell(text, done=self._done, total=self._total)

    def advance(self) -> None:
        """Tell that one more is done."""
        super().advance()
        done = f"{self._done} of {self._total} {self._noun} done"
        self._tell(done, done=self._done, total=self._total)
