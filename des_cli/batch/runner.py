"""One profile from its source to its output, and many of them over an Executor.

A job is plain data that can cross a process boundary, and so is its result: a
pool of this machine and a ``dask.distributed`` client's executor
(``client.get_executor()``) are one code path.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from des_cli.batch.job import STANDARD_STREAM, Job, JobResult
from des_cli.errors import Complaint, DesError, ExitCode, Failure, FileAccessError, UsageError
from des_cli.model.coriolis import COMPONENTS
from des_cli.model.stage import OnStage, untold

# What needs numpy is imported when a job runs: a worker must be able to set its
# number of BLAS threads before that, and a rejected command line needs none.
if TYPE_CHECKING:
    from des_cli.model.profile import Profile
    from des_cli.model.run import Run
    from des_cli.model.solution import Iteration

# With these a job leaves no command table under its name, not even an older one.
_NO_TABLE = (ExitCode.PROFILE, ExitCode.NO_SOLUTION, ExitCode.NOT_RELEASED)


def run_job(
    job: Job,
    on_iteration: Callable[[Iteration], None] | None = None,
    on_stage: OnStage = untold,
) -> JobResult:
    """Load a profile, reduce it, require its release, and write the output.

    Whatever fails becomes part of the result, so that one profile of a batch
    does not end the others; only an interruption and a reader that went away
    pass through.

    Parameters
    ----------
    job : Job
    on_iteration : callable, optional
        Called with each of the solver's iterations.
    on_stage : callable, optional
        Called with a few words for what is done next.
    """
    result = _run_job(job, on_iteration, on_stage)
    if result.exit_code not in _NO_TABLE or not job.overwrite or job.dry_run:
        return result
    try:
        return replace(result, notices=(*result.notices, *_withdraw(job, result.name)))
    except (DesError, OSError) as error:
        return replace(result, complaints=(*result.complaints, *Failure.of(error).lines))


def run_jobs(
    jobs: Sequence[Job],
    executor: Executor | None = None,
    *,
    keep_going: bool = False,
    on_iteration: Callable[[Iteration], None] | None = None,
    on_stage: OnStage = untold,
    on_finished: Callable[[], None] = lambda: None,
) -> Iterator[JobResult]:
    """Yield the result of every job, in the order of the jobs.

    Parameters
    ----------
    jobs : sequence of Job
    executor : Executor, optional
        Runs them; without one they run here, one after the other.
    keep_going : bool
        Whether to go on after a failed job; without it no job is begun that
        has not begun, and none of those has a result.
    on_iteration, on_stage : callable, optional
        For jobs that run here.
    on_finished : callable, optional
        Called whenever a job has ended, in any order and from any thread.
    """
    if executor is None:
        for job in jobs:
            result = run_job(job, on_iteration, on_stage)
            on_finished()
            yield result
            if result.exit_code and not keep_going:
                return
        return

    def note(future: Future[JobResult]) -> None:
        if not future.cancelled():
            on_finished()

    futures = [executor.submit(run_job, job) for job in jobs]
    try:
        for future in futures:
            future.add_done_callback(note)
        for job, future in zip(jobs, futures, strict=True):
            # What had begun when another job failed is finished and told.
            if future.cancelled():
                continue
            result = _result_of(job, future)
            if result.exit_code and not keep_going:
                _cancel(futures)
            yield result
    finally:
        _cancel(futures)


def load_job(job: Job) -> Profile:
    """Load the profile of a job with its overrides."""
    from des_cli.profiles_in.load import load_profile

    return load_profile(
        job.source,
        settings=job.settings,
        columns=dict(job.columns) or None,
        stdin=job.stdin,
        part=job.part,
        separator=job.separator,
        decimal=job.decimal,
    )


def split_jobs(jobs: Iterable[Job]) -> list[Job]:
    """Make a job of every stretch of the records that are split at their gaps.

    A profile that cannot be loaded stays one job, which says what is wrong with it.
    """
    from des_cli.profiles_in.load import count_parts

    found: list[Job] = []
    for job in jobs:
        try:
            parts = count_parts(
                job.source,
                settings=job.settings,
                columns=dict(job.columns),
                stdin=job.stdin,
                separator=job.separator,
                decimal=job.decimal,
            )
        except (DesError, OSError):
            parts = 1
        if parts == 1:
            found.append(job)
        else:
            found += [replace(job, part=k + 1, out_is_parent=True) for k in range(parts)]
    return found


def require_distinct_names(jobs: Iterable[Job]) -> None:
    """Refuse a batch in which two profiles would share a run folder.

    A profile that cannot be loaded has no name and is passed over here: its
    own job says what is wrong with it.

    Raises
    ------
    UsageError
        Naming the sources that share a name, one line for each name.
    """
    sources = defaultdict(list)
    for job in jobs:
        try:
            sources[load_job(job).name].append(job.source)
        except (DesError, OSError):
            continue
    complaints = [
        Complaint(name, f"several profiles have this name: {', '.join(same)}; rename all but one")
        for name, same in sources.items()
        if len(same) > 1
    ]
    if complaints:
        raise UsageError(complaints)


def _run_job(
    job: Job,
    on_iteration: Callable[[Iteration], None] | None,
    on_stage: OnStage,
) -> JobResult:
    name = ""
    try:
        on_stage(f"reading {job.source}")
        profile = load_job(job)
        name = profile.name
        _require_consistent(profile)
        target = job.destination(name)
        if job.resume and _holds_run_of(target, profile):
            return JobResult(job.source, name, written=str(target), state="kept")
        _refuse_existing(job, target)
        if job.dry_run:
            return JobResult(job.source, name, written=str(target), state="planned")
        return _reduce_and_write(job, profile, target, on_iteration, on_stage)
    except BrokenPipeError:
        raise
    except Exception as error:
        return JobResult.failed(job, error, name)


def _require_consistent(profile: Profile) -> None:
    """Refuse contradictions also where nothing will be solved."""
    from des_cli.reduction.consistency import require_consistent

    require_consistent(profile.reduction, profile.name)


def _reduce_and_write(
    job: Job,
    profile: Profile,
    target: Path,
    on_iteration: Callable[[Iteration], None] | None,
    on_stage: OnStage,
) -> JobResult:
    from des_cli.pipeline import reduce_profile

    run = reduce_profile(profile, on_iteration=on_iteration, on_stage=on_stage)
    told: dict[str, Any] = {
        "notices": run.notices,
        "violations": tuple(str(violation) for violation in run.violations),
        "metrics": run.metrics,
        "objective": _weighted_components(profile),
        "log": run.solution.log,
    }
    try:
        run.require_release()
        on_stage("plots and tables" if job.plots and job.table_format is None else "tables")
        table = _write(job, run, target)
    except DesError as error:
        # What the solver found explains the refusal: it is told all the same.
        lines = tuple(str(complaint) for complaint in error.complaints)
        return JobResult(job.source, profile.name, error.exit_code, lines, state="failed", **told)
    return JobResult(job.source, profile.name, written=str(target), table=table, **told)


def _write(job: Job, run: Run, target: Path) -> bytes | None:
    """Write a run folder or a table; return the table that belongs on stdout."""
    if job.table_format is None:
        from des_cli.runs_out.run_folder import write_run

        write_run(run, target, plots=job.plots, overwrite=job.overwrite)
        return None
    from des_cli.runs_out.atomic import write_file
    from des_cli.runs_out.tables import command_columns, encode_table

    table = encode_table(command_columns(run), job.table_format)
    if job.out == STANDARD_STREAM:
        return table
    write_file(target, table, overwrite=job.overwrite)
    return None


def _refuse_existing(job: Job, target: Path) -> None:
    """Refuse before solving what would be refused when writing."""
    if job.out == STANDARD_STREAM:
        return
    if job.table_format is not None:
        if not target.parent.is_dir():
            what = "cannot be written: the folder does not exist"
            raise FileAccessError([Complaint(str(target), what)])
        taken = target.is_file()
    else:
        taken = target.is_file() or (target.is_dir() and any(target.iterdir()))
    if not taken or job.overwrite:
        return
    what = "exists; --overwrite replaces it"
    if job.resume:
        what = "is not a finished run of this very profile; --overwrite replaces it"
    raise FileAccessError([Complaint(str(target), what)])


def _withdraw(job: Job, name: str) -> tuple[str, ...]:
    """Remove the earlier output that a failed job was to replace.

    Otherwise a console would find, under the name that it asked for, commands
    that are not this profile's.
    """
    if job.out == STANDARD_STREAM or (job.out_is_parent and not name):
        return ()
    from des_cli.runs_out.manifest import is_run
    from des_cli.runs_out.run_folder import discard_run

    target = job.destination(name)
    if job.table_format is not None and target.is_file():
        target.unlink(missing_ok=True)
    elif job.table_format is None and is_run(target):
        discard_run(target)
    else:
        return ()
    return (f"withdrew the earlier {target}: it is not what this profile asks for",)


def _holds_run_of(folder: Path, profile: Profile) -> bool:
    from des_cli.runs_out.manifest import is_run
    from des_cli.runs_out.run_folder import read_run

    if not is_run(folder):
        return False
    try:
        stored = read_run(folder).metrics["profile"]["sha256"]
    except (DesError, OSError, KeyError):
        return False
    return bool(profile.sha256) and stored == profile.sha256


def _weighted_components(profile: Profile) -> tuple[str, ...]:
    """Name the Coriolis components on which r1 puts a weight."""
    weights = profile.reduction.r1.diagonal()
    return tuple(
        component.key
        for component in COMPONENTS
        if component.axes == profile.reduction.axes and weights[component.index] != 0.0
    )


def _cancel(futures: Iterable[Future[JobResult]]) -> None:
    """Cancel every job that has not begun."""
    for future in futures:
        future.cancel()


def _result_of(job: Job, future: Future[JobResult]) -> JobResult:
    try:
        return future.result()
    except BrokenExecutor:
        lost = "its worker process died, perhaps for want of memory; try fewer --jobs"
        return JobResult.failed(job, FileAccessError([Complaint(job.source, lost)]))
    except Exception as error:  # of the executor; the job itself raises none
        return JobResult.failed(job, error)
