"""What became of each part of the Coriolis vector: the section ``coriolis``."""

from __future__ import annotations

from des_cli.model.arrays import Floats
from des_cli.model.coriolis import COMPONENTS
from des_cli.model.felt import TurningSizes
from des_cli.model.metrics import CrossCoupling, Objective, Part
from des_cli.model.response import Response
from des_cli.model.sides import sizes_of
from des_cli.reduction.baseline import relative_reduction


def coriolis_metrics(
    step: Floats, before: Response, after: Response, objective: float | None
) -> CrossCoupling:
    """Return reduction, RMS and peak of each part of the Coriolis vector.

    Parameters
    ----------
    step : (n - 1,) array
        [s]
    before, after : Response
    objective : float or None
        Reduction of what is weighed.
    """
    by_axes = {
        "seat": [sizes_of(step, each.coriolis_seat) for each in (before, after)],
        "report": [sizes_of(step, each.coriolis_report) for each in (before, after)],
    }
    parts = {}
    for component in COMPONENTS:
        old, new = by_axes[component.axes or "seat"]
        # The length, which has no axes, comes last.
        i = -1 if component.axes is None else component.index
        sizes = TurningSizes(
            float(old.rms[i]), float(new.rms[i]), float(old.peak[i]), float(new.peak[i])
        )
        reduction = relative_reduction(float(old.square[i]), float(new.square[i]))
        parts[component.key] = Part(reduction, sizes)
    return CrossCoupling(parts, Objective(objective))
