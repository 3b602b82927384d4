"""What the weight of a run looks at, read from its metrics.

The metrics may come from a file: what is missing or of another form is not an
error here.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from des_cli.model.coriolis import COMPONENTS, ComponentKey
from des_cli.results.reading import lookup, number


def weighted_component(metrics: Mapping[str, Any]) -> ComponentKey | None:
    """Return the one component that R1 weighs, None if it weighs several.

    Metrics that do not name R1 are taken for the study's, which weighs BB3,
    where their axes are the study's.

    >>> weighted_component({"solver": {"axes": "seat", "r1": [[2, 0], [0, 2]]}})
    >>> weighted_component({"solver": {"axes": "report"}})
    'bb3'
    """
    axes, r1 = lookup(metrics, "solver.axes"), lookup(metrics, "solver.r1")
    names = [each.key for each in COMPONENTS if each.axes is not None and each.axes == axes]
    if not names:
        return None
    try:
        weights = [bool(r1[i][i]) for i in range(3)]
    except (TypeError, LookupError):
        return "bb3" if axes == "report" else None
    return names[weights.index(True)] if sum(weights) == 1 else None


def reduction_of(metrics: Mapping[str, Any], component: str) -> float | None:
    """Return 1 - int after^2 / int before^2 of a component, None if it is not known."""
    return number(metrics, f"coriolis.{component}.reduction")
