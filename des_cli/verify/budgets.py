"""Fidelity metrics and budgets on them, measured from the motions alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_DEVIATION,
    ANGULAR_ACCELERATION_ERROR,
    ANGULAR_ACCELERATION_PEAK_RATIO,
    ANGULAR_ACCELERATION_RMS_RATIO,
    ATTITUDE_ERROR,
    FACTOR_DEVIATION,
    JOINT_DEVIATION,
    JOINT_DEVIATION_SQUARED,
    PEAK_METRICS,
    SEAT_G_DEVIATION,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
    UNFELT_ANGULAR_ACCELERATION,
    Budget,
)
from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.verify.claim import Claim
from des_cli.verify.felt import Attitudes, Felt
from des_cli.verify.integrals import integral, sizes

BUDGET_TOLERANCE = 1e-9
"""Relative excess over a budget that rounding alone may make."""

SPENT, SPENT_OF_TORN = 0.95, 0.6
"""Share of a budget from which on it may hold a motion. A method keeps a little clear of
its budgets, and more where a table of few rows is not quite its motion. Where the table
asked for is torn, its positions jump by what no rate tells, or where it is rough from sample
to sample, a method that looks between the samples sees more than the samples have: more of
a budget may seem to be left."""

TORN = 0.05
"""Largest difference of a mean rate by positions from that by rates, over the joint's
largest rate, that a quadrature makes; more is a jump."""

RATIOS = frozenset({ANGULAR_ACCELERATION_RMS_RATIO, ANGULAR_ACCELERATION_PEAK_RATIO})
"""Metrics that compare a ride with what was reduced: the noise of a record has no bearing."""

NOTHING = 1e-300
"""Least square of a norm to divide by."""


@dataclass(frozen=True, slots=True)
class Integral:
    """A metric whose square is an integral over the motion.

    Parameters
    ----------
    field : str
        Of `Felt`.
    relative : bool
        Whether it is over the same integral of the motion asked for; else over time.
    deviation : bool
        Whether it is of the deviation from the motion asked for; else of the motion itself.
    squared : bool
        Whether the metric is the integral and not its root.
    """

    field: str
    relative: bool
    deviation: bool = True
    squared: bool = False


INTEGRALS: Mapping[str, Integral] = MappingProxyType(
    {
        JOINT_DEVIATION: Integral("angle", relative=True),
        JOINT_DEVIATION_SQUARED: Integral("angle", relative=True, squared=True),
        SEAT_RATE_DEVIATION: Integral("rate", relative=True),
        SEAT_G_DEVIATION: Integral("g", relative=True),
        SEAT_G_ERROR: Integral("g", relative=False),
        ANGULAR_ACCELERATION_DEVIATION: Integral("turning", relative=True),
        ANGULAR_ACCELERATION_ERROR: Integral("turning", relative=False),
        ANGULAR_ACCELERATION_RMS_RATIO: Integral("turning", relative=True, deviation=False),
    }
)


def check_budgets(claim: Claim) -> list[Check]:
    """Measure what the reduction spends of every budget, and all that is off of the record."""
    reduced = claim.reduced
    checks = [
        Check(
            f"budget.{budget.metric}",
            f"excess over the budget on {budget.metric}",
            measure(reduced, budget.metric, claim.after) / budget.most - 1.0,
            BUDGET_TOLERANCE,
        )
        for budget in claim.reduction.budget
    ]
    if reduced is not claim:
        checks += [
            Check(
                f"record.{budget.metric}",
                f"excess over what is allowed of {budget.metric} from the record",
                measure(claim, budget.metric, claim.after) / budget.most - 1.0,
                BUDGET_TOLERANCE,
            )
            for budget in claim.most
            if budget.metric not in RATIOS
        ]
    return checks


def keeps_budgets(claim: Claim, felt: Felt) -> bool:
    """Return whether a motion keeps every budget."""
    return all(
        measure(claim, budget.metric, felt) <= budget.most * (1.0 + BUDGET_TOLERANCE)
        for budget in claim.reduction.budget
    )


def spent_budgets(claim: Claim) -> list[Budget]:
    """Return the budgets on integrals that may hold the motion: those that are spent."""
    share = SPENT_OF_TORN if claim.rough or _torn(claim.requested) else SPENT
    return [
        budget
        for budget in claim.reduction.budget
        if budget.metric not in PEAK_METRICS
        and measure(claim, budget.metric, claim.after) > share * budget.most
    ]


def measure(claim: Claim, metric: str, felt: Felt) -> float:
    """Return a fidelity metric of a motion against the one asked for, in its unit.

    Parameters
    ----------
    claim : Claim
    metric : str
    felt : Felt
        At the states of the motion.
    """
    if metric in PEAK_METRICS:
        return float(np.max(at_states(claim, metric, felt)))
    if metric == FACTOR_DEVIATION:
        return mean_square_one_minus_p(claim, claim.solution.control)
    square = _lost(claim, metric, felt) / size(claim, metric)
    return square if INTEGRALS[metric].squared else float(np.sqrt(square))


def _lost(claim: Claim, metric: str, felt: Felt) -> float:
    """Return the integral of a metric."""
    if felt is not claim.after:
        return integral(claim, partial(integrand, metric), felt, claim.before)
    kind = INTEGRALS[metric]
    key = (kind.field, "deviation" if kind.deviation else "after")
    if key not in claim.sums:
        claim.sums[key] = integral(claim, partial(integrand, metric), felt, claim.before)
    return claim.sums[key]


def integrand(metric: str, felt: Felt, before: Felt) -> Floats:
    """Return what the square of a metric is the integral of, at m states, (m,)."""
    kind = INTEGRALS[metric]
    values = getattr(felt, kind.field)
    if kind.deviation:
        values = values - getattr(before, kind.field)
    return np.asarray(np.einsum("im,im->m", values, values))


def size(claim: Claim, metric: str) -> float:
    """Return what that integral is divided by."""
    kind = INTEGRALS[metric]
    if not kind.relative:
        return claim.duration

    def square(before: Felt, _: Felt) -> Floats:
        values = getattr(before, kind.field)
        return np.asarray(np.einsum("im,im->m", values, values))

    least = NOTHING if kind.deviation else UNFELT_ANGULAR_ACCELERATION**2 * claim.duration
    key = (kind.field, "before")
    if key not in claim.sums:
        claim.sums[key] = integral(claim, square, claim.before, claim.before)
    return max(claim.sums[key], least)


def at_states(claim: Claim, metric: str, felt: Felt) -> Floats:
    """Return the values that a peak metric is the largest of, (m,).

    Raises
    ------
    ValueError
        If the metric is none.
    """
    if metric == ATTITUDE_ERROR:
        return _apart(felt.attitudes, claim.before.attitudes)
    if metric != ANGULAR_ACCELERATION_PEAK_RATIO:
        raise ValueError(f"{metric} is no largest value over time")
    largest = sizes(claim, claim.before.turning).peak[-1]
    after = np.sqrt(np.einsum("im,im->m", felt.turning, felt.turning))
    return np.asarray(after / max(largest, UNFELT_ANGULAR_ACCELERATION))


def _apart(one: Attitudes, other: Attitudes) -> Floats:
    """Return the angles between attitudes at m states, (m,) [deg], by their chord."""
    square = np.empty(len(one.angle))
    for (samples, mine), (_, its) in zip(one.blocks(), other.blocks(), strict=True):
        square[samples] = np.sum((mine - its) ** 2, axis=(0, 1))
    chord = np.minimum(np.sqrt(square / 8.0), 1.0)
    return one.at_states(np.degrees(2.0 * np.arcsin(chord)))


def mean_square_one_minus_p(claim: Claim, control: Floats) -> float:
    """Return the mean of (1 - u)^2 over time and factors (n, m)."""
    idle = np.mean((1.0 - control) ** 2, axis=1)
    return float(claim.weight @ np.concatenate([idle[:-1], idle[1:]]) / claim.duration)


def _torn(motion: Motion) -> bool:
    """Return whether positions jump between samples by what no rate tells."""
    off, fastest = np.zeros(3), np.zeros(3)
    for piece in motion.pieces():
        part = piece.motion
        by_position = np.diff(part.angle, axis=0) / part.step[:, None]
        apart = np.abs(by_position - 0.5 * (part.rate_start + part.rate_end))
        off = np.maximum(off, np.max(apart, axis=0))
        for rate in (part.rate_start, part.rate_end):
            fastest = np.maximum(fastest, np.max(np.abs(rate), axis=0))
    return bool(np.any(off > TORN * fastest))
