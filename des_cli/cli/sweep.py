"""``des-coriolis sweep``: what each further bit of deviation buys."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from des_cli.batch.job import STANDARD_STREAM, Job, TableFormat
from des_cli.cli.console import VERBOSE, Console
from des_cli.cli.options import (
    TABLE_FORMATS,
    read_budgets,
    reduction_options_without,
    reduction_settings,
    verbosity_options,
)
from des_cli.cli.source_options import machine_option, read_stdin, setting_options, source_job
from des_cli.cli.stdout import refuse_binary_on_terminal, write_data
from des_cli.cli.sweep_options import (
    DEFAULT_BUDGETS,
    DEFAULT_CONTROLS,
    DEFAULT_METRIC,
    Budgets,
    read_controls,
    read_swept_budgets,
    read_weights,
)
from des_cli.errors import Complaint, ExitCode, FileAccessError
from des_cli.profiles_in.setting import AnySetting

if TYPE_CHECKING:
    from des_cli.model.profile import Control, Profile
    from des_cli.model.tradeoff import TradePoint
    from des_cli.tradeoff.jobs import PointJob, PointResult


@click.command(
    short_help="Trade deviation for cross-coupling: a curve of optima.",
    epilog="""\b
Examples:
  des-coriolis sweep cobra
  des-coriolis sweep cobra --r2s 8,1,0.2 --plot curve.png -o curve.csv
  des-coriolis sweep my.yaml --budgets seat_g_rms_error_g=0.05,0.1,0.2 --jobs 2
  des-coriolis sweep my.yaml --controls free --budgets seat_rate_deviation_relative=5%,10%,20% \\
    --budget seat_g_rms_error_g=0.05
""",
)
@click.argument("profile", metavar="PROFILE")
@click.option(
    "--budgets",
    metavar="MOST,...",
    callback=read_swept_budgets,
    help="Budgets of joint_deviation_relative, or METRIC=MOST,... of another fidelity metric; "
    "the profile's budgets on other metrics stay.  [default: 0.01,0.02,0.05,0.1]",
)
@click.option(
    "--r2s",
    metavar="WEIGHT,...",
    callback=read_weights,
    help="Instead of budgets: weights r2 on leaving the desired rates.",
)
@click.option(
    "--controls",
    metavar="CONTROL,...",
    default=",".join(DEFAULT_CONTROLS),
    show_default=True,
    callback=read_controls,
    help="A curve for each: free joints, one factor for all, or one each.",
)
@machine_option
@setting_options
@reduction_options_without("method", "algorithm", "control", "tolerance", "iterations")
@click.option(
    "-o",
    "--out",
    metavar="FILE|-",
    help="Where the points go.  [default: stdout, as aligned text on a terminal]",
)
@click.option(
    "-f",
    "--format",
    "table_format",
    type=click.Choice(TABLE_FORMATS),
    help="Format of the points.  [default: by the suffix of FILE, or csv]",
)
@click.option("--plot", metavar="FILE.png", help="Draw the curve into this file.")
@click.option(
    "--jobs",
    type=click.IntRange(min=0),
    default=1,
    show_default=True,
    help="Points at a time; 0 is one for each CPU.",
)
@click.option("--overwrite", is_flag=True, help="Replace files that exist.")
@verbosity_options
@click.pass_obj
def sweep(
    console: Console,
    profile: str,
    budgets: Budgets | None,
    r2s: tuple[float, ...] | None,
    controls: tuple[str, ...],
    machine: str | None,
    settings: tuple[AnySetting, ...],
    columns: dict[str, str],
    separator: str | None,
    decimal: str | None,
    out: str | None,
    table_format: str | None,
    plot: str | None,
    jobs: int,
    overwrite: bool,
    **reduction: Any,
) -> ExitCode:
    """Show how much cross-coupling each deviation from PROFILE buys.

    Each point is an optimum: the most reduction for a budget, inside the limits,
    or the minimum for a weight r2. Beside them stand the study's single sweep and
    constant factors p. A point without a solution keeps its row with its status.
    """
    if budgets and r2s:
        raise click.UsageError("--budgets and --r2s exclude each other.")
    swept = None if r2s else budgets or (DEFAULT_METRIC, DEFAULT_BUDGETS)
    _refuse_weights(reduction, r2s)
    _refuse_budgets(reduction, swept)
    form = _form(out, table_format)
    if form != "text" and out in (None, STANDARD_STREAM):
        refuse_binary_on_terminal(form)
    _refuse_existing(out, plot, overwrite)
    source = source_job(
        profile,
        settings,
        machine=machine,
        stdin=read_stdin((profile,)),
        columns=columns,
        separator=separator,
        decimal=decimal,
    )
    points = _plan(source, reduction, swept, r2s or (), controls)
    return _run(console, points, jobs, out, form, plot, overwrite)


def _plan(
    source: Job,
    reduction: dict[str, Any],
    budgets: Budgets | None,
    r2s: tuple[float, ...],
    controls: Sequence[str],
) -> list[PointJob]:
    """Return a job for each point, over budgets or else over r2, and one for the baselines."""
    from dataclasses import replace

    from des_cli.tradeoff.jobs import PointJob

    swept, values = budgets or ("r2", r2s)
    base = reduction
    if budgets:
        # what a budget buys is meant inside the limits, and so is what it is compared with
        base = reduction | {"limits": reduction["limits"] or "enforce"}

    def job(own: Mapping[str, Any], *further: AnySetting) -> Job:
        settings = (*source.settings, *reduction_settings({**base, **own}), *further)
        return replace(source, settings=settings)

    jobs = []
    for control in controls:
        for value in values:
            own: dict[str, Any] = {"method": "minimum", "algorithm": "optimum", "control": control}
            if budgets:  # r2 is the study's then
                point = job(own | {"r2": None}, f"reduction.budget.{swept}={value!r}")
            else:
                point = job(own | {"r2": repr(value)})
            jobs.append(PointJob(point, cast("Control", control), swept, value))
    return [*jobs, PointJob(job({"budget": None}), weights=r2s)]


def _run(
    console: Console,
    jobs: list[PointJob],
    workers: int,
    out: str | None,
    form: str,
    plot: str | None,
    overwrite: bool,
) -> ExitCode:
    from des_cli.batch.pool import local_executor
    from des_cli.tradeoff.jobs import check_points, exit_code_of, run_points

    results = []
    with (
        local_executor(min(workers, len(jobs)) if workers else workers) as executor,
        console.working(len(jobs), "points") as line,
    ):
        line.stage("reading")
        profile = check_points(jobs)
        live = executor is None and console.verbosity >= VERBOSE
        on_iteration = console.follow(line, log=live)
        for result in run_points(jobs, executor, on_iteration, line.stage):
            results.append(result)
            line.advance()
            _tell(console, result, live)
    points = [point for result in results for point in result.points]
    from des_cli.tradeoff.point import doubts

    console.warn(doubts(points))
    about = f"{profile.name}, {_objective(profile)}"
    _write(points, about, out, form, overwrite)
    if plot is not None:
        from des_cli.runs_out.atomic import write_file
        from des_cli.show.plots import draw_tradeoff

        write_file(plot, draw_tradeoff(points, about), overwrite=overwrite)
    return exit_code_of(results)


def _tell(console: Console, result: PointResult, live: bool) -> None:
    """Say how a job ended; what has no answer, quiet or not."""
    from des_cli.cli.tradeoff_text import point_line

    if console.verbosity >= VERBOSE and not live:
        for iteration in result.log:
            console.iteration(iteration)
    console.end_log()
    if result.failure is not None:
        console.failure(result.failure)
    for point in result.points:
        if point.algorithm != "optimum" or point.status == "failed":
            continue
        if point.solved:
            console.say(point_line(point))
        else:
            console.warn([point_line(point)])


def _write(
    points: Sequence[TradePoint], about: str, out: str | None, form: str, overwrite: bool
) -> None:
    if form == "text":
        from des_cli.cli.tradeoff_text import points_text

        write_data(points_text(points, about))
        return
    from des_cli.runs_out.atomic import write_file
    from des_cli.runs_out.point_table import encode_points

    table = encode_points(points, cast(TableFormat, form))
    if out in (None, STANDARD_STREAM):
        write_data(table)
    else:
        write_file(out, table, overwrite=overwrite)


def _objective(profile: Profile) -> str:
    """Say what the objective weighs: ``r1 = 0, 2, 0 in report axes``."""
    r1 = profile.reduction.r1.tolist()
    plain = all(not r1[i][j] for i in range(3) for j in range(3) if i != j)
    weights = ", ".join(f"{r1[i][i]:g}" for i in range(3)) if plain else "a matrix"
    return f"r1 = {weights} in {profile.reduction.axes} axes"


def _form(out: str | None, named: str | None) -> str:
    """Return the format of the points, ``text`` where they are for a person."""
    on_terminal = sys.stdout is not None and sys.stdout.isatty()
    if out is None:
        return named or ("text" if on_terminal else "csv")
    suffix = "" if out == STANDARD_STREAM else Path(out).suffix.lower().removeprefix(".")
    if named is not None and suffix in TABLE_FORMATS and suffix != named:
        raise click.UsageError(f"--format {named} contradicts the suffix of {out}.")
    return named or (suffix if suffix in TABLE_FORMATS else "csv")


def _refuse_weights(reduction: dict[str, Any], r2s: tuple[float, ...] | None) -> None:
    if r2s and reduction["r2"] is not None:
        raise click.UsageError("--r2 and --r2s exclude each other.")
    if not r2s and reduction["tracking"] is not None:
        raise click.UsageError("--tracking needs --r2s: a budget brings its own weight.")


def _refuse_budgets(reduction: dict[str, Any], swept: Budgets | None) -> None:
    fixed = read_budgets(reduction["budget"])
    if fixed and swept is None:
        raise click.UsageError("--budget and --r2s exclude each other.")
    if swept is not None and swept[0] in fixed:
        raise click.UsageError(f"--budget keeps {swept[0]}, which is swept: leave one of them out.")


def _refuse_existing(out: str | None, plot: str | None, overwrite: bool) -> None:
    """Refuse before solving what would be refused when writing."""
    if plot is not None and Path(plot).suffix.lower() != ".png":
        raise click.UsageError(f"--plot draws a PNG: name it FILE.png, not {plot}.")
    complaints = []
    for name in (out, plot):
        if name is None or name == STANDARD_STREAM:
            continue
        path = Path(name)
        if path.is_dir():
            complaints.append(Complaint(name, "is a folder; name a file"))
        elif not path.parent.is_dir():
            complaints.append(Complaint(name, "cannot be written: its folder does not exist"))
        elif path.is_file() and not overwrite:
            complaints.append(Complaint(name, "exists; --overwrite replaces it"))
    if complaints:
        raise FileAccessError(complaints)
