"""What a worker of a cluster does: a profile comes in whole, and a run goes out as bytes.

The worker opens no file. Whoever sent the order reads the profile, writes the run, and
releases it.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from des_cli import __version__
from des_cli.batch.execution import reduce_with, result_of
from des_cli.batch.job import Job, JobResult
from des_cli.batch.pool import single_blas_thread
from des_cli.errors import Complaint, FileAccessError

if TYPE_CHECKING:
    from des_cli.model.profile import Profile
    from des_cli.model.run import Run

_ONE_AT_A_TIME = threading.Lock()
"""A worker may have several threads; the number of BLAS threads is the whole process's."""


@dataclass(frozen=True, slots=True)
class Order:
    """A profile that is to be reduced elsewhere.

    Parameters
    ----------
    job : Job
        Its name for messages, whether plots are drawn, and what it is refused for.
    profile : Profile
        As it was read.
    version : str
        Of this program, by whoever orders: another one has other bytes.
    """

    job: Job
    profile: Profile
    version: str = __version__


@dataclass(frozen=True, slots=True)
class Delivery:
    """What became of an order.

    Parameters
    ----------
    result : JobResult
        Nothing is written yet.
    outputs : mapping of str to bytes
        The files of the run folder, the manifest last; empty where it failed.
    """

    result: JobResult
    outputs: Mapping[str, bytes] = field(default_factory=dict)


def fulfil(order: Order) -> Delivery:
    """Reduce the profile of an order; whatever fails becomes part of what is delivered."""
    outputs: dict[str, bytes] = {}
    job, name = order.job, order.profile.name

    def encode(run: Run) -> None:
        from des_cli.release.gate import require_table
        from des_cli.runs_out.manifest import COMMANDS
        from des_cli.runs_out.run_folder import encode_run

        outputs.update(encode_run(run, plots=job.output.plots))
        require_table(run, outputs[COMMANDS], fail_on=job.fail_on)

    def whole() -> JobResult:
        if order.version != __version__:
            what = f"a worker has version {__version__} of des-coriolis, and not {order.version}"
            raise FileAccessError([Complaint(name, what)])
        return reduce_with(encode, job, order.profile)

    with _ONE_AT_A_TIME, single_blas_thread():
        result = result_of(job, name, whole)
    return Delivery(result, outputs if result.ok else {})
