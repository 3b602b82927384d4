"""What the weight of a run looks at, read from its metrics.

The metrics may come from a file: what is missing or of another form is not an
error here.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

_COMPONENTS = {"report": ("ab3", "bb3", "cb3"), "seat": ("seat_x", "seat_y", "seat_z")}


def weighted_component(metrics: Mapping[str, Any]) -> str | None:
    """Return the one component that R1 weighs, None if it weighs several.

    Metrics that do not name R1 are taken for the study's, which weighs BB3,
    where their axes are the study's.

    >>> weighted_component({"solver": {"axes": "seat", "r1": [[2, 0], [0, 2]]}})
    >>> weighted_component({"solver": {"axes": "report"}})
    'bb3'
    """
    solver = _mapping(metrics.get("solver"))
    axes: Any = solver.get("axes")
    r1: Any = solver.get("r1")
    names = _COMPONENTS.get(axes) if isinstance(axes, str) else None
    if names is None:
        return None
    try:
        weights = [bool(r1[i][i]) for i in range(3)]
    except (TypeError, LookupError):
        return "bb3" if axes == "report" else None
    return names[weights.index(True)] if sum(weights) == 1 else None


def reduction_of(metrics: Mapping[str, Any], component: str) -> float | None:
    """Return 1 - int after^2 / int before^2 of a component, None if it is not known."""
    coriolis = _mapping(metrics.get("coriolis"))
    reduction = _mapping(coriolis.get(component)).get("reduction")
    # An integer would do as well, but one from a file may have any size.
    return reduction if isinstance(reduction, float) and math.isfinite(reduction) else None


def _mapping(value: Any) -> Mapping[str, Any]:
    return value if isinstance(value, Mapping) else {}
