"""Free motions against CasADi/IPOPT on the identical discrete problem.

The peer is written with closed forms and its own splines (tests/support); the tool
evaluates Table 2's product. First their functions must agree at one motion, then their
optima.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest

from des_cli import load_profile
from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.arrays import Floats
from des_cli.model.metric import Budget
from des_cli.model.profile import Reduction
from des_cli.reduction.executable import ExecutableSpline, fit_executable
from des_cli.reduction.free.inside import find_inside
from des_cli.reduction.free.pose import pose_motion
from des_cli.reduction.free.program import MotionProgram
from des_cli.reduction.free.task import FreeTask, turned_seat
from des_cli.solver.barrier import Options, Outcome, minimise
from des_cli.solver.spline import SplineGrid
from tests.support.bridge import check, peer_task
from tests.support.ipopt_spline import solve
from tests.support.spline_task import ATTITUDE, TURNING_PEAK

pytestmark = pytest.mark.slow

G_AND_RATE = {"seat_g_rms_error_g": 0.05, "seat_rate_deviation_relative": 0.1}
TURNING = {"seat_angular_acceleration_rms_error_rad_s2": 0.15}
NO_ROUGHER = {
    "seat_angular_acceleration_rms_ratio": 1.05,
    "seat_angular_acceleration_peak_ratio": 1.1,
}
ALL_FREE = ("seat_yaw", "seat_pitch", "fork_start", "cab_start")
AGREE = 1e-6
"""Largest difference of the costs; that of the desired motion is one."""

OPTIONS = Options(gap=1e-9, tolerance=1e-7)


@dataclass(frozen=True)
class Case:
    """One problem of the tool, and where it starts."""

    task: FreeTask
    fit: ExecutableSpline
    program: MotionProgram

    @classmethod
    def of(
        cls,
        budgets: dict[str, float],
        *,
        profile: str = "cobra",
        intervals: int = 60,
        jerk_per_s: float = 2.0,
        **settings: object,
    ) -> Case:
        given = load_profile(profile)
        limits = tuple(
            replace(limit, jerk=jerk_per_s * limit.acceleration) for limit in given.machine.limits
        )
        budget = tuple(Budget(metric, most) for metric, most in budgets.items())
        asked = replace(
            given,
            machine=replace(given.machine, limits=limits),
            reduction=replace(Reduction(budget=budget), **settings),
        )
        task = FreeTask.of(asked, make_desired(asked).motion)
        t = task.reference.t
        grid = SplineGrid(float(t[0]), float(t[-1] - t[0]) / intervals, intervals)
        fit = fit_executable(grid, task.reference, task.limits, task.base_ends)
        assert not fit.trouble
        return cls(task, fit, MotionProgram(pose_motion(task, grid, fit.control)))

    def solve(self) -> Outcome:
        inside = find_inside(self.program, np.zeros(self.program.size))
        assert inside is not None
        return minimise(self.program, inside, OPTIONS)

    def motion(self, x: Floats) -> tuple[Floats, tuple[float, float]]:
        seat = turned_seat(self.task, self.program.seat_angles(x))
        return self.fit.control + self.program.control(x), (seat.yaw, seat.pitch)

    def seat_cost(self, x: Floats) -> float:
        """Return what the tool, and not the peer, charges for a turn of the seat."""
        if self.program.problem.seat is None:
            return 0.0
        turn = self.program.seat_angles(x)
        return 0.5 * self.program.problem.seat.weight * float(turn @ turn)


CASES = {
    "two budgets": partial(Case.of, G_AND_RATE),
    "no rougher, the defaults": partial(Case.of, G_AND_RATE | NO_ROUGHER),
    "no rougher, more allowed": partial(
        Case.of, {"seat_g_rms_error_g": 0.2, "seat_rate_deviation_relative": 0.2} | NO_ROUGHER
    ),
    "match-rates, angular acceleration": partial(
        Case.of, G_AND_RATE | TURNING, ends="match-rates", jerk_per_s=1.0
    ),
    "match-both": partial(Case.of, G_AND_RATE, ends="match-both"),
    "rates free at both ends": partial(Case.of, G_AND_RATE, ends="free"),
    "joints, angular acceleration": partial(
        Case.of, {"joint_deviation_relative": 0.05} | TURNING, ends="free"
    ),
    "relative budgets": partial(
        Case.of,
        {
            "joint_deviation_relative_squared": 0.01,
            "seat_g_deviation_relative": 0.03,
            "seat_angular_acceleration_deviation_relative": 0.4,
        },
    ),
    "blend": partial(Case.of, G_AND_RATE, objective="blend"),
    "felt": partial(Case.of, G_AND_RATE, objective="felt"),
    "attitude": partial(Case.of, {"attitude_error_max_deg": 5.0}),
    "attitude and rate": partial(
        Case.of, {"attitude_error_max_deg": 3.0, "seat_rate_deviation_relative": 0.05}
    ),
    "one component": partial(Case.of, G_AND_RATE, r1=np.diag([0.0, 2.0, 0.0])),
    "starts free": partial(Case.of, G_AND_RATE, ends="free", optimise=("fork_start", "cab_start")),
    "seat free": partial(Case.of, G_AND_RATE, ends="free", optimise=ALL_FREE),
    "another maneuver": partial(Case.of, G_AND_RATE, profile="post_stall_reversal", intervals=100),
}


@pytest.fixture(scope="module", params=list(CASES))
def case(request: pytest.FixtureRequest) -> Case:
    return CASES[request.param]()


def test_cost_budgets_and_limits_are_the_peers_at_any_motion(case: Case) -> None:
    draw = np.random.default_rng(5)
    x = 0.05 * draw.normal(size=case.program.size)
    found = case.program.values(x)
    peer = peer_task(case.task, case.fit.grid, case.fit.control)
    expected = check(peer, *case.motion(x))
    assert found.cost - case.seat_cost(x) == pytest.approx(expected.cost, rel=1e-11)
    at_points = np.array([name in (ATTITUDE, TURNING_PEAK) for name in peer.budgets])
    np.testing.assert_allclose(found.budgets, expected.budgets[~at_points], rtol=1e-10)
    if at_points.any():
        largest = expected.budgets[at_points].max()
        np.testing.assert_allclose(found.local.max(), largest, rtol=1e-10)
    # Both stand in one order: what is farthest beyond its bound.
    excess = np.max(np.abs(case.program.linear(x)) / case.program.bounds) - 1.0
    assert excess == pytest.approx(expected.excess, rel=1e-9)


def test_the_optimum_is_ipopts(case: Case) -> None:
    outcome = case.solve()
    assert outcome.status == "converged"
    peer = peer_task(case.task, case.fit.grid, case.fit.control)
    answer = solve(peer)
    assert answer.success
    found = check(peer, *case.motion(outcome.x))
    assert abs(found.cost - answer.cost) <= AGREE
    assert found.excess <= 1e-12
    assert (found.budgets <= 1.0).all()
