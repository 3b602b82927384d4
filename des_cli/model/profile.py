"""A maneuver profile: what the user asks the machine to fly, and how to reduce it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np

from des_cli.model.arrays import Floats, freeze
from des_cli.model.machine import Joint, Machine, Seat
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_PEAK_RATIO,
    ANGULAR_ACCELERATION_RMS_RATIO,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
    Budget,
)
from des_cli.model.origin import Origin

Method: TypeAlias = Literal["minimum", "zero"]
Algorithm: TypeAlias = Literal["optimum", "report-sweep"]
Control: TypeAlias = Literal["free", "scalar", "per-joint"]
Axes: TypeAlias = Literal["report", "seat"]
JacobianAt: TypeAlias = Literal["desired", "adapted"]
LimitsPolicy: TypeAlias = Literal["enforce", "check", "warn"]
Ends: TypeAlias = Literal["free", "match-start", "match-rates", "match-both"]
Objective: TypeAlias = Literal["coriolis", "blend", "felt"]
FreeParameter: TypeAlias = Literal["seat_yaw", "seat_pitch", "fork_start", "cab_start"]


@dataclass(frozen=True)
class JointCommands:
    """Commands sampled joint by joint: a velocity for the arm, positions for the rest.

    Parameters
    ----------
    arm_rate : (n,) array
        [rad/s]; linear between samples, as a velocity loop is fed.
    position : (n, 2) array
        Fork and cab angles [rad].
    rate_start, rate_end : (n - 1, 2) array
        Fork and cab rates at both ends of every interval [rad/s]: exact
        derivatives of an expression, three-point estimates of a table.
    arm_start : float, optional
        The arm's angle at the first sample [rad], where it is given by its angle.
    """

    arm_rate: Floats
    position: Floats
    rate_start: Floats
    rate_end: Floats
    arm_start: float | None = None

    def __post_init__(self) -> None:
        n = len(self.arm_rate)
        freeze(self, "arm_rate", (n,))
        freeze(self, "position", (n, 2))
        freeze(self, "rate_start", (n - 1, 2))
        freeze(self, "rate_end", (n - 1, 2))


@dataclass(frozen=True)
class BodyRates:
    """Roll, pitch and yaw rate p, q, r of the seat, in seat axes [rad/s].

    Parameters
    ----------
    start, middle, end : (n - 1, 3) array
        At the start, the middle and the end of every interval: exact values of
        an expression, interpolated ones of a table.
    attitude : (n, 4) array, optional
        Recorded attitude quaternion (w, x, y, z), body to inertial, to compare
        the integrated attitude with; NaN rows where none was recorded.
    skew : (n - 1, 3) array, optional
        What the rates between the three have beside their parabola: at the part s
        of an interval ``skew s (1 - s) (1 - 2 s)``, which makes any cubic of it.
        Zero if not given.
    """

    start: Floats
    middle: Floats
    end: Floats
    attitude: Floats | None = None
    skew: Floats | None = None

    def __post_init__(self) -> None:
        n = len(self.start)
        for name in ("start", "middle", "end"):
            freeze(self, name, (n, 3))
        if self.attitude is not None:
            freeze(self, "attitude", (n + 1, 4))
        if self.skew is not None:
            freeze(self, "skew", (n, 3))

    @cached_property
    def powers(self) -> Floats:
        """Coefficients of 1, s, s^2 and s^3 on each interval, (n - 1, 4, 3) [rad/s]."""
        start, middle, end = self.start, self.middle, self.end
        skew = np.zeros_like(start) if self.skew is None else self.skew
        return np.stack(
            [
                start,
                4.0 * middle - 3.0 * start - end + skew,
                2.0 * (start + end) - 4.0 * middle - 3.0 * skew,
                2.0 * skew,
            ],
            axis=1,
        )

    def at(self, s: float) -> Floats:
        """Return the rates at a part s of every interval, (n - 1, 3) [rad/s]."""
        constant, linear, square, cube = np.moveaxis(self.powers, 1, 0)
        return np.asarray(constant + s * (linear + s * (square + s * cube)))


WASHOUT = 2.0
"""Time constant [s] with which rates beside an asked G are washed out, unless said."""


@dataclass(frozen=True)
class GCommand:
    """The G-vector that the pilot is to feel, and perhaps rates beside it.

    Parameters
    ----------
    start, end : (n - 1, 3) array
        Asked Gx, Gy, Gz at both ends of every interval, in the pilot's signs
        (``kinematics.seat``) [g]; linear between, and a step at a sample is one.
    rates : BodyRates, optional
        Roll and pitch rate that are followed at high frequency. The yaw rate is zero: no
        joint is left for it.
    washout : float
        Time constant [s] above which the rates give way to the direction of G.
    """

    start: Floats
    end: Floats
    rates: BodyRates | None = None
    washout: float = WASHOUT

    def __post_init__(self) -> None:
        n = len(self.start)
        freeze(self, "start", (n, 3))
        freeze(self, "end", (n, 3))

    @property
    def sides(self) -> Floats:
        """Asked G at both ends of every interval, (n - 1, 2, 3) [g]."""
        return np.stack([self.start, self.end], axis=1)


FELT_BUDGETS = (
    Budget(SEAT_G_ERROR, 0.05),
    Budget(SEAT_RATE_DEVIATION, 0.1),
    Budget(ANGULAR_ACCELERATION_RMS_RATIO, 1.05),
    Budget(ANGULAR_ACCELERATION_PEAK_RATIO, 1.1),
)
"""What a silent profile may change of what the pilot feels: G and rate by so much, and the
total angular acceleration must not grow by more than what nobody notices. Without the last
two a motion may end, or begin, with a jerk that no integral over the whole of it sees."""


@dataclass(frozen=True)
class Reduction:
    """How to reduce the Coriolis; the defaults are what a silent profile gets.

    Parameters
    ----------
    r1 : (3, 3) array
        Symmetric positive semidefinite weight on the Coriolis components
        (AB3, BB3, CB3) in report axes or (x, y, z) in seat axes [s^4/rad^2].
    r2 : (3,) array
        Weight on ``(1 - u)^2`` for each joint; the scalar control takes their
        mean, so that equal factors cost the same in both.
    tracking : (3,) array
        Diagonal of Q, the weight on ``(Theta - theta)^2`` [1/rad^2].
    iterations : int
        Backward-forward sweeps of ``report-sweep``.
    limits : {"enforce", "check", "warn"}
        Solve inside the machine's limits, refuse a motion beyond them, or only
        name what is beyond them.
    max_iterations : int
        Newton steps in all.
    hold : frozenset of str
        Joints that keep their desired motion (free and per-joint control).
    ends : {"free", "match-start", "match-rates", "match-both"}
        Where the modified motion equals the desired one beside the angles at the
        start, which it always does: nowhere, in the rates at the start, in the
        rates at both ends, or in angles and rates at both ends.
    budget : tuple of Budget
        Instead of r2 and tracking: the largest values allowed of fidelity
        metrics, kept together.
    objective : {"coriolis", "blend", "felt"}
        What a free motion minimises: the weighted Coriolis vector; the same and a
        tenth of the felt error, which is how far the total angular acceleration
        is from the desired one without its Coriolis part; or the felt error alone.
    optimise : tuple of str
        Constants that are found together with a free motion.
    lead_in, lead_out : float
        Time [s] in which the command table ramps from rest to the maneuver's
        start, and from its end to rest; 0 for none.
    allow_change : float, optional
        Share of the record's seat rate, or of its G, that conditioning, damping and the
        limits may change before the reduction; the budgets are then what it may add. None
        for the little that needs no allowance, within the budgets.
    tolerance : float
        Largest Coriolis component that ``method: zero`` leaves [rad/s^2].
    """

    method: Method = "minimum"
    algorithm: Algorithm = "optimum"
    control: Control = "free"
    axes: Axes = "seat"
    jacobian: JacobianAt = "desired"
    r1: Floats = field(default_factory=lambda: 2.0 * np.eye(3))
    r2: Floats = field(default_factory=lambda: np.ones(3))
    tracking: Floats = field(default_factory=lambda: np.zeros(3))
    limits: LimitsPolicy = "enforce"
    iterations: int = 1
    max_iterations: int = 3000
    hold: frozenset[Joint] = frozenset()
    ends: Ends = "match-start"
    budget: tuple[Budget, ...] = FELT_BUDGETS
    objective: Objective = "coriolis"
    optimise: tuple[FreeParameter, ...] = ()
    lead_in: float = 0.0
    lead_out: float = 0.0
    allow_change: float | None = None
    tolerance: float = 1e-4

    def __post_init__(self) -> None:
        freeze(self, "r1", (3, 3))
        freeze(self, "r2", (3,))
        freeze(self, "tracking", (3,))

    @property
    def budget_of_record(self) -> tuple[Budget, ...]:
        """The budgets on the whole way from the record: none where a change is allowed."""
        return self.budget if self.allow_change is None else ()


Command: TypeAlias = JointCommands | BodyRates | GCommand
"""What a profile asks for."""


@dataclass(frozen=True)
class Profile:
    """One maneuver on one machine.

    Parameters
    ----------
    name : str
    t : (n,) array
        Sample times, strictly increasing, n >= 2 [s].
    command : JointCommands, BodyRates or GCommand
    initial_angle : (3,) array
        Arm, fork and cab angle at the first sample [rad]; for joint commands
        and an asked G only the arm's is used.
    machine, seat : Machine, Seat
    reduction : Reduction
    sha256 : str
        Digest of the bytes that the profile was read from, with its overrides.
    smooth_cutoff_hz : float
        What the record is smoothed with before it is reduced; the record stays
        the reference [Hz]. Infinite where it is not smoothed.
    remarks : tuple of str
        What reading changed of the file, a sentence each.
    origin : Origin, optional
        What it was read from; None of a profile that was made otherwise.
    """

    name: str
    t: Floats
    command: Command
    machine: Machine
    seat: Seat = field(default_factory=Seat)
    initial_angle: Floats = field(default_factory=lambda: np.zeros(3))
    reduction: Reduction = field(default_factory=Reduction)
    sha256: str = ""
    smooth_cutoff_hz: float = math.inf
    remarks: tuple[str, ...] = ()
    origin: Origin | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        freeze(self, "t", (None,))
        freeze(self, "initial_angle", (3,))
