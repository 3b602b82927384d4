"""The peer's derivatives against CasADi's own, and what it returns against the table oracle."""

import math

import casadi as ca
import numpy as np
import pytest

from tests.support.cobra import COBRA_S, cobra
from tests.support.felt_reference import evaluate
from tests.support.ipopt_program import program_of
from tests.support.ipopt_spline import fit_base, solve
from tests.support.seat_forms import Floats
from tests.support.spline_task import (
    ATTITUDE,
    G_RMS,
    JOINTS,
    OPTIMISE,
    RATE,
    TURNING,
    TURNING_PEAK,
    TURNING_RMS,
    Task,
    des_limits,
    reference_of,
    spline_states,
)

K = 50
LIMITS = des_limits(2.0)
BUDGETS = (RATE, ATTITUDE, G_RMS, JOINTS, TURNING, TURNING_RMS, TURNING_PEAK)


@pytest.fixture(scope="module")
def base() -> Floats:
    return fit_base(cobra, COBRA_S, K, LIMITS)


@pytest.mark.parametrize("optimise", [(), OPTIMISE])
@pytest.mark.parametrize("objective", ["coriolis", "blend", "felt"])
def test_assembled_derivatives_are_those_of_the_whole_graph(
    optimise: tuple[str, ...], objective: str
) -> None:
    draw = np.random.default_rng(11)
    k = 5
    task = Task(
        1.0,
        reference_of(cobra, 1.0, k),
        draw.normal(size=(k + 3, 3)),
        LIMITS,
        dict(zip(BUDGETS, (0.1, 5.0, 0.05, 0.05, 0.15, 0.5, 0.6), strict=True)),
        objective,
        r1=np.array([[2.0, 0.3, 0.0], [0.3, 1.0, 0.0], [0.0, 0.0, 0.5]]),
        optimise=optimise,
        regularisation=1e-3,
    )
    program = program_of(task)
    x, f, g = (program.problem[name] for name in "xfg")
    lam_f, lam_g = ca.MX.sym("f"), ca.MX.sym("g", g.shape[0])
    plain = ca.Function(
        "plain",
        [x, lam_f, lam_g],
        [
            ca.gradient(f, x),
            ca.jacobian(g, x),
            ca.triu(ca.hessian(lam_f * f + ca.dot(lam_g, g), x)[0]),
        ],
    )
    at = program.unknowns(task.base + 0.1 * draw.normal(size=(k + 3, 3)), (1.4, -0.2))
    weights = draw.normal(size=g.shape[0])
    expected = [np.asarray(each) for each in plain(at, 0.7, weights)]
    found = [
        np.asarray(program.gradient(at, [])[1]),
        np.asarray(program.jacobian(at, [])[1]),
        np.asarray(program.hessian(at, [], 0.7, weights)),
    ]
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-11 * np.abs(other).max())


def test_the_base_spline_is_the_cobra_inside_the_limits(base: Floats) -> None:
    h = COBRA_S / K
    # two rows an interval, so that the jerk is seen inside one
    rows = np.linspace(0, COBRA_S, 2 * K + 1)
    found = evaluate(lambda t: spline_states(base, COBRA_S, t), rows)
    assert found.attitude_error_max_deg < 0.5
    for values in (found.start_angle, found.start_rate, found.end_angle, found.end_rate):
        np.testing.assert_allclose(values, 0.0, atol=1e-7)
    third = np.abs(np.diff(base, 3, axis=0)).max(axis=0) / h**3
    np.testing.assert_allclose(third, found.jerk_peak, rtol=1e-6)
    assert (third <= LIMITS.jerk * (1 + 1e-6)).all()


def test_the_answer_spends_its_budgets_and_keeps_the_limits_and_the_start(base: Floats) -> None:
    most = {RATE: 0.1, G_RMS: 0.05}
    task = Task(COBRA_S, reference_of(cobra, COBRA_S, K), base, LIMITS, most)
    answer = solve(task)
    assert answer.success
    assert max(answer.spent.values()) == pytest.approx(1.0, abs=1e-6)

    # 4-point quadrature between other instants than the peer's
    rows = np.linspace(0, COBRA_S, 4 * K + 1)
    found = evaluate(lambda t: spline_states(answer.points, COBRA_S, t), rows)
    assert found.reduction == pytest.approx(1 - answer.cost, abs=2e-3)
    assert found.seat_rate_deviation_relative == pytest.approx(0.1, rel=5e-3)
    assert found.seat_g_rms_error_g == pytest.approx(0.05, rel=5e-3)
    assert (found.acceleration_peak <= LIMITS.acceleration * (1 + 1e-6)).all()
    assert (found.jerk_peak <= LIMITS.jerk * (1 + 1e-6)).all()
    np.testing.assert_allclose(found.start_angle, 0.0, atol=1e-6)
    np.testing.assert_allclose(found.start_rate, 0.0, atol=1e-6)


def test_a_bound_on_the_attitude_holds_at_every_point(base: Floats) -> None:
    task = Task(COBRA_S, reference_of(cobra, COBRA_S, K), base, LIMITS, {ATTITUDE: 5.0})
    answer = solve(task)
    assert answer.success
    found = evaluate(
        lambda t: spline_states(answer.points, COBRA_S, t), np.linspace(0, COBRA_S, K + 1)
    )
    assert 4.9 < found.attitude_error_max_deg < 5.1
    assert found.reduction > 0.3
    assert math.isclose(answer.spent[ATTITUDE], 1.0, abs_tol=1e-6)
