"""The budgets of a run and what is spent of each, read from its metrics."""

from __future__ import annotations

from dataclasses import dataclass

from des_cli.model.metric import metric_named
from des_cli.model.metrics import Metrics

_LONGEST = 60


@dataclass(frozen=True, slots=True)
class Spent:
    """One budget.

    Parameters
    ----------
    label : str
    spent, most : float
        In ``unit``: a share is in percent.
    unit : str
    """

    label: str
    spent: float
    most: float
    unit: str

    @property
    def allowed(self) -> str:
        """Say what is allowed."""
        return f"{self.label} ≤ {self.most:g} {self.unit}".rstrip()

    def __str__(self) -> str:
        return f"{self.label} {self.spent:.4g} of {self.most:g} {self.unit}".rstrip()


def spent_budgets(metrics: Metrics) -> list[Spent]:
    """Return the budgets of a run in the order in which they were set.

    The metrics may come from a stranger: a budget without numbers is left out.

    >>> from des_cli.model.metric import SEAT_G_ERROR
    >>> from des_cli.model.metrics import Fidelity, SolverFacts
    >>> solver, fidelity = SolverFacts(budget={SEAT_G_ERROR: 0.05}), Fidelity({SEAT_G_ERROR: 0.049})
    >>> print(*spent_budgets(Metrics(solver=solver, fidelity=fidelity)))
    G error 0.049 of 0.05 g
    """
    found = []
    for key, most in (metrics.solver.budget or {}).items():
        spent = metrics.fidelity.metrics.get(key)
        if spent is None:
            continue
        metric = metric_named(key)
        if metric is None:
            found.append(Spent(_line(key), spent, most, ""))
        elif metric.relative:
            found.append(Spent(metric.label, 100.0 * spent, 100.0 * most, "%"))
        else:
            found.append(Spent(metric.label, spent, most, metric.unit))
    return found


def _line(words: str) -> str:
    """Keep a text that a stranger wrote short and on one line."""
    return "".join(letter for letter in words[:_LONGEST] if letter.isprintable()) or "unknown"
