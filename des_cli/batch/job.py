"""What to do with one profile, and how that ended: data that crosses process boundaries."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from des_cli.errors import ExitCode, Failure
from des_cli.profiles_in.setting import AnySetting

if TYPE_CHECKING:
    from des_cli.model.solution import Iteration

TableFormat: TypeAlias = Literal["csv", "ndjson", "json", "parquet"]

STANDARD_STREAM = "-"
"""Stands for stdin as a source and for stdout as an output."""


@dataclass(frozen=True, slots=True)
class Job:
    """What to do with one profile.

    Parameters
    ----------
    source : str
        A path, the name of a built-in profile, or ``-``.
    settings : tuple of str or Setting
        Overrides, ``reduction.r2=0.2``, and what options say.
    columns : mapping of str to str
        Names of a CSV's columns: ours to the file's.
    separator, decimal : str, optional
        How a CSV is written.
    stdin : bytes, optional
        What ``-`` stands for.
    part : int, optional
        Which stretch between the gaps of a record that is split.
    out : str
        The run folder, the file of the command table, or ``-`` for a table
        that comes back in the result.
    out_is_parent : bool
        Whether ``out`` is only the folder in which the run folder is named
        after the profile.
    table_format : str, optional
        Write the command table alone, in this format; None writes a run folder.
    plots, overwrite : bool
    resume : bool
        Leave a finished run of the very same profile as it is.
    dry_run : bool
        Load and check, but neither solve nor write.
    """

    source: str
    settings: tuple[AnySetting, ...] = ()
    columns: Mapping[str, str] = field(default_factory=dict)
    separator: str | None = None
    decimal: str | None = None
    stdin: bytes | None = None
    part: int | None = None
    out: str = "runs"
    out_is_parent: bool = True
    table_format: TableFormat | None = None
    plots: bool = True
    overwrite: bool = False
    resume: bool = False
    dry_run: bool = False

    def destination(self, name: str) -> Path:
        """Return where a profile of this name is written."""
        return Path(self.out) / name if self.out_is_parent else Path(self.out)


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
    notices, violations : tuple of str
        Sentences for the user's attention, and every broken limit.
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
    notices: tuple[str, ...] = ()
    violations: tuple[str, ...] = ()
    metrics: Mapping[str, Any] | None = None
    objective: tuple[str, ...] = ()
    log: tuple[Iteration, ...] = ()
    written: str = ""
    state: Literal["reduced", "kept", "planned", "failed"] = "reduced"
    table: bytes | None = None
    traceback: str = ""

    @classmethod
    def failed(cls, job: Job, error: BaseException, name: str = "") -> JobResult:
        """Make the result of a job that an exception ended."""
        failure = Failure.of(error)
        return cls(
            job.source,
            name,
            failure.exit_code,
            failure.lines,
            state="failed",
            traceback=failure.traceback,
        )
