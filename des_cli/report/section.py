"""One run on the page: its tables, facts and figures."""

from __future__ import annotations

import base64
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from des_cli.files.run_folder import StoredRun
from des_cli.model.machine import JOINTS
from des_cli.plots import CAPTIONS, draw_plots
from des_cli.plots.standing import budget_words
from des_cli.report.comparison import Cell
from des_cli.report.numbers import (
    DASH,
    NO_BREAK,
    change,
    fixed,
    percent,
    plain,
    words,
)
from des_cli.report.summary import COMPONENTS, summary_sentences
from des_cli.results.reading import lookup, number

# Rounding of the solver's last step is no violation.
_ROUNDING = 1e-9

_MOTIONS = ("desired", "modified")
_SOLVER_WORDS = ("method", "algorithm", "control", "axes", "jacobian")


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
    coriolis, limits, joints, seat : list of list of Cell
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
    coriolis: list[list[Cell]]
    limits: list[list[Cell]]
    joints: list[list[Cell]]
    seat: list[list[Cell]]
    facts: list[tuple[str, str]]
    pictures: list[Picture]


def run_section(run: StoredRun, label: str, number_of_run: int) -> Section:
    """Return the section of a run.

    Parameters
    ----------
    run : StoredRun
    label : str
        What it is called on the page.
    number_of_run : int
        Its position on the page, from 1.
    """
    metrics = run.metrics
    pictures = [
        Picture(name, CAPTIONS[name], base64.b64encode(png).decode("ascii"))
        for name, png in draw_plots(run.trajectory, metrics).items()
    ]
    return Section(
        anchor=f"run-{number_of_run}",
        name=label,
        what=_what(metrics),
        sentences=summary_sentences(metrics),
        notices=_texts(lookup(metrics, "notices")),
        violations=_texts(lookup(metrics, "violations")),
        coriolis=_coriolis_rows(metrics),
        limits=_limit_rows(metrics),
        joints=_joint_rows(metrics),
        seat=_seat_rows(metrics),
        facts=_facts(run),
        pictures=pictures,
    )


def _what(metrics: Mapping[str, Any]) -> str:
    text = {key: words(lookup(metrics, f"solver.{key}")) for key in _SOLVER_WORDS}
    return (
        f"{text['method']} Coriolis by {text['algorithm']} · {text['control']} control · "
        f"{text['axes']} axes · Jacobian at {text['jacobian']} motion · "
        f"{words(lookup(metrics, 'profile.samples'))} samples over "
        f"{plain(number(metrics, 'profile.duration_s'))}{NO_BREAK}s"
    )


def _coriolis_rows(metrics: Mapping[str, Any]) -> list[list[Cell]]:
    rows = []
    for key, name in COMPONENTS.items():
        reduction = number(metrics, f"coriolis.{key}.reduction")
        mark = "bad" if reduction is not None and reduction < 0 else ""
        values = ("rms_before", "rms_after", "peak_before", "peak_after")
        rows.append(
            [
                Cell(name.removeprefix("the ")),
                Cell(change(reduction), mark),
                *(
                    Cell(fixed(number(metrics, f"coriolis.{key}.{value}_rad_s2"), 4))
                    for value in values
                ),
            ]
        )
    return rows


def _limit_rows(metrics: Mapping[str, Any]) -> list[list[Cell]]:
    rows = []
    for joint in JOINTS:
        for quantity, unit in (("rate", "rad_s"), ("acceleration", "rad_s2")):
            limit = number(metrics, f"limits.modified.{joint}.{quantity}_limit_{unit}")
            row = [
                Cell(f"{joint} {quantity} [{'rad/s' if unit == 'rad_s' else 'rad/s²'}]"),
                Cell(plain(limit)),
            ]
            for motion in _MOTIONS:
                peak = number(metrics, f"limits.{motion}.{joint}.{quantity}_peak_{unit}")
                over = limit is not None and peak is not None and peak > limit * (1 + _ROUNDING)
                text = f"{fixed(peak, 4)} exceeds" if over else fixed(peak, 4)
                row.append(Cell(text, "bad" if over else ""))
            rows.append(row)
        steps = [number(metrics, f"limits.{motion}.{joint}.rate_step_rad_s") for motion in _MOTIONS]
        if any(steps):
            values = (Cell(fixed(step, 4)) for step in steps)
            rows.append([Cell(f"{joint} step of the rate [rad/s]"), Cell(DASH), *values])
        rows.append([Cell(f"{joint}, all limits"), Cell(""), *_verdicts(metrics, joint)])
    return rows


def _verdicts(metrics: Mapping[str, Any], joint: str) -> list[Cell]:
    """Say whether a joint keeps its limits: also those of the angle, and steps of the rate."""
    cells = []
    for motion in _MOTIONS:
        ok = lookup(metrics, f"limits.{motion}.{joint}.ok")
        cells.append(Cell("broken", "bad") if ok is False else Cell("kept" if ok is True else DASH))
    return cells


def _joint_rows(metrics: Mapping[str, Any]) -> list[list[Cell]]:
    rows = []
    for joint in JOINTS:
        cells = [Cell(joint)]
        for key in ("joint_rms_rad", "end_error_rad"):
            value = number(metrics, f"fidelity.{key}.{joint}")
            cells.append(Cell(fixed(None if value is None else math.degrees(value))))
        rows.append(cells)
    return rows


def _seat_rows(metrics: Mapping[str, Any]) -> list[list[Cell]]:
    keys = (
        "peak_before_g",
        "peak_after_g",
        "onset_before_g_s",
        "onset_after_g_s",
        "jump_before_g",
        "jump_after_g",
        "rms_error_g",
    )
    rows = []
    for axis in "xyz":
        values = [number(metrics, f"fidelity.seat_g.g{axis}.{key}") for key in keys]
        if any(value is not None for value in values):
            rows.append([Cell(f"G{axis}"), *(Cell(fixed(value)) for value in values)])
    return rows


def _facts(run: StoredRun) -> list[tuple[str, str]]:
    metrics = run.metrics
    status, message = (words(lookup(metrics, f"solver.{key}")) for key in ("status", "message"))
    return [
        ("status", f"{status}: {message}"),
        ("iterations", words(lookup(metrics, "solver.iterations"))),
        ("budget", budget_words(metrics) or DASH),
        ("limits", words(lookup(metrics, "solver.limits"))),
        (
            "cost J",
            f"{plain(number(metrics, 'solver.cost'), 7)} "
            f"(unreduced {plain(number(metrics, 'solver.cost_unreduced'), 7)})",
        ),
        ("optimality", plain(number(metrics, "solver.optimality"), 2)),
        (
            "mean of (1 − p)²",
            percent(number(metrics, "fidelity.mean_square_one_minus_p")),
        ),
        (
            "largest attitude error",
            f"{plain(number(metrics, 'fidelity.attitude_error_max_deg'), 3)} deg",
        ),
        (
            "singularity",
            f"least |cos θ₂| {plain(number(metrics, 'singularity.min_abs_cos_fork'), 3)}, "
            f"damped samples {words(lookup(metrics, 'singularity.damped_samples'))}, "
            f"residual {plain(number(metrics, 'singularity.max_residual_rad_s'), 3)} rad/s",
        ),
        ("profile's SHA-256", words(lookup(metrics, "profile.sha256"))),
        (
            "made by",
            f"{words(lookup(run.manifest, 'tool.name'))} "
            f"{words(lookup(run.manifest, 'tool.version'))}",
        ),
    ]


def _texts(value: Any) -> list[str]:
    return [str(text) for text in value] if isinstance(value, list) else []
