"""A spline problem in CasADi, with derivatives assembled from those of one interval.

Nothing of ``des_cli`` is used: what the seat feels is written in CasADi from the closed
forms (see ``seat_forms``, whose constants are shared).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from scipy import sparse

from tests.support.seat_forms import HALF, L2, LT, LX, LY, LZ, Floats, G
from tests.support.spline_task import (
    ATTITUDE,
    BLEND,
    G_RMS,
    GAUSS,
    INFINITE,
    JOINTS,
    RATE,
    TURNING,
    TURNING_PEAK,
    TURNING_RMS,
    Task,
    basis,
)

SUMS = 7
"""Integrals, of which each interval has a share."""

OUTPUTS = SUMS + 4
"""Outputs of one interval: these, and two bounded quantities at each of its two points."""


def seat_in_casadi(angle: Any, rate: Any, acceleration: Any, yaw: Any, pitch: Any) -> Any:
    """Return W, c, dW/dt, G (3 each) and the attitude R (3, 3) of one state, as SX."""
    s1, s2, s3 = (ca.sin(angle[j]) for j in range(3))
    c1, c2, c3 = (ca.cos(angle[j]) for j in range(3))
    a, f, q = (rate[j] for j in range(3))
    a1, f1, q1 = (acceleration[j] for j in range(3))
    down = ca.vertcat(-s2, -c2 * s3, c2 * c3)
    radial = ca.vertcat(0, c3, s3)
    tangential = ca.vertcat(-c2, s2 * s3, -s2 * c3)
    w = down * a + radial * f + ca.vertcat(-q, 0, 0)
    cross = ca.vertcat(
        -c2 * f * a,
        (s2 * s3 * f - c2 * c3 * q) * a - s3 * q * f,
        (-s2 * c3 * f - c2 * s3 * q) * a + c3 * q * f,
    )
    turning = cross + down * a1 + radial * f1 + ca.vertcat(-q1, 0, 0)
    sy, cy, sp, cp = ca.sin(yaw - HALF), ca.cos(yaw - HALF), ca.sin(pitch), ca.cos(pitch)
    turn = ca.vertcat(
        ca.horzcat(cp * cy, -cp * sy, sp),
        ca.horzcat(sy, cy, 0),
        ca.horzcat(-sp * cy, sp * sy, cp),
    )
    offset = ca.vertcat(-LZ, LY, LX) - LT * turn[2, :].T
    centre = L2 * (a1 * tangential - a**2 * radial)
    force = centre - G * down + ca.cross(turning, offset) + ca.cross(w, ca.cross(w, offset))
    ground = ca.vertcat(ca.horzcat(c1, -s1, 0), ca.horzcat(-s1, -c1, 0), ca.horzcat(0, 0, -1))
    attitude = ground @ ca.vertcat(radial.T, tangential.T, down.T) @ turn.T
    g = ca.diag(ca.DM([1, 1, -1])) @ turn @ force / G
    return turn @ w, turn @ cross, turn @ turning, g, attitude


def _reference_seat(task: Task) -> tuple[Floats, ...]:
    """Return W, c, dW/dt, G (n, 3) and R (n, 9) of the reference, for n = 2K points."""
    state = [ca.SX.sym("state", 3) for _ in range(3)]
    felt = seat_in_casadi(*state, *task.seat)
    function = ca.Function("reference", state, [*felt[:4], ca.vec(felt[4])])
    reference = task.reference
    columns = [
        each.reshape(-1, 3).T for each in (reference.angle, reference.rate, reference.acceleration)
    ]
    return tuple(np.asarray(each).T for each in function.map(columns[0].shape[1])(*columns))


@dataclass(frozen=True)
class _Interval:
    """One interval's shares of the sums, what is bounded at its points, and their derivatives.

    Bounded: two squared attitude errors at the points, then two squared angular accelerations
    at the interval's ends, by the straight line through those at the points.

    Unknowns: 12 coordinates of its control points, point after point, then the seat's yaw
    and pitch where these are free. Data: 2 x (theta, W, c, dW, G, R) of the reference.
    """

    value: ca.Function  # (unknowns, data) -> sums (7), at points (4)
    slope: ca.Function  # (unknowns, data) -> their gradients (11, unknowns)
    curvature: ca.Function  # (unknowns, data, weights (11)) -> Hessian of weights . outputs


def _interval(task: Task, h: float, size: int) -> _Interval:
    unknowns, data, weights = ca.SX.sym("v", size), ca.SX.sym("data", 48), ca.SX.sym("w", OUTPUTS)
    points = ca.reshape(unknowns[:12], 3, 4)
    seat = (unknowns[12], unknowns[13]) if size > 12 else task.seat
    sums, apart, turnings = ca.SX.zeros(SUMS), [], []
    for gauss, u in enumerate(GAUSS):
        rows = basis(u, h)
        states = [points @ ca.DM(rows[order]) for order in range(3)]
        w, c, dw, g, attitude = seat_in_casadi(*states, *seat)
        theta, w0, c0, dw0, g0, r0 = ca.vertsplit(
            data[24 * gauss : 24 * gauss + 24], [0, 3, 6, 9, 12, 15, 24]
        )
        sums += (h / 2) * ca.vertcat(
            c.T @ ca.DM(task.r1) @ c,
            ca.sumsqr(dw - (dw0 - c0)),
            ca.sumsqr(w - w0),
            ca.sumsqr(g - g0),
            ca.sumsqr(states[0] - theta),
            ca.sumsqr(dw - dw0),
            ca.sumsqr(dw),
        )
        apart.append(ca.sumsqr(ca.vec(attitude) - r0))
        turnings.append(dw)
    # the straight line through both points, at both ends of the interval
    beyond = (math.sqrt(3) - 1) / 2
    ends = [
        ca.sumsqr((1 + beyond) * near - beyond * far)
        for near, far in (turnings, reversed(turnings))
    ]
    outputs = ca.vertcat(sums, *apart, *ends)
    hessian, _ = ca.hessian(ca.dot(weights, outputs), unknowns)
    return _Interval(
        ca.Function("value", [unknowns, data], [ca.cse(outputs)]),
        ca.Function(
            "slope", [unknowns, data], [ca.cse(ca.densify(ca.jacobian(outputs, unknowns)))]
        ),
        ca.Function("curvature", [unknowns, data, weights], [ca.cse(ca.densify(hessian))]),
    )


@dataclass(frozen=True)
class Program:
    """CasADi's problem with its derivatives, its bounds, and the rows of each budget in g.

    The derivatives are assembled from those of one interval, which is three times faster in
    all than what CasADi makes of the whole graph, as a map or expanded into scalars.
    """

    problem: dict[str, Any]
    gradient: ca.Function
    jacobian: ca.Function
    hessian: ca.Function
    least: Floats
    most: Floats
    low: Floats
    high: Floats
    budgets: dict[str, slice]

    def unknowns(self, points: Floats, seat: tuple[float, float]) -> Floats:
        """Return x of control points and a seat."""
        extra = len(self.least) - points.size
        return np.concatenate([points.ravel(), seat[:extra]])


def program_of(task: Task) -> Program:
    """Return the problem that IPOPT is given."""
    k, span = task.intervals, task.duration
    h = span / k
    free_seat = "seat_yaw" in task.optimise or "seat_pitch" in task.optimise
    size = 14 if free_seat else 12
    n = 3 * (k + 3) + size - 12
    interval = _interval(task, h, size)

    w0, c0, dw0, g0, r0 = _reference_seat(task)
    theta0 = task.reference.angle.reshape(-1, 3)
    data = ca.DM(np.concatenate([theta0, w0, c0, dw0, g0, r0], axis=1).reshape(k, 48).T)

    # what of the sums is in the objective and in each budget
    weight = h / 2
    denominator = weight * np.einsum("ni,ij,nj", c0, task.r1, c0)
    isotropic = np.trace(task.r1) / 3
    goal = np.zeros(SUMS)
    goal[:2] = {
        "coriolis": (1, 0),
        "blend": (1, BLEND * isotropic),
        "felt": (0, isotropic),
    }[task.objective]
    goal /= denominator
    scale = {
        RATE: (2, weight * (w0**2).sum()),
        G_RMS: (3, span),
        JOINTS: (4, weight * (theta0**2).sum()),
        TURNING: (5, span),
        TURNING_RMS: (6, span),
    }
    totals = [name for name in task.budgets if name in scale]
    shares = np.zeros((len(totals), SUMS))
    for row, name in enumerate(totals):
        column, whole = scale[name]
        shares[row, column] = 1 / (task.budgets[name] ** 2 * whole)
    budgets = {name: slice(row, row + 1) for row, name in enumerate(totals)}
    first_linear = len(totals)
    bounded: list[tuple[int, float, slice]] = []  # first output, factor, rows in g
    for output, (name, unit) in enumerate(
        (
            (ATTITUDE, lambda most: 8 * math.sin(math.radians(most) / 2) ** 2),
            (TURNING_PEAK, lambda most: most**2),
        )
    ):
        if name in task.budgets:
            budgets[name] = slice(first_linear, first_linear + 2 * k)
            bounded.append((SUMS + 2 * output, 1 / unit(task.budgets[name]), budgets[name]))
            first_linear += 2 * k

    linear, low, high = _linear(task, h, n)
    roughness = _roughness(task, h, n)
    curved = _dm(2 * (roughness.T @ roughness))
    base = np.concatenate([task.base.ravel(), np.zeros(size - 12)])

    x, parameter = ca.MX.sym("x", n), ca.MX.sym("p", 0)
    points = ca.reshape(x[: 3 * (k + 3)], 3, k + 3)
    local = ca.vertcat(*(points[:, a : a + k] for a in range(4)))
    if free_seat:
        local = ca.vertcat(local, ca.repmat(x[-2:], 1, k))

    outputs = interval.value.map(k)(local, data)
    sums = ca.sum2(outputs[:SUMS, :])
    f = ca.dot(goal, sums) + ca.sumsqr(_dm(roughness) @ (x - base))
    rows = [ca.DM(shares) @ sums] if totals else []
    rows += [factor * ca.vec(outputs[at : at + 2, :]) for at, factor, _ in bounded]
    g = ca.vertcat(*rows, _dm(linear) @ x)

    # the slopes of interval i are columns size * i ... of an (11, size * k) matrix
    slopes = interval.slope.map(k)(local, data)
    places = _places(k, size, n)
    scatter = _dm(sparse.csr_matrix((np.ones(size * k), (places.ravel(), np.arange(size * k)))))
    gradients = slopes[:SUMS, :] @ scatter.T
    df = gradients.T @ ca.DM(goal) + curved @ (x - base)
    jacobians = [ca.DM(shares) @ gradients] if totals else []
    jacobians += [
        factor * _point_rows(slopes[at : at + 2, :], places, k, size, n)
        for at, factor, _ in bounded
    ]
    dg = ca.vertcat(*jacobians, _dm(linear))

    lam_f, lam_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", g.shape[0])
    weights = lam_f * ca.DM(goal)
    if totals:
        weights += ca.DM(shares).T @ lam_g[: len(totals)]
    weights = ca.repmat(weights, 1, k)
    at_points = [ca.MX(ca.DM.zeros(2, k))] * 2
    for at, factor, where in bounded:
        at_points[(at - SUMS) // 2] = factor * ca.reshape(lam_g[where], 2, k)
    blocks = interval.curvature.map(k)(local, data, ca.vertcat(weights, *at_points))
    hessian = _assemble(blocks, places, k, size, n) + lam_f * ca.triu(curved)

    least, most = np.full(n, -INFINITE), np.full(n, INFINITE)
    if free_seat:
        for i, name in ((-2, "seat_yaw"), (-1, "seat_pitch")):
            if name not in task.optimise:
                least[i] = most[i] = task.seat[i]
    return Program(
        {"x": x, "f": f, "g": g},
        ca.Function("grad_f", [x, parameter], [f, df]),
        ca.Function("jac_g", [x, parameter], [g, dg]),
        ca.Function("hess_lag", [x, parameter, lam_f, lam_g], [hessian]),
        least,
        most,
        np.concatenate([np.full(first_linear, -INFINITE), low]),
        np.concatenate([np.ones(first_linear), high]),
        budgets,
    )


def _dm(matrix: Any) -> ca.DM:
    """Return a scipy matrix as CasADi's, which wants its rows in order."""
    ordered = sparse.csc_matrix(matrix)
    ordered.sum_duplicates()
    ordered.sort_indices()
    return ca.DM(ordered)


def _places(k: int, size: int, n: int) -> Any:
    """Return the index in x of each unknown of each interval, (K, size)."""
    places = 3 * np.arange(k)[:, None] + np.arange(12)
    if size == 12:
        return places
    return np.concatenate([places, np.tile([n - 2, n - 1], (k, 1))], axis=1)


def _scattered(values: Any, rows: Any, columns: Any, shape: tuple[int, int]) -> Any:
    """Return the sparse matrix in which values, flat, are summed at their places."""
    pattern = sparse.csc_matrix((np.ones(len(rows)), (rows, columns)), shape)
    pattern.sum_duplicates()
    pattern.sort_indices()
    key = np.repeat(np.arange(shape[1]), np.diff(pattern.indptr)) * shape[0] + pattern.indices
    target = np.searchsorted(key, columns * shape[0] + rows)
    gather = sparse.csr_matrix((np.ones(len(rows)), (target, np.arange(len(rows)))))
    found = ca.Sparsity(*shape, pattern.indptr.tolist(), pattern.indices.tolist())
    return ca.MX(found, _dm(gather) @ values)


def _assemble(blocks: Any, places: Any, k: int, size: int, n: int) -> Any:
    """Return the upper triangle of the sum of the intervals' Hessians, (size, size * K)."""
    # column-major: entry (r, c) of block i is at (i * size + c) * size + r
    columns = np.repeat(places, size, axis=1).ravel()
    rows = np.tile(places, (1, size)).ravel()
    upper = np.flatnonzero(rows <= columns)
    return _scattered(ca.vec(blocks)[upper.tolist()], rows[upper], columns[upper], (n, n))


def _point_rows(slopes: Any, places: Any, k: int, size: int, n: int) -> Any:
    """Return the Jacobian of a quantity at points, two of each interval, (2 K, n)."""
    columns = np.repeat(places, 2, axis=1).ravel()
    rows = (2 * np.arange(k)[:, None] + np.tile([0, 1], size)).ravel()
    return _scattered(ca.vec(slopes), rows, columns, (2 * k, n))


def _differences(count: int, order: int) -> Any:
    """Return the matrix of differences of an order, for three joints side by side."""
    matrix = sparse.eye_array(count, format="csr")
    for _ in range(order):
        matrix = matrix[1:] - matrix[:-1]
    return sparse.kron(matrix, sparse.eye_array(3), format="csr")


def _roughness(task: Task, h: float, n: int) -> Any:
    """Return the matrix whose product with x - x0 has the regularisation as its square."""
    k = task.intervals
    scale = math.sqrt(task.regularisation * h / task.duration) / h**3
    weights = np.tile(scale / task.limits.acceleration, k)
    third = sparse.diags_array(weights) @ _differences(k + 3, 3)
    return sparse.hstack([third, sparse.csr_array((3 * k, n - 3 * (k + 3)))], format="csr")


def _linear(task: Task, h: float, n: int) -> tuple[Any, Floats, Floats]:
    """Return A, low, high: the limits, each scaled to +-1, and the ends."""
    limits, count = task.limits, task.intervals + 3
    rows: list[Any] = []
    lows: list[Floats] = []
    highs: list[Floats] = []

    def add(matrix: Any, low: Floats, high: Floats) -> None:
        rows.append(matrix)
        lows.append(low)
        highs.append(high)

    def bound(matrix: Any, most: Floats) -> None:
        most = np.tile(most, matrix.shape[0] // 3)
        held = np.flatnonzero(np.isfinite(most))
        scaled = sparse.diags_array(1 / most[held]) @ matrix[held]
        add(scaled, -np.ones(len(held)), np.ones(len(held)))

    def end(order: int, last: bool) -> Any:
        at = np.zeros((1, count))
        at[0, slice(-4, None) if last else slice(4)] = basis(float(last), h)[order]
        return sparse.kron(at, sparse.eye_array(3), format="csr")

    def match(matrix: Any, joints: list[int]) -> None:
        value = (matrix @ task.base.ravel())[joints]
        add(matrix[joints], value, value)

    bound(_differences(count, 2) / h**2, limits.acceleration)
    bound(_differences(count, 3) / h**3, limits.jerk)
    bound(_differences(count, 1)[3:-3] / h, limits.rate)
    bound(_differences(count, 0)[3:-3], limits.angle)

    names = ("", "fork_start", "cab_start")
    held = [joint for joint, name in enumerate(names) if name not in task.optimise]
    match(end(0, False), held)
    bound(end(0, False), np.where(np.isin(np.arange(3), held), INFINITE, limits.angle))
    for order, last, where, most in (
        (1, False, ("match-start", "match-rates", "match-both"), limits.rate),
        (1, True, ("match-rates", "match-both"), limits.rate),
        (0, True, ("match-both",), limits.angle),
    ):
        if task.ends in where:
            match(end(order, last), [0, 1, 2])
        else:
            bound(end(order, last), most)
    points = sparse.vstack(rows, format="csr")
    seat = sparse.csr_array((points.shape[0], n - points.shape[1]))
    matrix = sparse.hstack([points, seat], format="csc")
    return matrix, np.concatenate(lows), np.concatenate(highs)
