"""A profile with free joints and what was found for it, to be changed and verified."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.response import respond_on
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion, integrate_sides
from des_cli.model.profile import Reduction
from des_cli.reduction.free.method import find_free_motion
from des_cli.reduction.free.task import FreeTask
from des_cli.verify.claim import Claim
from des_cli.verify.verify import verify
from tests.reduction.conftest import make_cobra
from tests.support.claims import profile_of

G, RATE = "seat_g_rms_error_g", "seat_rate_deviation_relative"
COBRA = make_cobra(250)


SPENT = {f"budget.{G}", f"budget.{RATE}"}
"""Spent to a billionth by an optimum: any change may overspend them."""


class Case:
    """A profile and what was found for it, to be changed and verified."""

    def __init__(self, most=(0.05, 0.1), machine=DES, requested=COBRA, budget=None, **options):
        budget = budget or (Budget(G, most[0]), Budget(RATE, most[1]))
        self.profile = profile_of(requested, Reduction(budget=budget, **options), machine)
        self.requested = requested
        found = find_free_motion(FreeTask.of(self.profile, requested))
        self.desired, self.seat, self.solution = found.desired, found.seat, found.solution
        assert self.solution.converged

    def checks(
        self, solution=None, *, requested=None, machine=None, seat=None, commands=None, **options
    ):
        profile = replace(
            self.profile,
            machine=machine or self.profile.machine,
            reduction=replace(self.profile.reduction, **options),
        )
        claim = Claim(
            profile,
            requested or self.requested,
            self.desired,
            seat or self.seat,
            solution or self.solution,
            commands=commands,
        )
        return verify(claim)

    def failed(self, solution=None, **changes):
        return {check.key for check in self.checks(solution, **changes) if not check.ok}

    def value(self, key, solution=None, **changes):
        (value,) = [c.value for c in self.checks(solution, **changes) if c.key == key]
        return value

    def played(self, motion, seat=None):
        """The solution with another motion, its cost by the program's own kinematics."""
        chain = chain_of(self.profile.machine, seat or self.seat)
        c = respond_on(chain, DES.gravity, motion).coriolis_seat
        running = np.sum((c @ self.profile.reduction.r1) * c, axis=-1)
        cost = 0.5 * float(integrate_sides(motion.step, running))
        return replace(self.solution, modified=motion, cost=cost)

    def moved(self, *changes, start=(0.0, 0.0, 0.0)):
        """The solution with changed rates at samples, (sample, joint, change)."""
        motion = self.solution.modified
        rate = np.vstack([motion.rate_start, motion.rate_end[-1:]])
        for sample, joint, change in changes:
            rate[sample, joint] += change
        return self.played(with_rates(motion.t, motion.angle[0] + start, rate))


def with_rates(t, first, rate):
    rise = np.cumsum(0.5 * np.diff(t)[:, None] * (rate[:-1] + rate[1:]), axis=0)
    return Motion(t, first + np.vstack([np.zeros(3), rise]), rate[:-1], rate[1:])


def between(one, other, share):
    """The motion at a share of the way from one to another: inside limits that both keep."""
    return Motion(
        one.t,
        *(
            getattr(one, name) + share * (getattr(other, name) - getattr(one, name))
            for name in ("angle", "rate_start", "rate_end")
        ),
    )
