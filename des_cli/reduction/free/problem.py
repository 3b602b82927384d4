"""From a profile to the program of a free motion: references, budgets, bounds, ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from des_cli.kinematics.attitude import rotation
from des_cli.kinematics.chain import Chain, chain_of
from des_cli.kinematics.coriolis import coriolis
from des_cli.kinematics.response import respond_on, with_shortfall
from des_cli.kinematics.seat import PILOT_SIGNS
from des_cli.kinematics.seat_turn import SeatTurn, seat_turns
from des_cli.kinematics.trig_polynomial import TrigPolynomial
from des_cli.kinematics.twist import SeatForms, SeatMotion, seat_forms
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, JointLimits, Machine, OccupantBounds, Seat
from des_cli.model.metric import UNFELT_ANGULAR_ACCELERATION, Budget, MetricKey
from des_cli.model.motion import Motion, Record, Shortfall
from des_cli.model.profile import Ends as EndsName
from des_cli.model.profile import Profile, Reduction
from des_cli.model.response import Response
from des_cli.reduction.free.asked import Asked, is_rough
from des_cli.reduction.free.ground_cross import GroundCross
from des_cli.reduction.free.limit_rows import LimitRows, Tie
from des_cli.reduction.free.local_bounds import (
    AttitudeBound,
    ComponentBound,
    LocalBound,
    NormBound,
    OnsetBound,
)
from des_cli.reduction.free.program import SEAT_VARIABLES, FreeSeat, MotionProblem
from des_cli.reduction.free.terms import JointBudget, Quantity, Term
from des_cli.reduction.free.windows import JOINTS as COMPONENTS
from des_cli.reduction.free.windows import Windows
from des_cli.reduction.reference import sample_motion, sample_sides
from des_cli.solver.spline import Ends, SplineGrid
from des_cli.units import STANDARD_GRAVITY_M_S2

BLEND = 0.1
"""Weight of the felt error in the objective ``blend``, relative to the cross-coupling."""

REGULARISATION = 1e-6
"""Weight on the mean square of the deviation's jerk, in units of the acceleration limits
per second, beside a cost that is one for the desired motion: it determines what neither
cost nor budgets do."""

SEAT_WEIGHT = 1e-6
"""Weight on the squared change of the seat's angles [1/rad^2], for the same reason."""

MARGIN = 1e-6
"""Relative distance that the solver keeps from a machine limit: room for the rounding of
whoever differentiates a table of positions twice."""

UNIT_ACCELERATION = 1.0
"""Acceleration [rad/s^2] that the regularisation takes for a joint without a limit."""

AT_POINTS: frozenset[MetricKey] = frozenset(
    {"attitude_error_max_deg", "seat_angular_acceleration_peak_ratio"}
)
"""Metrics that are a largest value over time: bounds at each point, and no integrals."""

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
    response : Response, optional
        As asked for, where it is known already.
    record : Record, optional
        What conditioning began from, where the reference is another motion.
    most : tuple of Budget
        What of fidelity to the record is allowed, where it counts beside the reference.
    round_base : bool
        Whether the reference is the table of the executable base itself.
    """

    machine: Machine
    seat: Seat
    reduction: Reduction
    reference: Motion
    limits: tuple[JointLimits, ...]
    room: float = 0.0
    shortfall: Shortfall | None = None
    response: Response | None = None
    record: Record | None = None
    most: tuple[Budget, ...] = ()
    round_base: bool = False

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

    def asked(self) -> Response:
        """Return what is asked of the seat, at both ends of every interval."""
        if self.response is not None:
            return self.response
        made = respond_on(self.chain, self.machine.gravity, self.reference)
        return with_shortfall(made, self.shortfall)

    def rough(self, grid: SplineGrid) -> bool:
        """Return whether what is asked is faster than the knots of a grid."""
        return not self.round_base and is_rough(self.asked(), self.reference.t, grid.step)

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
        return replace(self, response=self.asked())

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
    def base_ends(self) -> Ends:
        """What the executable motion keeps of the reference: the start, and the same ends."""
        yes = np.ones(len(JOINTS), dtype=bool)
        return replace(self.ends, start_value=yes, held=~yes)


def pose_motion(
    task: FreeTask, grid: SplineGrid, base: Floats, ties: Sequence[Tie] = ()
) -> MotionProblem:
    """Make the program's problem on a grid round an executable base.

    Parameters
    ----------
    task : FreeTask
    grid : SplineGrid
    base : (n, 3) array
        Control points [rad].
    ties : sequence of Tie
    """
    reduction = task.reduction
    forms = seat_forms(task.chain, task.machine.gravity)
    windows = Windows(grid, SEAT_VARIABLES)
    times = windows.times()
    angle, rate, acceleration = (
        (grid.values(base, times, order) for order in range(3))
        if task.round_base
        else sample_motion(task.reference, times)
    )
    seat = forms.at(np.concatenate([angle[:, 1:].T, rate.T, acceleration.T]))
    asked = _asked(seat, task, windows)
    # Of a rough record no motion makes the cross-coupling: costs are relative to the base's.
    along = _along(grid, base) if task.rough(grid) else None
    size = cross_coupling(task, grid) if along is None else _energy(task, grid, *along)
    measures = _Measures(grid, base, angle, asked, size)
    acceleration_limit = np.array([limit.acceleration for limit in task.machine.limits])
    unit = np.where(np.isfinite(acceleration_limit), acceleration_limit, UNIT_ACCELERATION)
    return MotionProblem(
        grid=grid,
        base=base,
        forms=forms,
        cost=measures.cost(reduction),
        budgets=[measures.budget(b) for b in reduction.budget if b.metric not in AT_POINTS],
        rows=LimitRows(grid, base, task.limits, task.ends, MARGIN, ties),
        ends=task.ends,
        smoothing=REGULARISATION / (grid.duration * unit**2),
        local=[
            *(
                _point_bound(task, times, angle, b)
                for b in reduction.budget
                if b.metric in AT_POINTS
            ),
            *_occupant_bounds(task.occupant, grid, task.room),
        ],
        seat=_free_seat(task),
        ground=measures.ground(task),
    )


def cross_coupling(task: FreeTask, grid: SplineGrid) -> float:
    """Return the reference's ``int c' R1 c dt``, which the cost is relative to."""
    times = Windows(grid, SEAT_VARIABLES).times()
    angle, rate, _ = sample_motion(task.reference, times)
    return _energy(task, grid, angle, rate)


def _along(grid: SplineGrid, control: Floats) -> tuple[Floats, Floats]:
    """Return a spline's angles and rates at the points of its grid, (p, 3) each."""
    times = Windows(grid, SEAT_VARIABLES).times()
    return grid.values(control, times), grid.values(control, times, 1)


def _energy(task: FreeTask, grid: SplineGrid, angle: Floats, rate: Floats) -> float:
    """Return ``int c' R1 c dt`` of angles and rates at the points."""
    c = coriolis(task.chain, angle, rate, "report" if in_ground_axes(task.reduction) else "seat")
    return float(0.5 * grid.step * np.sum((c @ _root(task.reduction.r1)) ** 2))


def in_ground_axes(reduction: Reduction) -> bool:
    """Return whether the weight needs the study's axes: a weight on the length needs none."""
    isotropic = np.array_equal(reduction.r1, reduction.r1[0, 0] * np.eye(3))
    return reduction.axes == "report" and not isotropic


def _asked(seat: SeatMotion, task: FreeTask, windows: Windows) -> Asked:
    """Return what is asked of the seat: at the points, or of a rough record by its samples."""
    if task.rough(windows.grid):
        return Asked.projected(task.asked(), task.reference.t, windows)
    return Asked.at_points(seat, task.reference, task.shortfall, windows.times())


class _Measures:
    """Costs on a grid, and budgets relative to the size of what is asked for."""

    def __init__(
        self,
        grid: SplineGrid,
        base: Floats,
        angle: Floats,
        asked: Asked,
        size: float,
    ) -> None:
        self.grid, self.base, self.angle, self.asked = grid, base, angle, asked
        self.size = max(size, 1e-300)
        self.weight = 0.5 * grid.step

    def cost(self, reduction: Reduction) -> list[Term]:
        """Return the terms of the objective; the reference's cross-coupling counts one."""
        terms = []
        if reduction.objective != "felt" and not in_ground_axes(reduction):
            terms.append(Term("cross", self._cross_root(reduction)))
        if reduction.objective != "coriolis":
            cross = self.asked.values["cross"]
            share = BLEND if reduction.objective == "blend" else 1.0
            isotropic = np.sqrt(share * np.trace(reduction.r1) / 3.0 * self.weight / self.size)
            target = self.asked.values["acceleration"] - cross
            terms.append(Term("acceleration", isotropic * np.eye(3), target))
        return terms

    def ground(self, task: FreeTask) -> GroundCross | None:
        """Return the cost of the cross-coupling in the study's axes, if that is weighed."""
        if task.reduction.objective == "felt" or not in_ground_axes(task.reduction):
            return None
        return GroundCross(task.chain, self._cross_root(task.reduction))

    def _cross_root(self, reduction: Reduction) -> Floats:
        return np.asarray(_root(reduction.r1) * np.sqrt(self.weight / self.size))

    def budget(self, budget: Budget) -> Term | JointBudget:
        """Return a budget as the square of its metric over the square of its most."""
        most, weight = budget.most, self.weight
        mean = weight / self.grid.duration
        match budget.metric:
            case "joint_deviation_relative":
                return self._joints(most)
            case "joint_deviation_relative_squared":
                return self._joints(float(np.sqrt(most)))
            case "seat_rate_deviation_relative":
                return self._term("rate", self._per_size("rate") / most)
            case "seat_g_deviation_relative":
                return self._term("force", self._per_size("force") / most)
            case "seat_g_rms_error_g":
                return self._term("force", np.sqrt(mean) / (most * STANDARD_GRAVITY_M_S2))
            case "seat_angular_acceleration_deviation_relative":
                return self._term("acceleration", self._per_size("acceleration") / most)
            case "seat_angular_acceleration_rms_error_rad_s2":
                return self._term("acceleration", np.sqrt(mean) / most)
            case "seat_angular_acceleration_rms_ratio":
                least = UNFELT_ANGULAR_ACCELERATION * np.sqrt(self.grid.duration / weight)
                scale = min(self._per_size("acceleration"), 1.0 / least)
                return Term("acceleration", scale / most * np.eye(3))
        raise ValueError(f"a free motion has no budget on {budget.metric}")

    def _per_size(self, quantity: Quantity) -> float:
        """Return one over the norm of a quantity of the reference."""
        return 1.0 / max(float(np.sqrt(self.asked.square[quantity])), 1e-150)

    def _term(self, quantity: Quantity, scale: float) -> Term:
        asked = self.asked
        floor = scale**2 * asked.floor[quantity]
        return Term(quantity, scale * np.eye(3), asked.values[quantity], floor)

    def _joints(self, most: float) -> JointBudget:
        windows = Windows(self.grid, tuple((0, joint) for joint in range(COMPONENTS)))
        base = [windows.gather(self.base, *span) for span in windows.chunks()]
        size = max(float(np.sum(self.angle**2)), 1e-300)
        return JointBudget(1.0 / (most**2 * size), np.concatenate(base, axis=1) - self.angle.T)


def _root(weight: Floats) -> Floats:
    """Return a symmetric square root of a positive semidefinite matrix, diagonal if it is."""
    if np.array_equal(weight, np.diag(np.diag(weight))):
        return np.diag(np.sqrt(np.diag(weight)))
    values, vectors = np.linalg.eigh(weight)
    return np.asarray((vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T)


def _point_bound(task: FreeTask, times: Floats, angle: Floats, budget: Budget) -> LocalBound:
    """Return a budget that bounds every point."""
    if budget.metric == "attitude_error_max_deg":
        return _attitude_bound(task, times, angle, budget.most)
    peak = np.max(np.linalg.norm(task.asked().seat_angular_acceleration, axis=-1))
    return NormBound("acceleration", budget.most * max(float(peak), UNFELT_ANGULAR_ACCELERATION))


def _attitude_bound(task: FreeTask, times: Floats, angle: Floats, most_deg: float) -> AttitudeBound:
    coefficient = task.chain.transform.coefficient[..., :3, :3]
    attitude = TrigPolynomial(coefficient.reshape(3, 3, 3, 9))
    asked = attitude(angle)
    if task.shortfall is not None:
        missing = task.shortfall.attitude
        sides = np.stack([missing[:-1], missing[1:]], axis=1)
        turn = rotation(sample_sides(task.reference.t, sides, times))
        asked = (asked.reshape(-1, 3, 3) @ turn).reshape(-1, 9)
    return AttitudeBound(attitude, asked.T, float(np.radians(most_deg)))


def _occupant_bounds(occupant: OccupantBounds, grid: SplineGrid, room: float) -> list[LocalBound]:
    """Return the machine's bounds on what is felt, drawn in by some room."""
    found: list[LocalBound] = []
    directions, bounds = [], []
    per_g = np.diag(PILOT_SIGNS) / STANDARD_GRAVITY_M_S2
    for axis, (least, most) in enumerate((occupant.gx, occupant.gy, occupant.gz)):
        for bound, sign in ((most, 1.0), (-least, -1.0)):
            if np.isfinite(bound):
                directions.append(sign * per_g[axis])
                bounds.append(bound)
    if bounds:
        scale = np.maximum(np.abs(bounds), 1.0)
        found.append(ComponentBound(np.array(directions), np.array(bounds) - room * scale, scale))
    if np.isfinite(occupant.angular_acceleration):
        found.append(NormBound("acceleration", (1.0 - room) * occupant.angular_acceleration))
    if np.isfinite(occupant.g_onset):
        apart = grid.step / np.sqrt(3.0)  # between the two points of an interval
        rate = per_g / ((1.0 - room) * occupant.g_onset * apart)
        found.append(OnsetBound(np.concatenate([rate, -rate])))
    return found


def _free_seat(task: FreeTask) -> FreeSeat | None:
    names = [name for name in SEAT_ANGLES if name in task.reduction.optimise]
    present = seat_turns(task.machine, task.seat)
    names = [name for name in present if name in names]
    if not names:
        return None

    def at(change: Floats) -> tuple[SeatForms, list[SeatTurn]]:
        seat = turned_seat(task, change)
        forms = seat_forms(chain_of(task.machine, seat), task.machine.gravity)
        turns = seat_turns(task.machine, seat)
        return forms, [turns[name] for name in names]

    return FreeSeat(len(names), at, SEAT_WEIGHT)


def turned_seat(task: FreeTask, change: Floats) -> Seat:
    """Return the seat with its free angles changed [rad], in the chain's order."""
    present = seat_turns(task.machine, task.seat)
    names = [name for name in present if name in task.reduction.optimise]
    by_name = dict(zip(names, change.tolist(), strict=True))
    return Seat(
        yaw=task.seat.yaw + by_name.get("seat_yaw", 0.0),
        pitch=task.seat.pitch + by_name.get("seat_pitch", 0.0),
    )
