"""The spline problem as a user of CasADi writes it: a map over points, and ``nlpsol``.

CasADi makes all derivatives, IPOPT and MUMPS run with their default options. Compare
``ipopt_program``, whose derivatives are assembled by hand. (Expanded into scalars the graph
takes thirty times as long to build, and is hardly faster to evaluate.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from tests.support.ipopt_program import seat_in_casadi
from tests.support.ipopt_spline import cpu_seconds
from tests.support.seat_forms import Floats, by_closed_forms
from tests.support.spline_task import G_RMS, GAUSS, INFINITE, RATE, Task, basis


@dataclass(frozen=True)
class PlainAnswer:
    """What IPOPT returned: cost, control points (K + 3, 3) [rad], steps, CPU times [s]."""

    cost: float
    points: Floats
    success: bool
    status: str
    iterations: int
    build_s: float
    solve_s: float


def solve_plainly(task: Task) -> PlainAnswer:
    """Solve a problem with budgets on G and seat rate, start angles and rates kept.

    Parameters
    ----------
    task : Task

    Raises
    ------
    ValueError
        If the problem is another one.
    """
    if (
        set(task.budgets) != {G_RMS, RATE}
        or task.ends != "match-start"
        or task.objective != "coriolis"
        or task.optimise
    ):
        raise ValueError("the plain peer knows two budgets, the start kept, and a fixed seat")
    began = cpu_seconds()
    problem, low, high = _problem(task)
    quiet = {"print_time": False, "ipopt": {"print_level": 0, "sb": "yes"}}
    solver = ca.nlpsol("plain", "ipopt", problem, quiet)
    built = cpu_seconds()
    found = solver(x0=task.base.ravel(), lbg=low, ubg=high)
    stats = solver.stats()
    return PlainAnswer(
        cost=float(found["f"]),
        points=np.asarray(found["x"]).reshape(-1, 3),
        success=bool(stats["success"]),
        status=str(stats["return_status"]),
        iterations=int(stats["iter_count"]),
        build_s=built - began,
        solve_s=cpu_seconds() - built,
    )


def _problem(task: Task) -> tuple[dict[str, Any], Floats, Floats]:
    k, span, limits = task.intervals, task.duration, task.limits
    h = span / k
    flat = [each.reshape(-1, 3) for each in vars(task.reference).values()]
    before = by_closed_forms(*flat, *task.seat)
    data = ca.DM(np.concatenate([before.rate, before.g], axis=1).T)

    state, desired = [ca.SX.sym(name, 3) for name in ("q", "v", "a")], ca.SX.sym("d", 6)
    w, c, _, g, _ = seat_in_casadi(*state, *task.seat)
    outputs = ca.vertcat(
        c.T @ ca.DM(task.r1) @ c, ca.sumsqr(w - desired[:3]), ca.sumsqr(g - desired[3:])
    )
    at_point = ca.Function("point", [*state, desired], [outputs])

    x = ca.MX.sym("x", 3 * (k + 3))
    points = ca.reshape(x, 3, k + 3)
    sums: Any = 0
    for gauss, u in enumerate(GAUSS):
        rows = basis(u, h)
        states = [
            sum(rows[order, a] * points[:, a : a + k] for a in range(4)) for order in range(3)
        ]
        sums += ca.sum2(at_point.map(k)(*states, data[:, gauss::2]))
    sums *= h / 2

    first = (points[:, 1:] - points[:, :-1]) / h
    second = (first[:, 1:] - first[:, :-1]) / h
    third = (second[:, 1:] - second[:, :-1]) / h
    base_third = np.diff(task.base, 3, axis=0).T / h**3
    unit = np.repeat(1 / limits.acceleration[:, None], k, axis=1)
    rough = ca.sumsqr((third - ca.DM(base_third)) * ca.DM(unit)) * task.regularisation * h / span
    whole = h / 2 * np.einsum("ni,ij,nj", before.cross, task.r1, before.cross)
    rate_size = h / 2 * float((before.rate**2).sum())

    start = points[:, :4]
    held = ca.vertcat(*(start @ ca.DM(basis(0.0, h)[order]) for order in (0, 1)))
    kept = np.concatenate([basis(0.0, h)[order] @ task.base[:4] for order in (0, 1)])
    last = points[:, -4:]
    bounded = [
        (points[:, 1:-1], limits.angle),
        (first[:, 1:-1], limits.rate),
        (second, limits.acceleration),
        (third, limits.jerk),
        (last @ ca.DM(basis(1.0, h)[0]), limits.angle),
        (last @ ca.DM(basis(1.0, h)[1]), limits.rate),
    ]
    most = np.concatenate([np.tile(bound, each.shape[1]) for each, bound in bounded])
    rows = ca.vertcat(
        sums[2] / (task.budgets[G_RMS] ** 2 * span),
        sums[1] / (task.budgets[RATE] ** 2 * rate_size),
        held,
        *(ca.vec(each) for each, _ in bounded),
    )
    problem = {"x": x, "f": sums[0] / whole + rough, "g": rows}
    return (
        problem,
        np.concatenate([[-INFINITE, -INFINITE], kept, -most]),
        np.concatenate([[1.0, 1.0], kept, most]),
    )
