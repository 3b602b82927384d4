"""What to do with one profile, and how that ended: data that crosses process boundaries."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from des_cli.batch.source import Source, split_source
from des_cli.errors import ExitCode, Failure
from des_cli.model.notice import Notice
from des_cli.runs_out.forms import Form

if TYPE_CHECKING:
    from des_cli.model.solution import Iteration

TableFormat: TypeAlias = Literal["csv", "ndjson", "json", "parquet"]


@dataclass(frozen=True, slots=True)
class Output:
    """Where the reduction of a profile goes, and in what form.

    Parameters
    ----------
    out : str
        The run folder, the file of the command table, or ``-`` for a table
        that comes back in the result.
    out_is_parent : bool
        Whether ``out`` is only the folder in which the run folder is named
        after the profile.
    table_format : str, optional
        Write the command table alone, in this format; None writes a run folder, or a form.
    form : Form, optional
        Write the rows alone, in this form.
    plots, overwrite : bool
    resume : bool
        Leave a finished run of the very same profile as it is.
    dry_run : bool
        Load and check, but neither solve nor write.
    """

    out: str = "runs"
    out_is_parent: bool = True
    table_format: TableFormat | None = None
    form: Form | None = None
    plots: bool = True
    overwrite: bool = False
    resume: bool = False
    dry_run: bool = False

    @property
    def one_file(self) -> bool:
        """Whether rows are written, and no run folder."""
        return self.table_format is not None or self.form is not None

    def destination(self, name: str) -> Path:
        """Return where a profile of this name is written."""
        return Path(self.out) / name if self.out_is_parent else Path(self.out)


@dataclass(frozen=True, slots=True)
class Job:
    """What to do with one profile: read it, reduce it, write it.

    Parameters
    ----------
    source : Source
    output : Output
    fail_on : frozenset of str
        Names of notices with which it is not to be written.
    """

    source: Source
    output: Output = Output()
    fail_on: frozenset[str] = frozenset()

    @property
    def label(self) -> str:
        """What a message about it begins with."""
        return self.source.name


def split_jobs(jobs: Iterable[Job]) -> list[Job]:
    """Make a job of every stretch of the records that are split at their gaps."""
    found: list[Job] = []
    for job in jobs:
        parts = split_source(job.source)
        several = len(parts) > 1
        output = replace(job.output, out_is_parent=True) if several else job.output
        found += [replace(job, source=part, output=output) for part in parts]
    return found


@dataclass(frozen=True, slots=True)
class JobResult:
    """How one job ended, without the arrays.

    Parameters
    ----------
    source, name : str
        What was asked for, and the profile's own name (empty where it could
        not be read).
    exit_code : ExitCode
    complaints : tuple of str
        Lines that say why it failed.
    notices : tuple of Notice
        Sentences for the user's attention.
    violations : tuple of str
        Every broken limit.
    metrics : dict, optional
        The content of ``metrics.json``.
    objective : tuple of str
        The Coriolis components under the objective's weight, by their keys in
        the metrics.
    log : tuple of Iteration
    written : str
        Where the output went, or would go; empty where there is none.
    state : {"reduced", "kept", "planned", "failed"}
        ``kept`` by ``resume``, ``planned`` by ``dry_run``.
    table : bytes, optional
        The command table of a job whose ``out`` is ``-``.
    traceback : str
        Of a bug.
    """

    source: str
    name: str
    exit_code: ExitCode = ExitCode.DONE
    complaints: tuple[str, ...] = ()
    notices: tuple[Notice, ...] = ()
    violations: tuple[str, ...] = ()
    metrics: Mapping[str, Any] | None = None
    objective: tuple[str, ...] = ()
    log: tuple[Iteration, ...] = ()
    written: str = ""
    state: Literal["reduced", "kept", "planned", "failed"] = "reduced"
    table: bytes | None = None
    traceback: str = ""

    @property
    def ok(self) -> bool:
        """Whether the job did not fail."""
        return self.exit_code == ExitCode.DONE

    @classmethod
    def failed(cls, job: Job, error: BaseException, name: str = "") -> JobResult:
        """Make the result of a job that an exception ended."""
        failure = Failure.of(error)
        return cls(
            job.source.name,
            name,
            failure.exit_code,
            failure.lines,
            state="failed",
            traceback=failure.traceback,
        )
