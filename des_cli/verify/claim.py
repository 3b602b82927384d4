"""What is claimed of a solution, and the motions as they are felt."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat
from des_cli.model.metric import Budget
from des_cli.model.metrics import Metrics
from des_cli.model.motion import Motion, Record, Shortfall
from des_cli.model.profile import Profile, Reduction
from des_cli.model.solution import Solution
from des_cli.reduction.problem import Problem
from des_cli.verify.felt import CHUNK, Felt, SeatChain
from des_cli.verify.requested import as_requested

ROUGH = 1e-3
"""Share of the seat rate's square that its samples have beside the mean of their neighbours,
from which it is rough. Of a wave of eight samples it is 0.086, of one of thirty 4.8e-4."""

STILL = 1e-9
"""Mean square of the weighted cross-coupling [rad^2/s^4] that costs are relative to at the
least, and below which there is nothing to reduce: rounding is no error of it."""


@dataclass(frozen=True, eq=False)
class Claim:
    """A solution with what it is a solution of.

    Parameters
    ----------
    profile : Profile
    requested : Motion
        What the profile asks for.
    desired : Motion
        The same, or the nearest motion inside the limits.
    seat : Seat
        As it is fixed in the modified motion.
    solution : Solution
    posed : Problem, optional
        The problem of factors on the desired rates, as it was solved, along ``desired``;
        None of a free motion, and of one per joint with budgets, which is found as a free
        one.
    commands : Motion, optional
        The motion of the command table, where it has leads before and after.
    target : Motion, optional
        What conditioning made of the motion asked for, where it did.
    shortfall : Shortfall, optional
        What is asked for beyond the motion asked for.
    held : Record, optional
        What the reduction's budgets hold against, where that is not the record.
    most : tuple of Budget
        What the profile allows of the whole way from the record, where it does.
    from_profile : bool
        Whether what is asked for is the profile's own record.
    told : Metrics, optional
        What a user is told of it.
    """

    profile: Profile
    requested: Motion
    desired: Motion
    seat: Seat
    solution: Solution
    posed: Problem | None = None
    commands: Motion | None = None
    target: Motion | None = None
    shortfall: Shortfall | None = None
    held: Record | None = None
    most: tuple[Budget, ...] = ()
    from_profile: bool = True
    told: Metrics | None = None

    @property
    def reduced(self) -> Claim:
        """The claim on what was reduced: budgets and optimality are round that motion."""
        if self.held is None or self.held == Record(self.requested, self.shortfall):
            return self
        return self._of_held

    @cached_property
    def _of_held(self) -> Claim:
        # Beside `reduced`, which may be the claim: one that holds itself lives on when it is
        # done with, and all that is felt of long motions with it.
        assert self.held is not None
        return replace(
            self, requested=self.held.motion, shortfall=self.held.shortfall, from_profile=False
        )

    @property
    def reduction(self) -> Reduction:
        """What the profile asks for."""
        return self.profile.reduction

    @property
    def modified(self) -> Motion:
        """The motion that is checked."""
        return self.solution.modified

    @property
    def table(self) -> Motion:
        """What the machine is to play: the modified motion with its leads."""
        return self.modified if self.commands is None else self.commands

    @property
    def enforced(self) -> bool:
        """Whether the motion is to be inside the machine's limits."""
        return self.reduction.limits == "enforce"

    @cached_property
    def sums(self) -> dict[tuple[str, str], float]:
        """Integrals that were taken already, by what they are of: several metrics share them."""
        return {}

    @cached_property
    def rough(self) -> bool:
        """Whether what was asked for is not smooth from sample to sample."""
        count, rate = len(self.requested.step), self.before.rate
        kinks, size = 0.0, float(np.sum(rate[:, -1] ** 2))
        for first in range(0, count, CHUNK):
            last = min(first + CHUNK, count)
            # The starts of the intervals, and of the two after them: the last start is an end.
            here = rate[:, first : min(last + 2, count)]
            if last + 2 > count:
                here = np.concatenate([here, rate[:, -1:]], axis=1)
            size += float(np.sum(here[:, : last - first] ** 2))
            kinks += float(np.sum((here[:, 1:-1] - 0.5 * (here[:, 2:] + here[:, :-2])) ** 2))
        return kinks > ROUGH * size

    @cached_property
    def weight(self) -> Floats:
        """Weights of the trapezoidal rule on the states of a motion, (2 (n - 1),) [s].

        States are in the order of `SeatChain.along`: the starts of all intervals, then
        the ends of all.
        """
        return np.tile(0.5 * self.requested.step, 2)

    @cached_property
    def duration(self) -> float:
        """Length of the motion [s]."""
        return float(self.requested.t[-1] - self.requested.t[0])

    @cached_property
    def chain(self) -> SeatChain:
        """The seat in the modified motion."""
        return SeatChain(self.profile.machine, self.seat)

    @cached_property
    def chain_before(self) -> SeatChain:
        """The seat as the profile fixes it."""
        return SeatChain(self.profile.machine, self.profile.seat)

    @cached_property
    def made(self) -> Felt:
        """What the joints make of what is asked for, at all states."""
        return self.chain_before.along(self.requested)

    @cached_property
    def before(self) -> Felt:
        """What is asked for at all states."""
        command = self.profile.command if self.from_profile else None
        return as_requested(self.made, command, self.shortfall)

    @cached_property
    def executable(self) -> Felt:
        """The desired motion at all states."""
        if self.desired is self.requested and self.shortfall is None:
            return self.before
        return self.chain_before.along(self.desired)

    @cached_property
    def after(self) -> Felt:
        """The modified motion at all states."""
        return self.chain.along(self.modified)
