"""``des-coriolis sweep``: what each further bit of deviation buys."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, cast

import click

from des_cli.batch.job import TableFormat
from des_cli.batch.source import STANDARD_STREAM, Source
from des_cli.cli.command import CURVE, OUTPUT, Command, option
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.completion import complete_budget, complete_files, complete_list, complete_profiles
from des_cli.cli.console import VERBOSE, Console
from des_cli.cli.options import (
    TABLE_FORMATS,
    jobs_option,
    overwrite_option,
    reduction_options_without,
    reduction_settings,
)
from des_cli.cli.source_options import machine_option, read_stdin, setting_options, source_of
from des_cli.cli.status_line import columns_of
from des_cli.cli.stdout import refuse_binary_on_terminal, write_data
from des_cli.cli.sweep_options import (
    CONTROLS,
    DEFAULT_BUDGETS,
    DEFAULT_CONTROLS,
    DEFAULT_METRIC,
    Budgets,
    outputs_held,
    point_format,
    read_controls,
    read_swept_budgets,
    read_weights,
    refuse_budgets,
    refuse_weights,
)
from des_cli.errors import ExitCode
from des_cli.model.metric import SEAT_G_ERROR, SEAT_RATE_DEVIATION
from des_cli.profiles_in.caps import Caps
from des_cli.profiles_in.setting import AnySetting

if TYPE_CHECKING:
    from des_cli.model.profile import Control, Profile
    from des_cli.model.tradeoff import TradePoint
    from des_cli.tradeoff.jobs import PointPlan, PointResult


@click.command(
    cls=Command,
    short_help="Trade deviation for cross-coupling: a curve of optima.",
    epilog=f"""\b
Examples:
  des-coriolis sweep cobra
  des-coriolis sweep cobra --r2s 8,1,0.2 --plot curve.png -o curve.csv
  des-coriolis sweep my.yaml --budgets {SEAT_G_ERROR}=0.05,0.1,0.2 --jobs 2
  des-coriolis sweep my.yaml --controls free --budgets {SEAT_RATE_DEVIATION}=5%,10%,20% \\
    --budget {SEAT_G_ERROR}=0.05
""",
)
@click.argument("profile", metavar="PROFILE", shell_complete=complete_profiles)
@option(
    CURVE,
    "--budgets",
    metavar="MOST,...",
    callback=read_swept_budgets,
    shell_complete=complete_budget,
    help=f"Budgets of {DEFAULT_METRIC}, or METRIC=MOST,... of another fidelity metric; "
    "the profile's budgets on other metrics stay.  [default: 0.01,0.02,0.05,0.1]",
)
@option(
    CURVE,
    "--r2s",
    metavar="WEIGHT,...",
    callback=read_weights,
    help="Instead of budgets: weights r2 on leaving the desired rates.",
)
@option(
    CURVE,
    "--controls",
    metavar="CONTROL,...",
    default=",".join(DEFAULT_CONTROLS),
    show_default=True,
    callback=read_controls,
    shell_complete=complete_list(CONTROLS),
    help="A curve for each: free joints, one factor for all, or one each.",
)
@machine_option
@setting_options
@reduction_options_without("method", "algorithm", "control", "tolerance", "iterations")
@option(
    OUTPUT,
    "-o",
    "--out",
    metavar="FILE|-",
    shell_complete=complete_files,
    help="Where the points go.  [default: stdout, as aligned text on a terminal]",
)
@option(
    OUTPUT,
    "-f",
    "--format",
    "table_format",
    type=click.Choice(TABLE_FORMATS),
    help="Format of the points.  [default: by the suffix of FILE, or csv]",
)
@option(
    OUTPUT,
    "--plot",
    metavar="FILE.png",
    shell_complete=complete_files,
    help="Draw the curve into this file.",
)
@jobs_option("Points at a time; 0 is one for each CPU.")
@overwrite_option("Replace files that exist.")
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
    caps: Caps,
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
    refuse_weights(reduction, r2s)
    refuse_budgets(reduction, swept)
    form = point_format(out, table_format)
    if form != "text" and out in (None, STANDARD_STREAM):
        refuse_binary_on_terminal(form)
    with outputs_held(out, plot, overwrite):
        source = source_of(
            profile,
            settings,
            machine=machine,
            stdin=read_stdin((profile,), caps),
            columns=columns,
            separator=separator,
            decimal=decimal,
            caps=caps,
        )
        plans = _plan(reduction, swept, r2s or (), controls)
        return _run(console, source, plans, jobs, out, form, plot, overwrite)


def _plan(
    reduction: dict[str, Any],
    budgets: Budgets | None,
    r2s: tuple[float, ...],
    controls: Sequence[str],
) -> list[PointPlan]:
    """Return what each point asks for, over budgets or else over r2, and the baselines."""
    from des_cli.tradeoff.jobs import PointPlan

    swept, values = budgets or ("r2", r2s)
    base = reduction
    if budgets:
        # what a budget buys is meant inside the limits, and so is what it is compared with
        base = reduction | {"limits": reduction["limits"] or "enforce"}

    def settings(own: Mapping[str, Any], *further: AnySetting) -> tuple[AnySetting, ...]:
        return (*reduction_settings({**base, **own}), *further)

    plans = []
    for control in controls:
        for value in values:
            own: dict[str, Any] = {"method": "minimum", "algorithm": "optimum", "control": control}
            if budgets:  # r2 is the study's then
                point = settings(own | {"r2": None}, f"reduction.budget.{swept}={value!r}")
            else:
                point = settings(own | {"r2": repr(value)})
            plans.append(PointPlan(point, cast("Control", control), swept, value))
    return [*plans, PointPlan(settings({"budget": None}), weights=r2s)]


def _run(
    console: Console,
    source: Source,
    plans: list[PointPlan],
    workers: int,
    out: str | None,
    form: str,
    plot: str | None,
    overwrite: bool,
) -> ExitCode:
    from des_cli.batch.pool import local_executor
    from des_cli.batch.runner import run_tasks
    from des_cli.tradeoff.jobs import PointResult, exit_code_of, load_points, make_jobs, run_point

    results = []
    with (
        local_executor(min(workers, len(plans)) if workers else workers) as executor,
        console.working(len(plans), "points") as line,
    ):
        line.stage("reading")
        profiles = load_points(source, plans)
        line.stage("desired motion")
        jobs = make_jobs(source.name, plans, profiles)
        live = executor is None and console.verbosity >= VERBOSE
        for result in run_tasks(
            jobs,
            run_point,
            PointResult.failed,
            executor,
            keep_going=True,
            on_iteration=console.follow(line, log=live),
            on_stage=line.stage,
            on_finished=line.advance,
        ):
            results.append(result)
            _tell(console, result, live)
    points = [point for result in results for point in result.points]
    from des_cli.tradeoff.curve import doubts

    console.warn(doubts(points))
    about = f"{profiles[0].name}, {_objective(profiles[0])}"
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
        facts = {key: value for key, value in asdict(point).items() if key not in ("kind", "text")}
        if point.solved:
            console.say(point_line(point), "point", **facts)
        else:
            console.warn([point_line(point)], kind="point", **facts)


def _write(
    points: Sequence[TradePoint], about: str, out: str | None, form: str, overwrite: bool
) -> None:
    if form == "text":
        from des_cli.cli.tradeoff_text import points_text

        write_data(points_text(points, about, columns_of(sys.stdout)))
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
