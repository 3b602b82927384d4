"""A reduced maneuver as Python users see it."""

from __future__ import annotations

import html
import os
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from des_cli.errors import Complaint, DesError, UsageError
from des_cli.model import run as model
from des_cli.model.metric import SEAT_G_ERROR, SEAT_RATE_DEVIATION
from des_cli.show.words import FIGURE

if TYPE_CHECKING:
    import pandas as pd

    from des_cli.api.picture import Picture


class Run:
    """A reduced maneuver: its motions as tables, what they cost, and files of them.

    Parameters
    ----------
    details : des_cli.model.run.Run
        Everything that was computed on the way; kept as ``details``.
    """

    def __init__(self, details: model.Run) -> None:
        self.details = details

    @property
    def name(self) -> str:
        """The profile's name."""
        return self.details.profile.name

    @property
    def status(self) -> str:
        """How the search ended: ``converged``, or why it did not."""
        return self.details.solution.status

    @property
    def metrics(self) -> dict[str, Any]:
        """The content of ``metrics.json``."""
        return self.details.metrics

    @property
    def notices(self) -> tuple[str, ...]:
        """Sentences for the user's attention."""
        return tuple(notice.text for notice in self.details.notices)

    @property
    def violations(self) -> tuple[str, ...]:
        """Limits that the desired or the modified motion breaks, a line each."""
        return tuple(str(violation) for violation in self.details.violations)

    @cached_property
    def refusal(self) -> tuple[str, ...]:
        """What stands against flying it, a line each; empty where it is released."""
        try:
            self.details.require_release()
        except DesError as error:
            return tuple(str(complaint) for complaint in error.complaints)
        return ()

    @property
    def released(self) -> bool:
        """Whether it converged, was verified, and keeps what it has to keep."""
        return not self.refusal

    def require_release(self) -> None:
        """Raise what stands against flying it.

        Raises
        ------
        NoSolutionError, NotReleasedError
            As the command line ends with 4 or 5.
        """
        self.details.require_release()

    @cached_property
    def commands(self) -> pd.DataFrame:
        """The command table: ``t_s, arm_rpm, fork_deg, cab_deg``."""
        import pandas as pd

        from des_cli.runs_out.tables import command_columns

        return pd.DataFrame(command_columns(self.details))

    @cached_property
    def trajectory(self) -> pd.DataFrame:
        """All that is known at each sample: the columns of ``trajectory.parquet``."""
        import pandas as pd

        from des_cli.runs_out.tables import trajectory_columns

        return pd.DataFrame(trajectory_columns(self.details))

    def to_pandas(self) -> pd.DataFrame:
        """Return the trajectory with the time as its index [s]."""
        return self.trajectory.set_index("t_s")

    def plot(self, figure: str = "felt") -> Picture:
        """Draw a figure, which a notebook shows; see `FIGURES` for the names.

        Raises
        ------
        UsageError
            If there is no such figure, or not of this run.
        """
        from des_cli.api.picture import Picture

        return Picture.of(self.details, figure)

    def save(
        self, path: str | os.PathLike[str], *, plots: bool = True, overwrite: bool = False
    ) -> Path:
        """Write a run folder, or the command table alone where the path ends in its format.

        Nothing is written that is not released, and no bytes get the name before they were
        read back and measured anew.

        Parameters
        ----------
        path : path
            A folder, or a file that ends in ``.csv``, ``.ndjson``, ``.json`` or ``.parquet``.
        plots : bool
            Whether a folder holds ``plots/*.png``.
        overwrite : bool
            Whether what is there may be replaced.

        Returns
        -------
        Path
            Of the folder or the file.

        Raises
        ------
        NoSolutionError, NotReleasedError
            If the run is not released.
        FileAccessError
            If something is in the way, or cannot be written.
        UsageError
            If the ending is none of a table.
        """
        from des_cli.release.gate import require_table
        from des_cli.runs_out.atomic import write_file
        from des_cli.runs_out.run_folder import write_run
        from des_cli.runs_out.tables import TableFormat, command_columns, encode_table

        self.require_release()
        target, accept = Path(path), partial(require_table, self.details)
        if not target.suffix:
            write_run(self.details, target, plots=plots, overwrite=overwrite, accept=accept)
            return target
        formats: tuple[TableFormat, ...] = get_args(TableFormat)
        for known in formats:
            if target.suffix.lower() == f".{known}":
                table = encode_table(command_columns(self.details), known)
                write_file(target, table, overwrite=overwrite, accept=accept)
                return target
        what = f"{target.suffix} is no format of a table: {', '.join(f'.{f}' for f in formats)}"
        raise UsageError([Complaint(str(path), what)])

    def __repr__(self) -> str:
        """Say in a line what it is."""
        words = [f"{name} {value}" for name, value in self._facts()]
        return f"<Run {self.name}: {', '.join([self.status, *words])}>"

    def _repr_html_(self) -> str:
        """Show a small table in a notebook."""
        standing = "released" if self.released else "not released: " + "; ".join(self.refusal)
        rows = [("status", self.status), *self._facts(), ("standing", standing)]
        rows += [("notice", notice) for notice in self.notices]
        cells = "".join(
            f"<tr><th scope='row' style='text-align:left'>{html.escape(name)}</th>"
            f"<td style='text-align:left'>{html.escape(value)}</td></tr>"
            for name, value in rows
        )
        return f"<table><caption>{html.escape(self.name)}</caption><tbody>{cells}</tbody></table>"

    def _facts(self) -> list[tuple[str, str]]:
        """Return what is felt, in words, as far as it is known."""
        results = self.details.results
        turning = results.felt.turning
        found = [
            ("cross-coupling", _words(FIGURE.change, results.coriolis.reduction("vector"))),
            ("angular acceleration", _in_unit(FIGURE.from_to(turning.rms), "rad/s² rms")),
            ("peak", _in_unit(FIGURE.from_to(turning.peak), "rad/s²")),
            (
                "seat rate off by",
                _words(FIGURE.percent, results.fidelity.value(SEAT_RATE_DEVIATION)),
            ),
            (
                "G off by",
                _words("{:.3g} g rms".format, results.fidelity.value(SEAT_G_ERROR)),
            ),
        ]
        return [(name, words) for name, words in found if words]


def _words(say: Any, value: float | None) -> str:
    return "" if value is None else str(say(value))


def _in_unit(words: str, unit: str) -> str:
    return f"{words} {unit}" if words else ""
