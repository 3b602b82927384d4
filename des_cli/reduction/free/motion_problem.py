"""Everything that defines the program of a free motion, as data."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from des_cli.kinematics.seat_turn import SeatTurn
from des_cli.kinematics.twist import SeatForms
from des_cli.model.arrays import Floats
from des_cli.reduction.free.ground_cross import GroundCross
from des_cli.reduction.free.limit_rows import LimitRows
from des_cli.reduction.free.local_bounds import LocalBound
from des_cli.reduction.free.terms import JointBudget, Term
from des_cli.solver.spline import Ends, SplineGrid


@dataclass(frozen=True, eq=False)
class FreeSeat:
    """How the seat's free angles change what is felt.

    Parameters
    ----------
    count : int
        Free angles, s.
    at : callable
        Of the angles' change (s,) [rad]: the forms of the seat, and for each angle how
        everything changes with it further, the outermost in the chain last.
    weight : float
        On the squared change, which determines it where nothing else does [1/rad^2].
    """

    count: int
    at: Callable[[Floats], tuple[SeatForms, Sequence[SeatTurn]]]
    weight: float


@dataclass(frozen=True, eq=False)
class MotionProblem:
    """Everything that defines a free motion's program.

    Parameters
    ----------
    grid : SplineGrid
    base : (n, 3) array
        Control points of the executable motion that deviations are added to [rad].
    forms : SeatForms
        Of the seat as the profile fixes it.
    cost : sequence of Term or JointBudget
        Summed up.
    ground : GroundCross, optional
        A further cost, of the cross-coupling in ground axes.
    budgets : sequence of Term or JointBudget
        Each at most one.
    rows : LimitRows
    ends : Ends
    smoothing : (3,) array
        Weight on the squared jerk of the deviation, per joint [s^5/rad^2].
    local : sequence of LocalBound
        Bounds at points.
    seat : FreeSeat, optional
    """

    grid: SplineGrid
    base: Floats
    forms: SeatForms
    cost: Sequence[Term | JointBudget]
    budgets: Sequence[Term | JointBudget]
    rows: LimitRows
    ends: Ends
    smoothing: Floats
    local: Sequence[LocalBound] = field(default_factory=tuple)
    seat: FreeSeat | None = None
    ground: GroundCross | None = None
