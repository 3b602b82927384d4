"""How far a run can be relied on, read from its metrics: status, budget, limits.

The metrics may come from a file: what is missing or of another form is not an
error here.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from des_cli.results.budgets import spent_budgets

NOTICEABLE = 1e-3
"""Change of a desired angle [rad] by the limits that is worth a word."""


def status_words(metrics: Mapping[str, Any]) -> str:
    """Name a status that is not ``converged``; empty for one that is, or is not known.

    >>> status_words({"solver": {"status": "acceptable", "converged": False}})
    'acceptable, not converged'
    """
    solver = _mapping(metrics.get("solver"))
    if solver.get("converged") is not False:
        return ""
    return f"{_line(solver.get('status'))}, not converged"


def budget_words(metrics: Mapping[str, Any]) -> str:
    """Say what the reduction was allowed to cost, and how much of it was spent.

    >>> budget_words({"solver": {"budget": {"seat_g_rms_error_g": 0.1}},
    ...               "fidelity": {"seat_g_rms_error_g": 0.09991}})
    'G error 0.09991 of 0.1 g'
    """
    return ", ".join(map(str, spent_budgets(metrics)))


def change_words(metrics: Mapping[str, Any]) -> str:
    """Say how much the desired motion was changed to keep the limits, if noticeably.

    >>> change_words({"executable": {"joint_change_max_rad": {"arm": 0.0, "cab": 0.0123}}})
    'cab by up to 0.0123 rad'
    """
    change = _mapping(_mapping(metrics.get("executable")).get("joint_change_max_rad"))
    return ", ".join(
        f"{_line(joint)} by up to {value:.3g} rad"
        for joint, value in change.items()
        if _is_number(value) and value > NOTICEABLE
    )


def _line(value: Any) -> str:
    """Keep a text that a stranger wrote short and on one line."""
    return "".join(letter for letter in str(value)[:60] if letter.isprintable()) or "unknown"


def _is_number(value: Any) -> bool:
    # An integer would do as well, but one from a file may have any size.
    return isinstance(value, float) and math.isfinite(value)


def _mapping(value: Any) -> Mapping[str, Any]:
    return value if isinstance(value, Mapping) else {}
