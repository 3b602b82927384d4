"""Jobs on the workers of a Dask cluster, which see no file of this machine.

Each job is done by a thread here as it would be in a process: read, locked, written and
settled. Only the reduction in between is sent away, and waited for. So this process alone
owns the outputs, and the workers may come, go and die: the scheduler gives what a lost one
had to another.
"""

from __future__ import annotations

import asyncio
import logging
import re
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from des_cli.batch.execution import run_job
from des_cli.batch.job import Job, JobResult
from des_cli.batch.pool import single_blas_thread
from des_cli.batch.remote import Delivery, Order, fulfil
from des_cli.errors import Complaint, FileAccessError, UsageError

if TYPE_CHECKING:
    from des_cli.model.profile import Profile

CONNECT_S = 4.0
"""For which a scheduler is waited."""

LEAST_IN_FLIGHT = 16
"""Profiles that are read, or waited for, at a time; more where the cluster has more threads."""

_CLOSE_S = 2.0
_ADDRESS = re.compile(r"(tcp|tls|ws|wss)://[^\s/]+:\d+")


@dataclass(frozen=True)
class Cluster:
    """A scheduler that answers.

    Parameters
    ----------
    executor : Executor
        Runs jobs.
    work : callable
        What is done with each.
    workers : int
        How many there were at the beginning.
    """

    executor: Executor
    work: Callable[..., JobResult]
    workers: int


@contextmanager
def cluster(address: str) -> Iterator[Cluster]:
    """Connect to a scheduler; whatever leaves the context cancels what is not done.

    Parameters
    ----------
    address : str
        ``tcp://host:port``.

    Raises
    ------
    UsageError
        If it is no address, or Dask is not installed.
    FileAccessError
        If no scheduler answers.
    """
    if not _ADDRESS.fullmatch(address):
        raise UsageError.of(f"--scheduler {address!r}: is not an address such as tcp://host:8786")
    try:
        distributed: Any = import_module("distributed")
    except ImportError:
        what = "--scheduler needs Dask: pip install 'des-coriolis[cluster]'"
        raise UsageError.of(what) from None
    _quieten()
    with single_blas_thread():
        try:
            client = distributed.Client(address, timeout=CONNECT_S, set_as_default=False)
        except (OSError, TimeoutError, ValueError) as error:
            raise FileAccessError([Complaint(address, "no scheduler answers there")]) from error
        pending: set[Any] = set()
        try:
            known = client.scheduler_info(n_workers=-1)["workers"].values()
            threads = sum(worker["nthreads"] for worker in known)
            pool = ThreadPoolExecutor(max(LEAST_IN_FLIGHT, 2 * threads))
            try:
                send = partial(_reduce_there, client, pending)
                yield Cluster(pool, partial(run_job, reduce=send), len(known))
            finally:
                pool.shutdown(wait=False, cancel_futures=True)
                if pending:
                    client.cancel(list(pending), force=True)
                pool.shutdown(wait=True)
        finally:
            with suppress(Exception):
                client.close(timeout=_CLOSE_S)


def _quieten() -> None:
    """Keep Dask's log from stderr: what ends a profile is said of that profile."""
    for name in list(logging.root.manager.loggerDict):
        if name.partition(".")[0] in ("distributed", "tornado", "asyncio"):
            logging.getLogger(name).disabled = True


def _reduce_there(
    client: Any,
    pending: set[Any],
    job: Job,
    profile: Profile,
    target: Path,
    on_iteration: object,
    on_stage: object,
) -> JobResult:
    """Have a profile reduced by a worker, and write what comes back."""
    from des_cli.release.delivered import require_delivered
    from des_cli.runs_out.run_folder import write_outputs

    sent = replace(job, source=replace(job.source, stdin=None, settings=()))
    delivery = _wait(client, pending, Order(sent, profile), profile.name)
    result = delivery.result
    if not result.ok:
        return result

    def accept(built: Path) -> None:
        require_delivered(built, profile, result.notices, job.fail_on)

    write_outputs(delivery.outputs, target, overwrite=job.output.overwrite, accept=accept)
    return replace(result, written=str(target))


def _wait(client: Any, pending: set[Any], order: Order, name: str) -> Delivery:
    killed: type[Exception] = import_module("distributed").KilledWorker
    # Not pure: nobody is to hash the profile, and each order is a task of its own.
    future = client.submit(fulfil, order, pure=False)
    pending.add(future)
    try:
        delivery = future.result()
    except killed:
        what = "each worker that began with it died, perhaps for want of memory"
        raise FileAccessError([Complaint(name, what)]) from None
    except (asyncio.CancelledError, CancelledError):
        what = "was given up: the scheduler is gone, or the batch was stopped"
        raise FileAccessError([Complaint(name, what)]) from None
    except ModuleNotFoundError as error:
        what = f"the cluster has no module {error.name}: install this version of des-coriolis there"
        raise FileAccessError([Complaint(name, what)]) from error
    finally:
        pending.discard(future)
        future.release()
    assert isinstance(delivery, Delivery)
    return delivery
