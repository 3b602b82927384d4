"""What else would have done: this run beside the study's law and a constant factor."""

from __future__ import annotations

from dataclasses import dataclass

from des_cli.model.metric import JOINT_DEVIATION
from des_cli.model.metrics import Metrics
from des_cli.show.weighted import weighted_component
from des_cli.show.words import PAGE

WIDTH, HEIGHT = 320, 190
_LEFT, _RIGHT, _TOP, _BOTTOM = 10, 310, 22, 160


@dataclass(frozen=True, slots=True)
class TradePlace:
    """One way to reduce, by the study's measure.

    Parameters
    ----------
    label, shape : str
        What it is called, and which mark it has: ``run``, ``law`` or ``constant``.
    deviation, reduction : str
        Of the joints, and of what is weighed.
    x, y : float
        Its place in a picture of WIDTH by HEIGHT.
    """

    label: str
    shape: str
    deviation: str
    reduction: str
    x: float
    y: float


def trade_places(metrics: Metrics) -> list[TradePlace]:
    """Return this run and what its baselines reach; nothing where the run has no baseline."""
    component = weighted_component(metrics.solver)
    own = metrics.coriolis.objective.reduction
    if own is None and component is not None:
        own = metrics.coriolis.reduction(component)
    cost = metrics.fidelity.value(JOINT_DEVIATION)
    if own is None or cost is None:
        return []
    found = [("this run", "run", cost, own)]
    sweep, constant = metrics.baseline.report_sweep, metrics.baseline.constant_p
    if sweep and sweep.reduction is not None and sweep.joint_deviation is not None:
        found.append(("the study's law", "law", sweep.joint_deviation, sweep.reduction))
    if constant and constant.p is not None and constant.joint_deviation is not None:
        label = f"constant p = {PAGE.number(constant.p)}"
        found.append((label, "constant", constant.joint_deviation, own))
    if len(found) == 1:
        return []
    widest = max(each[2] for each in found) or 1.0
    lowest, highest = (
        min(0.0, *(each[3] for each in found)),
        max(0.05, *(each[3] for each in found)),
    )
    across, up = (_RIGHT - _LEFT) / (1.1 * widest), (_BOTTOM - _TOP) / (1.1 * (highest - lowest))
    return [
        TradePlace(
            label,
            shape,
            PAGE.percent(deviation),
            PAGE.percent(reduction),
            round(_LEFT + across * deviation, 1),
            round(_BOTTOM - up * (reduction - lowest), 1),
        )
        for label, shape, deviation, reduction in found
    ]
