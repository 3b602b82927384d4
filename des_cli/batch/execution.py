"""One job, from its source to its output."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from des_cli.batch.earlier import settle, stands, unnamed
from des_cli.batch.job import Job, JobResult, Output
from des_cli.batch.source import STANDARD_STREAM, load_source, name_of_source
from des_cli.errors import Complaint, DesError, Failure, FileAccessError
from des_cli.model.coriolis import COMPONENTS
from des_cli.model.notice import Notice
from des_cli.model.stage import OnStage, untold
from des_cli.runs_out.lock import clear_lock, locked
from des_cli.signals import raise_if_stopped

# What needs numpy is imported when a job runs, as in `source`.
if TYPE_CHECKING:
    from des_cli.model.profile import Profile
    from des_cli.model.run import Run
    from des_cli.model.solution import Iteration


class Reduce(Protocol):
    """How a profile that was read is reduced, and its output written."""

    def __call__(
        self,
        job: Job,
        profile: Profile,
        target: Path,
        on_iteration: Callable[[Iteration], None] | None,
        on_stage: OnStage,
        /,
    ) -> JobResult:
        """Return what became of it."""


def run_job(
    job: Job,
    on_iteration: Callable[[Iteration], None] | None = None,
    on_stage: OnStage = untold,
    *,
    reduce: Reduce | None = None,
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
    reduce : callable, optional
        Reduces and writes in the place of this process.
    """
    do = reduce or _reduce_and_write
    source, output = job.source, job.output
    read = _read(job, on_stage)
    if isinstance(read, JobResult):
        return replace(read, notices=(*read.notices, *_earlier(_settle_unread(job, read))))
    target = output.destination(read.name)

    def whole() -> JobResult:
        if output.resume and (kept := _metrics_of_run(target, read)):
            if not output.dry_run:
                _clear_traces(target)
            return JobResult(
                source.name, read.name, metrics=kept, written=str(target), state="kept"
            )
        _refuse_place(output, target)
        if output.dry_run:
            _refuse_existing(output, target)
            return JobResult(source.name, read.name, written=str(target), state="planned")
        if output.out == STANDARD_STREAM:
            return do(job, read, target, on_iteration, on_stage)
        with locked(target):
            _refuse_existing(output, target)
            result = result_of(job, read.name, do, job, read, target, on_iteration, on_stage)
            return replace(
                result, notices=(*result.notices, *_earlier(settle(output, target, result)))
            )

    return result_of(job, read.name, whole)


def _earlier(sentences: Iterable[str]) -> tuple[Notice, ...]:
    """Return what became of an earlier output as notices."""
    return tuple(Notice("earlier", sentence) for sentence in sentences)


def result_of(job: Job, name: str, do: Callable[..., JobResult], *args: Any) -> JobResult:
    """Make a result of whatever becomes of a step of a job."""
    try:
        return do(*args)
    except BrokenPipeError:
        raise
    except Exception as error:
        raise_if_stopped(error)
        return JobResult.failed(job, error, name)


def _read(job: Job, on_stage: OnStage) -> Profile | JobResult:
    """Return the profile of a job, or the result of one that cannot be had."""
    name = ""
    try:
        on_stage(f"reading {job.source.name}")
        profile = load_source(job.source)
        name = profile.name
        _require_consistent(profile)
    except BrokenPipeError:
        raise
    except Exception as error:
        raise_if_stopped(error)
        return JobResult.failed(job, error, name)
    return profile


def _settle_unread(job: Job, result: JobResult) -> tuple[str, ...]:
    """Settle what stands where the output of a profile that cannot be read would go."""
    output = job.output
    if output.dry_run or output.out == STANDARD_STREAM:
        return ()
    name = result.name or (name_of_source(job.source) if output.out_is_parent else "")
    if output.out_is_parent and not name:
        return unnamed(output, result)
    target = output.destination(name)
    if not stands(output, target):
        return ()
    try:
        with locked(target):
            return settle(output, target, result)
    except DesError as error:
        return Failure.of(error).lines


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
    result = reduce_with(lambda run: _write(job, run, target), job, profile, on_iteration, on_stage)
    return replace(result, written=str(target)) if result.ok else result


def reduce_with(
    write: Callable[[Run], bytes | None],
    job: Job,
    profile: Profile,
    on_iteration: Callable[[Iteration], None] | None = None,
    on_stage: OnStage = untold,
) -> JobResult:
    """Reduce a profile, require its release, and hand the run on.

    Parameters
    ----------
    write : callable
        Given the run; what it returns is the result's table.
    job, profile, on_iteration, on_stage
        As of `run_job`.
    """
    from des_cli.pipeline import reduce_profile

    source, output = job.source.name, job.output
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
        on_stage("plots and tables" if output.plots and not output.one_file else "tables")
        table = write(run)
    except DesError as error:
        # What the solver found explains the refusal: it is told all the same.
        lines = tuple(str(complaint) for complaint in error.complaints)
        return JobResult(source, profile.name, error.exit_code, lines, state="failed", **told)
    return JobResult(source, profile.name, table=table, **told)


def _write(job: Job, run: Run, target: Path) -> bytes | None:
    """Write a run folder or a table; return the table that belongs on stdout.

    No table gets its name, or goes to stdout, whose bytes are not what the run is to be.
    """
    from des_cli.release.gate import require_table

    output = job.output
    accept: Callable[[bytes], None] = partial(require_table, run, fail_on=job.fail_on)
    if not output.one_file:
        from des_cli.runs_out.run_folder import write_run

        write_run(run, target, plots=output.plots, overwrite=output.overwrite, accept=accept)
        return None
    from des_cli.runs_out.atomic import write_file

    table, accept = _table(job, run, accept)
    if output.out == STANDARD_STREAM:
        accept(table)
        return table
    write_file(target, table, overwrite=output.overwrite, accept=accept)
    return None


def _table(
    job: Job, run: Run, accept: Callable[[bytes], None]
) -> tuple[bytes, Callable[[bytes], None]]:
    """Return the bytes of a table or of a form, and what they have to pass."""
    output = job.output
    if output.form is not None:
        from des_cli.release.exported import export_of_run

        export = export_of_run(run, output.form, job.fail_on)
        return export.data, export.require
    from des_cli.runs_out.tables import command_columns, encode_table

    assert output.table_format is not None, "it is one file"
    return encode_table(command_columns(run), output.table_format), accept


def _refuse_place(output: Output, target: Path) -> None:
    """Refuse before solving where no table or run can be; the folder of a run is made."""
    if output.out == STANDARD_STREAM:
        return
    if not output.one_file:
        from des_cli.runs_out.run_folder import require_place

        require_place(target)
        return
    from des_cli.runs_out.atomic import require_file

    if not target.parent.is_dir():
        what = "cannot be written: the folder does not exist"
        raise FileAccessError([Complaint(str(target), what)])
    require_file(target)


def _refuse_existing(output: Output, target: Path) -> None:
    """Refuse before solving what would be refused when writing."""
    if output.out == STANDARD_STREAM or output.overwrite:
        return
    if not output.one_file:
        from des_cli.runs_out.run_folder import is_free

        taken = not is_free(target)
    else:
        taken = target.is_file()
    if not taken:
        return
    what = "exists; --overwrite replaces it"
    if output.resume:
        what = "is not a finished run of this very profile; --overwrite replaces it"
    raise FileAccessError([Complaint(str(target), what)])


def _metrics_of_run(folder: Path, profile: Profile) -> dict[str, Any] | None:
    """Return the metrics of a finished run of this very profile, None where there is none."""
    from des_cli.results.reading import read_metrics
    from des_cli.runs_out.manifest import is_run
    from des_cli.runs_out.stored_run import read_run

    if not is_run(folder):
        return None
    try:
        metrics = read_run(folder).metrics
    except (DesError, OSError):
        return None
    same = bool(profile.sha256) and read_metrics(metrics).profile.sha256 == profile.sha256
    return metrics if same else None


def _clear_traces(target: Path) -> None:
    """Remove what a process left that was killed between its last file and its end."""
    from des_cli.runs_out.atomic import clear_leftovers

    clear_leftovers(Path(os.path.realpath(target)))
    clear_lock(target)


def _weighted_components(profile: Profile) -> tuple[str, ...]:
    """Name the Coriolis components on which r1 puts a weight."""
    weights = profile.reduction.r1.diagonal()
    return tuple(
        component.key
        for component in COMPONENTS
        if component.axes == profile.reduction.axes and weights[component.index] != 0.0
    )
