"""Values as the page's tables show them, and what its runs are called."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from des_cli.model.metrics import Metrics
from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.words import PAGE


@dataclass(frozen=True, slots=True)
class Cell:
    """A value as it is shown.

    Parameters
    ----------
    text : str
    mark : str
        ``bad`` for what needs attention, else empty.
    """

    text: str
    mark: str = ""


def labels(runs: Sequence[StoredRun]) -> list[str]:
    """Return what each run is called on the page: its name, told apart where two share it."""
    names = [run.name for run in runs]
    return [
        run.name if names.count(run.name) == 1 else f"{run.name} ({run.folder.resolve().name})"
        for run in runs
    ]


def limits_cell(metrics: Metrics) -> Cell:
    """Say whether the modified motion keeps the limits of every joint."""
    verdicts = {joint: load.ok for joint, load in metrics.limits.modified.items()}
    broken = [joint for joint, ok in verdicts.items() if ok is False]
    if broken:
        return Cell(f"broken: {', '.join(broken)}", "bad")
    return Cell("kept" if all(ok is True for ok in verdicts.values()) else PAGE.unknown)
