"""Numbers of ``metrics.json`` by their paths.

The metrics may be of an older or newer version, or come from a stranger's file:
what is missing, or is no number, is None and never an error.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any


def lookup(content: Mapping[str, Any], path: str) -> Any:
    """Return what stands at a dotted path, or None.

    >>> lookup({"solver": {"cost": 0.25}}, "solver.cost")
    0.25
    """
    value: Any = content
    for key in path.split("."):
        value = value.get(key) if isinstance(value, Mapping) else None
    return value


def number(content: Mapping[str, Any], path: str) -> float | None:
    """Return the finite number at a dotted path, or None."""
    value = lookup(content, path)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        value = float(value)
    except OverflowError:
        return None
    return value if math.isfinite(value) else None


def section(content: Mapping[str, Any], path: str) -> Mapping[str, Any]:
    """Return the mapping at a dotted path, an empty one where there is none."""
    value = lookup(content, path)
    return value if isinstance(value, Mapping) else {}
