"""One job, from its source to its output."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from des_cli.batch.job import Job, JobResult, Output
from des_cli.batch.source import STANDARD_STREAM, load_source
from des_cli.errors import Complaint, DesError, ExitCode, Failure, FileAccessError
from des_cli.model.coriolis import COMPONENTS
from des_cli.model.notice import Notice
from des_cli.model.stage import OnStage, untold

# What needs numpy is imported when a job runs, as in `source`.
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
    output = job.output
    if result.exit_code not in _NO_TABLE or not output.overwrite or output.dry_run:
        return result
    try:
        return replace(result, notices=(*result.notices, *_withdraw(output, result.name)))
    except (DesError, OSError) as error:
        return replace(result, complaints=(*result.complaints, *Failure.of(error).lines))


def _run_job(
    job: Job,
    on_iteration: Callable[[Iteration], None] | None,
    on_stage: OnStage,
) -> JobResult:
    name, source, output = "", job.source, job.output
    try:
        on_stage(f"reading {source.name}")
        profile = load_source(source)
        name = profile.name
        _require_consistent(profile)
        target = output.destination(name)
        if output.resume and _holds_run_of(target, profile):
            return JobResult(source.name, name, written=str(target), state="kept")
        _refuse_existing(output, target)
        if output.dry_run:
            return JobResult(source.name, name, written=str(target), state="planned")
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
        on_stage("plots and tables" if output.plots and output.table_format is None else "tables")
        table = _write(job, run, target)
    except DesError as error:
        # What the solver found explains the refusal: it is told all the same.
        lines = tuple(str(complaint) for complaint in error.complaints)
        return JobResult(source, profile.name, error.exit_code, lines, state="failed", **told)
    return JobResult(source, profile.name, written=str(target), table=table, **told)


def _write(job: Job, run: Run, target: Path) -> bytes | None:
    """Write a run folder or a table; return the table that belongs on stdout.

    No table gets its name, or goes to stdout, whose bytes are not what the run is to be.
    """
    from des_cli.release.gate import require_table

    output = job.output
    accept = partial(require_table, run, fail_on=job.fail_on)
    if output.table_format is None:
        from des_cli.runs_out.run_folder import write_run

        write_run(run, target, plots=output.plots, overwrite=output.overwrite, accept=accept)
        return None
    from des_cli.runs_out.atomic import write_file
    from des_cli.runs_out.tables import command_columns, encode_table

    table = encode_table(command_columns(run), output.table_format)
    if output.out == STANDARD_STREAM:
        accept(table)
        return table
    write_file(target, table, overwrite=output.overwrite, accept=accept)
    return None


def _refuse_existing(output: Output, target: Path) -> None:
    """Refuse before solving what would be refused when writing."""
    if output.out == STANDARD_STREAM:
        return
    if output.table_format is not None:
        if not target.parent.is_dir():
            what = "cannot be written: the folder does not exist"
            raise FileAccessError([Complaint(str(target), what)])
        taken = target.is_file()
    else:
        taken = target.is_file() or (target.is_dir() and any(target.iterdir()))
    if not taken or output.overwrite:
        return
    what = "exists; --overwrite replaces it"
    if output.resume:
        what = "is not a finished run of this very profile; --overwrite replaces it"
    raise FileAccessError([Complaint(str(target), what)])


def _withdraw(output: Output, name: str) -> tuple[Notice, ...]:
    """Remove the earlier output that a failed job was to replace.

    Otherwise a console would find, under the name that it asked for, commands
    that are not this profile's.
    """
    if output.out == STANDARD_STREAM or (output.out_is_parent and not name):
        return ()
    from des_cli.runs_out.manifest import is_run
    from des_cli.runs_out.run_folder import discard_run

    target = output.destination(name)
    if output.table_format is not None and target.is_file():
        target.unlink(missing_ok=True)
    elif output.table_format is None and is_run(target):
        discard_run(target)
    else:
        return ()
    said = f"withdrew the earlier {target}: it is not what this profile asks for"
    return (Notice("withdrawn", said),)


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
