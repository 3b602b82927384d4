"""Make the figures of the documentation with the tool itself.

    python scripts/figures.py [FOLDER] [NAME...]        default: docs, all of them

``felt.png``: what the pilot feels of the post-stall reversal, as ``plot --figure felt`` draws it.

``study``: the study's figures 7 to 10, in ``study/figure-N.svg``, as ``plot --figure N`` draws
them of its law.

``cobra.png``: what the pilot of the Cobra feels, before, within the felt budgets,
and within 5 % of the joint angles alone.

``tradeoff.png``: what budgets on what is felt buy, beside joint budgets and the
study's points, and what becomes of the total angular acceleration.

``azimuth.png``: the Cobra, flown from each azimuth of the arm. What the study's
objective costs and what share each component has depends on it; the same in
seat axes does not.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke

from des_cli.model.arrays import Floats
from des_cli.model.run import Run
from des_cli.pipeline import reduce_profile
from des_cli.profiles_in.load import load_profile
from des_cli.runs_out.tables import trajectory_columns
from des_cli.show.plots.canvas import draw, note, png, sheet, style
from des_cli.show.plots.figures import draw_figure
from des_cli.show.plots.pens import BEFORE, BLUE, GREEN, GREY, INK, VERMILION, Pen

AZIMUTH = np.arange(0.0, 180.1, 7.5)
"""Of the arm at the start [deg]; BB3 only changes its sign after half a turn."""

REPORT = Pen("report axes", BLUE)
SEAT = Pen("seat axes", VERMILION, (0, (6, 1.5)))
COMPONENTS = {
    "ab3": Pen("AB3", GREY),
    "bb3": Pen("BB3", BLUE),
    "seat_x": Pen("seat x", GREEN, (0, (2.5, 1.2))),
    "seat_y": Pen("seat y", VERMILION, (0, (6, 1.5))),
    "seat_z": Pen("seat z", "#CC79A7", (0, (6, 1.5, 1.5, 1.5))),
}

RATE, G, JOINTS = (
    "seat_rate_deviation_relative",
    "seat_g_rms_error_g",
    "joint_deviation_relative",
)
NO_WORSE = {
    "seat_angular_acceleration_rms_ratio": 1.05,
    "seat_angular_acceleration_peak_ratio": 1.1,
}
"""The bounds on the total angular acceleration that a silent profile has."""

FELT = Pen("felt budgets (the defaults)", BLUE, width=1.9, zorder=3.5)
FIVE = Pen("5 % of the joint angles alone", VERMILION, "-", 1.0, 3.0)

WITH_G = Pen("seat rate, and G to 0.05 g", BLUE, marker="o")
FREE_G = Pen("seat rate", GREEN, (0, (2.5, 1.2)), marker="D")
ANGLES = Pen("joint angles", VERMILION, (0, (6, 1.5)), marker="s")
STUDY = Pen("the study", INK, "", 0.0, 4.0, marker="X")

STUDY_R2 = {"7": 1.0, "8": 1.0, "9": 0.2, "10": 1.0}
"""The study's figures, and the weight for which each is drawn."""

SHOWN_ANGULAR = 1.6
"""Ordinate of the total angular acceleration [rad/s²]: more would flatten the rest."""

SHOWN_RATE = 50.0
"""Abscissa of the trade-off [%]."""


def main() -> int:
    """Write the figures."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[1] / "docs")
    makers = {"felt": felt, "cobra": cobra, "tradeoff": tradeoff, "azimuth": azimuth}
    for name in sys.argv[2:] or (*makers, "study"):
        if name == "study":
            (folder / "study").mkdir(exist_ok=True)
            for figure in STUDY_R2:
                (folder / "study" / f"figure-{figure}.svg").write_bytes(study(figure))
        else:
            (folder / f"{name}.png").write_bytes(makers[name]())
    return 0


def felt() -> bytes:
    """Draw what the pilot feels of a maneuver that keeps every limit."""
    run = reduce_profile(load_profile("post_stall_reversal"))
    return draw_figure("felt", trajectory_columns(run), run.results, "png")


def study(figure: str) -> bytes:
    """Draw a figure of the study, of its law."""
    settings = ["reduction.algorithm=report-sweep", f"reduction.r2={STUDY_R2[figure]}"]
    run = reduce_profile(load_profile("cobra", settings=[*settings, "time.step_s=0.05"]))
    return draw_figure(figure, trajectory_columns(run), run.results, "svg")


def cobra() -> bytes:
    """Draw what is felt of the Cobra by two kinds of budgets."""
    own, five = reduce_profile(load_profile("cobra_felt")), _reduce({JOINTS: 0.05})
    columns = trajectory_columns(own), trajectory_columns(five)
    title = "What the pilot of the Cobra feels"
    with style():
        figure, axes = sheet(title, [BEFORE, FELT, FIVE], 3, height=1.5)
        panels = [panel for (panel,) in axes]
        for panel, stem, label in (
            (panels[0], "coriolis_seat_{}_{}_rad_s2", "cross-coupling\n[rad/s²]"),
            (panels[1], "seat_angular_acceleration_{}_{}_rad_s2", "angular\nacceleration [rad/s²]"),
            (panels[2], "seat_g{}_{}_g", "sideways G\nGy [g]"),
        ):
            of_axes = "y" if panel is panels[2] else "xyz"
            curves = [
                (pen, _size(each, stem, of_axes, when))
                for pen, each, when in (
                    (BEFORE, columns[0], "before"),
                    (FIVE, columns[1], "after"),
                    (FELT, columns[0], "after"),
                )
            ]
            draw(panel, columns[0]["t_s"], curves, label, 0.1)
        panels[0].set_ylim(0.0, None)
        panels[1].set_ylim(0.0, SHOWN_ANGULAR)
        panels[1].set_yticks(np.arange(0.0, SHOWN_ANGULAR, 0.5))
        for panel, words in zip(panels, _told(own, five), strict=True):
            note(panel, words)
        return png(figure, title)


def _size(columns: Mapping[str, Floats], stem: str, axes: str, when: str) -> Floats:
    """Return a single component as it is, and several as their norm."""
    parts = [columns[stem.format(axis, when)] for axis in axes]
    return parts[0] if len(parts) == 1 else np.linalg.norm(parts, axis=0)


def _told(*runs: Run) -> list[str]:
    """Say in numbers what each panel of the Cobra shows of each run."""
    less = [f"{100.0 * run.metrics['coriolis']['vector']['reduction']:.0f} % less" for run in runs]
    whole = [run.metrics["felt"]["seat_angular_acceleration"]["magnitude"] for run in runs]
    gy = [run.metrics["felt"]["seat_g"]["gy"] for run in runs]
    turning = [f"{each['rms_after_rad_s2']:.2f}, {each['peak_after_rad_s2']:.2f}" for each in whole]
    before = f"{whole[0]['rms_before_rad_s2']:.2f}, {whole[0]['peak_before_rad_s2']:.2f}"
    sideways = [f"{each['peak_after_g']:.2f}" for each in gy]
    return [
        f"squared integral: {less[0]} within felt budgets, {less[1]} by angles alone",
        f"rms, peak: {before} before; {turning[0]} within felt budgets; "
        f"{turning[1]} by angles alone, off the page",
        f"peak: {gy[0]['peak_before_g']:.2f} before; {sideways[0]} within felt budgets; "
        f"{sideways[1]} by angles alone",
    ]


def tradeoff() -> bytes:
    """Draw reduction and total angular acceleration over the change of the seat's rate."""
    shares = (0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4)
    curves = {
        FREE_G: [_reduce({RATE: share, **NO_WORSE}) for share in shares],
        WITH_G: [_reduce({RATE: share, G: 0.05, **NO_WORSE}) for share in shares],
        ANGLES: [_reduce({JOINTS: share}) for share in (0.005, 0.01, 0.02, 0.05)],
        STUDY: [
            reduce_profile(load_profile("cobra", settings=[f"reduction.algorithm={algorithm}"]))
            for algorithm in ("optimum", "report-sweep")
        ],
    }
    title = "What budgets buy on the Cobra"
    with style():
        figure, ((above,), (below,)) = sheet(title, list(curves), 2, height=2.5)
        for pen, runs in curves.items():
            rate = [100.0 * run.metrics["fidelity"][RATE] for run in runs]
            less = [100.0 * run.metrics["coriolis"]["vector"]["reduction"] for run in runs]
            _dots(above, pen, rate, less, 0.0)
            whole = [run.metrics["felt"]["seat_angular_acceleration"]["magnitude"] for run in runs]
            turning = [each["rms_after_rad_s2"] for each in whole]
            _dots(below, pen, rate, turning, whole[0]["rms_before_rad_s2"])
        _names(above, curves)
        before = curves[STUDY][0].metrics["felt"]["seat_angular_acceleration"]["magnitude"]
        below.axhline(before["rms_before_rad_s2"], color=GREY, linewidth=0.9, zorder=1)
        _say(below, "of the maneuver itself", (SHOWN_RATE, before["rms_before_rad_s2"]), GREY)
        above.set_xlim(0.0, SHOWN_RATE)
        above.set_ylim(0.0, 100.0)
        below.set_ylim(0.0, None)
        above.set_ylabel("whole vector, less by [%]")
        below.set_ylabel("total angular\nacceleration, rms [rad/s²]")
        below.set_xlabel("change of the seat's rate [%]")
        note(above, "cross-coupling, squared integral")
        return png(figure, title)


def _dots(panel: Axes, pen: Pen, x: Sequence[float], y: Sequence[float], origin: float) -> None:
    """Draw a curve from the maneuver itself through its points, or points alone."""
    if pen.width:
        start = [0.0, *x], [origin, *y]
        panel.plot(*start, color=pen.color, linestyle=pen.dashes, linewidth=1.5, zorder=3)
    look: dict[str, Any] = {"linestyle": "", "markeredgecolor": "white", "markeredgewidth": 0.8}
    size = 9.0 if pen is STUDY else 5.5
    panel.plot(x, y, marker=pen.marker, color=pen.color, markersize=size, zorder=4, **look)


def _names(panel: Axes, curves: Mapping[Pen, Sequence[Run]]) -> None:
    """Name the points that are not told by their abscissa."""
    for pen, words in (
        (ANGLES, ("0.5 %", "1 %", "2 %", "5 %")),
        (STUDY, ("its problem, solved", "its law")),
    ):
        for run, name in zip(curves[pen], words, strict=True):
            at = 100.0 * run.metrics["fidelity"][RATE]
            height = 100.0 * run.metrics["coriolis"]["vector"]["reduction"]
            if pen is STUDY:
                _say(panel, name, (at, height), pen.color, shift=(0, 7), align="center")
            else:
                _say(panel, name, (at, height), pen.color, shift=(6, -11), align="left")


def _say(
    panel: Axes,
    words: str,
    at: tuple[float, float],
    color: str,
    *,
    shift: tuple[float, float] = (-2.0, 4.0),
    align: str = "right",
) -> None:
    """Write a few words beside a point."""
    panel.annotate(
        words,
        at,
        xytext=shift,
        textcoords="offset points",
        ha=align,
        fontsize=8,
        color=color,
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
        zorder=5,
    )


def _reduce(budget: Mapping[str, float]) -> Run:
    """Reduce the Cobra within other budgets than its own."""
    inside = ", ".join(f"{metric}: {most}" for metric, most in budget.items())
    return reduce_profile(load_profile("cobra_felt", settings=[f"reduction.budget={{{inside}}}"]))


def azimuth() -> bytes:
    """Draw the optimum's cost and the components' shares over the arm's azimuth."""
    report = [_fly(each, "report") for each in AZIMUTH]
    seat = [_fly(each, "seat") for each in AZIMUTH]
    title = "The Cobra by the azimuth at which the arm starts"
    with style():
        figure, axes = sheet(title, [REPORT, SEAT], rows=2, height=1.9)
        costs = [(REPORT, _costs(report)), (SEAT, _costs(seat))]
        draw(axes[0][0], AZIMUTH, costs, "least cost J", 0.1)
        shares = [(pen, _shares(report, name)) for name, pen in COMPONENTS.items()]
        draw(axes[1][0], AZIMUTH, shares, "share of ∫‖c‖²", 0.1)
        for name, pen in COMPONENTS.items():
            at = len(AZIMUTH) // 3
            axes[1][0].annotate(
                pen.label,
                (AZIMUTH[at], _shares(report, name)[at]),
                xytext=(0, 3),
                textcoords="offset points",
                color=pen.color,
                ha="center",
                fontsize=8.5,
            )
        for row in axes:
            row[0].set_ylim(0.0, None)
            row[0].set_xticks(np.arange(0, 181, 30))
        axes[1][0].set_xlabel("θ1 at the start [deg]")
        return png(figure, title)


def _fly(arm_deg: float, axes: str) -> Run:
    settings = [f"initial.arm_deg={arm_deg}", f"reduction.axes={axes}", "time.step_s=0.05"]
    return reduce_profile(load_profile("cobra", settings=settings))


def _costs(runs: list[Run]) -> Floats:
    return np.array([run.solution.cost for run in runs])


def _shares(runs: list[Run], name: str) -> Floats:
    """Return the part of a component in the energy of the desired motion's vector."""
    parts = [run.metrics["coriolis"] for run in runs]
    return np.array(
        [(p[name]["rms_before_rad_s2"] / p["vector"]["rms_before_rad_s2"]) ** 2 for p in parts]
    )


if __name__ == "__main__":
    sys.exit(main())
