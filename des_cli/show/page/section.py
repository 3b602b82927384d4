"""One run on the page: everything the template needs of it, and what its script does."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import markupsafe

from des_cli.model.metric import ATTITUDE_ERROR, FACTOR_DEVIATION
from des_cli.model.metrics import Metrics
from des_cli.results.verdict import Verdict, find_verdict
from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.cells import Cell
from des_cli.show.page.curves import Family, FamilyName, families_of
from des_cli.show.page.limit_bars import Bar, limit_bars
from des_cli.show.page.machine_view import MachineView, machine_view
from des_cli.show.page.packing import pack_family, thin_family
from des_cli.show.page.panels import GROUPS, Panel, panels_of
from des_cli.show.page.reproduce import Reproduction, reproduction_of, seat_words
from des_cli.show.page.sheet import Still, stills_of
from des_cli.show.page.summary import summary_sentences
from des_cli.show.page.tables import coriolis_rows, joint_rows, limit_rows, seat_rows, turning_rows
from des_cli.show.page.tiles import Tile, run_tiles
from des_cli.show.page.tradeoff_points import TradePlace, trade_places
from des_cli.show.standing import budget_words
from des_cli.show.words import PAGE, text_of

_CSV_UNITS = {"rad/s²": "rad_s2", "deg/s": "deg_s", "g": "g", "g/s": "g_s", "deg": "deg"}
_CSV_UNITS |= {"rad/s³": "rad_s3", "s/rad": "s_rad"}


@dataclass(frozen=True, slots=True)
class Section:
    """Everything the template needs of one run, as text.

    Parameters
    ----------
    anchor : str
        Made from the position, never from the name.
    name, machine, seat, what : str
        What the run is called, on which machine and seat, and in one line what was done.
    verdict : Verdict
    tiles : list of Tile
    stills : list of Still
        For paper, and for who has no script.
    sentences, notices, violations : list of str
    bars : list of Bar
    groups : list of (str, str, list of Panel)
        Of the interactive plots: key, title and panels.
    trade : list of TradePlace
    coriolis, turning, limits, joints, seat_g : list of list of Cell
        Rows of the tables.
    facts : list of (str, str)
        Of the solver.
    again : Reproduction
    moves : bool
        Whether the machine is known, so that it can be drawn.
    data : markupsafe.Markup
        JSON for the script.
    """

    anchor: str
    name: str
    machine: str
    seat: str
    what: str
    verdict: Verdict
    tiles: list[Tile]
    stills: list[Still]
    sentences: list[str]
    notices: list[str]
    violations: list[str]
    bars: list[Bar]
    groups: list[tuple[str, str, list[Panel]]]
    trade: list[TradePlace]
    coriolis: list[list[Cell]]
    turning: list[list[Cell]]
    limits: list[list[Cell]]
    joints: list[list[Cell]]
    seat_g: list[list[Cell]]
    facts: list[tuple[str, str]]
    again: Reproduction
    moves: bool
    data: markupsafe.Markup


def run_section(
    run: StoredRun, metrics: Metrics, label: str, number_of_run: int, columns: int
) -> Section:
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
    columns : int
        Into how many columns of pixels its curves are cut; see `packing.columns_for`.
    """
    families = families_of(run.trajectory)
    view = machine_view(run.manifest, metrics)
    panels = panels_of(families, metrics, view.angle_limits if view else None)
    return Section(
        anchor=f"run-{number_of_run}",
        name=label,
        machine=text_of(metrics.profile.machine),
        seat=seat_words(view) or PAGE.unknown,
        what=_what(metrics),
        verdict=find_verdict(metrics),
        tiles=run_tiles(metrics, families),
        stills=stills_of(families),
        sentences=summary_sentences(metrics),
        notices=list(metrics.notices),
        violations=list(metrics.violations),
        bars=limit_bars(metrics),
        groups=_grouped(panels),
        trade=trade_places(metrics),
        coriolis=coriolis_rows(metrics),
        turning=turning_rows(metrics),
        limits=limit_rows(metrics),
        joints=joint_rows(metrics),
        seat_g=seat_rows(metrics),
        facts=_facts(metrics),
        again=reproduction_of(run, metrics, view),
        moves=view is not None,
        data=_data(label, families, panels, view, columns),
    )


def _grouped(panels: Sequence[Panel]) -> list[tuple[str, str, list[Panel]]]:
    grouped = [
        (key, title, [panel for panel in panels if panel.group == key])
        for key, title in GROUPS.items()
    ]
    return [group for group in grouped if group[2]]


def _data(
    label: str,
    families: dict[FamilyName, Family],
    panels: Sequence[Panel],
    view: MachineView | None,
    columns: int,
) -> markupsafe.Markup:
    """Return what the script draws the run from, as JSON that no text can end early."""
    t = families["rate"].t
    start = float(t[0])
    content: dict[str, Any] = {
        "name": label,
        "file": re.sub(r"[^\w-]+", "_", label, flags=re.ASCII)[:60] or "run",
        "start": start,
        "duration": float(t[-1] - t[0]),
        "panels": [
            {
                "key": panel.key,
                "family": panel.family,
                "csv_unit": _CSV_UNITS.get(panel.unit, ""),
                "curves": [{"column": each.column, "pen": each.pen} for each in panel.curves],
                "span": panel.span,
                "limit": panel.limit,
                "at_limit": panel.at_limit,
            }
            for panel in panels
        ],
        "chains": view.chains() if view else None,
        "packed": {
            name: pack_family(thin_family(family, columns), start)
            for name, family in families.items()
        },
    }
    text = json.dumps(content, separators=(",", ":"), allow_nan=False)
    return markupsafe.Markup(text.replace("<", "\\u003c"))


def _what(metrics: Metrics) -> str:
    solver, profile = metrics.solver, metrics.profile
    return (
        f"{text_of(solver.method)} cross-coupling by {text_of(solver.algorithm)} · "
        f"{text_of(solver.control)} control · {text_of(solver.axes)} axes · "
        f"Jacobian at {text_of(solver.jacobian)} motion · {text_of(profile.samples)} samples over "
        f"{PAGE.number(profile.duration_s, 4)}{PAGE.space}s"
    )


def _facts(metrics: Metrics) -> list[tuple[str, str]]:
    solver, fidelity, singularity = metrics.solver, metrics.fidelity, metrics.singularity
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
    ]
