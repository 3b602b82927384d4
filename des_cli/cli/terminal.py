"""What a terminal may be given: text that stays on its line and moves nothing.

Paths, names and headers come from others. A newline in one could forge a line of its own,
an escape sequence could hide one. And what is meant for a terminal goes into no file.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any


def printable(text: str) -> str:
    r"""Write every character that is not to be seen as Python writes it.

    >>> printable("a\x1b[2J\nok, 5 µm")
    'a\\x1b[2J\\nok, 5 µm'
    """
    if text.isprintable():
        return text
    return "".join(
        each if each.isprintable() else each.encode("unicode_escape").decode() for each in text
    )


def fill_streams() -> None:
    """Open what of stdin, stdout and stderr is closed on nothing, here and for workers.

    The next file that is opened would have its number otherwise, and get what a library or
    a worker writes there. That Python found it closed (``sys.stdout is None``) stays so.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:  # the numbers below it are taken: this is the next
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)


def give_up(stream: Any) -> None:
    """Send what a stream could not write, and what follows, nowhere.

    Otherwise the interpreter tries, and fails, once more at its exit, with an exit code of
    its own.
    """
    with suppress(OSError, ValueError, AttributeError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)


@contextmanager
def without_broken_pipe_signal() -> Iterator[None]:
    """Let a reader that went away be an exception of the write, and no signal."""
    if not hasattr(signal, "sigtimedwait"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGPIPE])
    try:
        yield
    finally:
        if signal.SIGPIPE not in before:
            signal.sigtimedwait([signal.SIGPIPE], 0)
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
