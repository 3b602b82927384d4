"""The problem of one factor on the rates of a desired motion, for CasADi and IPOPT.

At n + 1 samples stand the factor p and the angles theta, and over every interval of length
h the rates are linear, from ``p_k Theta'_k`` to ``p_{k+1} Theta'_{k+1}``, which makes

    theta_{k+1} = theta_k + h/2 (theta'_k + theta'_{k+1}) + (p_k + p_{k+1})/2 missed_k,

with ``missed`` what the same rule at p = 1 lacks of the desired angles of fork and cab.
All integrals are trapezoidal sums over the two sides of every interval. Limits and budgets
hold to the last digit, without any room. Nothing of ``des_cli`` is used: what the seat
feels is written in CasADi from the closed forms, and the reference's in numpy.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import casadi as ca
import numpy as np

from tests.support.ipopt_program import seat_in_casadi
from tests.support.seat_forms import PITCH, YAW, Felt, Floats, by_closed_forms
from tests.support.spline_task import INFINITE, JointLimits, des_limits

OPTIONS = {
    "print_level": 0,
    "sb": "yes",
    "linear_solver": "mumps",
    "tol": 1e-10,
    "max_iter": 1000,
    "bound_relax_factor": 0.0,
}


@dataclass(frozen=True)
class FactorTask:
    """One discrete problem.

    Parameters
    ----------
    step : (n,) array
        Length of each interval [s].
    angle : (n + 1, 3) array
        Of the desired motion at samples [rad].
    rate : (n + 1, 3) array
        Likewise; it steps nowhere [rad/s].
    budgets : mapping
        Each metric's most, in its unit.
    r1 : (3, 3) array
        Weight of c in seat axes.
    limits : JointLimits
    regularisation : float
        Weight of (1 - p)^2 relative to the mean of c' R1 c along the desired motion.
    """

    step: Floats
    angle: Floats
    rate: Floats
    budgets: Mapping[str, float]
    r1: Floats
    limits: JointLimits = field(default_factory=des_limits)
    regularisation: float = 0.0


@dataclass(frozen=True)
class FactorAnswer:
    """What IPOPT returned: p (n + 1,), theta (n + 1, 3) [rad] and the share of c' R1 c less."""

    factor: Floats
    angle: Floats
    reduction: float


def solve_factors(task: FactorTask) -> FactorAnswer:
    """Minimise the integral of c' R1 c within the limits and the budgets, from p = 1.

    Parameters
    ----------
    task : FactorTask

    Raises
    ------
    RuntimeError
        If IPOPT does not converge.
    """
    n, h = len(task.step), task.step
    p, theta = ca.MX.sym("p", 1, n + 1), ca.MX.sym("theta", 3, n + 1)
    rate = ca.repmat(p, 3, 1) * ca.DM(task.rate.T)
    across = ca.repmat(ca.DM(h).T, 3, 1)
    acceleration = (rate[:, 1:] - rate[:, :-1]) / across
    jerk = (acceleration[:, 1:] - acceleration[:, :-1]) / ((across[:, 1:] + across[:, :-1]) / 2)

    missed = np.diff(task.angle, axis=0).T - h / 2 * (task.rate[1:] + task.rate[:-1]).T
    missed[0] = 0.0  # the arm is commanded by its velocity
    moved = across / 2 * (rate[:, 1:] + rate[:, :-1])
    moved += ca.repmat(p[:, 1:] + p[:, :-1], 3, 1) / 2 * ca.DM(missed)
    defect = theta[:, 1:] - theta[:, :-1] - moved

    left, kept = _seat_sums(task, p, theta, rate, acceleration)
    idle = ca.dot(ca.DM(_per_sample(h)).T, (1 - p) ** 2) / h.sum()
    goal = left + task.regularisation * idle

    limits = task.limits
    bounded = [
        ca.vec(each[joint, :]) / most[joint]
        for each, most in (
            (theta[:, 1:], limits.angle),
            (rate, limits.rate),
            (acceleration, limits.acceleration),
            (jerk, limits.jerk),
        )
        for joint in range(3)
        if math.isfinite(most[joint])
    ]
    equal = ca.vertcat(theta[:, 0] - ca.DM(task.angle[0]), ca.vec(defect))
    inside, spent = ca.vertcat(*bounded), ca.vertcat(*kept)
    x = ca.vertcat(ca.vec(theta), ca.vec(p))
    solver = ca.nlpsol(
        "factors",
        "ipopt",
        {"x": x, "f": goal, "g": ca.vertcat(equal, inside, spent)},
        {"print_time": False, "error_on_fail": False, "ipopt": OPTIONS},
    )
    none, ones = np.zeros(equal.numel()), np.ones(inside.numel())
    found = solver(
        x0=np.concatenate([task.angle.ravel(), np.ones(n + 1)]),
        lbg=np.concatenate([none, -ones, np.full(spent.numel(), -INFINITE)]),
        ubg=np.concatenate([none, ones, np.ones(spent.numel())]),
    )
    if not solver.stats()["success"]:
        raise RuntimeError(solver.stats()["return_status"])
    at = np.asarray(found["x"]).ravel()
    return FactorAnswer(
        factor=at[3 * (n + 1) :],
        angle=at[: 3 * (n + 1)].reshape(-1, 3),
        reduction=1.0 - float(ca.Function("left", [x], [left])(at)),
    )


def _per_sample(step: Floats) -> Floats:
    """Return the trapezoidal weight of each sample, (n + 1,) [s]."""
    return np.asarray((np.append(step, 0.0) + np.append(0.0, step)) / 2)


def _sides(values: Floats) -> Floats:
    """Return values at samples at the starts of all intervals, then at their ends."""
    return np.concatenate([values[:-1], values[1:]])


def _seat_sums(
    task: FactorTask, p: Any, theta: Any, rate: Any, acceleration: Any
) -> tuple[Any, list[Any]]:
    """Return the integral of c' R1 c over its desired value, and the rows of the budgets.

    A row is at most one where its budget is kept; it is a square for every metric but those
    that are squares themselves.
    """
    h, span = task.step, float(task.step.sum())
    own = np.diff(task.rate, axis=0) / h[:, None]
    before = by_closed_forms(
        _sides(task.angle), _sides(task.rate), np.concatenate([own, own]), YAW, PITCH
    )
    weight = np.concatenate([h, h]) / 2

    state = [ca.SX.sym(name, 3) for name in ("angle", "rate", "acceleration")]
    desired = [ca.SX.sym(name, size) for name, size in zip("wtgr", (3, 3, 3, 9), strict=True)]
    w, c, turning, g, attitude = seat_in_casadi(*state, YAW, PITCH)
    outputs = ca.vertcat(
        c.T @ ca.DM(task.r1) @ c,
        ca.sumsqr(w - desired[0]),
        ca.sumsqr(turning - desired[1]),
        ca.sumsqr(turning),
        ca.sumsqr(g - desired[2]),
        ca.sumsqr(ca.vec(attitude) - desired[3]),
    )
    at_side = ca.Function("side", [*state, *desired], [ca.cse(outputs)]).map(2 * len(h))
    columns = [before.rate, before.turning, before.g, _by_columns(before)]
    squares = at_side(
        ca.horzcat(theta[:, :-1], theta[:, 1:]),
        ca.horzcat(rate[:, :-1], rate[:, 1:]),
        ca.horzcat(acceleration, acceleration),
        *(ca.DM(each.T) for each in columns),
    )
    cross, spin, turned, turning_size, force, apart = ca.vertsplit(squares)

    def total(values: Any) -> Any:
        return ca.dot(ca.DM(weight).T, values)

    def size(vectors: Floats) -> float:
        return float(weight @ np.sum(vectors**2, axis=1))

    samples = _per_sample(h)
    joints = ca.dot(ca.DM(np.tile(samples, (3, 1))), (theta - ca.DM(task.angle.T)) ** 2)
    joints /= float(samples @ np.sum(task.angle**2, axis=1))
    peak = float(np.max(np.sum(before.turning**2, axis=1)))
    squared: dict[str, Any] = {
        "joint_deviation_relative": joints,
        "seat_rate_deviation_relative": total(spin) / size(before.rate),
        "seat_g_deviation_relative": total(force) / size(before.g),
        "seat_g_rms_error_g": total(force) / span,
        "seat_angular_acceleration_deviation_relative": total(turned) / size(before.turning),
        "seat_angular_acceleration_rms_error_rad_s2": total(turned) / span,
        "seat_angular_acceleration_rms_ratio": total(turning_size) / size(before.turning),
        "seat_angular_acceleration_peak_ratio": ca.vec(turning_size) / peak,
    }
    plain: dict[str, Any] = {
        "joint_deviation_relative_squared": joints,
        "mean_square_one_minus_p": ca.dot(ca.DM(samples).T, (1 - p) ** 2) / span,
    }
    rows = []
    for metric, most in task.budgets.items():
        if metric == "attitude_error_max_deg":
            # |R - R0|^2 = 8 sin^2(a / 2) for an angle a between the two
            rows.append(ca.vec(apart) / (8 * math.sin(math.radians(most) / 2) ** 2))
        elif metric in plain:
            rows.append(plain[metric] / most)
        else:
            rows.append(squared[metric] / most**2)
    energy = float(weight @ np.einsum("ni,ij,nj->n", before.cross, task.r1, before.cross))
    return total(cross) / energy, rows


def _by_columns(felt: Felt) -> Floats:
    """Return each attitude column after column, (n, 9), as CasADi's vec does."""
    return felt.attitude.swapaxes(-1, -2).reshape(-1, 9)
