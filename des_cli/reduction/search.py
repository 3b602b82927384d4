"""One numbered log over all the minimisations of a solution, within one limit."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from des_cli.model.arrays import Floats
from des_cli.model.solution import Iteration
from des_cli.reduction.transcription import Transcription
from des_cli.solver.interior import Outcome, minimise

TOLERANCE = 1e-9
"""On the first-order conditions, relative to the largest dJ/du of the desired motion."""

COARSE = 1e-5
"""On the way to a solution."""

Report: TypeAlias = Callable[[Iteration], None]


class Search:
    """Minimisations that share a log.

    Parameters
    ----------
    limit : int
        Newton steps in all.
    report : callable, optional
        Called with each line of the log.
    """

    def __init__(self, limit: int, report: Report | None = None) -> None:
        self.lines: list[Iteration] = []
        self.limit, self.report = limit, report

    @property
    def left(self) -> int:
        """Newton steps that may still be taken."""
        return max(0, self.limit - len(self.lines))

    def minimise(
        self,
        grid: Transcription,
        x: Floats,
        tolerance: float,
        barrier: float = 1.0,
        most: int | None = None,
        prices: Floats | None = None,
    ) -> Outcome:
        """Minimise from a start and log it, within at most ``most`` steps."""
        outcome = minimise(
            grid,
            x,
            tolerance=tolerance,
            max_iterations=self.left if most is None else min(most, self.left),
            barrier=barrier,
            prices=prices,
            first_number=len(self.lines),
            on_iteration=self.report,
        )
        self.lines += outcome.log
        return outcome
