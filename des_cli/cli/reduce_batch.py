"""Many profiles for ``reduce``: the jobs that they make, run and told one after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import TYPE_CHECKING

from des_cli.batch.job import Job, JobResult
from des_cli.cli.console import VERBOSE, Console
from des_cli.cli.grid_option import read_grid
from des_cli.cli.stdout import write_data
from des_cli.cli.summary import print_result
from des_cli.cli.summary_table import print_closing, print_table
from des_cli.errors import ExitCode

if TYPE_CHECKING:
    from des_cli.batch.summary import SummaryRow


def all_jobs(batch: list[Job], grid: tuple[str, ...]) -> list[Job]:
    """Return a job for each point of the grid, and of these for each stretch between gaps."""
    from des_cli.batch.job import split_jobs
    from des_cli.batch.pool import single_blas_thread

    with single_blas_thread():  # numpy may be imported here
        return split_jobs(_with_grid(batch, grid))


def _with_grid(batch: list[Job], grid: tuple[str, ...]) -> list[Job]:
    if not grid:
        return batch
    from des_cli.batch.grid import grid_jobs
    from des_cli.batch.source import require_distinct_names

    axes = read_grid(grid, batch[0].source.settings)
    require_distinct_names(job.source for job in batch)
    return grid_jobs(batch, axes)


def run_batch(
    console: Console,
    batch: list[Job],
    jobs: int,
    keep_going: bool,
    scheduler: str | None = None,
    store: str | None = None,
    *,
    distinct: bool = False,
) -> ExitCode:
    """Reduce profiles, tell how each ended, and sum up several.

    Parameters
    ----------
    console : Console
    batch : list of Job
    jobs : int
        How many at a time; 0 is one for each CPU.
    keep_going : bool
        Whether to go on after one has failed.
    scheduler : str, optional
        Address of the cluster that reduces them.
    store : str, optional
        Folder of a store to which the runs are added.
    distinct : bool
        Whether no two have one name, as those of a grid; otherwise each is read to see.
    """
    from des_cli.batch.runner import run_tasks
    from des_cli.batch.source import require_distinct_names
    from des_cli.batch.store import storing
    from des_cli.batch.summary import SummaryRow, exit_code_of

    alone = len(batch) == 1
    rows: list[SummaryRow] = []
    with (
        _workers(console, len(batch), jobs, scheduler) as (executor, work),
        storing(store) as writer,
        console.working(len(batch)) as line,
    ):
        if not (alone or distinct):
            require_distinct_names(job.source for job in batch)
        counted = not alone and console.has_line and console.verbosity < VERBOSE
        live = executor is None and console.verbosity >= VERBOSE
        for result in run_tasks(
            batch,
            work,
            JobResult.failed,
            executor,
            keep_going=keep_going,
            on_iteration=console.follow(line, log=live),
            on_stage=line.stage,
            on_finished=line.advance,
        ):
            if console.verbosity >= VERBOSE and not live:
                for iteration in result.log:
                    console.iteration(iteration)
            console.end_log()
            rows.append(SummaryRow.of(result))
            if writer is not None:
                writer.add(result)
            print_result(console, result, alone=alone, counted=counted)
            if result.table is not None:
                with console.aside():
                    write_data(result.table)
    if not alone:
        _sum_up(console, batch, rows)
    return exit_code_of(rows, len(batch))


@contextmanager
def _workers(
    console: Console, count: int, jobs: int, scheduler: str | None
) -> Iterator[tuple[Executor | None, Callable[..., JobResult]]]:
    """Offer what runs jobs, and what is done with each."""
    if scheduler is not None:
        from des_cli.batch.cluster import cluster

        with cluster(scheduler) as connected:
            if not connected.workers:
                console.warn([f"{scheduler} has no workers yet: waiting for one"])
            yield connected.executor, connected.work
        return
    from des_cli.batch.execution import run_job
    from des_cli.batch.pool import local_executor

    with local_executor(1 if count == 1 else min(jobs, count)) as executor:
        yield executor, run_job


def _sum_up(console: Console, batch: list[Job], rows: list[SummaryRow]) -> None:
    """Print the table of a batch, and write it beside its runs."""
    from des_cli.batch.summary import write_summary

    print_table(console, rows)
    print_closing(console, rows, len(batch))
    output = batch[0].output
    if not output.dry_run:
        write_summary(output.out, rows)
