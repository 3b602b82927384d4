"""Processes of this machine to run jobs in, with one BLAS thread each."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import AbstractContextManager, contextmanager, nullcontext
from multiprocessing import get_context, resource_tracker
from typing import Any, TypeVar

from des_cli.batch.worker import begin, do
from des_cli.signals import undisturbed

T = TypeVar("T")

# What a BLAS reads when it is loaded: one name for each that numpy and scipy are built with.
_THREAD_VARIABLES = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "BLIS_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
)


@contextmanager
def local_executor(workers: int) -> Iterator[Executor | None]:
    """Offer a pool of processes on this machine, or None where one worker is enough.

    Whatever ends this process or leaves the context ends the workers too. An exception
    does not wait for the tasks that have begun: they put away what they were building.

    Parameters
    ----------
    workers : int
        0 takes as many as there are CPUs that this process may use.
    """
    count = workers or available_cpus()
    with single_blas_thread():
        if count <= 1:
            yield None
            return
        context = get_context("spawn")  # not forked: numpy's threads do not survive a fork
        _start_tracker()
        theirs, ours = context.Pipe(duplex=False)
        with theirs, ours:
            pool = _Pool(count, context, initializer=begin, initargs=(os.getpid(), theirs))
            try:
                yield pool
            except BaseException:
                ours.close()
                raise
            finally:
                pool.shutdown(wait=True, cancel_futures=True)


def _start_tracker() -> None:
    """Start multiprocessing's resource tracker, which puts away what this process cannot.

    It is to outlive a signal to all processes of a terminal, and hears by itself all but
    INT and TERM. Without it whatever is released later is a traceback on stderr.
    """
    if os.name != "nt":
        with undisturbed():
            resource_tracker.ensure_running()


class _Pool(ProcessPoolExecutor):
    """Processes that stop their task when they are told to."""

    def submit(self, fn: Callable[..., T], /, *args: Any, **options: Any) -> Future[T]:
        """Have a task done; a worker may be started for it."""
        with undisturbed():  # it hears signals as soon as it knows what to do with them
            return super().submit(do, fn, *args, **options)


@contextmanager
def single_blas_thread() -> Iterator[None]:
    """Let BLAS use one thread, here and in processes that are started meanwhile.

    The number of threads changes the last bits of a result; with one thread
    everywhere, ``--jobs`` does not. The systems are banded and small, so that
    nothing is lost by it. What numpy has loaded already is limited by threadpoolctl;
    what is loaded later, as scipy's own BLAS is, reads the environment, and so does a
    new process.
    """
    before = {name: os.environ.get(name) for name in _THREAD_VARIABLES}
    os.environ.update(dict.fromkeys(_THREAD_VARIABLES, "1"))
    try:
        with _one_thread_of_what_is_loaded():
            yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _one_thread_of_what_is_loaded() -> AbstractContextManager[object]:
    if "numpy" not in sys.modules:
        return nullcontext()
    from threadpoolctl import threadpool_limits

    limits: AbstractContextManager[object] = threadpool_limits(limits=1, user_api="blas")
    return limits


def available_cpus() -> int:
    """Return how many CPUs this process may use, which can be fewer than there are."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
