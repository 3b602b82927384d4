"""What a free motion is to be: the record, the limits, and what budgets hold against."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from des_cli.kinematics.chain import Chain, chain_of
from des_cli.kinematics.response import respond_on, with_shortfall
from des_cli.kinematics.seat_turn import seat_turns
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, JointLimits, Machine, OccupantBounds, Seat
from des_cli.model.metric import (
    Budget,
)
from des_cli.model.motion import Motion, Record, Shortfall
from des_cli.model.profile import Ends as EndsName
from des_cli.model.profile import Profile, Reduction
from des_cli.model.response import SeatResponse
from des_cli.reduction.free.requested import is_rough
from des_cli.reduction.limits import find_violations
from des_cli.solver.spline import Ends, SplineGrid

SEAT_ANGLES = ("seat_yaw", "seat_pitch")


def unlimited() -> tuple[JointLimits, ...]:
    """Return limits that are none."""
    return tuple(JointLimits(np.inf, np.inf, np.inf) for _ in JOINTS)


@dataclass(frozen=True)
class FreeTask:
    """A free motion to find: what is asked, and what it may cost.

    Parameters
    ----------
    machine : Machine
    seat : Seat
    reduction : Reduction
    reference : Motion
        What the motion begins from and what budgets are measured against: the record, or
        what conditioning made of it.
    limits : tuple of JointLimits
        That hold for the motion.
    room : float
        Share of each bound on what the occupant gets that is left to the table.
    shortfall : Shortfall, optional
        What is asked for beyond the reference.
    response : SeatResponse, optional
        As asked for, where it is known already.
    record : Record, optional
        What conditioning began from, where the reference is another motion.
    most : tuple of Budget
        What of fidelity to the record is allowed, where it counts beside the reference.
    round_base : bool
        Whether the reference is the table of the executable base itself.
    roughness : dict of float to bool
        What `rough` has found of the response, by the step of a grid.
    """

    machine: Machine
    seat: Seat
    reduction: Reduction
    reference: Motion
    limits: tuple[JointLimits, ...]
    room: float = 0.0
    shortfall: Shortfall | None = None
    response: SeatResponse | None = None
    record: Record | None = None
    most: tuple[Budget, ...] = ()
    round_base: bool = False
    roughness: dict[float, bool] = field(default_factory=dict, compare=False, repr=False)

    @classmethod
    def of(
        cls,
        profile: Profile,
        reference: Motion,
        shortfall: Shortfall | None = None,
    ) -> FreeTask:
        """Take what a profile asks for, or what conditioning made of it."""
        enforced = profile.reduction.limits == "enforce"
        limits = profile.machine.limits if enforced else unlimited()
        return cls(
            machine=profile.machine,
            seat=profile.seat,
            reduction=profile.reduction,
            reference=reference,
            limits=limits,
            shortfall=shortfall,
        ).with_response()

    def requested(self) -> SeatResponse:
        """Return what is asked of the seat, at both ends of every interval."""
        if self.response is not None:
            return self.response
        response = respond_on(self.chain, self.machine.gravity, self.reference)
        return with_shortfall(response, self.shortfall)

    def rough(self, grid: SplineGrid) -> bool:
        """Return whether what is asked is faster than the knots of a grid."""
        if self.round_base:
            return False
        if grid.step not in self.roughness:
            self.roughness[grid.step] = is_rough(self.requested(), self.reference.t, grid.step)
        return self.roughness[grid.step]

    @property
    def held(self) -> Record:
        """What budgets hold against."""
        return Record(self.reference, self.shortfall)

    @property
    def recorded(self) -> Record:
        """What the profile asks for."""
        return self.record or self.held

    def around(self, table: Motion) -> FreeTask:
        """Return the task whose budgets hold against the executable base, of this table."""
        return replace(
            self,
            reference=table,
            shortfall=None,
            response=None,
            record=self.recorded,
            round_base=True,
        ).with_response()

    def with_response(self) -> FreeTask:
        """Return the task with what it would evaluate for every grid."""
        return replace(self, response=self.requested(), roughness={})

    @property
    def chain(self) -> Chain:
        """The chain with the seat as the profile fixes it."""
        return chain_of(self.machine, self.seat)

    @property
    def occupant(self) -> OccupantBounds:
        """The bounds on what is felt, where limits are enforced."""
        enforced = self.reduction.limits == "enforce"
        return self.machine.occupant if enforced else OccupantBounds()

    @property
    def ends(self) -> Ends:
        """What deviations from a motion that starts as the reference does keep."""
        name: EndsName = self.reduction.ends
        held = np.array([joint in self.reduction.hold for joint in JOINTS])
        freed = np.array([f"{joint}_start" in self.reduction.optimise for joint in JOINTS])
        both = np.full(len(JOINTS), name == "match-both")
        return Ends(
            start_value=~freed,
            start_rate=np.full(len(JOINTS), name != "free"),
            end_value=both,
            end_rate=both | (name == "match-rates"),
            held=held,
        )

    @property
    def base_limits(self) -> tuple[JointLimits, ...]:
        """The limits of the executable motion: none for a joint that is held and keeps its own.

        Such a joint plays its rows as they are, at a limit too, where no spline has room.
        """
        beyond = {v.joint for v in find_violations(self.machine, self.reference, "desired")}
        kept = [self.ends.held[j] and joint not in beyond for j, joint in enumerate(JOINTS)]
        none = unlimited()
        return tuple(
            none[j] if keeps else limit
            for j, (keeps, limit) in enumerate(zip(kept, self.limits, strict=True))
        )

    @property
    def base_ends(self) -> Ends:
        """What the executable motion keeps of the reference: the start, and the same ends."""
        yes = np.ones(len(JOINTS), dtype=bool)
        return replace(self.ends, start_value=yes, held=~yes)


def turned_seat(task: FreeTask, change: Floats) -> Seat:
    """Return the seat with its free angles changed [rad], in the chain's order."""
    present = seat_turns(task.machine, task.seat)
    names = [name for name in present if name in task.reduction.optimise]
    by_name = dict(zip(names, change.tolist(), strict=True))
    return Seat(
        yaw=task.seat.yaw + by_name.get("seat_yaw", 0.0),
        pitch=task.seat.pitch + by_name.get("seat_pitch", 0.0),
    )
