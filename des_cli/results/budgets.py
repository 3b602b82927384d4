"""The budgets of a run and what is spent of each, read from its metrics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from des_cli.model.metric import METRICS
from des_cli.results.reading import number, section

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


def spent_budgets(metrics: Mapping[str, Any]) -> list[Spent]:
    """Return the budgets of a run in the order in which they were set.

    The metrics may come from a stranger: a budget without numbers is left out.

    >>> metrics = {"solver": {"budget": {"seat_g_rms_error_g": 0.05}},
    ...            "fidelity": {"seat_g_rms_error_g": 0.049999}}
    >>> print(*spent_budgets(metrics))
    G error 0.05 of 0.05 g
    """
    found = []
    of = "added.budgets" if section(metrics, "added") else "fidelity"
    for key in section(metrics, "solver.budget"):
        most = number(section(metrics, "solver.budget"), key)
        spent = number(section(metrics, of), key)
        if most is None or spent is None:
            continue
        metric = next((each for each in METRICS.values() if each.key == key), None)
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
