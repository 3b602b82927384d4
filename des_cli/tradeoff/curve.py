"""Points of a curve beside each other: which of them cannot be the best there is."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby, pairwise

from des_cli.model.tradeoff import TradePoint

SLACK = 1e-3
"""Reduction that one point may have less than a tighter one before it is worth a word:
the regularisation beside a budget costs less than that."""


def doubts(points: Sequence[TradePoint]) -> list[str]:
    """Name the points that cannot be the best there is.

    A larger budget on a metric allows all that a smaller one does. Three equal factors are
    a scalar, and joints that move freely may move as any factor has them move. So a point
    with less reduction than one that it contains is a local minimum.
    """
    usable = [p for p in points if p.solved and p.objective_reduction is not None]
    return [*_less_for_more(usable), *_worse_than_scalar(usable)]


def _less_for_more(usable: Sequence[TradePoint]) -> list[str]:
    """Name budgets that buy less than a smaller one."""
    budgets = [p for p in usable if p.swept != "r2"]
    budgets.sort(key=lambda p: (p.control, p.swept, p.value))
    found = []
    for _, curve in groupby(budgets, key=lambda p: (p.control, p.swept)):
        for tight, loose in pairwise(curve):
            if _reduction(loose) < _reduction(tight) - SLACK:
                found.append(
                    f"{_name(loose)} takes off less than {_name(tight)}: a local minimum, "
                    "not the best there is"
                )
    return found


def _worse_than_scalar(usable: Sequence[TradePoint]) -> list[str]:
    """Name points of other controls that are worse than one factor for all joints."""
    scalars = {(p.swept, p.value): p for p in usable if p.control == "scalar"}
    found = []
    for point in usable:
        scalar = scalars.get((point.swept, point.value))
        if point.control == "scalar" or scalar is None:
            continue
        if point.swept != "r2":
            worse = _reduction(point) < _reduction(scalar) - SLACK
        else:
            worse = (point.cost or 0.0) > (scalar.cost or 0.0) * (1.0 + 1e-6)
        if worse:
            found.append(f"{_name(point)} is worse than {_name(scalar)}: a local minimum")
    return found


def _name(point: TradePoint) -> str:
    return f"{point.control} at {point.swept} = {point.value:g}"


def _reduction(point: TradePoint) -> float:
    assert point.objective_reduction is not None
    return point.objective_reduction
