"""A figure of a run that a notebook shows and a file keeps."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

from des_cli.errors import Complaint, UsageError
from des_cli.model.run import Run
from des_cli.results.reading import read_metrics
from des_cli.runs_out.atomic import write_file
from des_cli.runs_out.tables import trajectory_columns
from des_cli.show.plots.canvas import PictureFormat
from des_cli.show.plots.figures import FIGURES, draw_figure


@dataclass(frozen=True, eq=False)
class Picture:
    """A figure that is drawn in a format when it is asked for.

    Parameters
    ----------
    run : Run
    figure : str
    """

    run: Run
    figure: str

    @classmethod
    def of(cls, run: Run, figure: str) -> Picture:
        """Take a figure by its name.

        Raises
        ------
        UsageError
            If there is no such figure, or not of this run.
        """
        if figure not in FIGURES:
            what = f"{figure!r} is no figure: {', '.join(FIGURES)}"
            raise UsageError([Complaint(run.profile.name, what)])
        picture = cls(run, figure)
        picture.encode("png")
        return picture

    def encode(self, format: PictureFormat) -> bytes:
        """Return its bytes; the same run gives the same.

        Raises
        ------
        UsageError
            If the run has no such figure.
        """
        metrics = read_metrics(self.run.metrics)
        try:
            return draw_figure(self.figure, trajectory_columns(self.run), metrics, format)
        except ValueError as error:
            what = f"has no figure {self.figure}: {error}"
            raise UsageError([Complaint(self.run.profile.name, what)]) from None

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
        """Write it; the ending is the format: ``.svg``, ``.pdf`` or ``.png``."""
        target = Path(path)
        formats: tuple[PictureFormat, ...] = get_args(PictureFormat)
        for known in formats:
            if target.suffix.lower() == f".{known}":
                write_file(target, self.encode(known), overwrite=overwrite)
                return target
        raise UsageError([Complaint(str(path), "a figure's file ends in .svg, .pdf or .png")])

    def __repr__(self) -> str:
        """Say what it is of."""
        return f"<Picture {self.figure} of {self.run.profile.name}>"

    def _repr_png_(self) -> bytes:
        return self.encode("png")
