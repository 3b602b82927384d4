"""The study's figures 7 to 10 of any run, and the run beside the study's law and a constant p."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TypeAlias, get_args

import numpy as np
from matplotlib.figure import Figure

from des_cli.model.arrays import Floats
from des_cli.model.metric import JOINT_DEVIATION
from des_cli.model.metrics import Metrics
from des_cli.model.profile import Control
from des_cli.model.tradeoff import BASELINE, Means, TradePoint
from des_cli.show.plots.canvas import draw, note, sheet
from des_cli.show.plots.pens import AFTER, BEFORE, DASHES, GREY, JOINT_PENS, MODIFIED, Pen
from des_cli.show.plots.tradeoff import tradeoff_sheet
from des_cli.show.weighted import weighted_component
from des_cli.show.words import FIGURE

Columns: TypeAlias = Mapping[str, Floats]

_HEIGHT = 2.6
_SWEEP = "report-sweep"
_FLOOR = 2e-3
"""Lowest height of an ordinate [rad/s^2]."""


def _original(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    title = "BB3 of the cross-coupling, as the profile asks for it (study Fig. 7)"
    figure, axes = sheet(title, [], 1, height=_HEIGHT)
    curve = (MODIFIED, columns["coriolis_bb3_before_rad_s2"])
    draw(axes[0][0], columns["t_s"], [curve], "BB3 [rad/s²]", _FLOOR)
    return figure, title


def _adjoint(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    if "adjoint_fork" not in columns:
        raise ValueError(f"the run has no adjoint, {_OF_FACTORS}")
    title = "Adjoint λ₂ of the fork (study Fig. 8)"
    figure, axes = sheet(title, [], 1, height=_HEIGHT)
    values = columns["adjoint_fork"]
    curve = (MODIFIED, values)
    draw(axes[0][0], columns["t_s"], [curve], "λ₂ [s/rad]", 1e-3 * float(np.ptp(values)) or 1.0)
    return figure, title


def factor(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    """Draw the factor on the joint rates, one for all or one for each."""
    title = "Factor p on the joint rates (study Fig. 9)"
    one = Pen("desired, p = 1", GREY, DASHES, 1.3, 2.5)
    factors = [(Pen("p", MODIFIED.color), columns["p"])] if "p" in columns else []
    factors += [
        (pen, columns[f"p_{pen.label}"]) for pen in JOINT_PENS if f"p_{pen.label}" in columns
    ]
    if not factors:
        raise ValueError(f"the run has no factor p, {_OF_FACTORS}")
    curves = [(one, np.ones_like(columns["t_s"])), *factors]
    figure, axes = sheet(title, [pen for pen, _ in curves], 1, height=_HEIGHT)
    draw(axes[0][0], columns["t_s"], curves, "p [–]", 0.02)
    return figure, title


def _both(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    title = "BB3 of the cross-coupling, before and after (study Fig. 10)"
    figure, axes = sheet(title, [BEFORE, AFTER], 1, height=_HEIGHT)
    curves = [(pen, columns[f"coriolis_bb3_{pen.label}_rad_s2"]) for pen in (BEFORE, AFTER)]
    draw(axes[0][0], columns["t_s"], curves, "BB3 [rad/s²]", _FLOOR)
    reduction = metrics.coriolis.reduction("bb3")
    if reduction is not None:
        note(axes[0][0], f"squared integral {FIGURE.change(reduction)}")
    return figure, title


_OF_FACTORS = (
    "which only factors on the desired rates have: reduce with --control scalar, or the "
    "profile cobra as the study poses it"
)

STUDY_FIGURES: Mapping[str, Callable[[Columns, Metrics], tuple[Figure, str]]] = MappingProxyType(
    {"7": _original, "8": _adjoint, "9": factor, "10": _both}
)


def tradeoff_of_run(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    """Draw the run beside the study's law and a constant factor of the same reduction.

    No more is known of a run; the command ``sweep`` computes a curve of optima.
    """
    reduction = metrics.coriolis.reduction(weighted_component(metrics.solver) or "vector")
    sweep, constant = metrics.baseline.report_sweep, metrics.baseline.constant_p
    deviation = metrics.fidelity.value(JOINT_DEVIATION)
    points = []
    if reduction is not None and deviation is not None:
        algorithm: Means = "report-sweep" if metrics.solver.algorithm == _SWEEP else "optimum"
        controls: tuple[Control, ...] = get_args(Control)
        control = next((c for c in controls if c == metrics.solver.control), controls[0])
        points.append(_point(algorithm, control, JOINT_DEVIATION, reduction, deviation))
        if constant is not None and constant.joint_deviation is not None:
            point = _point("constant-p", "scalar", "p", reduction, constant.joint_deviation)
            points.append(replace(point, value=_short(constant.p or 0.0)))
    if sweep is not None and sweep.reduction is not None and sweep.joint_deviation is not None:
        point = _point("report-sweep", "scalar", "r2", sweep.reduction, sweep.joint_deviation)
        points.append(replace(point, value=(metrics.solver.r2 or (1.0,))[0] or 1.0))
    if not points:
        raise ValueError("the run has no reduction to be compared")
    return tradeoff_sheet(points, metrics.profile.name or "")


def _point(
    algorithm: Means, control: Control, swept: str, reduction: float, deviation: float
) -> TradePoint:
    return TradePoint(
        algorithm,
        control,
        swept,
        _short(deviation),
        BASELINE,
        objective_reduction=reduction,
        joint_deviation_relative=deviation,
    )


def _short(value: float) -> float:
    """Return a value as it is written beside its point."""
    return float(f"{value:.3g}")
