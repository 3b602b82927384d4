"""CasADi/IPOPT on the problem of uniform cubic B-splines, for comparison with the tool."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from tests.support.ipopt_program import program_of
from tests.support.seat_forms import Floats
from tests.support.spline_task import GAUSS, JointLimits, Task, basis, reference_of


@dataclass(frozen=True)
class Answer:
    """What IPOPT returned.

    Parameters
    ----------
    cost : float
        The objective, with its regularisation.
    points : (K + 3, 3) array
        P [rad].
    seat : (yaw, pitch)
        [rad]
    spent : mapping
        Each budget's constraint value, 1 where it is used up; the largest for the attitude.
    success : bool
    status : str
    iterations : int
    build_s, solve_s : float
        CPU time of the graph with its derivatives, and of the solution [s].
    """

    cost: float
    points: Floats
    seat: tuple[float, float]
    spent: Mapping[str, float]
    success: bool
    status: str
    iterations: int
    build_s: float
    solve_s: float


def cpu_seconds() -> float:
    """Return the CPU time of this process so far [s]."""
    return time.process_time()


def solve(
    task: Task,
    start: Floats | None = None,
    seat_start: tuple[float, float] | None = None,
    options: Mapping[str, Any] | None = None,
) -> Answer:
    """Solve a problem with IPOPT and MUMPS.

    Parameters
    ----------
    task : Task
    start : (K + 3, 3) array, optional
        Control points to start from; the base spline unless given.
    seat_start : (yaw, pitch), optional
        [rad]; the profile's seat unless given.
    options : mapping, optional
        Further options of IPOPT.
    """
    began = cpu_seconds()
    program = program_of(task)
    quiet = {"print_level": 0, "sb": "yes", "linear_solver": "mumps"}
    solver = ca.nlpsol(
        "solver",
        "ipopt",
        program.problem,
        {
            "print_time": False,
            "error_on_fail": False,
            "grad_f": program.gradient,
            "jac_g": program.jacobian,
            "hess_lag": program.hessian,
            "ipopt": {**quiet, "tol": 1e-8, "max_iter": 1000, **(options or {})},
        },
    )
    built = cpu_seconds()
    x0 = program.unknowns(task.base if start is None else start, seat_start or task.seat)
    found = solver(x0=x0, lbx=program.least, ubx=program.most, lbg=program.low, ubg=program.high)
    solved = cpu_seconds()
    stats = solver.stats()
    x, g = np.asarray(found["x"]).ravel(), np.asarray(found["g"]).ravel()
    size = task.base.size
    return Answer(
        cost=float(found["f"]),
        points=x[:size].reshape(-1, 3),
        seat=(float(x[-2]), float(x[-1])) if len(x) > size else task.seat,
        spent={name: float(g[rows].max()) for name, rows in program.budgets.items()},
        success=bool(stats["success"]),
        status=str(stats["return_status"]),
        iterations=int(stats["iter_count"]),
        build_s=built - began,
        solve_s=solved - built,
    )


def fit_base(
    path: Callable[[Floats], tuple[Floats, ...]],
    duration: float,
    intervals: int,
    limits: JointLimits,
    *,
    lag: float = 0.1,
) -> Floats:
    """Return the spline inside the limits nearest to a motion, with its ends, (K + 3, 3).

    Least squares of the angle and of ``lag`` [s] times the rate at the Gauss points, joint
    by joint, angles and rates of both ends kept.
    """
    h = duration / intervals
    want = reference_of(path, duration, intervals)
    first, last = ([each[0] for each in path(np.array([t]))] for t in (0.0, duration))
    columns = []
    for joint in range(3):
        p = ca.MX.sym("p", intervals + 3)
        cost: Any = 0
        for gauss, u in enumerate(GAUSS):
            rows = basis(u, h)
            for order, scale in ((0, 1.0), (1, lag)):
                value = sum(rows[order, a] * p[a : a + intervals] for a in range(4))
                goal = (want.angle, want.rate)[order][:, gauss, joint]
                cost += ca.sumsqr(scale * (value - ca.DM(goal))) / intervals
        d1 = (p[1:] - p[:-1]) / h
        d2 = (d1[1:] - d1[:-1]) / h
        d3 = (d2[1:] - d2[:-1]) / h
        bounded = [
            (each, most[joint])
            for each, most in (
                (d1[1:-1], limits.rate),
                (d2, limits.acceleration),
                (d3, limits.jerk),
                (p[1:-1], limits.angle),
            )
            if math.isfinite(most[joint])
        ]
        held = [
            (ca.dot(p[:4], ca.DM(basis(0.0, h)[order])), first[order][joint]) for order in (0, 1)
        ] + [(ca.dot(p[-4:], ca.DM(basis(1.0, h)[order])), last[order][joint]) for order in (0, 1)]
        g = ca.vertcat(*(each / most for each, most in bounded), *(each for each, _ in held))
        goal = np.array([value for _, value in held])
        inside = np.ones(g.shape[0] - len(held))
        quiet = {"print_level": 0, "sb": "yes", "tol": 1e-10}
        solver = ca.nlpsol(
            "fit",
            "ipopt",
            {"x": p, "f": cost, "g": g},
            {"expand": True, "print_time": False, "ipopt": quiet},
        )
        knots = h * np.arange(-1, intervals + 2)
        x0 = path(np.clip(knots, 0.0, duration))[0][:, joint]
        found = solver(
            x0=x0, lbg=np.concatenate([-inside, goal]), ubg=np.concatenate([inside, goal])
        )
        if not solver.stats()["success"]:
            raise RuntimeError(f"joint {joint}: {solver.stats()['return_status']}")
        columns.append(np.asarray(found["x"]).ravel())
    return np.stack(columns, axis=-1)
