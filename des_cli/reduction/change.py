"""What was changed of the record before anything was reduced, and how much is allowed.

A record may be smoothed, held at a rate limit or damped near the singularity, and replaced
by the nearest motion inside the machine's limits. Each of these changes what is felt. All
of it counts: fidelity is measured against the record, and a change beyond what is allowed
is refused, for the rest would be a reduction of a motion that nobody asked for.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.model.metric import METRICS, Budget, MetricKey
from des_cli.model.motion import Motion, Shortfall
from des_cli.model.profile import Reduction
from des_cli.reduction.fidelity import Deviation

LARGEST_CHANGE = 0.1
"""Share of the record's seat rate, or of a requested G, that may be changed before the
reduction without a word of the user: what a silent profile may lose of the seat rate in all."""

SHARES: tuple[MetricKey, ...] = ("seat_rate_deviation_relative", "seat_g_deviation_relative")
"""What of a change is told and bounded: what the pilot feels of it, relative to the record."""

RATIOS: frozenset[MetricKey] = frozenset(
    {"seat_angular_acceleration_rms_ratio", "seat_angular_acceleration_peak_ratio"}
)
"""Metrics that compare sizes: their value is one where nothing is changed."""


@dataclass(frozen=True)
class Change:
    """How far a motion is from the record before its cross-coupling is reduced.

    Parameters
    ----------
    deviation : Deviation
        Between the record and the motion.
    """

    deviation: Deviation

    @classmethod
    def between(
        cls,
        record: Motion,
        motion: Motion,
        chain: Chain,
        gravity: float,
        shortfall: Shortfall | None = None,
    ) -> Change:
        """Measure a motion of a chain under a gravity [m/s^2] against a record."""
        chains = (chain, chain)
        return cls(Deviation.between(record, motion, chains, gravity, shortfall=shortfall))

    @property
    def nothing(self) -> bool:
        """Whether the motion is the record itself."""
        same = self.deviation.modified is self.deviation.reference
        return same and self.deviation.shortfall is None

    @property
    def _asks_for_g(self) -> bool:
        """Whether the record is one of G; that of rates is made of their derivatives, noise too."""
        missing = self.deviation.shortfall
        return missing is not None and bool(np.any(missing.seat_g))

    def refusal(self, reduction: Reduction) -> str:
        """Say that more was changed than is allowed; empty where it was not."""
        if self.nothing:
            return ""
        shares = {metric: self.deviation.value(metric) for metric in SHARES}
        recorded = SHARES if self._asks_for_g else SHARES[:1]
        allowed = {metric: _allowed(reduction, metric) for metric in recorded}
        if all(shares[metric] <= allowed[metric] for metric in recorded):
            return ""
        told = " and ".join(
            f"{100.0 * shares[metric]:.1f} % of its {METRICS[metric].label}" for metric in SHARES
        )
        enough = np.ceil(100.0 * max(shares[metric] for metric in recorded)) / 100.0
        return (
            f"the record is changed by {told} before any reduction, and "
            f"{100.0 * min(allowed.values()):g} % is allowed; condition the record, or take "
            f"--allow-change {enough:g}"
        )

    def widened(
        self, reduction: Reduction, between: Mapping[MetricKey, float] | None = None
    ) -> tuple[Budget, ...]:
        """Return the budgets that hold against the record.

        Where the user allows a change, a budget is what the reduction may add to it. Two
        deviations that know nothing of each other add up in their squares, so that the
        whole is at most ``hypot(change, budget)``. A ratio of sizes is to those of the
        changed motion: the noise of a record is no size to compare a ride with.

        Parameters
        ----------
        reduction : Reduction
        between : mapping, optional
            The change by each metric as a method sees it that looks between the samples
            too, where a rough record is not what its samples are.
        """
        if self.nothing or reduction.allow_change is None:
            return reduction.budget
        seen = between or {}
        return tuple(
            replace(b, most=self._most(b, seen.get(b.metric, 0.0))) for b in reduction.budget
        )

    def _most(self, budget: Budget, between: float) -> float:
        change = max(self.deviation.value(budget.metric), between)
        if budget.metric in RATIOS:
            return budget.most * change
        if budget.metric == "mean_square_one_minus_p":
            return budget.most
        if budget.metric == "joint_deviation_relative_squared":
            return budget.most + change
        return float(np.hypot(change, budget.most))


def _allowed(reduction: Reduction, metric: MetricKey) -> float:
    """Return what may be changed; who has a budget of more allows more."""
    if reduction.allow_change is not None:
        return reduction.allow_change
    return max([LARGEST_CHANGE, *(b.most for b in reduction.budget if b.metric == metric)])
