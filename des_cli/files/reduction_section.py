"""The ``reduction`` section of a profile, made into the model's ``Reduction``."""

from __future__ import annotations

from typing import Any

import numpy as np

from des_cli.files.findings import Findings
from des_cli.files.sections import Section
from des_cli.model.arrays import Floats
from des_cli.model.metric import Budget
from des_cli.model.profile import Reduction

_PLAIN = (
    "method",
    "algorithm",
    "control",
    "axes",
    "jacobian",
    "limits",
    "iterations",
    "max_iterations",
    "ends",
    "tolerance",
)
DEFAULT_METRIC = "joint_deviation_relative"
"""What a budget without a name is on."""

ABSOLUTE = ("seat_g_rms_error_g", "attitude_error_max_deg")
"""Budgets with a unit; all others are shares."""

_ROUNDING = 1e-12
"""An eigenvalue this far below zero, relative to the largest, is rounding."""


def read_reduction(section: Section | None, findings: Findings) -> Reduction:
    """Return how a profile asks to be reduced.

    Parameters
    ----------
    section : ReductionSection or None
    findings : Findings
        Takes what is wrong.

    Returns
    -------
    Reduction
        With the model's default for everything left out.
    """
    if section is None:
        return Reduction()
    given = {key: getattr(section, key) for key in section.model_fields_set}
    values: dict[str, Any] = {key: given[key] for key in _PLAIN if key in given}
    for key in ("r2", "tracking"):
        if key in given:
            values[key] = np.broadcast_to(np.array(given[key], dtype=np.float64), (3,))
    if "r1" in given:
        weight = np.array(given["r1"], dtype=np.float64)
        values["r1"] = np.diag(weight) if weight.ndim == 1 else _checked(weight, findings)
    if "hold" in given:
        values["hold"] = frozenset(given["hold"])
    weights = [key for key in ("r2", "tracking") if key in given]
    if "budget" in given:
        if weights:
            findings.add(
                ["reduction", "budget"], f"stands instead of {' and '.join(weights)}: give either"
            )
        budget = given["budget"]
        by_metric: dict[Any, float] = (
            budget if isinstance(budget, dict) else {DEFAULT_METRIC: budget}
        )
        values["budget"] = tuple(Budget(m, float(most)) for m, most in by_metric.items())
        for metric, most in by_metric.items():
            if metric not in ABSOLUTE and most >= 1.0:
                findings.add(
                    ["reduction", "budget"],
                    f"is a share and must be below 1: 0.05 means 5 % of {metric} (not {most:g})",
                )
    elif weights or given.get("algorithm") == "report-sweep" or given.get("method") == "zero":
        values["budget"] = ()
    return Reduction(**values)


def _checked(weight: Floats, findings: Findings) -> Floats:
    """Say where a weight matrix is not symmetric, or not positive semidefinite."""
    unequal = np.argwhere(np.triu(np.abs(weight - weight.T) > _ROUNDING * np.abs(weight).max()))
    for row, column in unequal.tolist():
        findings.add(
            ["reduction", "r1"],
            f"must be symmetric: [{row}][{column}] is {weight[row, column]:g}, "
            f"[{column}][{row}] is {weight[column, row]:g}",
        )
    symmetric = 0.5 * (weight + weight.T)
    if not len(unequal):
        values, vectors = np.linalg.eigh(symmetric)
        if values[0] < -_ROUNDING * max(abs(values[-1]), abs(values[0])):
            along = ", ".join(f"{part:.3g}" for part in vectors[:, 0])
            findings.add(
                ["reduction", "r1"],
                "must be positive semidefinite: it rewards Coriolis along "
                f"({along}), eigenvalue {values[0]:.3g}",
            )
    return symmetric
