"""One reduced profile with everything that was computed on the way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any, Literal, TypeAlias

from des_cli.errors import Complaint, NoSolutionError, NotReleasedError
from des_cli.model.machine import Joint, Seat
from des_cli.model.metrics import Metrics
from des_cli.model.motion import DesiredMotion, Motion
from des_cli.model.notice import Notice
from des_cli.model.profile import Profile
from des_cli.model.response import Response
from des_cli.model.solution import Solution

JointQuantity: TypeAlias = Literal["angle", "rate", "acceleration", "jerk", "rate step"]
SeatQuantity: TypeAlias = Literal[
    "Gx", "Gy", "Gz", "Gx onset", "Gy onset", "Gz onset", "angular acceleration"
]

_UNITS: Mapping[JointQuantity | SeatQuantity, str] = MappingProxyType(
    {
        "angle": "rad",
        "rate": "rad/s",
        "acceleration": "rad/s^2",
        "jerk": "rad/s^3",
        "rate step": "rad/s",
        "Gx": "g",
        "Gy": "g",
        "Gz": "g",
        "Gx onset": "g/s",
        "Gy onset": "g/s",
        "Gz onset": "g/s",
        "angular acceleration": "rad/s^2",
    }
)


@dataclass(frozen=True, slots=True)
class Violation:
    """A joint limit, or a bound for the occupant, that a motion breaks.

    Parameters
    ----------
    motion : {"desired", "modified"}
    joint : {"arm", "fork", "cab", "seat"}
        The joint, or the seat for a bound on what the occupant gets.
    quantity : str
        A rate step is a jump of the rate at one sample: no acceleration limit
        admits it, and a finite difference across it would mean nothing.
    peak, limit : float
        The value farthest beyond the bound, and the bound, in the quantity's unit: a
        magnitude, but of a component of the G-vector the component itself.
    from_s, to_s : float
        First and last time at which the bound is broken [s].
    """

    motion: Literal["desired", "modified"]
    joint: Joint | Literal["seat"]
    quantity: JointQuantity | SeatQuantity
    peak: float
    limit: float
    from_s: float
    to_s: float

    def __str__(self) -> str:
        unit = _UNITS[self.quantity]
        bound = "bound" if self.joint == "seat" else "limit"
        beyond = "exceeds" if self.peak > self.limit else "is below"
        span = (
            f"at t = {self.from_s:g} s"
            if self.from_s == self.to_s
            else f"from t = {self.from_s:g} to {self.to_s:g} s"
        )
        if self.quantity == "rate step":
            return (
                f"{self.motion} {self.joint} rate steps by {self.peak:.4g} rad/s, "
                f"which takes an infinite acceleration, {span}"
            )
        return (
            f"{self.motion} {self.joint} {self.quantity} {self.peak:.4g} {unit} "
            f"{beyond} the {bound} {self.limit:g} {unit} {span}"
        )


@dataclass(frozen=True, slots=True)
class Check:
    """One thing that the independent verification measured.

    Parameters
    ----------
    key : str
        What it is called by programs, the same in every version: ``limits.arm.jerk``.
    name : str
        What it is called in a sentence.
    value, tolerance : float
        The check holds where ``value <= tolerance``; a value that is not a
        number fails.
    cure : str
        What to do where it fails, as a part of a sentence; empty where only the tool's
        makers can do something.
    """

    key: str
    name: str
    value: float
    tolerance: float
    cure: str = ""

    @property
    def ok(self) -> bool:
        """Whether the measured value is a number within the tolerance."""
        return self.value <= self.tolerance

    def __str__(self) -> str:
        said = f"{self.name} is {self.value:.3g}, tolerance {self.tolerance:.3g}"
        return f"{said}; {self.cure}" if self.cure and not self.ok else said


@dataclass(frozen=True, repr=False)
class Run:
    """A profile, its desired motion, the solution, and what both do to the seat.

    Parameters
    ----------
    profile : Profile
    asked : DesiredMotion
        What the profile asks for.
    desired : Motion
        The same, or the nearest motion inside the limits where these are enforced.
    seat : Seat
        As fixed in the modified motion.
    solution : Solution
    commands : Motion
        What the command table plays: the modified motion, with its leads from and to
        rest where the profile asks for them.
    before, after : Response
        Of the motion that the profile asks for, and of the modified one.
    checks : tuple of Check
        The independent verification.
    violations : tuple of Violation
        Limits, and bounds for the occupant, that the desired or the modified motion breaks.
    results : Metrics
        What was gained and what it cost, with one sentence each for the user's attention
        (a damped inverse, a component bought with another).
    """

    profile: Profile
    asked: DesiredMotion
    desired: Motion
    seat: Seat
    solution: Solution
    commands: Motion
    before: Response
    after: Response
    checks: tuple[Check, ...]
    violations: tuple[Violation, ...]
    results: Metrics

    def __repr__(self) -> str:
        """Name it: its arrays would fill a book."""
        return f"<Run {self.profile.name}: {self.solution.status}, {len(self.commands.t)} rows>"

    @cached_property
    def metrics(self) -> dict[str, Any]:
        """The content of ``metrics.json``."""
        return self.results.mapping()

    @property
    def notices(self) -> tuple[Notice, ...]:
        """The sentences for the user's attention."""
        return self.results.named_notices

    def require_release(self) -> None:
        """Raise unless this run may become a command table.

        Raises
        ------
        NoSolutionError
            If the solver did not converge.
        NotReleasedError
            If the record was changed by more than is allowed, a verification check
            failed, or a limit or a bound for the occupant
            under ``check`` or ``enforce``.
        """
        name = self.profile.name
        if self.solution.status == "changed":
            raise NotReleasedError([Complaint(name, self.solution.message)])
        if not self.solution.usable:
            raise NoSolutionError(
                [Complaint(name, f"{self.solution.status}: {self.solution.message}")]
            )
        complaints = [
            Complaint(name, f"verification failed: {check}")
            for check in self.checks
            if not check.ok
        ]
        if self.profile.reduction.limits != "warn":
            complaints += [
                Complaint(name, str(violation))
                for violation in self.violations
                if violation.motion == "modified"
            ]
        if complaints:
            raise NotReleasedError(complaints)
