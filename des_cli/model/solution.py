"""What a solver hands over: the modified motion and how it was found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from des_cli.model.arrays import Floats, freeze
from des_cli.model.motion import Motion

Status: TypeAlias = Literal[
    "converged",
    "acceptable",
    "iteration-limit",
    "diverged",
    "infeasible",
    "changed",
    "invalid-input",
]
"""How a solution ended; ``changed`` is one that was not looked for, because the record had
been changed by more than is allowed."""


@dataclass(frozen=True, slots=True)
class Iteration:
    """One line of a solver's log.

    Parameters
    ----------
    number : int
    cost : float
        J at this iterate.
    infeasibility : float
        Largest violation of a constraint.
    optimality : float
        Largest violation of the first-order conditions, scaled.
    step : float
        Length of the line search's step, 0 to 1.
    """

    number: int
    cost: float
    infeasibility: float
    optimality: float
    step: float


@dataclass(frozen=True)
class Solution:
    """A solver's result; not converging is a status here, not an exception.

    Parameters
    ----------
    status : str
    message : str
        One sentence for a person.
    control : (n, m) array
        The factor p at each sample (m = 1), or one per joint (m = 3); a free motion
        has none (m = 0).
    modified : Motion
    adjoint : (n, m) array
        Costate of the joint angles at each sample (m = 3); of a free motion, whose
        dynamics are eliminated, there is none (m = 0).
    cost, cost_unreduced : float
        J of this solution, and of the desired motion (p = 1).
    optimality : float
        Largest violation of the first-order conditions, scaled.
    iterations : int
    log : tuple of Iteration
    """

    status: Status
    message: str
    control: Floats
    modified: Motion
    adjoint: Floats
    cost: float
    cost_unreduced: float
    optimality: float
    iterations: int
    log: tuple[Iteration, ...] = ()

    def __post_init__(self) -> None:
        n = len(self.modified.t)
        freeze(self, "control", (n, None))
        freeze(self, "adjoint", (n, None))

    @classmethod
    def refused(
        cls,
        status: Status,
        message: str,
        desired: Motion,
        *,
        controls: int,
        costates: int,
        log: tuple[Iteration, ...] = (),
    ) -> Solution:
        """Return what stands where a solution cannot be, or is not looked for.

        The motion is the desired one, its factors are one, and nothing has a cost.

        Parameters
        ----------
        status : str
        message : str
            Why.
        desired : Motion
        controls, costates : int
            Columns of ``control`` and ``adjoint``.
        log : tuple of Iteration
            Of what was tried before.
        """
        n, nan = len(desired.t), float("nan")
        return cls(
            status=status,
            message=message,
            control=np.ones((n, controls)),
            modified=desired,
            adjoint=np.zeros((n, costates)),
            cost=nan,
            cost_unreduced=nan,
            optimality=nan,
            iterations=len(log),
            log=log,
        )

    @property
    def usable(self) -> bool:
        """Whether the solution may be released if its checks hold."""
        return self.status in ("converged", "acceptable")

    @property
    def converged(self) -> bool:
        """Whether the solution is optimal to the solver's tolerance."""
        return self.status == "converged"
