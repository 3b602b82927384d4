"""``des-coriolis reduce``: profiles in, command tables out."""

from __future__ import annotations

from typing import Any, NoReturn

import click
from click.core import ParameterSource

from des_cli.batch.job import Job, Output
from des_cli.batch.source import STANDARD_STREAM
from des_cli.cli.command import BATCH, CLUSTER, OUTPUT, Command, option
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.completion import complete_files, complete_folders, complete_grid
from des_cli.cli.console import Console
from des_cli.cli.form_options import (
    FormWords,
    form_of,
    form_options,
    hz_option,
    output_form,
)
from des_cli.cli.options import (
    DEFAULT_RUNS,
    TABLE_FORMATS,
    fail_on_option,
    jobs_option,
    overwrite_option,
    reduction_options,
    reduction_settings,
)
from des_cli.cli.source_options import (
    machine_option,
    profile_argument,
    read_stdin,
    setting_options,
    source_of,
)
from des_cli.cli.stdout import refuse_binary_on_terminal
from des_cli.errors import ExitCode
from des_cli.profiles_in.caps import Caps
from des_cli.profiles_in.setting import AnySetting
from des_cli.runs_out.forms import Form


@click.command(
    cls=Command,
    short_help="Reduce the cross-coupling of profiles; write command tables.",
    epilog="""\b
Examples:
  des-coriolis reduce cobra
  des-coriolis reduce my.yaml --control per-joint -o my-run
  des-coriolis reduce log.csv --column t_s=time -o commands.csv
  des-coriolis reduce profiles/*.yaml --jobs 4 --keep-going
  des-coriolis reduce cobra_felt --grid budget.seat_g_rms_error_g=0.02,0.05,0.1
""",
)
@profile_argument
@machine_option
@setting_options
@reduction_options
@option(
    OUTPUT,
    "-o",
    "--out",
    metavar="DIR|FILE|-",
    shell_complete=complete_files,
    help="The run folder (for several profiles: the folder of their run folders), or a file "
    "of the command table alone, or stdout.  [default: runs/NAME]",
)
@option(
    OUTPUT,
    "-f",
    "--format",
    "table_format",
    type=click.Choice(TABLE_FORMATS),
    help="Format of the command table that -o FILE or -o - writes.  [default: by suffix, or csv]",
)
@form_options
@hz_option
@jobs_option("Profiles at a time; 0 is one for each CPU.")
@option(
    CLUSTER,
    "--scheduler",
    metavar="tcp://HOST:PORT",
    help="Reduce on the workers of this Dask scheduler instead of here; runs are written here.",
)
@option(
    BATCH,
    "--store",
    metavar="DIR",
    shell_complete=complete_folders,
    help="Also add a row a run to this store of Parquet files; report --store reads it.",
)
@option(
    BATCH,
    "--grid",
    metavar="KEY=V,V...",
    shell_complete=complete_grid,
    multiple=True,
    help="Reduce each profile with each of these values of a key, such as r2=0.2,1; repeatable: "
    "with every combination.",
)
@fail_on_option
@option(BATCH, "--keep-going", is_flag=True, help="Go on with the others after one has failed.")
@option(BATCH, "--resume", is_flag=True, help="Keep finished runs of the very same profile.")
@overwrite_option("Replace an output that exists.")
@option(OUTPUT, "--dry-run", is_flag=True, help="Check the profiles and say what would be written.")
@option(OUTPUT, "--no-plots", is_flag=True, help="Write no plots into the run folder.")
@verbosity_options
@click.pass_obj
def reduce(
    console: Console,
    profiles: tuple[str, ...],
    machine: str | None,
    settings: tuple[AnySetting, ...],
    columns: dict[str, str],
    separator: str | None,
    decimal: str | None,
    caps: Caps,
    out: str | None,
    table_format: str | None,
    words: FormWords,
    hz: float | None,
    jobs: int,
    scheduler: str | None,
    store: str | None,
    grid: tuple[str, ...],
    fail_on: frozenset[str],
    keep_going: bool,
    resume: bool,
    overwrite: bool,
    dry_run: bool,
    no_plots: bool,
    **reduction: Any,
) -> ExitCode:
    """Reduce the cross-coupling of each PROFILE, and write what the machine is to do.

    A PROFILE is a YAML or CSV file, the name of a built-in profile, or "-" for
    stdin. Each run is verified by independent code before its command table
    exists. Options that name a key of the profile's "reduction:" override it,
    and --set.
    """
    # What sums runs up is not for --help, nor for a shell that completes.
    from des_cli.cli.reduce_batch import all_jobs, run_batch

    several = len(profiles) > 1 or bool(grid)
    form = form_of(out, table_format, words, hz)
    if form is not None and several:
        _refuse_one_table()
    if form is not None and resume:
        raise click.UsageError("--resume needs run folders: a table does not tell its profile.")
    if store is not None and form is not None:
        raise click.UsageError("--store needs run folders: name a folder with -o DIR.")
    if scheduler is not None:
        _refuse_beside_scheduler(form)
    if out == STANDARD_STREAM and not dry_run:
        refuse_binary_on_terminal(None if form is None else form.kind)
    stdin = read_stdin(profiles, caps)
    output = Output(
        out=DEFAULT_RUNS if out is None else out,
        out_is_parent=out is None or several,
        **output_form(form),
        plots=not no_plots,
        overwrite=overwrite,
        resume=resume,
        dry_run=dry_run,
    )
    every = (*settings, *reduction_settings(reduction))
    batch = [
        Job(
            source_of(
                name,
                every,
                machine=machine,
                stdin=stdin,
                columns=columns,
                separator=separator,
                decimal=decimal,
                caps=caps,
            ),
            output,
            fail_on,
        )
        for name in profiles
    ]
    parts = all_jobs(batch, grid)
    if len(parts) > 1 and form is not None:
        _refuse_one_table()
    there = (None, None) if dry_run else (scheduler, store)
    return run_batch(console, parts, jobs, keep_going, *there, distinct=bool(grid))


def _refuse_beside_scheduler(form: Form | None) -> None:
    """Refuse what a cluster cannot do."""
    if form is not None:
        raise click.UsageError("--scheduler needs run folders: name a folder with -o DIR.")
    if click.get_current_context().get_parameter_source("jobs") != ParameterSource.DEFAULT:
        raise click.UsageError("--jobs is for this machine: a scheduler knows its own workers.")


def _refuse_one_table() -> NoReturn:
    raise click.UsageError(
        "one command table cannot hold several profiles: name a folder with -o DIR."
    )
