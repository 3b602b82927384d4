"""What was changed of the record before anything was reduced, and how much is allowed.

A record may be smoothed, held at a rate limit or damped near the singularity, and replaced
by the nearest motion inside the machine's limits. Each of these changes what is felt, and
all of it counts: fidelity is measured against the record, and a change beyond what is
allowed is refused, for the rest would be a reduction of a motion that nobody asked for.

What is left of a budget holds round the changed motion, and where the user allows a
change all of it does, as what the reduction may add. A reduction that saw the record alone
would follow the noise that was taken out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.kinematics.response import with_shortfall
from des_cli.model.metric import METRICS, Budget, MetricKey
from des_cli.model.motion import Record
from des_cli.model.profile import Reduction
from des_cli.reduction.fidelity import Deviation

LARGEST_CHANGE = 0.1
"""Share of the record's seat rate, or of an asked G, that may be changed before the
reduction without a word of the user: what a silent profile may lose of the seat rate in all."""

SHARES: tuple[MetricKey, ...] = ("seat_rate_deviation_relative", "seat_g_deviation_relative")
"""What of a change is told and bounded: what the pilot feels of it, relative to the record."""

UNSPENT: frozenset[MetricKey] = frozenset(
    {
        "seat_angular_acceleration_rms_ratio",
        "seat_angular_acceleration_peak_ratio",
        "mean_square_one_minus_p",
    }
)
"""Metrics of which a change spends nothing: ratios of sizes, and factors on rates."""

SQUARED: MetricKey = "joint_deviation_relative_squared"
"""The metric that is a square: its root is what adds up."""


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
    def between(cls, record: Record, changed: Record, chain: Chain, gravity: float) -> Change:
        """Measure what became of a record, on a chain under a gravity [m/s^2]."""
        deviation = Deviation.between(
            record.motion, changed.motion, (chain, chain), gravity, shortfall=record.shortfall
        )
        deviation.after = with_shortfall(deviation.after, changed.shortfall)
        return cls(deviation)

    @property
    def nothing(self) -> bool:
        """Whether the motion is the record itself."""
        same = self.deviation.modified is self.deviation.reference
        return same and self.deviation.shortfall is None

    @property
    def _recorded(self) -> tuple[MetricKey, ...]:
        """The shares that count: G that a record of rates asks for is made of derivatives."""
        return SHARES if self._asks_for_g else SHARES[:1]

    @property
    def enough(self) -> float:
        """The share that has to be allowed for it, in whole percents."""
        largest = max(self.deviation.value(metric) for metric in self._recorded)
        return float(np.ceil(100.0 * largest)) / 100.0

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
        allowed = {metric: allowed_change(reduction, metric) for metric in self._recorded}
        if all(shares[metric] <= most for metric, most in allowed.items()):
            return ""
        told = " and ".join(
            f"{100.0 * shares[metric]:.1f} % of its {METRICS[metric].label}" for metric in SHARES
        )
        return (
            f"the record is changed by {told} before any reduction, and "
            f"{100.0 * min(allowed.values()):g} % is allowed; condition the record, or take "
            f"--allow-change {self.enough:g}"
        )

    def left(
        self, reduction: Reduction, *, measured: bool = False
    ) -> tuple[tuple[Budget, ...], str]:
        """Return what the change leaves of the budgets, and which it overspends.

        Deviations that know nothing of each other add up in their squares. Ratios of sizes
        are to those of the changed motion: noise is no size to compare a ride with.

        Parameters
        ----------
        reduction : Reduction
        measured : bool
            Whether the whole will be measured against the record: then budgets are left as
            if the reduction knew nothing of the change. Else as much as is safe, whatever
            it does.

        Returns
        -------
        budgets : tuple of Budget
            As they are where the user allows a change.
        overspent : str
            Empty, or what a user should know and do.
        """
        if self.nothing or reduction.allow_change is not None:
            return reduction.budget, ""
        left = [replace(b, most=self._remainder(b, measured)) for b in reduction.budget]
        over = [
            f"{METRICS[b.metric].label} {self.deviation.value(b.metric):.3g} of {b.most:.3g}"
            for b, rest in zip(reduction.budget, left, strict=True)
            if rest.most <= 0.0
        ]
        if not over:
            return tuple(left), ""
        return reduction.budget, (
            f"smoothing alone spends {', '.join(over)}; --allow-change {self.enough:g} makes the "
            "budgets those of what the reduction adds to it"
        )

    def _remainder(self, budget: Budget, measured: bool) -> float:
        if budget.metric in UNSPENT:
            return budget.most
        most, spent = budget.most, self.deviation.value(budget.metric)
        if budget.metric == SQUARED:
            most, spent = np.sqrt([most, spent])
        rest = most - spent
        if measured and rest > 0.0 and budget.metric != "attitude_error_max_deg":
            rest = np.sqrt(rest * (most + spent))
        if METRICS[budget.metric].relative:  # of a motion that is larger by no more than that
            rest /= 1.0 + spent
        return float(rest * abs(rest)) if budget.metric == SQUARED else float(rest)


def allowed_change(reduction: Reduction, metric: MetricKey) -> float:
    """Return what may be changed; who has a budget of more allows more."""
    if reduction.allow_change is not None:
        return reduction.allow_change
    return max([LARGEST_CHANGE, *(b.most for b in reduction.budget if b.metric == metric)])
