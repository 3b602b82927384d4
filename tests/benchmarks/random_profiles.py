"""Free motions of random maneuvers, against CasADi/IPOPT on the same final problem.

    python -m tests.benchmarks.random_profiles --count 1000 --seed 0
    python -m tests.benchmarks.random_profiles --count 1 --seed 17 --verbose

Each seed draws a smooth maneuver, jerk limits, what is kept at the ends, an objective and
one or two budgets (``random_task``). The tool solves it; IPOPT solves the discrete problem
that the tool solved last (its grid, its base motion, its budgets), from the base motion.
Where the tool's cost is above IPOPT's, IPOPT also starts from the tool's motion: if it stays
there, that is another local optimum, else the tool has not converged.
"""

from __future__ import annotations

import argparse
import math
import os
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any
from unittest import mock

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, JointLimits, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.model.profile import Ends, Objective, Reduction
from des_cli.reduction.fidelity import Deviation
from des_cli.reduction.free import method as free
from des_cli.reduction.free.task import FreeTask
from des_cli.reduction.limits import measure_peaks
from tests.support.bridge import check, peer_task
from tests.support.ipopt_spline import Answer, cpu_seconds, solve
from tests.support.random_problems import RANGES, random_budgets
from tests.support.spline_task import Task

ROWS = (101, 151)
"""Least and most rows of a table, of which each interval has a knot."""

DURATIONS_S = (3.0, 20.0)
JERKS_PER_S = (1.0, 2.0, 5.0, math.inf)
"""Jerk limits over acceleration limits, each as likely."""

ENDS: dict[Ends, float] = {
    "match-start": 0.55,
    "free": 0.15,
    "match-rates": 0.15,
    "match-both": 0.15,
}
OBJECTIVES: dict[Objective, float] = {"coriolis": 0.8, "blend": 0.15, "felt": 0.05}
ROUNDING = 1e-9
"""Relative excess over a limit or a budget that is none."""

AGREE = 1e-6
"""Largest excess over IPOPT's cost that counts as none; that of the desired motion is one."""


def random_motion(draw: np.random.Generator) -> Motion:
    """Return a smooth motion whose rates may step, of joints that may stand still."""
    duration = draw.uniform(*DURATIONS_S)
    t = np.linspace(0.0, duration, draw.integers(*ROWS, endpoint=True))
    angle, rate = np.zeros((len(t), 3)), np.zeros((2, len(t) - 1, 3))
    loudness = draw.uniform(0.2, 1.0)
    for j, (rise, speed) in enumerate(((0.3, 1.5), (0.8, 0.0), (0.8, 0.0))):
        if draw.random() < 0.1:
            angle[:, j] = draw.uniform(-1.0, 1.0)
            continue
        first = speed * draw.uniform(0.2, 1.0)
        angle[:, j] = draw.uniform(-0.5, 0.5) + first * t
        smooth = np.full(len(t), first)
        for wave in range(1, 4):
            w = 2.0 * math.pi * wave * draw.uniform(0.7, 1.3) / max(duration, 8.0)
            phase = draw.uniform(0.0, 2.0 * math.pi)
            size = loudness * rise * draw.normal() / wave**1.5
            angle[:, j] += size * np.sin(w * t + phase)
            smooth += size * w * np.cos(w * t + phase)
        rate[:, :, j] = smooth[:-1], smooth[1:]
        if draw.random() < 0.3:
            at, step = draw.integers(1, len(t) - 1), draw.uniform(-0.15, 0.15)
            angle[at:, j] += step * (t[at:] - t[at])
            rate[:, at:, j] += step
    return Motion(t, angle, rate[0], rate[1])


def random_task(seed: int) -> FreeTask:
    """Return a maneuver with limits and one or two budgets."""
    draw = np.random.default_rng(seed)
    motion = random_motion(draw)
    per_s = draw.choice(JERKS_PER_S)
    limits: Any = tuple(replace(limit, jerk=per_s * limit.acceleration) for limit in DES.limits)
    budget = random_budgets(draw, list(RANGES))
    ends = list(ENDS)[draw.choice(len(ENDS), p=list(ENDS.values()))]
    objective = list(OBJECTIVES)[draw.choice(len(OBJECTIVES), p=list(OBJECTIVES.values()))]
    reduction = Reduction(budget=budget, ends=ends, objective=objective)
    return FreeTask(replace(DES, limits=limits), Seat(), reduction, motion, limits)


@dataclass
class Record:
    """What the tool solved last: its problem, and how."""

    posed: list[tuple[FreeTask, Any]] = field(default_factory=list)
    last: tuple[Any, Any] | None = None

    def problem(self) -> tuple[FreeTask, Any]:
        """Return task and problem of the last minimisation, or of the last program."""
        if self.last is None:
            return self.posed[-1]
        return next(pair for pair in self.posed if pair[1] is self.last[0].problem)


@contextmanager
def recorded() -> Iterator[Record]:
    """Watch which problems the tool poses and minimises."""
    record, pose, minimise = Record(), free.pose_motion, free.minimise

    def posed(task: FreeTask, *rest: Any) -> Any:
        record.posed.append((task, pose(task, *rest)))
        return record.posed[-1][1]

    def minimised(program: Any, *rest: Any) -> Any:
        outcome = minimise(program, *rest)
        record.last = program, outcome
        return outcome

    with (
        mock.patch.object(free, "pose_motion", posed),
        mock.patch.object(free, "minimise", minimised),
    ):
        yield record


@dataclass(frozen=True)
class Case:
    """What became of one seed.

    Parameters
    ----------
    status : str
        The tool's.
    steps, last_steps : int
        Newton steps in all, and of the last minimisation.
    difference : float
        The tool's cost minus IPOPT's; NaN where either has none.
    from_there : float
        The tool's cost minus IPOPT's that started from the tool's motion.
    peer : str
        IPOPT's status.
    over_limits, over_budgets : float
        Relative excess of the modified table; negative inside.
    ours_s, peer_s : float
        CPU time.
    """

    seed: int
    task: FreeTask
    status: str
    message: str
    steps: int = 0
    last_steps: int = 0
    reduction: float = math.nan
    difference: float = math.nan
    from_there: float = math.nan
    peer: str = ""
    over_limits: float = math.nan
    over_budgets: float = math.nan
    ours_s: float = 0.0
    peer_s: float = 0.0

    @property
    def verdict(self) -> str:
        """One word on the case."""
        if self.status == "infeasible":
            return "refused although feasible" if self.peer == "feasible" else "refused"
        if self.status != "converged":
            return self.status
        if self.over_limits > ROUNDING:
            return "over a limit"
        if self.over_budgets > ROUNDING:
            return "over a budget"
        if not self.difference > AGREE:
            return "good"
        return "other optimum" if self.from_there <= AGREE else "not optimal"

    def __str__(self) -> str:
        r, motion = self.task.reduction, self.task.reference
        budgets = ", ".join(f"{b.metric} {b.most:.3g}" for b in r.budget)
        jerk = self.task.limits[0].jerk / self.task.limits[0].acceleration
        still = "".join(n[0] for j, n in enumerate(JOINTS) if not np.ptp(motion.angle[:, j]))
        return (
            f"seed {self.seed:5d}  {self.verdict:25s} "
            f"{self.difference:+.1e} ({self.from_there:+.1e})  "
            f"{self.steps:4d} steps, last {self.last_steps:3d}; {100 * self.reduction:5.1f} %; "
            f"{r.objective}, {r.ends}, jerk {jerk:g}/s, {motion.t[-1]:.1f} s, {budgets}"
            + (f", {still} still" if still else "")
            + (f"; {self.over_budgets:.1e} over" if self.over_budgets > ROUNDING else "")
            + (f"; IPOPT: {self.peer}" if self.peer not in ("", "Solve_Succeeded") else "")
            + (f"; {self.message}" if self.status != "converged" else "")
        )


def compare(seed: int) -> Case:
    """Solve one seed by both."""
    task = random_task(seed)
    began = cpu_seconds()
    with recorded() as record:
        result = free.find_free_motion(task)
    case = Case(seed, task, result.solution.status, result.solution.message)
    case = replace(case, steps=result.solution.iterations, ours_s=cpu_seconds() - began)
    if not record.posed:
        return case  # passed through, or no executable motion
    posed_task, problem = record.problem()
    peer = peer_task(posed_task, problem.grid, problem.base)
    if result.solution.status == "infeasible" or record.last is None:
        return replace(case, peer="feasible" if solve(peer).success else "infeasible too")
    began = cpu_seconds()
    answer = solve(peer)
    case = replace(case, peer=answer.status, peer_s=cpu_seconds() - began)
    program, outcome = record.last
    points = problem.base + program.control(outcome.x)
    cost = check(peer, points).cost
    difference, from_there = _difference(cost, answer), math.nan
    if difference > AGREE:
        from_there = _difference(cost, _from(peer, points))
    limits, budgets = _excess(task, result.solution.modified)
    return replace(
        case,
        last_steps=len(outcome.steps) - 1,
        reduction=1.0 - result.solution.cost / result.solution.cost_unreduced,
        difference=difference,
        from_there=from_there,
        over_limits=limits,
        over_budgets=budgets,
    )


def _difference(cost: float, answer: Answer) -> float:
    return cost - answer.cost if answer.success else math.nan


def _from(peer: Task, points: Floats) -> Answer:
    """Return what IPOPT makes of a motion that is nearly optimal."""
    near = {"mu_init": 1e-8, "bound_push": 1e-9, "bound_frac": 1e-9, "warm_start_init_point": "yes"}
    return solve(peer, points, options=near)


def _excess(task: FreeTask, modified: Motion) -> tuple[float, float]:
    """Return the largest relative excess of a table over a limit and over a budget."""
    peaks = measure_peaks(modified)
    over = [
        float(np.max(getattr(peaks, name) / _limit(task.limits, name))) - 1.0
        for name in ("angle", "rate", "acceleration", "jerk")
    ]
    chains = (task.chain, task.chain)
    deviation = Deviation.between(task.reference, modified, chains, task.machine.gravity)
    spent = [deviation.value(b.metric) / b.most - 1.0 for b in task.reduction.budget]
    return max(over), max(spent)


def _limit(limits: tuple[JointLimits, ...], name: str) -> Floats:
    return np.array([getattr(limit, name) for limit in limits])


def report(cases: list[Case], say: Callable[[str], None] = print) -> None:
    """Print what the cases have in common."""
    verdicts = Counter(case.verdict for case in cases)
    solved = [case for case in cases if case.status == "converged" and case.last_steps]
    say(f"\n{len(cases)} profiles: " + ", ".join(f"{n} {v}" for v, n in verdicts.most_common()))
    if not solved:
        return
    for name, steps in (
        ("of the last minimisation", [case.last_steps for case in solved]),
        ("in all", [case.steps for case in solved]),
    ):
        middle, high, most = np.percentile(steps, [50, 95, 100])
        say(f"Newton steps {name}: median {middle:.0f}, 95 % {high:.0f}, most {most:.0f}")
    compared = [case.difference for case in solved if not math.isnan(case.difference)]
    within = sum(d <= AGREE for d in compared)
    below = sum(d < -AGREE for d in compared)
    share = 100.0 * within / max(len(compared), 1)
    say(
        f"of {len(compared)} that IPOPT solved too, {within} ({share:.1f} %) "
        f"have at most {AGREE:g} more than its cost, {below} have more than {AGREE:g} less"
    )
    say(
        f"largest excess over a limit {max(case.over_limits for case in solved):.1e}, "
        f"over a budget {max(case.over_budgets for case in solved):.1e}"
    )
    for metric in RANGES:
        of = [case for case in cases if metric in {b.metric for b in case.task.reduction.budget}]
        if of:
            bad = Counter(case.verdict for case in of if case.verdict not in ("good", "refused"))
            say(
                f"{metric}: {len(of)} profiles, {np.median([case.steps for case in of]):.0f} steps "
                f"in all (median); " + (", ".join(f"{n} {v}" for v, n in bad.items()) or "all good")
            )
    ours, peer = (sum(getattr(case, name) for case in cases) for name in ("ours_s", "peer_s"))
    say(f"CPU time {ours:.1f} s (with all its grids and starts), IPOPT {peer:.1f} s")


def main() -> None:
    """Compare and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0, help="first seed")
    parser.add_argument("--slow", type=int, default=100, help="steps in all from which to list")
    parser.add_argument("--verbose", action="store_true", help="list every seed")
    options = parser.parse_args()
    cases = []
    for seed in range(options.seed, options.seed + options.count):
        case = compare(seed)
        cases.append(case)
        if options.verbose or case.verdict != "good" or case.steps >= options.slow:
            print(case, flush=True)
    report(cases)


if __name__ == "__main__":
    main()
