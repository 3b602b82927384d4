"""A filter: which trial points of a line search are worth having.

Waechter and Biegler (Mathematical Programming 106, 2006), section 2.3: a trial
must not be worse in both cost and violation than any point that the filter
remembers. Unlike a merit function it needs no weight between the two, which
would have to be large and would refuse good steps along curved constraints.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

ARMIJO = 1e-4
"""Share of the predicted decrease of the cost that a step must bring, as is usual (Nocedal and
Wright, Numerical Optimization, section 3.1): any step that is not far too long has it."""

MARGIN = 1e-5
"""Share of the violation by which a trial must be better than a point of the filter, gamma of
Waechter and Biegler: small, and enough that trials do not pile up in front of a point."""

STEEP, SMALL = 2.3, 1.1
"""Exponents of the predicted decrease and of the violation in the switching condition, s_phi
and s_theta of Waechter and Biegler, whose proof needs s_phi > 2 s_theta > 2."""

WORST_VIOLATION, SMALL_VIOLATION = 1e4, 1e-4
"""Violation that no trial may have, and that counts as small, relative to the first one or to
one: theta_max and theta_min of Waechter and Biegler."""


@dataclass(frozen=True)
class Trial:
    """What is weighed: total violation of the constraints, and cost of the barrier problem."""

    violation: float
    cost: float


class Filter:
    """The points that later trials must improve on.

    Parameters
    ----------
    violation : float
        Of the start.
    unit : float
        Size of a cost that counts, in the cost's unit.
    """

    def __init__(self, violation: float, unit: float) -> None:
        self.unit = unit
        self.worst = WORST_VIOLATION * max(1.0, violation)
        self.small = SMALL_VIOLATION * max(1.0, violation)
        self._points: list[Trial] = []

    def clear(self) -> None:
        """Forget everything: the costs of another barrier are no measure."""
        self._points = []

    def noise(self, current: Trial) -> float:
        """Return the difference of costs below which their rounding decides."""
        return 1e-13 * (abs(current.cost) + self.unit)

    def accepts(self, current: Trial, trial: Trial, length: float, slope: float) -> bool:
        """Return whether a trial is acceptable; remember what it was accepted from.

        Parameters
        ----------
        current, trial : Trial
            The present point, and the trial.
        length : float
            Of the step between them.
        slope : float
            Derivative of the cost along the step.
        """
        if not np.isfinite(trial.cost) or trial.violation > self.worst:
            return False
        if any(
            trial.violation >= (1.0 - MARGIN) * old.violation
            and trial.cost >= old.cost - MARGIN * old.violation
            for old in self._points
        ):
            return False
        noise = self.noise(current)
        steep = slope < 0.0 and length * (-slope / self.unit) ** STEEP > current.violation**SMALL
        if current.violation <= self.small and steep:
            return trial.cost <= current.cost + ARMIJO * length * slope + noise
        better = (
            trial.violation < (1.0 - MARGIN) * current.violation
            or trial.cost <= current.cost - MARGIN * current.violation + noise
        )
        if better:
            self._points.append(current)
        return better
