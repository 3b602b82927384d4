"""CPU time of the study's scalar optimum beside CasADi/IPOPT on the identical discrete problem.

    python -m tests.benchmarks.study_scalar                     # 40,000 intervals
    python -m tests.benchmarks.study_scalar --intervals 1000 10000

The Cobra, one factor p for all joints, r1 = 2 on BB3, r2 = 1, no limits: what the shipped
``cobra.yaml`` asks for. Unknowns, trapezoidal rule and start are the tool's; the equations
are the study's closed forms, written as a user of CasADi writes them, a map over intervals
and ``nlpsol``. The tool's time is that of the whole search, with its three starts and its
coarse grids; the peer has one start. Posing the problem and building derivatives counts for
both. One process, one thread; medians.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import casadi as ca
import numpy as np

from des_cli import load_profile
from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.motion import Motion
from des_cli.reduction.optimum import find_optimum
from des_cli.reduction.problem import Problem
from des_cli.reduction.search import Search
from tests.support.ipopt_spline import cpu_seconds

R1, R2, DURATION_S = 2.0, 1.0, 10.0
QUIET = {"print_time": False, "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-9}}


@dataclass(frozen=True)
class Timing:
    """CPU time of one solution, with its building [s], Newton steps, and cost."""

    cpu_s: float
    steps: int
    cost: float


def cobra(intervals: int) -> Motion:
    """Return the Cobra on so many intervals."""
    step = f"time.step_s={DURATION_S / intervals!r}"
    return make_desired(load_profile("cobra", settings=[step])).motion


def ours(motion: Motion) -> Timing:
    """Time the tool."""
    began = cpu_seconds()
    profile = load_profile("cobra")
    problem = Problem(
        desired=motion,
        chain=chain_of(profile.machine, profile.seat),
        axes="report",
        r1=np.diag([0.0, R1, 0.0]),
        r2=np.array([R2]),
        tracking=np.zeros(3),
    )
    found = find_optimum(problem, Search(500))
    spent = cpu_seconds() - began
    if not found.converged:
        raise RuntimeError(found.message)
    return Timing(spent, found.iterations, found.cost)


def peer(motion: Motion) -> Timing:
    """Time CasADi and IPOPT."""
    began = cpu_seconds()
    n = len(motion.t)
    unknowns = ca.MX.sym("unknowns", 4 * n)
    samples = ca.reshape(unknowns, 4, n)  # three angles and the factor
    cost, defect = _interval().map(n - 1)(
        samples[:, :-1],
        samples[:, 1:],
        ca.DM(np.vstack([motion.rate_start.T, motion.rate_end.T, motion.step, _missed(motion).T])),
    )
    nlp = {
        "x": unknowns,
        "f": ca.sum2(cost),
        "g": ca.vertcat(ca.vec(defect), samples[:3, 0] - ca.DM(motion.angle[0])),
    }
    solver: Any = ca.nlpsol("study", "ipopt", nlp, QUIET)
    start = np.hstack([motion.angle, np.ones((n, 1))])
    found = solver(x0=start.ravel(), lbg=0.0, ubg=0.0)
    stats = solver.stats()
    spent = cpu_seconds() - began
    if not stats["success"]:
        raise RuntimeError(stats["return_status"])
    return Timing(spent, int(stats["iter_count"]), float(found["f"]))


def _missed(motion: Motion) -> Any:
    """Return what the trapezoidal rule misses of the desired angles, (n - 1, 3) [rad]."""
    by_rates = 0.5 * motion.step[:, None] * (motion.rate_start + motion.rate_end)
    missed = np.diff(motion.angle, axis=0) - by_rates
    missed[:, 0] = 0.0  # the arm is commanded by its rate
    return missed


def _interval() -> Any:
    """Return cost and defect of one interval: both of its sides, and (T, h, missed) as data."""
    left, right, data = ca.SX.sym("left", 4), ca.SX.sym("right", 4), ca.SX.sym("data", 10)
    h, missed = data[6], data[7:]
    cost, moved = 0, 0
    for side, rate in ((left, data[:3]), (right, data[3:6])):
        adapted = side[3] * rate
        a, f, q = ca.vertsplit(adapted)
        s1, c1, s2, c2 = ca.sin(side[0]), ca.cos(side[0]), ca.sin(side[1]), ca.cos(side[1])
        bb3 = -f * a * c1 + q * a * s1 * c2 + q * f * c1 * s2  # (23)
        cost += h / 4 * (R1 * bb3**2 + R2 * (1 - side[3]) ** 2)
        moved += h / 2 * adapted + side[3] / 2 * missed
    return ca.Function("interval", [left, right, data], [cost, right[:3] - left[:3] - moved])


def median(repeats: int, run: Callable[[], Timing]) -> Timing:
    """Return the run of median CPU time."""
    runs = sorted((run() for _ in range(repeats)), key=lambda each: each.cpu_s)
    return runs[len(runs) // 2]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--intervals", type=int, nargs="*", default=[40000])
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    print("| intervals | steps | CPU-s | IPOPT: steps | CPU-s | ratio | J | J of IPOPT − ours |")
    print("|" + " ---: |" * 8, flush=True)
    for intervals in options.intervals:
        motion = cobra(intervals)
        tool, other = (median(options.repeats, partial(run, motion)) for run in (ours, peer))
        print(
            f"| {intervals} | {tool.steps} | {tool.cpu_s:.3g} | {other.steps} | {other.cpu_s:.3g} "
            f"| {other.cpu_s / tool.cpu_s:.1f} | {tool.cost:.9f} | {other.cost - tool.cost:+.1e} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
