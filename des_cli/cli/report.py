"""``des-coriolis report``: runs on one page, to compare and to hand on."""

from __future__ import annotations

from pathlib import Path

import click

from des_cli.batch.source import STANDARD_STREAM
from des_cli.cli.command import OUTPUT, STORE, Command, option
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.completion import complete_files, complete_folders, complete_runs, complete_where
from des_cli.cli.console import Console
from des_cli.cli.options import DEFAULT_RUNS, overwrite_option
from des_cli.cli.outputs import files_held
from des_cli.cli.report_store import list_store
from des_cli.cli.stdout import write_data
from des_cli.errors import Complaint, DesError, FileAccessError


@click.command(
    cls=Command,
    short_help="Put runs on one HTML page.",
    epilog="""\b
Examples:
  des-coriolis report
  des-coriolis report runs/cobra -o cobra.html
  des-coriolis report --store study --where "seat_g_rms_error_g <= 0.05"
""",
)
@click.argument("runs", metavar="[RUN]...", nargs=-1, shell_complete=complete_runs)
@option(
    OUTPUT,
    "-o",
    "--out",
    metavar="FILE|-",
    shell_complete=complete_files,
    help="The page, or the rows of a store as CSV.  [default: report.html, or stdout]",
)
@overwrite_option("Replace a file that exists.")
@option(
    STORE,
    "--store",
    metavar="DIR",
    shell_complete=complete_folders,
    help="Instead: list the runs of a store.",
)
@option(
    STORE,
    "--where",
    metavar="CONDITION",
    shell_complete=complete_where,
    help="Of a store only these, such as: seat_g_rms_error_g <= 0.05 and status = converged",
)
@verbosity_options
@click.pass_obj
def report(
    console: Console,
    runs: tuple[str, ...],
    out: str | None,
    overwrite: bool,
    store: str | None,
    where: str | None,
) -> None:
    """Make a single HTML page of each RUN, or of every run under runs/.

    A RUN is a run folder, or a folder of run folders. The page needs no
    network and no other file. With --store, list the runs that reduce --store
    added to it instead: for people on a terminal, otherwise as CSV.
    """
    if store is not None:
        if runs:
            raise click.UsageError("--store lists the runs of a store: leave out RUN.")
        list_store(console, store, where, out, overwrite=overwrite)
        return
    if where is not None:
        raise click.UsageError("--where needs --store.")
    _make_page(console, runs, out or "report.html", overwrite)


def _make_page(console: Console, runs: tuple[str, ...], out: str, overwrite: bool) -> None:
    from des_cli.runs_out.atomic import write_file
    from des_cli.runs_out.stored_run import StoredRun, read_run
    from des_cli.show.page.page import render_report

    stored: list[StoredRun] = []
    complaints: list[Complaint] = []
    files = [] if out == STANDARD_STREAM else [out]
    with files_held(files, overwrite), console.working() as line:
        line.stage("reading runs")
        for folder in _run_folders(runs or (DEFAULT_RUNS,)):
            try:
                stored.append(read_run(folder))
            except DesError as error:
                complaints += error.complaints
        if complaints:
            raise FileAccessError(complaints)
        line.stage("page")
        page = render_report(stored)
        if files:
            write_file(out, page.encode(), overwrite=overwrite)
    if not files:
        write_data(page)
        return
    count = "1 run" if len(stored) == 1 else f"{len(stored)} runs"
    console.say(f"{count} in {console.style(out, 'good')}")


def _run_folders(named: tuple[str, ...]) -> list[Path]:
    """Expand folders of runs; each run once, in the order of naming.

    Raises
    ------
    FileAccessError
        Naming every argument that is no run and holds none.
    """
    from des_cli.runs_out.manifest import is_run

    folders: dict[Path, None] = {}
    complaints = []
    for name in named:
        folder = Path(name)
        if is_run(folder):
            found = [folder]
        else:
            inside = sorted(folder.iterdir()) if folder.is_dir() else []
            found = [path for path in inside if is_run(path)]
        if not found:
            what = "holds no run; make one with: des-coriolis reduce cobra"
            if not folder.exists():
                what = "does not exist; make a run with: des-coriolis reduce cobra"
            complaints.append(Complaint(name, what))
        folders |= dict.fromkeys(found)
    if complaints:
        raise FileAccessError(complaints)
    return list(folders)
