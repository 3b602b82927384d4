"""CPU time of a free motion beside CasADi/IPOPT on the identical discrete problem.

    python -m tests.benchmarks.free_control                     # the table of peers
    python -m tests.benchmarks.free_control growth              # the tool alone, longer
    python -m tests.benchmarks.free_control command             # `des-coriolis reduce cobra`

The Cobra, repeated for more than 500 intervals of 0.02 s: seat G within 0.05 g and seat rate
within 10 %, the DES's limits with a jerk limit of 2/s, angles and rates of the start kept.
All begin from the same executable motion, whose fit counts for nobody; posing the problem
and building its derivatives counts. One process, one thread; medians.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np

from des_cli import load_profile
from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion
from des_cli.model.profile import Reduction
from des_cli.profiles_in.builtin import builtin_profile
from des_cli.reduction.executable import fit_executable
from des_cli.reduction.free.inside import find_inside
from des_cli.reduction.free.limit_rows import LimitRows
from des_cli.reduction.free.method import GAP, TOLERANCE, find_free_motion
from des_cli.reduction.free.pose import MARGIN, pose_motion
from des_cli.reduction.free.program import MotionProgram
from des_cli.reduction.free.task import FreeTask
from des_cli.solver.barrier import Options, minimise
from des_cli.solver.spline import SplineGrid
from tests.support.bridge import peer_task
from tests.support.ipopt_plain import solve_plainly
from tests.support.ipopt_spline import cpu_seconds, solve

STEP_S = 0.02
PEERS = (250, 500, 2000, 10000)
ALONE = (40000, 100000)
BUDGETS = (Budget("seat_g_rms_error_g", 0.05), Budget("seat_rate_deviation_relative", 0.1))


@dataclass(frozen=True)
class Timing:
    """CPU time of one solution, with its building [s], Newton steps, and cost."""

    cpu_s: float
    steps: int
    cost: float
    converged: bool


def repeated_cobra(intervals: int) -> Motion:
    """Return so many intervals of the Cobra, flown again and again; two rows an interval."""
    once = make_desired(load_profile("cobra")).motion
    step = float(once.step[0])
    rows = round(intervals * STEP_S / step)
    at = np.arange(rows) % len(once.step)
    start, end = once.rate_start[at], once.rate_end[at]
    gained = np.vstack([np.zeros(3), np.cumsum(0.5 * step * (start + end), axis=0)])
    return Motion(step * np.arange(rows + 1), once.angle[0] + gained, start, end)


def task_of(intervals: int) -> FreeTask:
    """Return the problem of the module's docstring."""
    reduction = Reduction(budget=BUDGETS, ends="match-start")
    motion = repeated_cobra(intervals)
    return FreeTask(DES, Seat(), reduction, motion, DES.limits)


class Case:
    """One length, and the executable motion that all begin from."""

    def __init__(self, intervals: int) -> None:
        self.task = task_of(intervals)
        self.grid = SplineGrid(0.0, STEP_S, intervals)
        fit = fit_executable(self.grid, self.task.reference, DES.limits, self.task.base_ends)
        self.base: Floats = fit.control
        rows = LimitRows(self.grid, self.base, DES.limits, self.task.ends, MARGIN)
        if np.any(np.abs(rows.value(np.zeros_like(self.base))) >= rows.bounds):
            raise RuntimeError(fit.trouble)

    def ours(self) -> Timing:
        """Time the tool."""
        began = cpu_seconds()
        program = MotionProgram(pose_motion(self.task, self.grid, self.base))
        lines: list[Any] = []
        inside = find_inside(program, np.zeros(program.size), lines.append)
        if inside is None:
            raise RuntimeError("no motion inside")
        outcome = minimise(program, inside, Options(gap=GAP, tolerance=TOLERANCE))
        steps = len(outcome.steps) - 1 + len(lines)
        spent = cpu_seconds() - began
        return Timing(spent, steps, outcome.values.cost, outcome.status == "converged")

    def peer(self, solver: Callable[[Any], Any]) -> Timing:
        """Time a peer."""
        task = peer_task(self.task, self.grid, self.base)
        began = cpu_seconds()
        answer = solver(task)
        return Timing(cpu_seconds() - began, answer.iterations, answer.cost, answer.success)


def median(repeats: int, run: Callable[[], Timing]) -> Timing:
    """Return the run of median CPU time."""
    runs = sorted((run() for _ in range(repeats)), key=lambda each: each.cpu_s)
    return runs[len(runs) // 2]


def compare(lengths: Sequence[int], alone: Sequence[int], repeats: int) -> None:
    """Print the table of peers."""
    print("hand: CasADi with derivatives assembled by hand (tests/support/ipopt_program.py)")
    print("plain: CasADi as a user writes it, map and nlpsol (tests/support/ipopt_plain.py)\n")
    heads = ["intervals", "steps", "CPU-s"]
    for name in ("hand", "plain"):
        heads += [f"{name}: steps", "CPU-s", "ratio", "cost − ours"]
    print(_row(heads))
    print(_row(["---:"] * len(heads)), flush=True)
    for intervals in (*lengths, *alone):
        case = Case(intervals)
        ours = median(repeats, case.ours)
        cells = [str(intervals), _steps(ours), f"{ours.cpu_s:.3g}"]
        if intervals in lengths:
            # a second run of a peer that takes minutes would tell nothing new
            often = repeats if intervals <= 2000 else 1
            for solver in (solve, solve_plainly):
                peer = median(often, partial(case.peer, solver))
                cells += [
                    _steps(peer),
                    f"{peer.cpu_s:.3g}",
                    f"{peer.cpu_s / ours.cpu_s:.1f}",
                    f"{peer.cost - ours.cost:+.1e}",
                ]
        else:
            cells += ["–"] * 8
        print(_row(cells), flush=True)


def _row(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _steps(timing: Timing) -> str:
    return f"{timing.steps}" + ("" if timing.converged else " (not converged)")


def growth(lengths: Sequence[int], repeats: int) -> None:
    """Print how the tool's time grows with the number of intervals."""
    print("whole: the executable motion, all grids, and the table within its budgets\n")
    heads = ["intervals", "steps", "CPU-s", "µs an interval and step", "whole: steps", "CPU-s"]
    print(_row(heads))
    print(_row(["---:"] * len(heads)), flush=True)
    for intervals in lengths:
        ours = median(repeats, Case(intervals).ours)
        whole = median(repeats, partial(_whole, task_of(intervals)))
        each = 1e6 * ours.cpu_s / (intervals * max(ours.steps, 1))
        cells = [str(intervals), _steps(ours), f"{ours.cpu_s:.3g}", f"{each:.2f}"]
        print(_row([*cells, _steps(whole), f"{whole.cpu_s:.3g}"]), flush=True)


def _whole(task: FreeTask) -> Timing:
    began = cpu_seconds()
    solution = find_free_motion(task).solution
    spent = cpu_seconds() - began
    return Timing(spent, solution.iterations, solution.cost, solution.status == "converged")


def command(repeats: int) -> None:
    """Print the CPU time of whole processes."""
    for options in ([], ["--no-plots"], ["--no-plots", "-o", "cobra.csv"]):
        times = [_process(["reduce", "cobra.yaml", *options]) for _ in range(repeats)]
        shown = " ".join(["reduce cobra.yaml", *options])
        print(f"{shown}: {statistics.median(times):.2f} CPU-s, whole process")


def _process(arguments: list[str]) -> float:
    before = os.times()
    path = os.pathsep.join([os.getcwd(), os.environ.get("PYTHONPATH", "")])
    with tempfile.TemporaryDirectory() as folder:
        # the built-in Cobra reduces as the study does; without that it gets the defaults
        cobra = builtin_profile("cobra")
        assert cobra is not None
        text = cobra.path.read_text(encoding="utf-8").partition("\nreduction:")[0]
        Path(folder, "cobra.yaml").write_text(text + "\n", encoding="utf-8")
        subprocess.run(
            [sys.executable, "-m", "des_cli", *arguments],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": path},
            check=True,
            capture_output=True,
        )
    after = os.times()
    used = after.children_user - before.children_user
    return used + after.children_system - before.children_system


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", nargs="?", choices=("peers", "growth", "command"), default="peers")
    parser.add_argument("--intervals", type=int, nargs="*", help="instead of the usual ones")
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    if options.what == "peers":
        lengths = PEERS if options.intervals is None else options.intervals
        compare(lengths, ALONE if options.intervals is None else (), options.repeats)
    elif options.what == "growth":
        growth(options.intervals or (*PEERS, *ALONE), options.repeats)
    else:
        command(options.repeats)


if __name__ == "__main__":
    main()
