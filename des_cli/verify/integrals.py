"""Integrals over a motion of what is felt of it, and its sizes, block by block.

So that nothing of the length of a long motion is made of what is there already.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple, TypeAlias

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.verify.claim import Claim
from des_cli.verify.felt import CHUNK, Felt

Running: TypeAlias = Callable[[Felt, Felt], Floats]
"""What is integrated, (m,): of what is felt, and of what is felt of the motion asked for."""


class Sizes(NamedTuple):
    """Sizes of vectors over a motion: of each component, and last of the length.

    Parameters
    ----------
    rms, peak : list of float
        Root of the mean square over time, and largest magnitude.
    """

    rms: list[float]
    peak: list[float]


def state_blocks(states: int) -> Iterator[slice]:
    """Yield blocks of the states of a motion: of starts of intervals, then of ends."""
    count = states // 2
    for side in (0, count):
        for first in range(0, count, CHUNK):
            yield slice(side + first, side + min(first + CHUNK, count))


def integral(claim: Claim, running: Running, felt: Felt, before: Felt) -> float:
    """Integrate a function of what is felt over the motion.

    Parameters
    ----------
    claim : Claim
        Its weights are those of the states.
    running : callable
    felt, before : Felt
    """
    return sum(
        float(claim.weight[states] @ running(felt.block(states), before.block(states)))
        for states in state_blocks(len(claim.weight))
    )


def sizes(claim: Claim, vectors: Floats, less: Floats | None = None) -> Sizes:
    """Return the sizes of vectors (d, m), or of their differences from others."""
    if less is None:
        return _sizes(claim, lambda states: vectors[:, states])
    return _sizes(claim, lambda states: vectors[:, states] - less[:, states])


def ground_sizes(claim: Claim, felt: Felt) -> Sizes:
    """Return the sizes of the cross-coupling along ground axes."""
    return _sizes(claim, lambda states: felt.block(states).cross_ground)


def angle_changes(claim: Claim, felt: Felt, before: Felt) -> Sizes:
    """Return the sizes of the differences of the joints' angles."""
    return _sizes(claim, lambda states: felt.block(states).angle - before.block(states).angle)


def _sizes(claim: Claim, values: Callable[[slice], Floats]) -> Sizes:
    """Return the sizes of vectors (d, k) at blocks of states."""
    total, largest = np.zeros(1), np.zeros(1)
    for states in state_blocks(len(claim.weight)):
        here = values(states)
        squares = np.empty((len(here) + 1, here.shape[1]))
        np.multiply(here, here, out=squares[:-1])
        np.sum(squares[:-1], axis=0, out=squares[-1])
        total = total + squares @ claim.weight[states]
        largest = np.maximum(largest, np.max(squares, axis=1))
    return Sizes(np.sqrt(total / claim.duration).tolist(), np.sqrt(largest).tolist())
