"""``des-coriolis plot``: one figure of a run, for a report or a paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, get_args

import click

from des_cli.batch.source import STANDARD_STREAM
from des_cli.cli.command import OUTPUT, Command, option
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.completion import complete_files, complete_runs, complete_words
from des_cli.cli.console import Console
from des_cli.cli.options import overwrite_option
from des_cli.cli.outputs import files_held
from des_cli.cli.stdout import write_data
from des_cli.errors import Complaint, UsageError

if TYPE_CHECKING:
    from des_cli.show.plots.canvas import PictureFormat

FIGURES = {
    "7": "BB3 of the cross-coupling as the profile asks for it, the study's figure 7",
    "8": "the adjoint of the fork, the study's figure 8",
    "9": "the factor on the joint rates, the study's figure 9",
    "10": "BB3 before and after, the study's figure 10",
    "felt": "what the pilot feels: rates, angular acceleration, G",
    "coriolis": "the cross-coupling that is weighed, and the whole vector",
    "coriolis_components": "all of its components",
    "commands": "the joint commands",
    "limits": "rates, accelerations and jerks within the machine's limits",
    "deviation": "how far the joints are from the desired motion",
    "factor": "the factor on each joint's rate",
    "adjoint": "the adjoint of each joint",
    "tradeoff": "the run beside the study's law and a constant factor",
}
"""What ``--figure`` takes, and what that is."""

FORMATS = ("svg", "pdf", "png")


@click.command(
    cls=Command,
    short_help="Draw one figure of a run, as SVG, PDF or PNG.",
    epilog="""\b
Examples:
  des-coriolis plot runs/cobra --figure 10 -o fig10.svg
  des-coriolis plot runs/cobra_felt --figure limits -o limits.pdf

\b
Figures:
"""
    + "\n".join(f"  {name:<20} {words}" for name, words in FIGURES.items()),
)
@click.argument("run", shell_complete=complete_runs)
@option(
    OUTPUT,
    "--figure",
    "name",
    type=click.Choice(list(FIGURES)),
    shell_complete=complete_words(FIGURES),
    default="felt",
    show_default=True,
    metavar="NAME",
    help="Which one: see below.",
)
@option(
    OUTPUT,
    "-o",
    "--out",
    metavar="FILE|-",
    shell_complete=complete_files,
    help="Where it goes; its ending is the format.  [default: the figure's name, as SVG]",
)
@option(OUTPUT, "-f", "--format", "form", type=click.Choice(FORMATS), help="Of standard output.")
@overwrite_option("Replace a file that exists.")
@verbosity_options
@click.pass_obj
def plot(
    console: Console, run: str, name: str, out: str | None, form: str | None, overwrite: bool
) -> None:
    """Draw one figure of RUN, a run folder.

    All figures are in one style, and the same run gives the same bytes.
    """
    target = f"{name}.{form or 'svg'}" if out is None else out
    format = _format_of(target, form)

    from des_cli.results.reading import read_metrics
    from des_cli.runs_out.atomic import write_file
    from des_cli.runs_out.stored_run import read_run
    from des_cli.show.plots.figures import draw_figure

    files = [] if target == STANDARD_STREAM else [target]
    with files_held(files, overwrite):
        stored = read_run(Path(run))
        try:
            drawn = draw_figure(name, stored.trajectory, read_metrics(stored.metrics), format)
        except ValueError as error:
            raise UsageError([Complaint(run, f"has no figure {name}: {error}")]) from None
        if files:
            write_file(target, drawn, overwrite=overwrite)
    if not files:
        write_data(drawn)
        return
    console.say(f"figure {name} in {console.style(target, 'good')}")


def _format_of(target: str, form: str | None) -> PictureFormat:
    """Return the format that a file's ending or an option names."""
    from des_cli.show.plots.canvas import PictureFormat

    known: tuple[PictureFormat, ...] = get_args(PictureFormat)
    asked = form or "png" if target == STANDARD_STREAM else Path(target).suffix[1:].lower()
    for each in known:
        if each == asked and form in (None, each):
            return each
    if asked in known:
        raise click.UsageError(f"-o {target} is no {form}: leave one of them out.")
    raise click.UsageError(f"-o {target}: a figure's file ends in .svg, .pdf or .png.")
