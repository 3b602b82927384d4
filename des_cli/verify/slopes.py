"""Slopes of integrals over a motion along directions, by central differences."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS
from des_cli.model.motion import Motion
from des_cli.verify.claim import Claim
from des_cli.verify.directions import Direction
from des_cli.verify.felt import SeatChain
from des_cli.verify.integrals import Running, integral

STEP = 1e-4
"""Half step of the differences, in rad/s of a rate or rad of a seat angle: what is
integrated is smooth, so that their error is of the order of 1e-8, relative."""


@dataclass(frozen=True, eq=False)
class Sampled:
    """The states that directions change, all in one array.

    Parameters
    ----------
    interval : (m,) int array
    begin : (d,) int array
        Where each direction's intervals begin among them.
    joint : (m,) int array
    weight : (m,) array
        Of either end of an interval [s].
    angle, rate, acceleration : (2 m,) array
        Change at the starts of the intervals, then at their ends.
    """

    interval: NDArray[np.intp]
    begin: NDArray[np.intp]
    joint: NDArray[np.intp]
    weight: Floats
    angle: Floats
    rate: Floats
    acceleration: Floats

    @classmethod
    def of(cls, directions: Sequence[Direction], step: Floats) -> Sampled:
        """Collect directions on a grid of steps [s]."""
        local = [direction.sampled for direction in directions]
        counts = [len(each) for each in local]
        interval = np.concatenate([d.first + i for d, i in zip(directions, local, strict=True)])
        spans = [step[d.first : d.first + len(d.rate) - 1] for d in directions]
        weight = [
            0.5 * span[i] * (np.sum(span) / np.sum(span[i]))  # every so many stand for all
            for span, i in zip(spans, local, strict=True)
        ]
        start, end = (
            [
                np.concatenate([values(d)[i + by] for d, i in zip(directions, local, strict=True)])
                for values in (attrgetter("angle"), attrgetter("rate"))
            ]
            for by in (0, 1)
        )
        acceleration = (end[1] - start[1]) / step[interval]
        return cls(
            interval=interval,
            begin=np.concatenate([[0], np.cumsum(counts)[:-1]]),
            joint=np.repeat([d.joint for d in directions], counts),
            weight=np.concatenate(weight),
            angle=np.concatenate([start[0], end[0]]),
            rate=np.concatenate([start[1], end[1]]),
            acceleration=np.tile(acceleration, 2),
        )


def slopes_along(
    claim: Claim,
    motion: Motion,
    chain: SeatChain,
    directions: Sequence[Direction],
    functions: Sequence[Running],
) -> Floats:
    """Return the slopes of integrals along directions, (d, f).

    Parameters
    ----------
    claim : Claim
    motion : Motion
        Where the slopes are taken.
    chain : SeatChain
    directions : sequence of Direction
    functions : sequence of callable
        What is integrated.
    """
    if not directions:
        return np.zeros((0, len(functions)))
    at = Sampled.of(directions, motion.step)
    states = np.concatenate([at.interval, len(motion.step) + at.interval])
    before = claim.before.part(states)
    base = [
        np.concatenate([motion.angle[at.interval], motion.angle[at.interval + 1]]),
        np.concatenate([motion.rate_start[at.interval], motion.rate_end[at.interval]]),
        np.tile(motion.acceleration[at.interval], (2, 1)),
    ]
    moves = np.tile(np.arange(len(JOINTS)) == at.joint[:, None], (2, 1))
    values = []
    for sign in (STEP, -STEP):
        moved = [
            each + sign * moves * change[:, None]
            for each, change in zip(base, (at.angle, at.rate, at.acceleration), strict=True)
        ]
        felt = chain.at(*moved)
        values.append([f(felt, before) for f in functions])
    ends = (np.array(values[0]) - np.array(values[1])) / (2.0 * STEP)
    m = len(at.interval)
    return np.add.reduceat((ends[:, :m] + ends[:, m:]) * at.weight, at.begin, axis=1).T


def slopes_by_seat(
    claim: Claim, motion: Motion, chain: SeatChain, angle: str, functions: Sequence[Running]
) -> Floats:
    """Return the slopes of integrals by an angle of the seat's fixing, (1, f)."""
    values = []
    for sign in (STEP, -STEP):
        seat = replace(chain.seat, **{angle: getattr(chain.seat, angle) + sign})
        felt = replace(chain, seat=seat).along(motion)
        values.append([integral(claim, f, felt, claim.before) for f in functions])
    return np.asarray((np.array(values[:1]) - np.array(values[1:])) / (2.0 * STEP))
