"""The budgets of a run and what is spent of each, read from its metrics."""

from __future__ import annotations

from dataclasses import dataclass

from des_cli.model.metric import metric_named
from des_cli.model.metrics import Metrics
from des_cli.units import percent

_LONGEST = 60


@dataclass(frozen=True, slots=True)
class Spent:
    """One budget.

    Parameters
    ----------
    label : str
    spent, most : float
        In the metric's unit.
    unit : str
        Empty where the metric is of another version, and its unit not known.
    share : bool
        Whether it is written in percent.
    """

    label: str
    spent: float
    most: float
    unit: str = ""
    share: bool = False

    @property
    def allowed(self) -> str:
        """Say what is allowed."""
        return f"{self.label} ≤ {self._most}"

    @property
    def _most(self) -> str:
        # As it was given.
        return percent(self.most, 6) if self.share else f"{self.most:g} {self.unit}".rstrip()

    def __str__(self) -> str:
        spent = percent(self.spent, 4).removesuffix(" %") if self.share else f"{self.spent:.4g}"
        return f"{self.label} {spent} of {self._most}"


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
    values = metrics.added.budgets if metrics.added else metrics.fidelity.metrics
    for key, most in (metrics.solver.budget or {}).items():
        spent = values.get(key)
        if spent is None:
            continue
        metric = metric_named(key)
        if metric is None:
            found.append(Spent(_line(key), spent, most))
        else:
            found.append(Spent(metric.label, spent, most, metric.unit, metric.relative))
    return found


def _line(words: str) -> str:
    """Keep a text that a stranger wrote short and on one line."""
    return "".join(letter for letter in words[:_LONGEST] if letter.isprintable()) or "unknown"
