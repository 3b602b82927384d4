"""The trade-off curve: reduction of the cross-coupling against deviation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter, MaxNLocator

from des_cli.model.metric import (
    ANGULAR_ACCELERATION_ERROR,
    ATTITUDE_ERROR,
    JOINT_DEVIATION,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
)
from des_cli.model.tradeoff import TradePoint
from des_cli.show.plots.canvas import png, sheet, style
from des_cli.show.plots.pens import BLUE, DASHES, GREEN, GREY, INK, NOTE, VERMILION, ZERO, Pen
from des_cli.units import percent

FREE = Pen("free", GREEN, (0, (2.5, 1.2)), marker="D")
PER_JOINT = Pen("per joint", BLUE, marker="o")
SCALAR = Pen("scalar", VERMILION, (0, (6, 1.5)), marker="s")
CONSTANT = Pen("constant p", GREY, DASHES, 1.3, 2.5, marker=".")
STUDY = Pen("study's single sweep", INK, "", 0.0, 4.0, marker="X")
_OFF_PAGE = Pen("", INK)

_HEIGHT = 4.6
_SIZES = {"D": 4.8, "o": 5.5, "s": 5.0, ".": 5.0, "X": 9.0}

# Abscissae: column, what it is called, what it is multiplied with, its unit.
_ABSCISSAE = {
    JOINT_DEVIATION: ("deviation of the joint angles ‖θ − Θ‖ / ‖Θ‖", 100.0, "%"),
    SEAT_RATE_DEVIATION: ("deviation of the seat's angular rate", 100.0, "%"),
    SEAT_G_ERROR: ("error of the G-vector at the seat, rms", 1.0, "g"),
    ANGULAR_ACCELERATION_ERROR: (
        "error of the total angular acceleration at the seat, rms",
        1.0,
        "rad/s²",
    ),
    ATTITUDE_ERROR: ("largest error of the seat's attitude", 1.0, "deg"),
}
_MARGIN = 1.08
_TOP = 105.0  # room above a reduction of all
_ROOM = 7.0  # below the lowest point, for its label
_LONGEST = 110
_WIDEST = 3.0  # the study's points count for the width up to this multiple of the optima's
_CLEAR = (75.0, 22.0)  # pixels between a label of the constant factors and any other mark


def draw_tradeoff(points: Sequence[TradePoint], about: str) -> bytes:
    """Draw the reduction of the objective against the deviation.

    Parameters
    ----------
    points : sequence of TradePoint
        Those without numbers are left out.
    about : str
        The profile, and what its objective weighs.

    Returns
    -------
    bytes
        The PNG. The abscissa is the metric that the budgets were set on where a
        point knows it, otherwise the joint deviation.
    """
    with style():
        return png(*tradeoff_sheet(points, about))


def tradeoff_sheet(points: Sequence[TradePoint], about: str) -> tuple[Figure, str]:
    """Return the figure of `draw_tradeoff` and its title, in the style that is set."""
    title = "Reduction of the cross-coupling against deviation"
    figure = _figure(points, title)
    shown = about if len(about) <= _LONGEST else f"{about[: _LONGEST - 1]}…"
    noted = figure.axes[0].set_title(shown, loc="right", fontsize=8, color=NOTE, pad=3)
    noted.set_parse_math(False)
    return figure, f"{title}: {about}"


def _figure(points: Sequence[TradePoint], title: str) -> Figure:
    known = [point for point in points if point.objective_reduction is not None]
    swept = {point.swept for point in points if point.algorithm == "optimum"}
    abscissa = next((key for key in _ABSCISSAE if key in swept), JOINT_DEVIATION)
    curves = [
        (pen, _along(known, abscissa, algorithm, control))
        for pen, algorithm, control in (
            (FREE, "optimum", "free"),
            (PER_JOINT, "optimum", "per-joint"),
            (SCALAR, "optimum", "scalar"),
            (STUDY, "report-sweep", "scalar"),
            (CONSTANT, "constant-p", "scalar"),
        )
    ]
    drawn = [(pen, curve) for pen, curve in curves if curve]
    figure, ((axes,),) = sheet(title, [pen for pen, _ in drawn], 1, height=_HEIGHT)
    _scale(axes, drawn, abscissa)
    for pen, curve in drawn:
        _draw(axes, pen, curve, abscissa)
    _name_points(axes, drawn, abscissa)
    return figure


def _along(
    points: Sequence[TradePoint], abscissa: str, algorithm: str, control: str
) -> list[TradePoint]:
    """Return the points of one curve, from left to right."""
    own = [p for p in points if (p.algorithm, p.control) == (algorithm, control)]
    return sorted(own, key=lambda point: float(getattr(point, abscissa)))


def _places(curve: Sequence[TradePoint], abscissa: str) -> tuple[np.ndarray, np.ndarray]:
    """Return where the points lie, in the units of the axes."""
    scale = _ABSCISSAE[abscissa][1]
    x = np.array([scale * float(getattr(point, abscissa)) for point in curve])
    return x, np.array([100.0 * float(point.objective_reduction or 0.0) for point in curve])


def _scale(axes: Axes, drawn: Sequence[tuple[Pen, list[TradePoint]]], abscissa: str) -> None:
    """Set the axes: as wide as what was asked for, not as the baselines reach."""
    places = {pen: _places(curve, abscissa) for pen, curve in drawn}
    asked = [places[pen][0].max() for pen in (FREE, PER_JOINT, SCALAR) if pen in places]
    alone = [x.max() for pen, (x, _) in places.items() if pen is CONSTANT and len(x) == 1]
    every = [x.max() for x, _ in places.values()]
    right = float(max([*asked, *alone] or every, default=1.0))
    if asked and STUDY in places:
        near = [x for x in places[STUDY][0] if x <= _WIDEST * right]
        right = max([right, *near])
    axes.set_xlim(0.0, _MARGIN * max(right, 1e-6))
    low = [y[x <= right].min(initial=0.0) for pen, (x, y) in places.items() if pen is not CONSTANT]
    # the study's sweep is labelled below its point
    bare = [y[x <= right].min(initial=_ROOM) for pen, (x, y) in places.items() if pen is STUDY]
    floor = min([*low, *(height - _ROOM for height in bare)], default=0.0)
    axes.set_ylim(min(0.0, float(floor)), _TOP)
    words, _, unit = _ABSCISSAE[abscissa]
    axes.set_xlabel(f"{words} [{unit}]")
    axes.set_ylabel("reduction of the weighted cross-coupling [%]")
    axes.xaxis.set_major_locator(MaxNLocator(nbins=8, steps=[1, 2, 5, 10]))
    plain = FuncFormatter(lambda value, _: f"{value:g}".replace("-", "−"))
    axes.xaxis.set_major_formatter(plain)
    axes.yaxis.set_major_formatter(plain)
    axes.axhline(0.0, color=ZERO, linewidth=0.8, zorder=1)


def _draw(axes: Axes, pen: Pen, curve: Sequence[TradePoint], abscissa: str) -> None:
    x, y = _places(curve, abscissa)
    if pen is not STUDY and len(x) > 1:
        # The desired motion itself, no deviation and no reduction, is on every curve.
        axes.plot(
            np.append(0.0, x),
            np.append(0.0, y),
            color=pen.color,
            linestyle=pen.dashes,
            linewidth=pen.width,
            zorder=pen.zorder,
        )
    axes.plot(
        x,
        y,
        linestyle="",
        marker=pen.marker,
        color=pen.color,
        markersize=_SIZES[pen.marker],
        markeredgecolor="white",
        markeredgewidth=0.0 if pen is CONSTANT else 0.8,
        zorder=pen.zorder + 0.5,
    )


def _name_points(axes: Axes, drawn: Sequence[tuple[Pen, list[TradePoint]]], abscissa: str) -> None:
    """Write what was swept beside each point that is on the page, or at its edge."""
    right = axes.get_xlim()[1]
    marks: list[np.ndarray] = []
    for pen, curve in drawn:
        for point, at, height in zip(curve, *_places(curve, abscissa), strict=True):
            pixel = axes.transData.transform((at, height))
            if pen is CONSTANT and (at > right or _crowded(pixel, marks)):
                continue
            if pen is not CONSTANT:
                marks.append(pixel)
            if at <= right:
                _label(axes, pen, _name(point), at, height)
            else:
                unit = _ABSCISSAE[abscissa][2]
                _label(axes, _OFF_PAGE, f"{_name(point)} at {at:.3g} {unit} →", right, height)


def _crowded(pixel: np.ndarray, marks: Sequence[np.ndarray]) -> bool:
    return any(bool(np.all(np.abs(pixel - mark) < _CLEAR)) for mark in marks)


def _label(axes: Axes, pen: Pen, words: str, x: float, y: float) -> None:
    # Off the curves, which rise to the right and bend down.
    place = {
        FREE: (-4, 4, "right", "bottom"),
        PER_JOINT: (-4, 4, "right", "bottom"),
        STUDY: (0, -7, "center", "top"),
        _OFF_PAGE: (-2, 0, "right", "center"),
    }
    left, up, horizontal, vertical = place.get(pen, (4, -4, "left", "top"))
    axes.annotate(
        words,
        (x, y),
        xytext=(left, up),
        textcoords="offset points",
        ha=horizontal,
        va=vertical,
        fontsize=8,
        color=pen.color,
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
        zorder=5,
    )


def _name(point: TradePoint) -> str:
    """Name a point by what was swept."""
    if point.swept == "p":
        return f"p = {point.value:g}"
    if point.swept == "r2":
        return f"r₂ = {point.value:g}"
    if point.swept.endswith("_deg"):
        return f"{point.value:g}°"
    if point.swept.endswith("_rad_s2"):
        return f"{point.value:g} rad/s²"
    if point.swept.endswith("_g"):
        return f"{point.value:g} g"
    return percent(point.value, 6)
