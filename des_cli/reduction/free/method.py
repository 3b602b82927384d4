"""The free motion with the least cross-coupling inside limits and budgets.

The joints move freely: a spline of each, from an executable motion near the desired one
to the optimum, every iterate inside the limits and within the budgets.

A budget on what is felt makes a problem with one optimum. Budgets on joint angles or on
G alone leave fast motions free that neither sees: the optimum chatters, and there are
several. Such a problem is solved on a coarse grid first, from three starts (the executable
motion, down from budgets many times as large, and through budgets on the seat's rate), and
then refined.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.seat_turn import seat_turns
from des_cli.kinematics.twist import seat_forms
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, Seat
from des_cli.model.metric import PEAK_METRICS, SEAT_RATE_DEVIATION, Budget, MetricKey
from des_cli.model.motion import Motion, Record
from des_cli.model.profile import Reduction
from des_cli.model.solution import Iteration
from des_cli.model.stage import OnStage, untold
from des_cli.reduction.change import UNSPENT, Change
from des_cli.reduction.executable import (
    ExecutableSpline,
    fit_for_table,
    knot_grid,
    sample_spline,
)
from des_cli.reduction.fidelity import Deviation
from des_cli.reduction.free.answers import Answers, FreeResult, StepLog
from des_cli.reduction.free.inside import find_inside, is_inside
from des_cli.reduction.free.limit_rows import Tie
from des_cli.reduction.free.pose import cross_coupling, pose_motion
from des_cli.reduction.free.program import MotionProgram
from des_cli.reduction.free.task import SEAT_ANGLES, FreeTask, turned_seat
from des_cli.reduction.free.ties import tie_reversals
from des_cli.reduction.limits import (
    find_occupant_violations,
    find_violations,
    steps_too_short,
)
from des_cli.reduction.problem import FAINT
from des_cli.solver.barrier import Options, Outcome, minimise
from des_cli.solver.spline import SplineGrid

WELL_POSED: MetricKey = SEAT_RATE_DEVIATION
"""The metric that sees fast motions of every joint, so that a budget on it leaves one
optimum."""

MOST_ROUNDING = 1.0
"""Share of a jerk limit that rounding may make: beyond it no row can keep the limit."""

FEW = 250
"""Intervals from which an ill-posed problem is solved on a coarser grid first, and the most
that this has."""

FINER = 2
"""Knots of an ill-posed problem beside those of another: its optimum is of fast motions."""

DOWN = (16.0, 8.0, 4.0, 2.0, 1.0)
"""Multiples of the budgets that the second start of an ill-posed problem comes down by."""

SEAT_RATES = (0.1, 0.4, None)
"""Budgets on the seat's rate beside the others through which the third start goes."""

GAP, TOLERANCE = 1e-7, 1e-6
"""Where a minimisation ends: complementarity, relative to the desired cross-coupling, and
first-order conditions, relative to the gradients at its start."""

ROUGH_GAP = 1e-3
"""Where it ends on a coarser grid: far enough inside to be inside on a finer one too."""

START_GAP, WARM_GAP = 3.0, 1e-2
"""Complementarity that a search begins with, from far away and near the optimum."""

ROOM = 1e-4
"""Share of each budget that is left to the table, which is a little other than the spline."""

PEAK_ROOM = 2e-3
"""The same of a budget on a peak, which the spline may have between the points at which it is
bounded, and a table at its rows."""

SETTLINGS, GENEROUS = 10, 4
"""Solutions with adapted budgets until the table keeps them, and after how many of them
a table need not spend them any more."""

TOUCHING = 1.0 - 1e-9
"""Share of a budget that a table may spend."""

G_COMPONENTS = ("Gx", "Gy", "Gz")

LEAST_ROOM = 1e-4
"""Share of a bound on what the occupant gets that is left once the table went beyond it."""

AGAIN = 0.2
"""Share by which more room is left to a bound than the table went beyond it."""

LEFT, BINDING = 0.999, 0.9
"""Share of the budget that binds which a table should spend, at least, and below which no
budget binds."""


def find_free_motion(
    task: FreeTask,
    report: Callable[[Iteration], None] | None = None,
    on_stage: OnStage = untold,
) -> FreeResult:
    """Find the motion with the least cost inside limits and budgets.

    Parameters
    ----------
    task : FreeTask
    report : callable, optional
        Called with each line of the solver's log.
    on_stage : callable, optional
        Called with what is done next.

    Returns
    -------
    FreeResult
        Its solution is ``infeasible`` where no executable motion keeps the budgets, and
        passed through where the desired motion makes no cross-coupling.
    """
    search = _Search(task, StepLog(task.reduction.max_iterations, report), on_stage)
    return search.run()


class _Search:
    """The search for one task: its grids, its starts, and the budgets of its table."""

    def __init__(self, task: FreeTask, log: StepLog, on_stage: OnStage) -> None:
        self.task, self.log, self.on_stage = task, log, on_stage
        self.answers = Answers(task, log)
        self.t = task.reference.t
        self.warm = False
        self.well_posed = any(b.metric == WELL_POSED for b in task.reduction.budget)

    def run(self) -> FreeResult:
        if not seat_forms(self.task.chain, self.task.machine.gravity).vertical:
            why = "free joints need an arm that turns about the vertical; take --control scalar"
            return self.answers.refused(self.task.reference, why)
        fixed = {name for name in self.task.reduction.optimise if name in SEAT_ANGLES}
        if missing := sorted(fixed - set(seat_turns(self.task.machine, self.task.seat))):
            why = f"the machine has no {' and no '.join(missing)} beyond its cab to be found"
            return self.answers.refused(self.task.reference, why)
        if self.task.reduction.limits == "enforce" and (
            trouble := steps_too_short(self.task.machine, self.task.reference, MOST_ROUNDING)
        ):
            return self.answers.refused(self.task.reference, trouble)
        *coarse, finest = (self._fit(grid) for grid in self._grids())
        desired = self._desired(finest)
        if finest.trouble:
            return self.answers.refused(desired, finest.trouble)
        change = self._change(desired)
        if refusal := change.refusal(self.task.reduction):
            return self.answers.refused(desired, refusal, "changed")
        if self.task.reduction.allow_change is not None and not change.nothing:
            desired = sample_spline(finest, self.t)
            self.task = self.task.around(desired)
            self.answers = Answers(self.task, self.log)
        fits = [*(fit for fit in coarse if not fit.trouble), finest]
        energy = cross_coupling(self.task, finest.grid)
        if energy <= FAINT * finest.grid.duration:
            return self.answers.passed_through(desired)
        budgets = tuple(
            replace(b, most=b.most * (1.0 - (PEAK_ROOM if b.metric in PEAK_METRICS else ROOM)))
            for b in self.task.reduction.budget
        )
        outcome: Outcome | None = None
        x = start = np.zeros(0)
        for level, fit in enumerate(fits):
            self.on_stage(f"grid {level + 1} of {len(fits)}")
            last = level == len(fits) - 1
            level_budgets = budgets if last else _drawn_in(budgets)
            program = self._program(fit, level_budgets)
            if outcome is None:
                started = self._start(program, fit, level_budgets)
                if isinstance(started, str):
                    return self.answers.refused(desired, started)
                x, warm = started
            else:
                x, warm = _refined(fits[level - 1], fit, x), True
                inside = find_inside(program, x, self.log)
                if inside is None:
                    x, warm = np.zeros(program.size), False
                    inside = find_inside(program, x, self.log)
                if inside is None:
                    return self.answers.refused(desired, self.answers.unreachable(program, fit))
                warm = warm and inside is x
                x = inside
            start, self.warm = x, warm
            outcome = self._minimise(program, x, rough=not last, warm=warm)
            x = outcome.x
        assert outcome is not None
        return self._settled(finest, desired, budgets, outcome, start)

    def _desired(self, fit: ExecutableSpline) -> Motion:
        """Return what the motion begins from, or its executable replacement if it needs one."""
        enforced = self.task.reduction.limits == "enforce"
        if not enforced or not find_violations(self.task.machine, self.task.reference, "desired"):
            return self.task.reference
        return sample_spline(fit, self.t)

    def _change(self, desired: Motion) -> Change:
        """Measure what was changed of the record already."""
        task = self.task
        return Change.between(task.recorded, Record(desired), task.chain, task.machine.gravity)

    def _grids(self) -> list[SplineGrid]:
        """Return the grids to solve on, the last one that of the result."""
        if self.well_posed:
            return [knot_grid(self.t)]
        natural = knot_grid(self.t, finer=FINER).intervals
        doublings = max(0, int(np.ceil(np.log2(natural / FEW))))
        finest = knot_grid(self.t, 2**doublings, finer=FINER)
        return [
            SplineGrid(finest.start, finest.step * each, finest.intervals // each)
            for each in (2**d for d in range(doublings, -1, -1))
        ]

    def _fit(self, grid: SplineGrid) -> ExecutableSpline:
        task = self.task
        fit, limits = fit_for_table(grid, self.t, task.reference, task.base_limits, task.base_ends)
        self.task = replace(task, limits=limits)
        return fit

    def _program(self, fit: ExecutableSpline, budgets: Sequence[Budget]) -> MotionProgram:
        ties: tuple[Tie, ...] = ()
        if self.task.reduction.control == "per-joint":
            ties = tie_reversals(fit.grid, fit.control)
        task = self._with_budgets(budgets)
        return MotionProgram(pose_motion(task, fit.grid, fit.control, ties))

    def _with_budgets(self, budgets: Sequence[Budget]) -> FreeTask:
        reduction: Reduction = replace(self.task.reduction, budget=tuple(budgets))
        return replace(self.task, reduction=reduction)

    def _start(
        self,
        program: MotionProgram,
        fit: ExecutableSpline,
        budgets: Sequence[Budget],
    ) -> tuple[Floats, bool] | str:
        """Return where to begin and whether that is near the optimum, or why nowhere."""
        inside = find_inside(program, np.zeros(program.size), self.log)
        if inside is None:
            return self.answers.unreachable(program, fit)
        if self.well_posed:
            return inside, False
        found = [
            self._minimise(program, inside, rough=True, warm=False),
            self._from_above(fit, budgets),
            self._by_seat_rate(fit, budgets, inside),
        ]
        best = min((each for each in found if each), key=lambda each: each.values.cost)
        return best.x, True

    def _by_seat_rate(
        self, fit: ExecutableSpline, budgets: Sequence[Budget], x: Floats
    ) -> Outcome | None:
        """Return the solution that is reached through ever looser budgets on the seat's rate."""
        outcome: Outcome | None = None
        for most in SEAT_RATES:
            further = [] if most is None else [Budget(WELL_POSED, most)]
            program = self._program(fit, [*budgets, *further])
            inside = find_inside(program, x, self.log)
            if inside is None:
                return None
            outcome = self._minimise(program, inside, rough=True, warm=False)
            x = outcome.x
        return outcome

    def _from_above(self, fit: ExecutableSpline, budgets: Sequence[Budget]) -> Outcome | None:
        """Return the solution that is reached from budgets many times as large."""
        outcome: Outcome | None = None
        for multiple in DOWN:
            looser = [replace(b, most=_looser(b, multiple)) for b in budgets]
            program = self._program(fit, looser)
            x = np.zeros(program.size) if outcome is None else outcome.x
            inside = find_inside(program, x, self.log)
            if inside is None:
                return None
            outcome = self._minimise(program, inside, rough=True, warm=False)
        return outcome

    def _minimise(self, program: MotionProgram, x: Floats, *, rough: bool, warm: bool) -> Outcome:
        """Minimise; where a warm start leads nowhere, begin far from all bounds instead."""
        most = ROUGH_STEPS if rough else STEPS
        outcome: Outcome | None = None
        for start_gap in (WARM_GAP, START_GAP) if warm else (START_GAP,):
            options = Options(
                gap=ROUGH_GAP if rough else GAP,
                tolerance=TOLERANCE,
                start_gap=start_gap,
                halfway=WARM_GAP,
                max_iterations=min(most, self.log.left),
            )
            found = minimise(program, x, options, self.log)
            if outcome is None or found.values.cost < outcome.values.cost:
                outcome = found
            if found.status == "converged":
                return found
        assert outcome is not None
        return outcome

    def _settled(
        self,
        fit: ExecutableSpline,
        desired: Motion,
        budgets: Sequence[Budget],
        outcome: Outcome,
        start: Floats,
    ) -> FreeResult:
        """Adapt the budgets of the spline until its table spends what is allowed."""
        allowed = {b.metric: b.most for b in self.task.reduction.budget}
        best: FreeResult | None = None
        for attempt in range(SETTLINGS):
            self.on_stage("settling the table" + f", attempt {attempt + 1}" * (attempt > 0))
            program = self._program(fit, budgets)
            modified, seat = self._table(program, fit, outcome.x, desired)
            deviation = Deviation.between(
                self.task.reference,
                modified,
                (self.task.chain, chain_of(self.task.machine, seat)),
                self.task.machine.gravity,
                shortfall=self.task.shortfall,
            )
            spent = {m: deviation.value(m) / most for m, most in allowed.items()}
            for metric, share in self._spent_of_record(modified, seat).items():
                spent[metric] = max(spent[metric], share)
            worst = max(spent.values(), default=TOUCHING)
            beyond = self._beyond(deviation, modified, seat)
            spends = worst >= LEFT or worst < BINDING or attempt >= GENEROUS
            kept = worst <= TOUCHING and not beyond
            if kept or (best is None and outcome.status != "converged"):
                best = self.answers.found(outcome, modified, desired, seat)
            if (kept and spends) or attempt == SETTLINGS - 1:
                break
            if beyond:
                room = self.task.room + (1.0 + AGAIN) * beyond
                self.task = replace(self.task, room=room)
            factor = {m: (1.0 - 0.5 * ROOM) / max(share, BINDING) for m, share in spent.items()}
            if worst <= TOUCHING:  # a budget that is not the binding one stays
                factor = {m: f if spent[m] == worst else 1.0 for m, f in factor.items()}
            else:  # the table follows the spline with a delay: ask for a little more each time
                over = {m: (1.0 + attempt * AGAIN) * (1.0 - f) for m, f in factor.items()}
                factor = {m: 1.0 - max(each, 0.0) for m, each in over.items()}
            budgets = [replace(b, most=b.most * factor[b.metric]) for b in budgets]
            program = self._program(fit, budgets)
            # from halfway, or from the start: at the end hundreds of limits have no room
            inside, warm = outcome.halfway, True
            if not is_inside(program, inside):
                found, warm = find_inside(program, start, self.log), self.warm
                if found is None:
                    break
                inside = found
            outcome = self._minimise(program, inside, rough=False, warm=warm)
        return best or self.answers.refused(desired, self.answers.unkept(spent, beyond))

    def _spent_of_record(self, modified: Motion, seat: Seat) -> dict[MetricKey, float]:
        """Return what of the budgets against the record the whole way from it spends."""
        task = self.task
        if not task.most:
            return {}
        deviation = Deviation.between(
            task.recorded.motion,
            modified,
            (task.chain, chain_of(task.machine, seat)),
            task.machine.gravity,
            shortfall=task.recorded.shortfall,
        )
        return {
            budget.metric: deviation.value(budget.metric) / budget.most
            for budget in task.most
            if budget.metric not in UNSPENT
        }

    def _beyond(self, deviation: Deviation, modified: Motion, seat: Seat) -> float:
        """Return by how much the table exceeds a bound on what the occupant gets, relative."""
        if self.task.reduction.limits != "enforce":
            return 0.0
        broken = find_occupant_violations(
            self.task.machine, seat, deviation.after, modified, "modified"
        )
        # components of G are bounded relative to 1 g at least, magnitudes to themselves
        sizes = (max(abs(v.limit), float(v.quantity in G_COMPONENTS)) for v in broken)
        excesses = [abs(v.peak - v.limit) / size for v, size in zip(broken, sizes, strict=True)]
        return max(*excesses, LEAST_ROOM) if excesses else 0.0

    def _table(
        self, program: MotionProgram, fit: ExecutableSpline, x: Floats, desired: Motion
    ) -> tuple[Motion, Seat]:
        """Return the motion of the table; a joint that is held plays the desired one's rows."""
        spline = ExecutableSpline(fit.grid, fit.control + program.control(x))
        seat = self.task.seat
        if program.free_angles:
            seat = turned_seat(self.task, program.seat_angles(x))
        held = [joint for joint, name in enumerate(JOINTS) if name in self.task.reduction.hold]
        return sample_spline(spline, self.t).with_joints(held, desired), seat


ROUGH_STEPS, STEPS = 120, 500
"""Newton steps of one minimisation on the way, and at the end, at the most: a problem that
has one optimum takes twenty."""

COARSE_ROOM = 1e-2
"""Share of a bound at points that a coarse grid leaves to the finer ones."""

MOST_SHARE = 1e3
"""Largest budget that the way down from above starts with."""


def _drawn_in(budgets: Sequence[Budget]) -> list[Budget]:
    """Return budgets for a coarse grid, whose points see less of a largest value."""
    return [
        replace(b, most=b.most * (1.0 - COARSE_ROOM)) if b.metric in PEAK_METRICS else b
        for b in budgets
    ]


def _looser(budget: Budget, multiple: float) -> float:
    return min(budget.most * multiple, max(budget.most, MOST_SHARE))


def _refined(coarse: ExecutableSpline, fine: ExecutableSpline, x: Floats) -> Floats:
    """Return a coarse solution on a fine grid, as a deviation from the fine base."""
    size = coarse.control.size
    grid, control = coarse.grid, coarse.control + x[:size].reshape(coarse.control.shape)
    while grid.intervals < fine.grid.intervals:
        grid, control = grid.refined(control)
    return np.concatenate([(control - fine.control).reshape(-1), x[size:]])
