"""Slacks and multipliers of inequalities ``-1 <= value(x) <= 1``."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from des_cli.model.arrays import Floats

FIRST_SLACK = 1e-2
"""Slacks start at least this far inside their bounds, in the rows' unit: kappa_1 of Waechter
and Biegler (section 3.6), who move a start as far from a bound."""


@dataclass
class Side:
    """Slack s and multiplier z of one side of the bounds of one set of rows.

    ``sign * value + s = 1`` with ``s z = weight mu`` on the central path.

    Parameters
    ----------
    sign : float
        +1 for the upper bound, -1 for the lower one.
    slack, dual : (q, r) array
        Positive.
    weight : float
        Of its barrier.
    """

    sign: float
    slack: Floats
    dual: Floats
    weight: float = 1.0

    @classmethod
    def at(cls, sign: float, value: Floats, mu: float, weight: float = 1.0) -> Side:
        """Begin at a value, inside the bound."""
        slack = np.maximum(1.0 - sign * value, FIRST_SLACK)
        return cls(sign, slack, weight * mu / slack, weight)

    @property
    def product(self) -> Floats:
        """S z over the weight: mu on the central path."""
        return self.slack * self.dual / self.weight

    def barrier(self) -> float:
        """Return what the barrier adds to the cost, over mu."""
        return -self.weight * float(np.sum(np.log(self.slack)))

    def barrier_slope(self, slack_move: Floats) -> float:
        """Return the derivative of ``barrier`` along a step of the slack."""
        return -self.weight * float(np.sum(slack_move / self.slack))

    def excess(self, value: Floats) -> Floats:
        """Return how far value and slack together miss the bound."""
        return self.sign * value + self.slack - 1.0

    def stiffness(self) -> Floats:
        """Return what the eliminated slack adds to the Hessian, z / s."""
        return self.dual / self.slack

    def barrier_multiplier(self, mu: float, excess: Floats) -> Floats:
        """Return the signed multiplier after a step that leaves the value alone."""
        return self.sign * (self.weight * mu + self.dual * excess) / self.slack

    def slack_move(self, change: Floats, excess: Floats) -> Floats:
        """Return the slack's step for a change of the value."""
        return -self.sign * change - excess

    def dual_move(self, mu: float, slack_move: Floats) -> Floats:
        """Return the multiplier's step for a step of the slack."""
        return (self.weight * mu - self.dual * slack_move) / self.slack - self.dual


def longest_step(values: Floats, moves: Floats, fraction: float) -> float:
    """Return the longest step, at most one, that keeps a fraction of positive values."""
    shrinking = moves < 0.0
    if not np.any(shrinking):
        return 1.0
    return float(min(1.0, fraction * np.min(-values[shrinking] / moves[shrinking])))
