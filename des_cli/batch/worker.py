"""What a worker process does beside its tasks: it ends when it is to, and with its parent.

A pipe whose other end only the parent holds tells both that the parent stops its workers
and that it is gone, however it went. On Linux the kernel sees to the latter as well.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any, NoReturn, TypeVar

from des_cli.signals import disturbed, hear, undisturbed

T = TypeVar("T")

GRACE_S = 1.0
"""Time in which a task that is stopped puts away what it was building."""

_SET_PARENT_DEATH_SIGNAL = 1
"""``PR_SET_PDEATHSIG`` of Linux's ``prctl``."""

_at_work = False


def begin(parent: int, parent_pipe: Connection) -> None:
    """Make this process a worker of its parent; the initializer of a pool.

    Parameters
    ----------
    parent : int
        Its process id.
    parent_pipe : Connection
        Nothing ever comes through it but its end.
    """
    # The parent starts workers that hear nothing: until here it would mean a traceback.
    hear(lambda: _at_work)
    disturbed()
    _die_with(parent)
    waiting = threading.Thread(target=_await_end, args=(parent_pipe,), daemon=True)
    with undisturbed():  # what this thread keeps waiting would come through that one
        waiting.start()


def do(work: Callable[..., T], *args: Any) -> T:
    """Do a task; a signal to stop ends the process after the task has put away its things."""
    global _at_work
    try:
        _at_work = True
        return work(*args)
    except KeyboardInterrupt:
        _leave()
    finally:
        _at_work = False


def _leave() -> NoReturn:
    # Neither a traceback nor a result: the parent is ending, or gone.
    os._exit(1)


def _die_with(parent: int) -> None:
    """Have the kernel end this process with its parent, where it can."""
    if not sys.platform.startswith("linux"):
        return
    import ctypes

    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)
    # It may have died before that was said.
    if os.getppid() != parent:
        _leave()


def _await_end(parent_pipe: Connection) -> None:
    with suppress(EOFError, OSError):
        parent_pipe.recv_bytes()
    os.kill(os.getpid(), signal.SIGTERM)
    threading.Event().wait(GRACE_S)
    _leave()
