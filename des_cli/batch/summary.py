"""A batch in a row a run: what is kept of a result once it was told, and ``summary.csv``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Literal

from des_cli.batch.job import JobResult
from des_cli.errors import Complaint, ExitCode, FileAccessError
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_PEAK_RATIO,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
)

SUMMARY = "summary.csv"


@dataclass(frozen=True, slots=True)
class SummaryRow:
    """How one job ended, in few numbers; a field is called as its column.

    Parameters
    ----------
    source, name : str
        What was asked for, and the profile's name; empty where it could not be read.
    folder : str
        Of the run, inside the output folder; empty where there is none.
    state : {"reduced", "kept", "planned", "failed"}
    exit_code : int
    status : str, optional
        Of the solver.
    objective_reduction, vector_reduction : float, optional
        Of what the objective weighs, and of the whole cross-coupling vector.
    seat_rate_deviation_relative, seat_g_rms_error_g, seat_angular_acceleration_peak_ratio
        Metrics of these keys.
    iterations : int, optional
    message : str
        Why it failed.
    """

    source: str
    name: str
    folder: str
    state: Literal["reduced", "kept", "planned", "failed"]
    exit_code: int
    status: str | None = None
    objective_reduction: float | None = None
    vector_reduction: float | None = None
    seat_rate_deviation_relative: float | None = None
    seat_g_rms_error_g: float | None = None
    seat_angular_acceleration_peak_ratio: float | None = None
    iterations: int | None = None
    message: str = ""

    @classmethod
    def of(cls, result: JobResult) -> SummaryRow:
        """Return what is kept of a result."""
        from des_cli.results.reading import read_metrics

        metrics = read_metrics(result.metrics)
        return cls(
            source=result.source,
            name=result.name,
            folder=Path(result.written).name,
            state=result.state,
            exit_code=int(result.exit_code),
            status=metrics.solver.status,
            objective_reduction=metrics.coriolis.objective.reduction,
            vector_reduction=metrics.coriolis.reduction("vector"),
            seat_rate_deviation_relative=metrics.fidelity.value(SEAT_RATE_DEVIATION),
            seat_g_rms_error_g=metrics.fidelity.value(SEAT_G_ERROR),
            seat_angular_acceleration_peak_ratio=metrics.fidelity.value(
                ANGULAR_ACCELERATION_PEAK_RATIO
            ),
            iterations=metrics.solver.iterations,
            message="; ".join(result.complaints),
        )


COLUMNS = tuple(field.name for field in fields(SummaryRow))
"""Names of the columns of ``summary.csv``, in their order."""

_BEGINNING = ",".join(COLUMNS[:3]).encode()
"""How a summary of this version and of later ones begins."""


def encode_summary(rows: Sequence[SummaryRow]) -> bytes:
    """Return the rows as CSV; what is not known is an empty cell."""
    from des_cli.runs_out.mixed_csv import encode_mixed_csv

    return encode_mixed_csv(COLUMNS, [asdict(row) for row in rows])


def write_summary(folder: str, rows: Sequence[SummaryRow]) -> Path:
    """Write the summary of a batch into its output folder; that of an earlier one is replaced.

    Parameters
    ----------
    folder : str
        Made where it is missing.
    rows : sequence of SummaryRow

    Raises
    ------
    FileAccessError
        If it cannot be written, or something else has its name.
    """
    from des_cli.runs_out.atomic import write_file
    from des_cli.runs_out.plain_words import plain_words

    path = Path(folder) / SUMMARY
    with plain_words(path, "cannot be written"):
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.is_file():
            with open(path, "rb") as file:
                if file.read(len(_BEGINNING)) != _BEGINNING:
                    what = "is not the summary of a batch: rename it, or name another output"
                    raise FileAccessError([Complaint(str(path), what)])
    return write_file(path, encode_summary(rows), overwrite=True)


def exit_code_of(rows: Sequence[SummaryRow], planned: int) -> ExitCode:
    """Return the exit code of a whole batch: of a single profile, its own."""
    if planned == 1:
        return ExitCode(rows[0].exit_code)
    done = len(rows) == planned and not any(row.exit_code for row in rows)
    return ExitCode.DONE if done else ExitCode.FILE
