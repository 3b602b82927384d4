"""A signal that asks the process to end becomes an exception, so that all is put away.

Imports next to nothing: it is the first thing that the command does.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from des_cli.errors import ExitCode, Stopped

_ENDINGS = {
    "SIGHUP": ExitCode.HUNG_UP,
    "SIGINT": ExitCode.INTERRUPTED,
    "SIGPIPE": ExitCode.READER_GONE,
    "SIGTERM": ExitCode.TERMINATED,
}
"""By name, because not every system has them all."""

_NUMBERS = {getattr(signal, name): code for name, code in _ENDINGS.items() if hasattr(signal, name)}


def die_at_once() -> None:
    """Let Ctrl-C end the process without a traceback while there is nothing to put away."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


@contextmanager
def stopping() -> Iterator[None]:
    """Raise `Stopped` in the main thread at the first signal that asks to end.

    What was ignored when the process was started (``nohup``, a shell's ``&``) stays
    ignored. The first signal counts: what it began takes no two seconds, and another one
    must not disturb it. Afterwards a signal ends the process at once.
    """
    stopped = False

    def stop(number: int, _: FrameType | None) -> None:
        nonlocal stopped
        if not stopped:
            stopped = True
            raise Stopped(_NUMBERS[signal.Signals(number)])

    heard = [number for number in _NUMBERS if _is_heard(number)]
    for number in heard:
        signal.signal(number, stop)
    try:
        yield
    finally:
        for number in heard:
            ignored = number.name == "SIGPIPE"
            signal.signal(number, signal.SIG_IGN if ignored else signal.SIG_DFL)


def _is_heard(number: signal.Signals) -> bool:
    # Python ignores SIGPIPE itself, whatever it was started with.
    return number.name == "SIGPIPE" or signal.getsignal(number) is not signal.SIG_IGN
