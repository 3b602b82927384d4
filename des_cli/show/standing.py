"""How far a run can be relied on, read from its metrics: status, budget, limits.

The metrics may come from a file: what is missing or of another form is not an
error here.
"""

from __future__ import annotations

from des_cli.model.metrics import Change, Metrics
from des_cli.results.budgets import spent_budgets

NOTICEABLE = 1e-3
"""Change of a desired angle [rad] by the limits that is worth a word."""


def status_words(metrics: Metrics) -> str:
    """Name a status that is not ``converged``; empty for one that is, or is not known.

    >>> from des_cli.model.metrics import SolverFacts
    >>> status_words(Metrics(solver=SolverFacts(status="acceptable", converged=False)))
    'acceptable, not converged'
    """
    if metrics.solver.converged is not False:
        return ""
    return f"{_line(metrics.solver.status or '')}, not converged"


def budget_words(metrics: Metrics) -> str:
    """Say what the reduction was allowed to cost, and how much of it was spent."""
    return ", ".join(map(str, spent_budgets(metrics)))


def change_words(change: Change) -> str:
    """Say how much the desired motion was changed to keep the limits, if noticeably.

    >>> change_words(Change(joint_change_max_rad={"arm": 0.0, "cab": 0.0123}))
    'cab by up to 0.0123 rad'
    """
    return ", ".join(
        f"{joint} by up to {value:.3g} rad"
        for joint, value in change.joint_change_max_rad.items()
        if value is not None and value > NOTICEABLE
    )


def _line(words: str) -> str:
    """Keep a text that a stranger wrote short and on one line."""
    return "".join(letter for letter in words[:60] if letter.isprintable()) or "unknown"
