"""From a problem of the tool to the peer's: the same discrete problem, in CasADi's words.

What the tool decides is handed over as numbers (grid, control points of the base, limits
with their margin, budgets); what these mean is written twice.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import casadi as ca
import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion
from des_cli.reduction.free.pose import MARGIN, REGULARISATION
from des_cli.reduction.free.task import FreeTask
from des_cli.reduction.reference import sample_motion
from des_cli.solver.spline import SplineGrid
from tests.support.ipopt_program import program_of
from tests.support.seat_forms import Felt, by_closed_forms
from tests.support.spline_task import (
    ATTITUDE,
    G_RMS,
    JOINTS,
    RATE,
    TURNING,
    TURNING_PEAK,
    TURNING_RMS,
    JointLimits,
    Reference,
    Task,
    gauss_instants,
)


@dataclass(frozen=True)
class Check:
    """The peer's functions at a motion of the tool.

    Parameters
    ----------
    cost : float
        The objective, with its regularisation.
    budgets : (j,) array
        Each budget's constraint value in the peer task's order, 1 where it is used up; the
        largest for the attitude.
    excess : float
        How far beyond a limit the motion is at the most, relative to it; negative inside.
    """

    cost: float
    budgets: Floats
    excess: float


def peer_task(task: FreeTask, grid: SplineGrid, base: Floats) -> Task:
    """Return the peer's problem.

    Of two budgets that the peer measures alike, relative and absolute, the tighter counts.

    Parameters
    ----------
    task : FreeTask
        Of the DES; its budgets count as they are.
    grid : SplineGrid
    base : (n, 3) array
        Control points of the executable motion [rad].

    Raises
    ------
    ValueError
        If the peer does not know what the task asks for.
    """
    reduction = task.reduction
    if task.machine.rows != DES.rows or task.machine.gravity != DES.gravity:
        raise ValueError("the peer's closed forms are those of the DES")
    if reduction.hold or reduction.control != "free" or task.occupant.bounded:
        raise ValueError("the peer holds no joint, ties no rate and bounds nothing that is felt")
    if not all(math.isfinite(limit.acceleration) for limit in task.limits):
        raise ValueError("the peer's regularisation is in units of the acceleration limits")
    t = grid.start + gauss_instants(grid.duration, grid.intervals).reshape(-1)
    states = sample_motion(task.reference, t)
    seat = (task.seat.yaw, task.seat.pitch)
    felt = by_closed_forms(*states, *seat)
    table = _at_rows(task.reference, seat)
    budgets: dict[str, float] = {}
    for budget in reduction.budget:
        name, most = _peer_budget(budget, felt, table)
        budgets[name] = min(most, budgets.get(name, math.inf))
    return Task(
        duration=grid.duration,
        reference=Reference(*(each.reshape(-1, 2, 3) for each in states)),
        base=base,
        limits=JointLimits(
            *(
                np.array([getattr(limit, name) for limit in task.limits]) * (1.0 - MARGIN)
                for name in ("angle", "rate", "acceleration", "jerk")
            )
        ),
        budgets=budgets,
        objective=reduction.objective,
        r1=reduction.r1,
        ends=reduction.ends,
        optimise=reduction.optimise,
        seat=seat,
        # in units of the limits themselves, not of what the margin leaves of them
        regularisation=REGULARISATION * (1.0 - MARGIN) ** 2,
    )


def _at_rows(motion: Motion, seat: tuple[float, float]) -> Felt:
    """Return what is felt at both ends of a table's intervals."""
    both = (motion.angle_sides, motion.rate_sides, np.repeat(motion.acceleration[:, None], 2, 1))
    return by_closed_forms(*(each.reshape(-1, 3) for each in both), *seat)


def _peer_budget(budget: Budget, felt: Felt, table: Felt) -> tuple[str, float]:
    """Return the peer's name of a budget and its most, which may be a share of the reference's.

    Integrals are taken at the grid's points, a peak at the rows of the reference's table.
    """
    match budget.metric:
        case "joint_deviation_relative":
            return JOINTS, budget.most
        case "joint_deviation_relative_squared":
            return JOINTS, math.sqrt(budget.most)
        case "seat_rate_deviation_relative":
            return RATE, budget.most
        case "seat_g_rms_error_g":
            return G_RMS, budget.most
        case "seat_g_deviation_relative":
            return G_RMS, budget.most * _rms(felt.g)
        case "seat_angular_acceleration_rms_error_rad_s2":
            return TURNING, budget.most
        case "seat_angular_acceleration_deviation_relative":
            return TURNING, budget.most * _rms(felt.turning)
        case "seat_angular_acceleration_rms_ratio":
            return TURNING_RMS, budget.most * _rms(felt.turning)
        case "seat_angular_acceleration_peak_ratio":
            return TURNING_PEAK, budget.most * float(np.linalg.norm(table.turning, axis=1).max())
        case "attitude_error_max_deg":
            return ATTITUDE, budget.most
    raise ValueError(f"the peer has no budget on {budget.metric}")


def _rms(values: Floats) -> float:
    return math.sqrt(float(np.mean(np.sum(values**2, axis=-1))))


def check(task: Task, points: Floats, seat: tuple[float, float] | None = None) -> Check:
    """Evaluate the peer's functions.

    Parameters
    ----------
    task : Task
    points : (K + 3, 3) array
        Control points [rad].
    seat : (yaw, pitch), optional
        [rad]; the profile's unless given.
    """
    program = program_of(task)
    functions = ca.Function("f", [program.problem["x"]], [program.problem[n] for n in "fg"])
    cost, rows = functions(program.unknowns(points, seat or task.seat))
    g = np.asarray(rows).reshape(-1)
    first_linear = max((rows.stop for rows in program.budgets.values()), default=0)
    beyond = np.maximum(g - program.high, program.low - g)[first_linear:]
    return Check(
        float(cost),
        np.array([float(g[program.budgets[name]].max()) for name in task.budgets]),
        float(beyond.max()),
    )
