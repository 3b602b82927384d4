"""A free motion: real optima pass, and each check fails on a motion that breaks just that."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.response import respond_on
from des_cli.model.machine import OccupantBounds
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion, integrate_sides
from des_cli.model.profile import Reduction
from des_cli.reduction.fidelity import Deviation
from des_cli.reduction.free.method import find_free_motion
from des_cli.reduction.free.problem import FreeTask
from des_cli.verify.claim import Claim
from des_cli.verify.verify import verify
from tests.reduction.conftest import make_cobra
from tests.support.claims import profile_of

G, RATE = "seat_g_rms_error_g", "seat_rate_deviation_relative"
COBRA = make_cobra(250)


SPENT = {f"budget.{G}", f"budget.{RATE}"}
"""Spent to a billionth by an optimum: any change may overspend them."""


class Case:
    """A profile and what was found for it, to be changed and verified."""

    def __init__(self, most=(0.05, 0.1), machine=DES, asked=COBRA, budget=None, **options):
        budget = budget or (Budget(G, most[0]), Budget(RATE, most[1]))
        self.profile = profile_of(asked, Reduction(budget=budget, **options), machine)
        self.asked = asked
        found = find_free_motion(FreeTask.of(self.profile, asked))
        self.desired, self.seat, self.solution = found.desired, found.seat, found.solution
        assert self.solution.converged

    def checks(
        self, solution=None, *, asked=None, machine=None, seat=None, commands=None, **options
    ):
        profile = replace(
            self.profile,
            machine=machine or self.profile.machine,
            reduction=replace(self.profile.reduction, **options),
        )
        claim = Claim(
            profile,
            asked or self.asked,
            self.desired,
            seat or self.seat,
            solution or self.solution,
            commands=commands,
        )
        return verify(claim)

    def failed(self, solution=None, **changes):
        return {check.key for check in self.checks(solution, **changes) if not check.ok}

    def value(self, key, solution=None, **changes):
        (value,) = [c.value for c in self.checks(solution, **changes) if c.key == key]
        return value

    def played(self, motion, seat=None):
        """The solution with another motion, its cost by the program's own kinematics."""
        chain = chain_of(self.profile.machine, seat or self.seat)
        c = respond_on(chain, DES.gravity, motion).coriolis_seat
        running = np.sum((c @ self.profile.reduction.r1) * c, axis=-1)
        cost = 0.5 * float(integrate_sides(motion.step, running))
        return replace(self.solution, modified=motion, cost=cost)

    def moved(self, *changes, start=(0.0, 0.0, 0.0)):
        """The solution with changed rates at samples, (sample, joint, change)."""
        motion = self.solution.modified
        rate = np.vstack([motion.rate_start, motion.rate_end[-1:]])
        for sample, joint, change in changes:
            rate[sample, joint] += change
        return self.played(with_rates(motion.t, motion.angle[0] + start, rate))


def with_rates(t, first, rate):
    rise = np.cumsum(0.5 * np.diff(t)[:, None] * (rate[:-1] + rate[1:]), axis=0)
    return Motion(t, first + np.vstack([np.zeros(3), rise]), rate[:-1], rate[1:])


def between(one, other, share):
    """The motion at a share of the way from one to another: inside limits that both keep."""
    return Motion(
        one.t,
        *(
            getattr(one, name) + share * (getattr(other, name) - getattr(one, name))
            for name in ("angle", "rate_start", "rate_end")
        ),
    )


@pytest.fixture(scope="module")
def case():
    return Case()


@pytest.mark.parametrize(
    "options",
    [
        {"ends": "free"},
        {"ends": "match-rates"},
        {"ends": "match-both"},
        {"control": "per-joint", "ends": "free"},
        {"hold": frozenset({"cab"})},
        {"objective": "felt"},
        {"objective": "blend", "limits": "warn"},
        {"ends": "free", "optimise": ("seat_yaw", "seat_pitch", "fork_start", "cab_start")},
        {"budget": (Budget("attitude_error_max_deg", 8.0), Budget(RATE, 0.1))},
        {
            "budget": (
                Budget("joint_deviation_relative", 0.05),
                Budget("seat_angular_acceleration_rms_error_rad_s2", 0.15),
            )
        },
    ],
    ids=str,
)
def test_optima_pass(options):
    case = Case(**options)
    checks = case.checks()
    assert [check for check in checks if not check.ok] == []
    assert case.value("optimality") < 0.01
    assert case.value("optimality", case.played(case.desired), seat=case.profile.seat) > 0.9


def test_every_check_has_a_key_and_a_sentence_of_its_own(case):
    checks = case.checks()
    for names in ([c.key for c in checks], [c.name for c in checks]):
        assert len(set(names)) == len(names)
    limited = [
        f"limits.{joint}.{quantity}"
        for joint in ("arm", "fork", "cab")
        for quantity in ("angle", "rate", "acceleration", "jerk", "rate_step")
    ]
    limited.remove("limits.arm.angle")  # it turns endlessly
    assert [check.key for check in checks] == [
        "finite",
        "samples.times",
        *limited,
        "start.angle",
        "start.rate",
        "dynamics.angles",
        f"budget.{G}",
        f"budget.{RATE}",
        "cost",
        "cost.unreduced",
        "cost.rise",
        "optimality",
    ]


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize("name", ["angle", "rate_start", "control", "adjoint", "cost"])
def test_numbers_that_are_none(case, name, value):
    solution, n = case.solution, len(case.asked.t)
    if name == "cost":
        broken = replace(solution, cost=value)
    elif name in ("control", "adjoint"):
        broken = replace(solution, **{name: np.where(np.arange(n) == 7, value, 1.0)[:, None]})
    else:
        values = getattr(solution.modified, name).copy()
        values[7, 1] = value
        broken = replace(solution, modified=replace(solution.modified, **{name: values}))
    assert case.failed(broken) == {"finite"}


def test_times_that_are_others(case):
    motion = case.solution.modified
    slower = Motion(2.0 * motion.t, motion.angle, motion.rate_start, motion.rate_end)
    assert case.failed(replace(case.solution, modified=slower)) == {"samples.times"}
    fewer = Motion(motion.t[:-1], motion.angle[:-1], motion.rate_start[:-1], motion.rate_end[:-1])
    n = len(fewer.t)
    short = replace(
        case.solution, modified=fewer, control=np.zeros((n, 0)), adjoint=np.zeros((n, 0))
    )
    assert case.failed(short) == {"samples.times"}


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_a_spike_of_jerk_at_one_sample(case, joint):
    limit = DES.limits[joint].jerk
    spike = 0.6 * limit * case.asked.step[0] ** 2  # its second difference is 1.2 times it
    at = np.argmin(np.abs(case.solution.modified.jerk[:, joint])) + 1
    name = ("arm", "fork", "cab")[joint]
    failed = case.failed(case.moved((at, joint, spike)))
    assert f"limits.{name}.jerk" in failed
    assert failed <= {f"limits.{name}.jerk", "optimality", *SPENT}


@pytest.mark.parametrize(
    ("quantity", "share"), [("acceleration", 0.9), ("jerk", 0.999), ("rate", 0.9), ("angle", 0.9)]
)
def test_limits_that_are_smaller(case, quantity, share):
    motion = case.solution.modified
    peak = float(np.max(np.abs(getattr(motion, quantity)[:, 1])))
    limits = list(DES.limits)
    for factor, broken in ((1.0 + 1e-5, False), (share, True), (1.0 - 1e-5, True)):
        limits[1] = replace(DES.limits[1], **{quantity: factor * peak})
        failed = case.failed(machine=replace(DES, limits=tuple(limits)))
        assert (f"limits.fork.{quantity}" in failed) is broken
        assert failed <= {f"limits.fork.{quantity}"}


def test_a_motion_that_is_passed_through_keeps_its_angles(case):
    # its positions are more than the integrals of its rates
    passed = replace(case.solution, modified=case.asked)
    assert "dynamics.angles" not in case.failed(passed)
    angle = case.asked.angle.copy()
    angle[-1, 2] += 1e-9
    other = replace(case.solution, modified=replace(case.asked, angle=angle))
    assert "dynamics.angles" in case.failed(other)


def test_an_angle_that_is_exceeded_only_between_two_samples(case):
    # the fork turns back half-way between two samples: the parabola's top is between them
    t = np.arange(0.0, 1.01, 0.1)
    rate = np.zeros((11, 3))
    rate[:, 1] = 0.45 - t
    motion = with_rates(t, np.zeros(3), rate)
    top = 0.5 * 0.45**2
    assert motion.angle[:, 1].max() == pytest.approx(top - 0.5 * 0.05**2)
    reduction = Reduction(ends="free", budget=())
    for factor, broken in ((1.0 + 1e-6, False), (1.0 - 1e-6, True)):
        fork = replace(DES.limits[1], angle=factor * top)
        machine = replace(DES, limits=(DES.limits[0], fork, DES.limits[2]))
        profile = profile_of(motion, reduction, machine)
        solution = replace(
            case.solution, modified=motion, control=np.zeros((11, 0)), adjoint=np.zeros((11, 0))
        )
        checks = verify(Claim(profile, motion, motion, profile.seat, solution))
        assert ("limits.fork.angle" in {c.key for c in checks if not c.ok}) is broken


def test_a_step_of_a_rate(case):
    motion = case.solution.modified
    start = motion.rate_start.copy()
    start[100:, 2] += 1e-8
    end = motion.rate_end.copy()
    end[100:, 2] += 1e-8
    rise = np.cumsum(0.5 * motion.step[:, None] * (start + end), axis=0)
    angle = motion.angle[0] + np.vstack([np.zeros(3), rise])
    stepped = case.played(Motion(motion.t, angle, start, end))
    assert case.failed(stepped) - SPENT == {"limits.cab.rate_step"}
    assert case.failed(stepped, limits="check") <= SPENT


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_an_angle_that_is_not_the_integral(case, joint):
    angle = case.solution.modified.angle.copy()
    angle[120:, joint] += 1e-9
    broken = case.played(replace(case.solution.modified, angle=angle))
    assert case.failed(broken) - SPENT == {"dynamics.angles"}


def test_a_start_that_is_off(case):
    assert case.failed(case.moved(start=(0.0, 0.0, 1e-8))) - SPENT == {"start.angle"}
    gentle = [(k, 2, -2e-9 * (1.0 - k / 50)) for k in range(50)]
    assert case.failed(case.moved(*gentle)) - SPENT == {"start.rate"}
    assert case.failed(case.moved(*gentle), ends="free") <= {"optimality", *SPENT}


def test_a_start_that_is_free_may_be_off():
    case = Case(ends="free", optimise=("cab_start",))
    start = case.solution.modified.angle[0] - case.asked.angle[0]
    assert abs(start[2]) > 0.01
    assert case.failed() == set()
    assert "start.angle" in case.failed(optimise=())
    assert "start.angle" in case.failed(case.moved(start=(0.0, 1e-8, 0.0)))


def test_an_end_that_is_off():
    case = Case(ends="match-both")
    n = len(case.asked.t)
    late = [(n - 1 - k, 1, 2e-9 * (1.0 - k / 40)) for k in range(40)]
    assert case.failed(case.moved(*late)) - SPENT == {"ends.rate"}
    bump = [(100 + k, 1, 1e-3 * np.sin(np.pi * k / 100) ** 2) for k in range(101)]
    assert "ends.angle" in case.failed(case.moved(*bump))
    assert "ends.angle" not in case.failed(case.moved(*bump), ends="match-rates")


def test_the_end_of_a_finer_table_is_held_to_more():
    # a table ends off the smooth motion by the order of the step squared, and no more
    tolerance = {}
    for intervals in (100, 400):
        case = Case(ends="match-both", asked=make_cobra(intervals))
        (check,) = [c for c in case.checks() if c.key == "ends.angle"]
        assert check.ok
        tolerance[intervals] = check.tolerance
    assert tolerance[400] < tolerance[100] / 8.0


def test_a_joint_that_is_held_but_moves():
    case = Case(hold=frozenset({"cab"}))
    bump = [(100 + k, 2, 1e-7 * np.sin(2.0 * np.pi * k / 60)) for k in range(61)]
    assert "hold" in case.failed(case.moved(*bump))
    assert "hold" not in case.failed(case.moved(*[(k, 1, change) for k, _, change in bump]))


def test_factors_that_are_not_those_of_the_motion():
    case = Case(control="per-joint", ends="free")
    control = case.solution.control.copy()
    control[60, 0] += 1e-6
    assert case.failed(replace(case.solution, control=control)) == {"dynamics.rates"}


@pytest.mark.parametrize(
    "metric",
    [
        G,
        RATE,
        "joint_deviation_relative",
        "joint_deviation_relative_squared",
        "seat_g_deviation_relative",
        "seat_angular_acceleration_deviation_relative",
        "seat_angular_acceleration_rms_error_rad_s2",
        "attitude_error_max_deg",
    ],
)
def test_a_budget_that_is_overspent_by_little(case, metric):
    chain = chain_of(DES, case.seat)
    measured = Deviation.between(
        case.asked, case.solution.modified, (chain, chain), DES.gravity
    ).value(metric)
    for share, broken in ((1.0 + 1e-7, False), (1.0 - 1e-7, True)):
        budget = (Budget(metric, share * measured),)
        assert (f"budget.{metric}" in case.failed(budget=budget)) is broken


def test_budgets_are_on_the_motion_that_was_asked_for(case):
    # the cab's rate steps in what was asked for, and not in the executable motion
    own = case.value(f"budget.{G}")
    assert own == pytest.approx(0.0, abs=1e-3)
    assert case.value(f"budget.{G}", asked=case.desired) != pytest.approx(own, abs=1e-4)


OCCUPANT = {
    "occupant.gx": ("gx", 0),
    "occupant.gy": ("gy", 1),
    "occupant.gz": ("gz", 2),
}


@pytest.mark.parametrize("key", OCCUPANT)
@pytest.mark.parametrize("side", ["least", "most"])
def test_a_component_of_g_beyond_its_bound_at_one_sample(case, key, side):
    name, axis = OCCUPANT[key]
    chain = chain_of(DES, case.seat)
    values = respond_on(chain, DES.gravity, case.solution.modified).seat_g[..., axis]
    for slack, broken in ((1e-6, False), (-1e-6, True)):
        bounds = (-np.inf, float(values.max()) + slack)
        if side == "least":
            bounds = (float(values.min()) - slack, np.inf)
        machine = replace(DES, occupant=OccupantBounds(**{name: bounds}))
        assert (key in case.failed(machine=machine)) is broken
        assert key not in {c.key for c in case.checks(machine=machine, limits="check")}


def test_onset_and_angular_acceleration_beyond_their_bounds(case):
    motion = case.solution.modified
    response = respond_on(chain_of(DES, case.seat), DES.gravity, motion)
    samples = np.vstack([response.seat_g[:, 0], response.seat_g[-1:, 1]])
    onset = float(np.max(np.abs(np.diff(samples, axis=0)) / motion.step[:, None]))
    turning = float(np.max(np.linalg.norm(response.seat_angular_acceleration, axis=-1)))
    for share, broken in ((1.0 + 1e-6, False), (1.0 - 1e-6, True)):
        for key, bounds in (
            ("occupant.onset", OccupantBounds(g_onset=share * onset)),
            (
                "occupant.angular_acceleration",
                OccupantBounds(angular_acceleration=share * turning),
            ),
        ):
            assert (key in case.failed(machine=replace(DES, occupant=bounds))) is broken


def led(motion, seconds, last=0.0):
    """A motion that comes from rest in so many seconds, with the cosine's rates, (n, 3)."""
    t = np.concatenate([motion.t[0] - seconds + np.arange(0.0, seconds, 0.04), motion.t])
    share = 0.5 - 0.5 * np.cos(np.pi * (t - t[0])[:, None] / seconds)
    count = len(t) - len(motion.t)
    rate = np.vstack([motion.rate_start[0] * share[:count] + last, motion.rate])
    found = with_rates(t, np.zeros(3), rate)
    angle = found.angle + (motion.angle[0] - found.angle[count])
    angle[count:] = motion.angle
    return replace(found, angle=angle)


def test_a_table_with_a_lead(case):
    motion, lead = case.solution.modified, {"lead_in": 4.0, "limits": "warn"}
    assert case.failed(commands=led(motion, 4.0), **lead) == set()
    # faster than the machine may, though the maneuver itself is not
    failed = case.failed(commands=led(motion, 0.4), lead_in=0.4)
    assert {"limits.arm.acceleration", "limits.arm.jerk"} <= failed
    assert all(key.startswith("limits.") for key in failed)
    assert case.failed(commands=led(motion, 4.0), lead_in=5.0, limits="warn") == {"leads.length"}
    assert case.failed(commands=led(motion, 4.0, last=2e-9), **lead) == {"leads.rest"}
    table = led(motion, 4.0)
    angle = table.angle.copy()
    angle[150:, 0] += 1e-8
    failed = case.failed(commands=replace(table, angle=angle), **lead)
    assert failed == {"leads.maneuver", "dynamics.angles"}
    cut = led(replace_end(motion), 4.0)
    assert "leads.maneuver" in case.failed(commands=cut, **lead)
    angle[3, 1] = np.nan
    assert case.failed(commands=replace(table, angle=angle), **lead) == {"finite"}


def replace_end(motion):
    """The motion without its last interval."""
    return Motion(motion.t[:-1], motion.angle[:-1], motion.rate_start[:-1], motion.rate_end[:-1])


def test_costs_that_are_off(case):
    solution = case.solution
    off = 1.0 + 1e-7
    assert case.failed(replace(solution, cost=off * solution.cost)) == {"cost"}
    dearer = replace(solution, cost_unreduced=off * solution.cost_unreduced)
    assert case.failed(dearer) == {"cost.unreduced"}


def test_a_weight_in_the_studys_axes_is_on_these(case):
    # only along the ground's j0: another number than along the seat's y
    r1 = np.diag([0.0, 2.0, 0.0])
    costs = []
    for name in ("coriolis_report", "coriolis_seat"):
        c = getattr(respond_on(chain_of(DES, case.seat), DES.gravity, case.solution.modified), name)
        costs.append(float(integrate_sides(case.asked.step, c[..., 1] ** 2)))
    for axes, right, wrong in (("report", *costs), ("seat", *reversed(costs))):
        assert "cost" not in case.failed(replace(case.solution, cost=right), r1=r1, axes=axes)
        assert "cost" in case.failed(replace(case.solution, cost=wrong), r1=r1, axes=axes)


def test_a_motion_that_is_worse_than_the_desired_one(case):
    away = between(case.solution.modified, case.desired, 1.3)
    assert "cost.rise" in case.failed(case.played(away))
    # what is allowed to be rougher may be worse than a desired motion that is not allowed
    tight = (Budget(G, 1e-6), Budget(RATE, 1e-6))
    assert "cost.rise" not in {c.key for c in case.checks(case.played(away), budget=tight)}


def test_the_desired_motion_is_no_optimum(case):
    assert case.failed(case.played(case.desired)) == {"optimality"}


@pytest.mark.parametrize("share", [0.1, 0.5])
def test_a_share_of_the_way_is_no_optimum(case, share):
    halfway = case.played(between(case.desired, case.solution.modified, 1.0 - share))
    assert case.failed(halfway) == {"optimality"}


def test_the_optimum_of_other_budgets(case):
    half = Case(most=(0.025, 0.05))
    assert half.failed() == set()
    assert case.failed(half.solution) == {"optimality"}


def test_the_optimum_between_other_ends(case):
    both = Case(ends="match-both")
    assert case.failed(both.solution) == {"optimality"}


def test_the_optimum_of_another_objective(case):
    felt = Case(objective="felt")
    assert case.failed(felt.solution) == {"optimality"}
    assert felt.failed(case.solution) == {"optimality"}


def test_the_optimum_of_other_weights_on_a_fine_table():
    r1, fine = np.diag([2.0, 3.0, 2.0]), make_cobra(1000)
    case, other = Case(asked=fine), Case(asked=fine, r1=r1)
    assert other.failed() == set()
    assert "optimality" in case.failed(r1=r1)
    assert "optimality" in other.failed(r1=case.profile.reduction.r1)


def test_the_optimum_of_another_seat():
    fixed, freed = (Case(ends="free", optimise=o) for o in ((), ("seat_pitch",)))
    assert freed.failed() == set()
    assert freed.failed(fixed.solution, seat=fixed.profile.seat) == {"optimality"}


def test_budgets_on_a_table_whose_positions_jump():
    # no sample at 5 s, where the cab turns back: within one interval it is elsewhere than
    # its rates tell, and less of the budget on G is seen at the samples than between them
    case = Case(asked=make_cobra(1013))
    assert -0.4 < case.value(f"budget.{G}") < -0.2
    assert case.failed() == set()
    assert case.value("optimality") < 0.01


def test_a_maneuver_without_cross_coupling_passes():
    t = np.linspace(0.0, 6.0, 151)
    rate = np.stack([0.5 + 0.2 * np.sin(t), 0.0 * t, 0.0 * t], axis=1)
    for objective in ("coriolis", "blend"):
        case = Case(asked=with_rates(t, np.zeros(3), rate), objective=objective)
        assert case.failed() == set()
