"""Which figures there are, and what each of them shows.

Every figure is a function of the columns of ``trajectory.parquet`` and of the
content of ``metrics.json``; ``before`` belongs to the motion that the profile asks for and
``after`` to the modified one. Where the machine cannot make the former, the solver starts
from the nearest one that it can; the figures show the profile's own.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, TypeAlias

import numpy as np
from matplotlib.figure import Figure

from des_cli.model.arrays import Floats
from des_cli.model.coriolis import COMPONENTS, ComponentKey
from des_cli.model.machine import JOINTS
from des_cli.model.metrics import Metrics
from des_cli.results.reading import read_metrics
from des_cli.show.plots.canvas import (
    PictureFormat,
    draw,
    encode,
    note,
    set_span,
    sheet,
    stamp,
    style,
)
from des_cli.show.plots.pens import AFTER, BEFORE, DESIRED, MODIFIED, Pen
from des_cli.show.plots.ride import felt, limits
from des_cli.show.plots.study import STUDY_FIGURES, factor, tradeoff_of_run
from des_cli.show.standing import budget_words, change_words, status_words
from des_cli.show.weighted import weighted_component
from des_cli.show.words import FIGURE
from des_cli.units import split_unit

Columns: TypeAlias = Mapping[str, Floats]

CAPTIONS: Mapping[str, str] = {
    "felt": (
        "What the pilot feels: the seat's rates of roll, pitch and yaw, its total angular "
        "acceleration α = dW/dt, and the G-vector, gravity included, each with its size below."
    ),
    "coriolis": "The cross-coupling: the component that the weight looks at, and the whole vector.",
    "coriolis_components": (
        "All components of the cross-coupling on one scale: along the inertial axes of the study "
        "(left) and along the axes of the seat, which the pilot feels (right)."
    ),
    "commands": "What the machine is commanded: the arm's rate, the angles of fork and cab.",
    "limits": "How hard and how smoothly the joints are driven, within the machine's limits.",
    "deviation": "How far the modified joint angles are from the desired ones.",
    "factor": "The factor p on the joint rates; 1 leaves the desired motion as it is.",
    "adjoint": "The adjoint of the joint angles: what a change of each angle would cost.",
}
"""A sentence for each figure, in the order of a report."""

# Ordinates are at least this high, whatever the noise: a thousandth of what
# the machine does in earnest.
_FLOOR = {"rpm": 0.01, "deg": 0.01, "rad/s²": 2e-3, "p": 0.02}
_LEAST_SHARE = 1e-3
_NO_ADJOINT = 1e-12

_COMPONENTS = {component.key: component for component in COMPONENTS}
_IN_AXES = [
    [component.key for component in COMPONENTS if component.axes == axes]
    for axes in ("report", "seat")
]


def draw_plots(trajectory: Columns, content: Mapping[str, Any]) -> dict[str, bytes]:
    """Draw all figures of a run.

    Parameters
    ----------
    trajectory : mapping of str to (n,) array
        The columns of ``trajectory.parquet``.
    content : mapping
        Of ``metrics.json``.

    Returns
    -------
    dict of str to bytes
        The PNG of each figure by its name, in the order of ``CAPTIONS``; without
        ``factor`` and ``adjoint`` where the motion has none. The same input gives the same bytes.
    """
    metrics = read_metrics(content)
    return {name: draw_figure(name, trajectory, metrics, "png") for name in figures_of(trajectory)}


def figures_of(trajectory: Columns) -> list[str]:
    """Return which of the figures of ``CAPTIONS`` a motion has."""
    has = {
        "factor": any(_is_factor(name) for name in trajectory),
        "adjoint": "adjoint_arm" in trajectory,
    }
    return [name for name in CAPTIONS if has.get(name, True)]


def draw_figure(name: str, trajectory: Columns, metrics: Metrics, format: PictureFormat) -> bytes:
    """Draw one figure.

    Parameters
    ----------
    name : str
        Of ``FIGURES``.
    trajectory : mapping of str to (n,) array
        The columns of ``trajectory.parquet``.
    metrics : Metrics
    format : {"png", "svg", "pdf"}

    Returns
    -------
    bytes
        The same for the same input.

    Raises
    ------
    ValueError
        Saying what the motion lacks for the figure.
    """
    with style():
        figure, title = FIGURES[name](trajectory, metrics)
        if status := status_words(metrics):
            stamp(figure, status)
        return encode(figure, title, format)


def _commands(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    title = "Joint commands"
    figure, axes = sheet(title, [DESIRED, MODIFIED], 3)
    commands = (
        ("arm_rad_s", "arm_rpm", "arm [rpm]"),
        ("fork_rad", "fork_deg", "fork [deg]"),
        ("cab_rad", "cab_deg", "cab [deg]"),
    )
    for (panel,), (column, shown, label) in zip(axes, commands, strict=True):
        unit = split_unit(shown)[1]
        assert unit is not None
        curves = [
            (DESIRED, columns[f"asked_{column}"] / unit.to_si),
            (MODIFIED, columns[f"modified_{column}"] / unit.to_si),
        ]
        draw(panel, columns["t_s"], curves, label, _FLOOR[unit.suffix])
    if changed := change_words(metrics.executable.change):
        note(axes[0][0], f"moved by the limits alone: {changed}")
    return figure, title


def _coriolis(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    component = _shown_component(columns, metrics)
    label = _COMPONENTS[component].label
    study = " (study Fig. 7, 10)" if component == "bb3" else ""
    title = f"Cross-coupling: {label}{study} and the whole vector"
    figure, axes = sheet(title, [BEFORE, AFTER], 2, height=2.0)
    t = columns["t_s"]
    draw(axes[0][0], t, _before_after(columns, component), f"{label} [rad/s²]", _FLOOR["rad/s²"])
    norms = [(pen, _norm(columns, pen.label)) for pen in (BEFORE, AFTER)]
    draw(axes[1][0], t, norms, "norm ‖c‖ [rad/s²]", _FLOOR["rad/s²"])
    for panel, key in ((axes[0][0], component), (axes[1][0], "vector")):
        note(panel, _share_taken_off(metrics, key))
    return figure, title


def _coriolis_components(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    title = "Cross-coupling by component: study's axes and seat's axes"
    figure, axes = sheet(title, [BEFORE, AFTER], 3, 2, same_scale=True)
    for j, keys in enumerate(_IN_AXES):
        for i, key in enumerate(keys):
            label = f"{_COMPONENTS[key].label} [rad/s²]"
            draw(axes[i][j], columns["t_s"], _before_after(columns, key), label, _FLOOR["rad/s²"])
            note(axes[i][j], _share_taken_off(metrics, key))
    together = [values for name, values in columns.items() if name.startswith("coriolis_")]
    set_span(axes[0][0], together, _FLOOR["rad/s²"])
    return figure, title


def _adjoint(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    title = "Adjoint λ of the joint angles (study Fig. 8: fork)"
    figure, axes = sheet(title, [], 3)
    adjoint = [columns[f"adjoint_{joint}"] for joint in JOINTS]
    # Its scale is that of the weights: what is small is small beside the largest.
    spread = float(np.ptp(adjoint))
    floor = _LEAST_SHARE * spread if spread > _NO_ADJOINT else 1.0
    for (panel,), joint, index, values in zip(axes, JOINTS, "₁₂₃", adjoint, strict=True):
        draw(panel, columns["t_s"], [(MODIFIED, values)], f"λ{index} {joint} [s/rad]", floor)
    return figure, title


def _deviation(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    title = "Joint deviation θ − Θ"
    figure, axes = sheet(title, [], 3)
    for (panel,), joint in zip(axes, JOINTS, strict=True):
        deviation = np.degrees(columns[f"modified_{joint}_rad"] - columns[f"asked_{joint}_rad"])
        draw(panel, columns["t_s"], [(MODIFIED, deviation)], f"{joint} [deg]", _FLOOR["deg"])
    if budget := budget_words(metrics):
        note(axes[0][0], f"budget: {budget}")
    return figure, title


def _is_factor(column: str) -> bool:
    return column in ("p", *(f"p_{joint}" for joint in JOINTS))


def _before_after(columns: Columns, component: ComponentKey) -> list[tuple[Pen, Floats]]:
    stem = f"coriolis_{component}"
    return [(pen, columns[f"{stem}_{pen.label}_rad_s2"]) for pen in (BEFORE, AFTER)]


def _norm(columns: Columns, when: str) -> Floats:
    parts = [columns[f"coriolis_{name}_{when}_rad_s2"] for name in _IN_AXES[0]]
    return np.sqrt(np.sum(np.square(parts), axis=0))


def _shown_component(columns: Columns, metrics: Metrics) -> ComponentKey:
    """Return the component that the weight looks at, else the one that is largest before."""
    weighted = weighted_component(metrics.solver)
    if weighted is not None:
        return weighted
    return max(_IN_AXES[1], key=lambda key: float(np.ptp(columns[f"coriolis_{key}_before_rad_s2"])))


def _share_taken_off(metrics: Metrics, key: ComponentKey) -> str:
    """Say how much of the squared integral of a component is gone, or was added."""
    reduction = metrics.coriolis.reduction(key)
    if reduction is None:
        return ""
    return f"squared integral {FIGURE.change(reduction)}"


FIGURES: Mapping[str, Callable[[Columns, Metrics], tuple[Figure, str]]] = MappingProxyType(
    {
        "felt": felt,
        "coriolis": _coriolis,
        "coriolis_components": _coriolis_components,
        "commands": _commands,
        "limits": limits,
        "deviation": _deviation,
        "factor": factor,
        "adjoint": _adjoint,
        **STUDY_FIGURES,
        "tradeoff": tradeoff_of_run,
    }
)
"""How each is drawn: those of ``CAPTIONS``, the study's by their numbers, and the trade-off."""
