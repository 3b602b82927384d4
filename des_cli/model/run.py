"""One reduced profile with everything that was computed on the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from des_cli.errors import NoSolutionError, NotReleasedError, Problem
from des_cli.model.machine import Joint
from des_cli.model.motion import DesiredMotion, Motion
from des_cli.model.profile import Profile
from des_cli.model.response import Response
from des_cli.model.solution import Solution


@dataclass(frozen=True, slots=True)
class Violation:
    """A joint limit that a motion breaks.

    Parameters
    ----------
    motion : {"desired", "modified"}
    joint : {"arm", "fork", "cab"}
    quantity : {"angle", "rate", "acceleration", "rate step"}
        A rate step is a jump of the rate at one sample: no acceleration limit
        admits it, and a finite difference across it would mean nothing.
    peak, limit : float
        Largest magnitude and the bound [rad, rad/s, rad/s^2; a step in rad/s].
    from_s, to_s : float
        First and last time at which the bound is broken [s].
    """

    motion: Literal["desired", "modified"]
    joint: Joint
    quantity: Literal["angle", "rate", "acceleration", "rate step"]
    peak: float
    limit: float
    from_s: float
    to_s: float

    def __str__(self) -> str:
        unit = {"angle": "rad", "acceleration": "rad/s^2"}.get(self.quantity, "rad/s")
        span = (
            f"at t = {self.from_s:g} s"
            if self.from_s == self.to_s
            else f"from t = {self.from_s:g} to {self.to_s:g} s"
        )
        return (
            f"{self.motion} {self.joint} {self.quantity} {self.peak:.4g} {unit} "
            f"exceeds the limit {self.limit:g} {unit} {span}"
        )


@dataclass(frozen=True, slots=True)
class Check:
    """One thing that the independent verification measured.

    Parameters
    ----------
    name : str
    value, tolerance : float
        The check holds where ``value <= tolerance``; a value that is not a
        number fails.
    """

    name: str
    value: float
    tolerance: float

    @property
    def ok(self) -> bool:
        """Whether the measured value is a number within the tolerance."""
        return self.value <= self.tolerance


@dataclass(frozen=True)
class Run:
    """A profile, its desired motion, the solution, and what both do to the seat.

    Parameters
    ----------
    profile : Profile
    asked : DesiredMotion
        What the profile asks for.
    desired : Motion
        The same, or the nearest motion inside the limits where these are enforced.
    solution : Solution
    before, after : Response
        Of the motion that the profile asks for, and of the modified one.
    checks : tuple of Check
        The independent verification.
    violations : tuple of Violation
        Limits that the desired or the modified motion breaks.
    metrics : dict
        The content of ``metrics.json``.
    notices : tuple of str
        One sentence each for the user's attention (a damped inverse, a
        component bought with another).
    """

    profile: Profile
    asked: DesiredMotion
    desired: Motion
    solution: Solution
    before: Response
    after: Response
    checks: tuple[Check, ...]
    violations: tuple[Violation, ...]
    metrics: dict[str, Any]
    notices: tuple[str, ...] = ()

    def require_release(self) -> None:
        """Raise unless this run may become a command table.

        Raises
        ------
        NoSolutionError
            If the solver did not converge.
        NotReleasedError
            If a verification check failed, or a limit under ``check`` or
            ``enforce``.
        """
        name = self.profile.name
        if not self.solution.usable:
            raise NoSolutionError(
                [Problem(name, f"{self.solution.status}: {self.solution.message}")]
            )
        problems = [
            Problem(
                name,
                f"verification failed: {check.name} is {check.value:.3g}, "
                f"tolerance {check.tolerance:.3g}",
            )
            for check in self.checks
            if not check.ok
        ]
        if self.profile.reduction.limits != "warn":
            problems += [
                Problem(name, str(violation))
                for violation in self.violations
                if violation.motion == "modified"
            ]
        if problems:
            raise NotReleasedError(problems)
