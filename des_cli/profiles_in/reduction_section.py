"""The ``reduction`` section of a profile, made into the model's ``Reduction``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_PEAK_RATIO,
    METRICS,
    STUDY_METRIC,
    Budget,
    MetricKey,
)
from des_cli.model.profile import FELT_BUDGETS, Reduction
from des_cli.profiles_in.findings import Findings
from des_cli.profiles_in.sections import Section

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
    "objective",
    "allow_change",
    "tolerance",
)
_WEIGHTS = ("r2", "tracking")

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
        With the defaults of `defaults_beside` for everything left out.
    """
    if section is None:
        return Reduction()
    given = {key: getattr(section, key) for key in section.model_fields_set}
    values: dict[str, Any] = defaults_beside(given)
    values |= {key: given[key] for key in _PLAIN if key in given}
    for key in _WEIGHTS:
        if key in given:
            values[key] = np.broadcast_to(np.array(given[key], dtype=np.float64), (3,))
    if "r1" in given:
        weight = np.array(given["r1"], dtype=np.float64)
        values["r1"] = np.diag(weight) if weight.ndim == 1 else _checked(weight, findings)
    if "hold" in given:
        values["hold"] = frozenset(given["hold"])
    if "optimise" in given:
        values["optimise"] = tuple(given["optimise"])
    for key in ("lead_in", "lead_out"):
        values[key] = section.si(key)
    if "budget" in given:
        values["budget"] = _budgets(given["budget"], findings)
        weights = [key for key in _WEIGHTS if key in given]
        if weights:
            findings.add(
                ["reduction", "budget"], f"stands instead of {' and '.join(weights)}: give either"
            )
    return Reduction(**values)


def defaults_beside(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return what differs from the model's defaults, because of what a section gives.

    The model's defaults are those of a motion that is fit to fly: free joints, budgets
    on what is felt, the start matched. They hold for every section, the empty one
    included, but for the study's own problem. That is a section with weights (``r2``,
    ``tracking``), with ``algorithm: report-sweep``, or with ``method: zero``:

    - nothing is kept within a budget: weights, the single sweep and a tolerance each
      settle by themselves how far the motion may leave the desired one;
    - the control is a factor on the desired rates, one for all joints, and for
      ``method: zero`` one for each, since a single one could only stand still;
    - the ends are free.

    One factor for all joints (``control: scalar``) is within the felt budgets, but for the
    one on the peak: it cannot bring down a corner of one joint that was rounded already.

    What the section gives by itself goes before all of these.

    Parameters
    ----------
    given : mapping of str to object
        The keys of the section and their values.

    Returns
    -------
    dict of str to object
        Fields of `Reduction`.

    >>> defaults_beside({"axes": "report"}), defaults_beside({"r2": 1.0})
    ({}, {'budget': (), 'control': 'scalar', 'ends': 'free'})
    """
    zero = given.get("method") == "zero"
    weighted = any(key in given for key in _WEIGHTS)
    if not (zero or weighted or given.get("algorithm") == "report-sweep"):
        if given.get("control") != "scalar":
            return {}
        peak: MetricKey = ANGULAR_ACCELERATION_PEAK_RATIO
        return {"budget": tuple(each for each in FELT_BUDGETS if each.metric != peak)}
    return {"budget": (), "control": "per-joint" if zero else "scalar", "ends": "free"}


def _budgets(given: float | Mapping[MetricKey, float], findings: Findings) -> tuple[Budget, ...]:
    """Return the budgets, and say which shares are not below one."""
    by_metric: Mapping[MetricKey, float]
    by_metric = given if isinstance(given, Mapping) else {STUDY_METRIC: given}
    for metric, most in by_metric.items():
        if METRICS[metric].relative and most >= 1.0:
            findings.add(
                ["reduction", "budget", *([metric] if by_metric is given else [])],
                f"is a share and must be below 1: 0.05 means 5 % of {metric} (not {most:g})",
            )
    return tuple(Budget(metric, float(most)) for metric, most in by_metric.items())


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
