"""One run on the page: its tables, facts and figures."""

from __future__ import annotations

import base64
from dataclasses import dataclass

from des_cli.model.metric import ATTITUDE_ERROR, FACTOR_DEVIATION
from des_cli.model.metrics import Metrics
from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.comparison import Cell
from des_cli.show.page.summary import summary_sentences
from des_cli.show.page.tables import coriolis_rows, joint_rows, limit_rows, seat_rows, turning_rows
from des_cli.show.page.tiles import Tile, felt_tiles
from des_cli.show.plots import CAPTIONS, draw_plots
from des_cli.show.plots.standing import budget_words
from des_cli.show.words import PAGE, text_of


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure inside the page.

    Parameters
    ----------
    name, caption : str
    data : str
        The PNG in base64.
    """

    name: str
    caption: str
    data: str


@dataclass(frozen=True, slots=True)
class Section:
    """Everything the template needs of one run, as text.

    Parameters
    ----------
    anchor : str
        Made from the position, never from the name.
    name, what : str
        What the run is called, and in one line what was done with it.
    sentences, notices, violations : list of str
    tiles : list of Tile
        What the pilot feels, at the head of the section.
    coriolis, turning, limits, joints, seat : list of list of Cell
        Rows of the tables.
    facts : list of (str, str)
        Of the solver, the profile and the tool.
    pictures : list of Picture
    """

    anchor: str
    name: str
    what: str
    sentences: list[str]
    notices: list[str]
    violations: list[str]
    tiles: list[Tile]
    coriolis: list[list[Cell]]
    turning: list[list[Cell]]
    limits: list[list[Cell]]
    joints: list[list[Cell]]
    seat: list[list[Cell]]
    facts: list[tuple[str, str]]
    pictures: list[Picture]


def run_section(run: StoredRun, metrics: Metrics, label: str, number_of_run: int) -> Section:
    """Return the section of a run.

    Parameters
    ----------
    run : StoredRun
    metrics : Metrics
        Of the run.
    label : str
        What it is called on the page.
    number_of_run : int
        Its position on the page, from 1.
    """
    pictures = [
        Picture(name, CAPTIONS[name], base64.b64encode(png).decode("ascii"))
        for name, png in draw_plots(run.trajectory, run.metrics, run.figures).items()
    ]
    return Section(
        anchor=f"run-{number_of_run}",
        name=label,
        what=_what(metrics),
        sentences=summary_sentences(metrics),
        notices=list(metrics.notices),
        violations=list(metrics.violations),
        tiles=felt_tiles(metrics),
        coriolis=coriolis_rows(metrics),
        turning=turning_rows(metrics),
        limits=limit_rows(metrics),
        joints=joint_rows(metrics),
        seat=seat_rows(metrics),
        facts=_facts(run, metrics),
        pictures=pictures,
    )


def _what(metrics: Metrics) -> str:
    solver, profile = metrics.solver, metrics.profile
    return (
        f"{text_of(solver.method)} cross-coupling by {text_of(solver.algorithm)} · "
        f"{text_of(solver.control)} control · {text_of(solver.axes)} axes · "
        f"Jacobian at {text_of(solver.jacobian)} motion · {text_of(profile.samples)} samples over "
        f"{PAGE.number(profile.duration_s, 4)}{PAGE.space}s"
    )


def _facts(run: StoredRun, metrics: Metrics) -> list[tuple[str, str]]:
    solver, fidelity, singularity = metrics.solver, metrics.fidelity, metrics.singularity
    tool = run.manifest.get("tool")
    maker = tool if isinstance(tool, dict) else {}
    return [
        ("status", f"{text_of(solver.status)}: {text_of(solver.message)}"),
        ("iterations", text_of(solver.iterations)),
        ("budget", budget_words(metrics) or PAGE.unknown),
        ("limits", text_of(solver.limits)),
        (
            "cost J",
            f"{PAGE.number(solver.cost, 7)} (unreduced {PAGE.number(solver.cost_unreduced, 7)})",
        ),
        ("optimality", PAGE.number(solver.optimality, 2)),
        ("mean of (1 − p)²", PAGE.percent(fidelity.value(FACTOR_DEVIATION))),
        (
            "largest error of attitude, of tilt",
            f"{PAGE.number(fidelity.value(ATTITUDE_ERROR), 3)} deg, "
            f"{PAGE.number(fidelity.tilt_error_max_deg, 3)} deg",
        ),
        (
            "singularity",
            f"least |cos θ₂| {PAGE.number(singularity.min_abs_cos_fork, 3)}, "
            f"damped samples {text_of(singularity.damped_samples)}, "
            f"residual {PAGE.number(singularity.max_residual_rad_s, 3)} rad/s",
        ),
        ("profile's SHA-256", text_of(metrics.profile.sha256)),
        ("made by", f"{text_of(maker.get('name'))} {text_of(maker.get('version'))}"),
    ]
