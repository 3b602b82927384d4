"""Derivatives on spans of intervals, with a seat that turns, by differences of the values."""

from __future__ import annotations

from collections.abc import Callable
from typing import get_args

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.seat_turn import seat_turns
from des_cli.kinematics.trig_polynomial import TrigPolynomial
from des_cli.kinematics.twist import SeatMotion, seat_forms
from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.reduction.free.chunk import Chunk
from des_cli.reduction.free.expansion import MotionExpansion
from des_cli.reduction.free.local_bounds import (
    AttitudeBound,
    ComponentBound,
    LocalBound,
    NormBound,
    OnsetBound,
)
from des_cli.reduction.free.terms import JointBudget, Quantity, Term, square
from des_cli.reduction.free.unknowns import Unknowns
from des_cli.reduction.free.windows import POINTS
from des_cli.solver.spline import SplineGrid
from tests.support.bands import dense
from tests.support.differences import along

GRID = SplineGrid(0.0, 0.4, 6)
SEAT = Seat(0.4, -0.3)
UNKNOWNS = Unknowns(GRID, 2)
ALL = POINTS * GRID.intervals
WHOLE, TWO = ((0, 6),), ((0, 4), (4, 6))
SPANS = pytest.mark.parametrize("spans", [WHOLE, TWO], ids=["whole", "in two"])
ROOT = np.array([[1.0, 0.2, 0.0], [0.3, 0.8, -0.1], [0.0, 0.5, 1.1]])
TRANSFORM = chain_of(DES, SEAT).transform.coefficient[..., :3, :3]
ROTATION = TrigPolynomial(TRANSFORM.reshape(3, 3, 3, 9))
REFERENCE = np.random.default_rng(1).uniform(-0.5, 0.5, (3, ALL))
BOUNDS: dict[str, LocalBound] = {
    "components": ComponentBound(
        np.array([[0.1, 0.0, 0.0], [0.0, 0.03, -0.1]]), np.array([2.0, 1.0]), np.array([2.0, 1.5])
    ),
    "length of the acceleration": NormBound("acceleration", 1.7),
    "length of the force": NormBound("force", 20.0),
    "onset": OnsetBound(np.concatenate([np.eye(3), -np.eye(3)]) / 7.0),
    "attitude": AttitudeBound(ROTATION, ROTATION(REFERENCE.T).T, 0.4),
}
Span = tuple[int, int]


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(23)


@pytest.fixture
def x(rng: np.random.Generator) -> Floats:
    return 0.3 * rng.normal(size=UNKNOWNS.size)


def turned(x: Floats) -> Seat:
    """The seat of a vector; its angles stand in the order of the machine's turns."""
    assert list(seat_turns(DES, SEAT)) == ["seat_yaw", "seat_pitch"]
    yaw, pitch = UNKNOWNS.seat_angles(x)
    return Seat(SEAT.yaw + float(yaw), SEAT.pitch + float(pitch))


def seat_on(x: Floats, span: Span) -> SeatMotion:
    forms = seat_forms(chain_of(DES, turned(x)), DES.gravity)
    return forms.at(UNKNOWNS.seat_windows.gather(UNKNOWNS.control(x), *span))


def at_of(span: Span) -> slice:
    return slice(POINTS * span[0], POINTS * span[1])


def expanded(
    x: Floats, spans: tuple[Span, ...], add: Callable[[Chunk, MotionExpansion, Span], None]
) -> MotionExpansion:
    """An expansion to which every span adds something."""
    total, turns = MotionExpansion(UNKNOWNS, 0), list(seat_turns(DES, turned(x)).values())
    for span in spans:
        chunk = Chunk(total, seat_on(x, span), turns, *span)
        add(chunk, total, span)
        chunk.finish()
    return total


def whole(expansion: MotionExpansion, share: float) -> Floats:
    hessian = expansion.hessian(share)
    return np.block([[dense(hessian.band), hessian.border.T], [hessian.border, hessian.corner]])


def same(found: Floats, expected: Floats, rtol: float = 1e-7) -> None:
    np.testing.assert_allclose(found, expected, rtol=0, atol=rtol * np.abs(expected).max() + 1e-12)


@SPANS
@pytest.mark.parametrize("quantity", get_args(Quantity))
def test_a_term(
    quantity: Quantity, spans: tuple[Span, ...], x: Floats, rng: np.random.Generator
) -> None:
    term, factor = Term(quantity, ROOT, rng.normal(size=(3, ALL))), 0.7

    def take(at: Floats) -> MotionExpansion:
        def add(chunk: Chunk, total: MotionExpansion, span: Span) -> None:
            total.cost += chunk.take(term, factor, total.gradient)

        return expanded(at, spans, add)

    def value(at: Floats) -> Floats:
        return np.array(
            [sum(square(term.residual(seat_on(at, span), at_of(span))) for span in spans)]
        )

    step, found = rng.normal(size=x.shape), take(x)
    assert found.cost == pytest.approx(value(x)[0], rel=1e-12)
    same(np.array([found.gradient @ step]), along(value, x, step))
    bend = along(lambda at: take(at).gradient, x, step)
    same(whole(found, 1.0) @ step, factor * bend, 1e-6)
    assert np.linalg.eigvalsh(whole(found, 0.0))[0] > -1e-9 * np.abs(whole(found, 0.0)).max()


@SPANS
def test_a_joint_budget(spans: tuple[Span, ...], x: Floats, rng: np.random.Generator) -> None:
    """Of the angles at the points from a reference: 0.6 times their squares, summed up."""
    off = rng.normal(size=(3, ALL))
    budget, windows = JointBudget(0.6, off), UNKNOWNS.angle_windows

    def add(chunk: Chunk, total: MotionExpansion, span: Span) -> None:
        total.cost += chunk.take_joints(budget, UNKNOWNS.control(x), total.gradient)

    def value(at: Floats) -> Floats:
        control = UNKNOWNS.control(at)
        angles = [windows.gather(control, *span) + off[:, at_of(span)] for span in spans]
        return np.array([0.6 * sum(np.sum(each**2) for each in angles)])

    found, step = expanded(x, spans, add), rng.normal(size=x.shape)
    assert found.cost == pytest.approx(value(x)[0], rel=1e-12)
    same(np.array([found.gradient @ step]), along(value, x, step))
    assert not UNKNOWNS.seat_angles(found.gradient).any()


@SPANS
@pytest.mark.parametrize("bound", BOUNDS.values(), ids=list(BOUNDS))
def test_a_bound(
    bound: LocalBound, spans: tuple[Span, ...], x: Floats, rng: np.random.Generator
) -> None:
    each = bound.rows * (1 if bound.per_interval else POINTS)
    multiplier, stiffness = rng.random((2, each * GRID.intervals))

    def angles_on(at: Floats, span: Span) -> Floats:
        return UNKNOWNS.angle_windows.gather(UNKNOWNS.control(at), *span)

    def bind(at: Floats) -> MotionExpansion:
        values: list[Floats] = []

        def add(chunk: Chunk, total: MotionExpansion, span: Span) -> None:
            rows, angles = slice(each * span[0], each * span[1]), angles_on(at, span)
            values.append(chunk.bind(bound, angles, rows, multiplier[rows], stiffness[rows]))

        total = expanded(at, spans, add)
        total.local = np.concatenate(values)
        return total

    def value(at: Floats) -> Floats:
        return np.concatenate(
            [
                bound.value(seat_on(at, span), angles_on(at, span), at_of(span)).ravel()
                for span in spans
            ]
        )

    step, found = rng.normal(size=x.shape), bind(x)
    np.testing.assert_allclose(found.local, value(x), rtol=1e-12)
    change = found.local_change(step)
    same(change, along(value, x, step))
    barrier = found.local_adjoint(stiffness * change)
    bend = along(lambda at: bind(at).local_adjoint(multiplier), x, step)
    same(whole(found, 1.0) @ step, bend + barrier, 1e-6)
    same(whole(found, 0.0) @ step, barrier, 1e-9)


def test_terms_and_bounds_of_one_quantity_add_up(x: Floats, rng: np.random.Generator) -> None:
    bound, term = BOUNDS["components"], Term("force", ROOT)
    nothing, (multiplier, stiffness) = np.zeros((3, 0)), rng.random((2, bound.rows * ALL))
    rows = slice(0, bound.rows * ALL)

    def take(chunk: Chunk, total: MotionExpansion, span: Span) -> None:
        chunk.take(term, 1.0, total.gradient)

    def bind(chunk: Chunk, total: MotionExpansion, span: Span) -> None:
        chunk.bind(bound, nothing, rows, multiplier, stiffness)

    def both(chunk: Chunk, total: MotionExpansion, span: Span) -> None:
        take(chunk, total, span)
        bind(chunk, total, span)

    one, other, total = (whole(expanded(x, WHOLE, add), 1.0) for add in (take, bind, both))
    same(total, one + other, 1e-12)
