"""One run on the page: its tables, facts and figures."""

from __future__ import annotations

import base64
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from des_cli.model.coriolis import COMPONENTS
from des_cli.model.machine import JOINTS
from des_cli.results.reading import lookup, number
from des_cli.results.worse import worse_paths
from des_cli.runs_out.run_folder import StoredRun
from des_cli.show.page.comparison import Cell
from des_cli.show.page.numbers import (
    DASH,
    NO_BREAK,
    change,
    fixed,
    percent,
    plain,
    words,
)
from des_cli.show.page.summary import summary_sentences
from des_cli.show.page.tiles import Tile, felt_tiles
from des_cli.show.plots import CAPTIONS, draw_plots
from des_cli.show.plots.standing import budget_words

# Rounding of the solver's last step is no violation.
_ROUNDING = 1e-9

_LIMITED = (
    ("rate", "rad_s", "rad/s"),
    ("acceleration", "rad_s2", "rad/s²"),
    ("jerk", "rad_s3", "rad/s³"),
)

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
        tiles=felt_tiles(metrics),
        coriolis=_coriolis_rows(metrics),
        turning=_turning_rows(metrics),
        limits=_limit_rows(metrics),
        joints=_joint_rows(metrics),
        seat=_seat_rows(metrics),
        facts=_facts(run),
        pictures=pictures,
    )


def _what(metrics: Mapping[str, Any]) -> str:
    text = {key: words(lookup(metrics, f"solver.{key}")) for key in _SOLVER_WORDS}
    return (
        f"{text['method']} cross-coupling by {text['algorithm']} · {text['control']} control · "
        f"{text['axes']} axes · Jacobian at {text['jacobian']} motion · "
        f"{words(lookup(metrics, 'profile.samples'))} samples over "
        f"{plain(number(metrics, 'profile.duration_s'))}{NO_BREAK}s"
    )


def _coriolis_rows(metrics: Mapping[str, Any]) -> list[list[Cell]]:
    rows = []
    for component in COMPONENTS:
        stem = f"coriolis.{component.key}"
        reduction = number(metrics, f"{stem}.reduction")
        mark = "bad" if reduction is not None and reduction < 0 else ""
        rows.append(
            [
                Cell(component.label),
                Cell(change(reduction), mark),
                *(Cell(fixed(number(metrics, path), 4)) for path in _size_paths(stem, "rad_s2")),
            ]
        )
    return rows


def _turning_rows(metrics: Mapping[str, Any]) -> list[list[Cell]]:
    """Return the seat's rates and its total angular acceleration, a row a component."""
    rows, worse = [], worse_paths(metrics)
    for section, axes, symbol, unit, suffix in (
        ("seat_rate", "pqr", "", "rad/s", "rad_s"),
        ("seat_angular_acceleration", "xyz", "α", "rad/s²", "rad_s2"),
    ):
        whole = f"|{symbol or 'W'}|"
        for key, name in (*((axis, f"{symbol}{axis}") for axis in axes), ("magnitude", whole)):
            stem = f"felt.{section}.{key}"
            cells = [
                Cell(fixed(number(metrics, path), 4), "bad" if path in worse else "")
                for path in _size_paths(stem, suffix)
            ]
            if any(cell.text != DASH for cell in cells):
                rows.append([Cell(f"{name} [{unit}]"), *cells])
    return rows


def _size_paths(stem: str, suffix: str) -> list[str]:
    """Return the paths of RMS before and after, then of peak before and after."""
    return [
        f"{stem}.{kind}_{when}_{suffix}" for kind in ("rms", "peak") for when in ("before", "after")
    ]


def _limit_rows(metrics: Mapping[str, Any]) -> list[list[Cell]]:
    rows = []
    for joint in JOINTS:
        for quantity, unit, shown in _LIMITED:
            limit = number(metrics, f"limits.modified.{joint}.{quantity}_limit_{unit}")
            row = [
                Cell(f"{joint} {quantity} [{shown}]"),
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
        changes = [
            plain(number(metrics, f"limits.{motion}.{joint}.acceleration_sign_changes"))
            for motion in _MOTIONS
        ]
        if any(text != DASH for text in changes):
            label = f"{joint}, sign changes of its acceleration"
            rows.append([Cell(label), Cell(""), *map(Cell, changes)])
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
        paths = (
            f"joint_rms_rad.{joint}",
            f"start_error.{joint}_rad",
            f"start_error.{joint}_rad_s",
            f"end_error_rad.{joint}",
            f"end_error_rad_s.{joint}",
        )
        values = [number(metrics, f"fidelity.{path}") for path in paths]
        degrees = (None if value is None else math.degrees(value) for value in values)
        rows.append([Cell(joint), *(Cell(fixed(value)) for value in degrees)])
    return rows


def _seat_rows(metrics: Mapping[str, Any]) -> list[list[Cell]]:
    rows, worse = [], worse_paths(metrics)
    for axis in ("gx", "gy", "gz"):
        stem = f"felt.seat_g.{axis}"
        cells = []
        for kind, suffix in (("min", "g"), ("max", "g"), ("onset", "g_s"), ("jump", "g")):
            paths = [f"{stem}.{kind}_{when}_{suffix}" for when in ("before", "after")]
            before, after = (number(metrics, path) for path in paths)
            known = before is not None and after is not None
            text = f"{fixed(before)} → {fixed(after)}" if known else DASH
            cells.append(Cell(text, "bad" if paths[1] in worse else ""))
        cells.append(Cell(fixed(number(metrics, f"{stem}.rms_error_g"))))
        if any(cell.text != DASH for cell in cells):
            rows.append([Cell(axis.capitalize()), *cells])
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
            "largest error of attitude, of tilt",
            f"{plain(number(metrics, 'fidelity.attitude_error_max_deg'), 3)} deg, "
            f"{plain(number(metrics, 'fidelity.tilt_error_max_deg'), 3)} deg",
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
