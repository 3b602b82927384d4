"""The figures of the ride: what the pilot feels, and how hard the joints are driven for it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from des_cli.model.arrays import Floats
from des_cli.model.loads import Driven
from des_cli.model.machine import JOINTS
from des_cli.model.metrics import Metrics
from des_cli.show.plots.canvas import draw, note, sheet
from des_cli.show.plots.pens import AFTER, BEFORE, BEYOND, DESIRED, MODIFIED, WITHIN, Pen
from des_cli.show.words import FIGURE

Columns: TypeAlias = Mapping[str, Floats]

_FLOOR = {"deg/s": 0.1, "rad/s": 2e-3, "rad/s²": 2e-3, "g": 2e-3, "rad/s³": 0.02}

_DRIVEN: tuple[tuple[str, Driven, str], ...] = (
    ("rad_s", "rate", "rad/s"),
    ("rad_s2", "acceleration", "rad/s²"),
    ("rad_s3", "jerk", "rad/s³"),
)

_ROOM = 1.15
_NEAR = 3.0  # the ordinate reaches to the limit where that is no more than so many peaks


def felt(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    """Draw the seat's rate, its total angular acceleration and the G-vector."""
    title = "What the pilot feels"
    figure, axes = sheet(title, [BEFORE, AFTER], 4, 3, height=1.45)
    t = columns["t_s"]
    families = (
        ("seat_{}", "rad_s", "pqr", ("{}", "|W|"), "deg/s", np.degrees(1.0)),
        ("seat_angular_acceleration_{}", "rad_s2", "xyz", ("α{}", "|α|"), "rad/s²", 1.0),
        ("seat_g{}", "g", "xyz", ("G{}", "|G|"), "g", 1.0),
    )
    for j, (stem, suffix, names, (label, whole), unit, scale) in enumerate(families):
        values = {
            pen: scale
            * np.stack([columns[f"{stem.format(name)}_{pen.label}_{suffix}"] for name in names])
            for pen in (BEFORE, AFTER)
        }
        for i, name in enumerate(names):
            curves = [(pen, each[i]) for pen, each in values.items()]
            draw(axes[i][j], t, curves, f"{label.format(name)} [{unit}]", _FLOOR[unit])
        sizes = [(pen, np.linalg.norm(each, axis=0)) for pen, each in values.items()]
        draw(axes[3][j], t, sizes, f"{whole} [{unit}]", _FLOOR[unit])
    for panel, words in zip(
        (axes[0][0], axes[0][1], axes[0][2], axes[3][1]),
        ("rate of the seat", "total angular acceleration", "G-vector", _size(metrics)),
        strict=True,
    ):
        note(panel, words)
    return figure, title


def limits(columns: Columns, metrics: Metrics) -> tuple[Figure, str]:
    """Draw rate, acceleration and jerk of each joint inside the machine's limits."""
    title = "How the joints are driven, within their limits"
    band = Pen("within the limit", WITHIN, width=7.0)
    figure, axes = sheet(title, [band, DESIRED, MODIFIED], 3, 3, height=1.7)
    for i, joint in enumerate(JOINTS):
        for j, (suffix, name, unit) in enumerate(_DRIVEN):
            curves = [
                (DESIRED, columns[f"asked_{joint}_{suffix}"]),
                (MODIFIED, columns[f"modified_{joint}_{suffix}"]),
            ]
            draw(axes[i][j], columns["t_s"], curves, f"{joint} [{unit}]", _FLOOR[unit])
            load = metrics.limits.modified[joint]
            bound, peak = load.limit(name), load.peak(name)
            _shade(axes[i][j], bound, [values for _, values in curves])
            note(axes[i][j], _standing(name, bound, peak, unit))
    return figure, title


def _shade(panel: Axes, bound: float | None, values: list[Floats]) -> None:
    """Shade what is within a limit and what is beyond it, where that is near."""
    if bound is None or bound <= 0.0:
        return
    # The modified motion decides: a desired one that steps would squeeze it to a line.
    least, most = panel.get_ylim()
    largest = float(np.max(np.abs(values[-1])))
    if bound <= _NEAR * largest:
        reach = _ROOM * max(bound, largest)
        panel.set_ylim(-reach, reach)
        least, most = -reach, reach
    panel.axhspan(-bound, bound, color=WITHIN, linewidth=0.0, zorder=0.5)
    panel.axhspan(bound, max(most, bound), color=BEYOND, linewidth=0.0, zorder=0.5)
    panel.axhspan(min(least, -bound), -bound, color=BEYOND, linewidth=0.0, zorder=0.5)
    panel.set_ylim(least, most)


def _standing(name: str, bound: float | None, peak: float | None, unit: str) -> str:
    if bound is None:
        return f"{name}: no limit"
    used = f", peak at {FIGURE.percent(peak / bound)}" if peak is not None and bound > 0.0 else ""
    return f"{name}: limit ±{bound:.3g} {unit}{used}"


def _size(metrics: Metrics) -> str:
    rms = FIGURE.from_to(metrics.felt.turning.rms)
    return f"rms {rms} rad/s²" if rms else ""
