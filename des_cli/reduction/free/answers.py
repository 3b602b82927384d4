"""What a search for a free motion ends with: a solution, or why there is none."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.coriolis_along import weighted_square
from des_cli.kinematics.response import respond_on
from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat
from des_cli.model.metric import METRICS, PEAK_METRICS, Budget, MetricKey
from des_cli.model.motion import Motion, Record
from des_cli.model.profile import Axes
from des_cli.model.solution import Iteration, Solution, Status
from des_cli.reduction.change import Change
from des_cli.reduction.executable import ExecutableSpline, sample_spline
from des_cli.reduction.free.pose import in_ground_axes
from des_cli.reduction.free.program import MotionProgram
from des_cli.reduction.free.task import FreeTask
from des_cli.reduction.limits import find_occupant_violations
from des_cli.solver.barrier import Outcome, Step
from des_cli.units import percent

ACCEPTABLE = 1e-4
"""Complementarity at which a search that did not converge is good enough to be used: its
cost is within this of a minimum's."""

MOVING = 1e-6
"""Rate relative to its largest below which a factor on it means nothing."""


@dataclass(frozen=True)
class FreeResult:
    """A free motion, and what it started from.

    Parameters
    ----------
    desired : Motion
        The executable motion nearest to the reference.
    solution : Solution
    seat : Seat
        As fixed in the modified motion.
    budgets : tuple of Budget
    held : Record
        What the budgets were kept against.
    """

    desired: Motion
    solution: Solution
    seat: Seat
    budgets: tuple[Budget, ...]
    held: Record


@dataclass
class StepLog:
    """One numbered log over all minimisations of a solution, within one limit."""

    limit: int
    report: Callable[[Iteration], None] | None
    lines: list[Iteration] = field(default_factory=list)

    @property
    def left(self) -> int:
        """Steps that may still be taken."""
        return max(0, self.limit - len(self.lines))

    def __call__(self, step: Step) -> None:
        """Add a step of a minimisation."""
        line = Iteration(len(self.lines), step.cost, 0.0, step.optimality, step.length)
        self.lines.append(line)
        if self.report is not None:
            self.report(line)


class Answers:
    """Solutions of one task.

    Parameters
    ----------
    task : FreeTask
    log : StepLog
    """

    def __init__(self, task: FreeTask, log: StepLog) -> None:
        self.task, self.log = task, log
        self.budgets = task.reduction.budget
        self._rows = len(task.reference.t)

    def found(self, outcome: Outcome, modified: Motion, desired: Motion, seat: Seat) -> FreeResult:
        """Return where a search ended."""
        status, message = self._verdict(outcome)
        return self._result(status, message, modified, desired, seat, outcome.optimality)

    def passed_through(self, desired: Motion) -> FreeResult:
        """Return the executable motion of a profile that makes no cross-coupling."""
        message = "the desired motion makes no cross-coupling: it is passed through"
        return self._result("converged", message, desired, desired, self.task.seat, 0.0)

    def refused(self, desired: Motion, why: str, status: Status = "infeasible") -> FreeResult:
        """Return that there is no motion to be found, or to be looked for."""
        solution = Solution.refused(
            status,
            why,
            desired,
            controls=3 if self._tied else 0,
            costates=0,
            log=tuple(self.log.lines),
        )
        return FreeResult(desired, solution, self.task.seat, self.budgets, self.task.held)

    def _result(
        self,
        status: Status,
        message: str,
        modified: Motion,
        desired: Motion,
        seat: Seat,
        optimality: float,
    ) -> FreeResult:
        solution = Solution(
            status=status,
            message=message,
            control=self._factors(modified, desired),
            modified=modified,
            adjoint=np.zeros((self._rows, 0)),
            cost=self._cost(modified, seat),
            cost_unreduced=self._cost(self.task.recorded.motion, self.task.seat),
            optimality=optimality,
            iterations=len(self.log.lines),
            log=tuple(self.log.lines),
        )
        return FreeResult(desired, solution, seat, self.budgets, self.task.held)

    def _verdict(self, outcome: Outcome) -> tuple[Status, str]:
        steps = f"{len(self.log.lines)} steps in all"
        if outcome.status == "converged":
            return "converged", f"first-order optimal to {outcome.optimality:.1e}, {steps}"
        off = (
            f"the first-order conditions are off by {outcome.optimality:.1e}, "
            f"the gap is {outcome.gap:.1e}"
        )
        if outcome.gap <= ACCEPTABLE:
            return "acceptable", f"not quite optimal: {off}; {steps}"
        if outcome.status == "iteration-limit":
            limit = self.log.limit
            return "iteration-limit", f"{off} after {steps}; raise max_iterations ({limit})"
        return "diverged", f"no step makes it better although {off}; {steps}"

    @property
    def _tied(self) -> bool:
        """Whether the motion has factors on the desired rates, one a joint."""
        return self.task.reduction.control == "per-joint"

    def _factors(self, modified: Motion, desired: Motion) -> Floats:
        """Return the factors on the desired rates that a tied motion has, one a joint."""
        if not self._tied:
            return np.zeros((self._rows, 0))
        moving = np.abs(desired.rate) > MOVING * np.max(np.abs(desired.rate), axis=0)
        return np.divide(modified.rate, desired.rate, out=np.ones_like(desired.rate), where=moving)

    def _cost(self, motion: Motion, seat: Seat) -> float:
        """Return J = 1/2 int c' R1 c dt of a motion as its table plays it."""
        chain = chain_of(self.task.machine, seat)
        axes: Axes = "report" if in_ground_axes(self.task.reduction) else "seat"
        return 0.5 * weighted_square(chain, motion, axes, self.task.reduction.r1)

    def unkept(self, spent: Mapping[MetricKey, float], beyond: float) -> str:
        """Say what the motion keeps and its table does not, which is straight between samples."""
        over = [
            f"{METRICS[metric].label} by {percent(share - 1.0, 2)}"
            for metric, share in spent.items()
            if share > 1.0
        ]
        if beyond > 0.0:
            over.append(f"a bound on what the occupant gets by {percent(beyond, 2)}")
        return (
            f"no table with a step of {self.task.reference.step.max():.3g} s was found within the "
            f"budgets, the nearest exceeds {' and '.join(over) or 'them barely'}; "
            "sample the profile finer, or allow more"
        )

    def unreachable(self, program: MotionProgram, fit: ExecutableSpline) -> str:
        """Say which budgets the limits alone exceed, or which bounds."""
        task = self.task
        values = program.values(np.zeros(program.size))
        budgets = [b for b in task.reduction.budget if b.metric not in PEAK_METRICS]
        over = [
            f"{METRICS[b.metric].label} {np.sqrt(value) * b.most:.3g} instead of {b.most:.3g}"
            for b, value in zip(budgets, values.budgets, strict=True)
            if value >= 1.0
        ]
        if over and task.reduction.limits != "enforce":
            return (
                "no smooth motion comes nearer to the steps of what the profile asks for than "
                f"{', '.join(over)}; smooth it, or allow more"
            )
        if over:
            change = Change.between(
                task.recorded,
                Record(sample_spline(fit, task.reference.t)),
                task.chain,
                task.machine.gravity,
            )
            allow = f"--allow-change {change.enough:g}"
            return (
                "conditioning and the machine's limits alone cost more than the budgets allow: "
                f"{', '.join(over)}; smooth the motion, allow more, or let {allow} make the "
                "budgets those of what is added"
            )
        desired = sample_spline(fit, task.reference.t)
        response = respond_on(task.chain, task.machine.gravity, desired)
        broken = find_occupant_violations(task.machine, task.seat, response, desired, "desired")
        return (
            f"{'; '.join(str(violation) for violation in broken) or 'a budget is exceeded'}: no "
            "motion within the budgets was found that keeps it"
        )
