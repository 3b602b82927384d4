"""Make the figures of the documentation with the tool itself.

    python scripts/figures.py [FOLDER]        default: docs

``azimuth.png``: the Cobra, flown from each azimuth of the arm. What the study's
objective costs and what share each component has depends on it; the same in
seat axes does not.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from des_cli import load_profile, reduce_profile
from des_cli.model.arrays import Floats
from des_cli.model.run import Run
from des_cli.plots.canvas import BLUE, GREEN, GREY, VERMILION, Pen, draw, png, sheet, style

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


def main() -> int:
    """Write every figure."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[1] / "docs")
    (folder / "azimuth.png").write_bytes(azimuth())
    return 0


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
