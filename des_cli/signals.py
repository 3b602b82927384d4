"""A signal that asks the process to end becomes an exception, so that all is put away.

Imports next to nothing: it is the first thing that the command does.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.machinery import ExtensionFileLoader
from types import FrameType
from typing import Any

from des_cli.errors import ExitCode, Stopped

_ENDINGS = {
    "SIGHUP": ExitCode.HUNG_UP,
    "SIGINT": ExitCode.INTERRUPTED,
    "SIGPIPE": ExitCode.READER_GONE,
    "SIGTERM": ExitCode.TERMINATED,
}
"""By name, because not every system has them all."""

_CODES = {getattr(signal, name): code for name, code in _ENDINGS.items() if hasattr(signal, name)}

_raised: list[ExitCode] = []
"""What was raised in this process."""

_AGAIN_S = 0.01
"""After which time a signal is sent again whose exception was, or would be, lost."""


def die_at_once() -> None:
    """Let Ctrl-C end the process without a traceback while there is nothing to put away."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


@contextmanager
def stopping() -> Iterator[None]:
    """Raise `Stopped` at the first signal that asks to end; afterwards a signal ends at once."""
    heard = hear()
    try:
        yield
    finally:
        for number in heard:
            # As Python begins, which ignores SIGPIPE.
            begun = signal.SIG_IGN if _CODES[number] == ExitCode.READER_GONE else signal.SIG_DFL
            signal.signal(number, begun)


def hear(when: Callable[[], bool] = lambda: True) -> list[signal.Signals]:
    """Raise `Stopped` in the main thread at the first signal that asks to end.

    What was ignored when the process was started (``nohup``, a shell's ``&``) stays
    ignored. The first signal counts: what it began takes no two seconds, and another one
    must not disturb it.

    Parameters
    ----------
    when : callable
        Asked at a signal; where it says no, the process ends without further ado.

    Returns
    -------
    list of Signals
        Those that are heard.
    """
    stopped = False

    def stop(number: int, frame: FrameType | None) -> None:
        nonlocal stopped
        code = _CODES[signal.Signals(number)]
        if not when():
            os._exit(code)
        if not stopped and _loads_compiled_code(frame):
            _send_again(number)
        elif not stopped:
            stopped = True
            _raised.append(code)
            raise Stopped(code)

    def again(lost: Any) -> None:
        # Raised in a finalizer or a weak reference's callback, an exception leads nowhere.
        nonlocal stopped
        if not isinstance(lost.exc_value, Stopped):
            sys.__unraisablehook__(lost)
            return
        code = lost.exc_value.exit_code
        _raised.clear()
        number = next(each for each in heard if _CODES[each] == code)
        stopped = False
        _send_again(number)

    heard = [number for number in _CODES if _is_heard(number)]
    sys.unraisablehook = again
    for number in heard:
        signal.signal(number, stop)
    return heard


def cause_of(error: BaseException) -> BaseException:
    """Return an error, or `Stopped` where it came of that.

    What was raised in code that makes another error of it, such as an ``ImportError``, is
    found again.
    """
    return error if not _raised or isinstance(error, Stopped) else Stopped(_raised[0])


def raise_if_stopped(error: BaseException) -> None:
    """Raise `Stopped` again where another error came of it."""
    cause = cause_of(error)
    if cause is not error:
        raise cause from error


@contextmanager
def undisturbed() -> Iterator[None]:
    """Keep signals that ask to end waiting, here and in processes that are started."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, _CODES)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def disturbed() -> None:
    """Hear what was kept waiting by the process that started this one."""
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _CODES)


def _loads_compiled_code(frame: FrameType | None) -> bool:
    """Tell whether a module of compiled code is being loaded.

    It makes ``ImportError: initialization failed`` of whatever is raised meanwhile, or, as
    Cython does where it registers its types, nothing at all.
    """
    while frame is not None:
        loads = frame.f_code.co_name in ("create_module", "exec_module")
        if loads and isinstance(frame.f_locals.get("self"), ExtensionFileLoader):
            return True
        frame = frame.f_back
    return False


def _send_again(number: int) -> None:
    with undisturbed():  # a thread that hears it would have this one disturbed at any time
        threading.Timer(_AGAIN_S, os.kill, (os.getpid(), number)).start()


def _is_heard(number: signal.Signals) -> bool:
    # Python ignores SIGPIPE itself, whatever it was started with.
    ignored = signal.getsignal(number) is signal.SIG_IGN
    return not ignored or _CODES[number] == ExitCode.READER_GONE
