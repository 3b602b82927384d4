"""Where a transcription evaluates its cost: samples, and both sides of a rate step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.motion import Motion
from des_cli.solver.program import Indices


@dataclass(frozen=True)
class Points:
    """Every sample once, and once more where the desired rate steps.

    Parameters
    ----------
    node : (q,) int array
        The sample of each point: first 0 to n - 1, then the further sides.
    weight : (q,) array
        Quadrature weight [s].
    rate : (q, 3) array
        Desired rate on this side of the sample [rad/s].
    start, end : (n - 1,) int array
        The points at the start and at the end of each interval.
    """

    node: Indices
    weight: Floats
    rate: Floats
    start: Indices
    end: Indices

    @classmethod
    def of(cls, motion: Motion) -> Points:
        """Place the points of a motion."""
        n = len(motion.t)
        half = 0.5 * motion.step
        after, before = np.append(half, 0.0), np.append(0.0, half)
        stepping = 1 + np.flatnonzero(np.any(motion.rate_step != 0.0, axis=1))
        weight = after + before
        weight[stepping] = after[stepping]
        end = np.arange(1, n)
        end[stepping - 1] = n + np.arange(len(stepping))
        return cls(
            node=np.concatenate([np.arange(n), stepping]),
            weight=np.concatenate([weight, before[stepping]]),
            rate=np.vstack(
                [motion.rate_start, motion.rate_end[-1:], motion.rate_end[stepping - 1]]
            ),
            start=np.arange(n - 1),
            end=end,
        )

    def gather(self, values: Floats) -> Floats:
        """Return at each point what an array says at its sample."""
        return values if len(self.node) == len(values) else values[self.node]

    def scatter(self, values: Floats, n: int) -> Floats:
        """Add up by sample what an array says at each point."""
        total = values[:n].copy()
        total[self.node[n:]] += values[n:]  # at most one further point a sample
        return total
