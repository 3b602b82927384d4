"""The study's maneuvers as motions, and its closed forms as an independent cost."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.model.arrays import Floats
from des_cli.model.machine import Machine, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.model.solution import Solution
from des_cli.reduction.optimum import find_optimum
from des_cli.reduction.problem import Problem
from des_cli.reduction.search import Search
from tests.support.cobra import cobra_intervals


def make_cobra(intervals: int = 1000, *, table3: bool = False, azimuth: float = 0.0) -> Motion:
    """The Cobra of (34)-(37), or the maneuver of Table 3: the cab's rate steps at 5 s."""
    t = np.linspace(0.0, 10.0, intervals + 1)
    angle, start, end = cobra_intervals(t)
    if table3:
        fold = np.abs(t - 5.0)
        arm, side = 1.3 + 0.24 * fold, np.where(t[:-1] < 5.0 - 1e-9, -1.0, 1.0)
        start[:, 0], end[:, 0], start[:, 2], end[:, 2] = arm[:-1], arm[1:], *2 * [0.105 * side]
        angle[:, 2] = np.radians(30.0) + 0.105 * (fold - 5.0)
        turned = np.cumsum(0.5 * np.diff(t) * (arm[1:] + arm[:-1]))
        angle[:, 0] = np.concatenate([[0.0], turned])
    angle[:, 0] += azimuth
    return Motion(t, angle, start, end)


def make_wave(
    amplitude: Sequence[Sequence[float]], *, intervals: int = 24, duration: float = 6.0
) -> Motion:
    """A smooth motion: joint i has the rate sum_j amplitude_ij cos(j pi t / duration)."""
    t = np.linspace(0.0, duration, intervals + 1)
    order = np.arange(np.shape(amplitude)[1])
    rate = np.cos(np.pi * order * t[:, None] / duration) @ np.transpose(amplitude)
    step = 0.5 * np.diff(t)[:, None] * (rate[1:] + rate[:-1])
    angle = np.array([0.2, -0.3, 0.4]) + np.vstack([np.zeros(3), np.cumsum(step, axis=0)])
    return Motion(t, angle, rate[:-1], rate[1:])


def make_uneven() -> Motion:
    """Nine samples, unequal steps, rates that step twice, positions of their own."""
    rng = np.random.default_rng(17)
    t = np.cumsum(np.concatenate([[1.5], rng.uniform(0.05, 0.4, 8)]))
    rate = rng.normal(size=(9, 3))
    start, end = rate[:-1].copy(), rate[1:].copy()
    start[3, 2] += 0.7
    start[6] -= 0.4
    step = np.diff(t)[:, None]
    moved = 0.5 * step * (start + end)
    moved[:, 1:] += 0.01 * rng.normal(size=(8, 2))  # more than the rates' trapezoids
    angle = np.array([0.6, -0.3, 0.9]) + np.vstack([np.zeros(3), np.cumsum(moved, axis=0)])
    return Motion(t, angle, start, end)


def make_problem(
    motion: Motion,
    r2: float | Sequence[float] = 1.0,
    *,
    control: str = "scalar",
    axes: str = "report",
    r1: Any = (0.0, 2.0, 0.0),
    tracking: float | Sequence[float] = 0.0,
    **further: Any,
) -> Problem:
    """A problem with the study's weights; a single r2 is shared by the joints."""
    weight = np.broadcast_to(np.asarray(r2, dtype=float), 3)
    return Problem(
        desired=motion,
        chain=chain_of(DES, Seat()),
        axes=axes,  # type: ignore[arg-type]
        r1=np.diag(np.array(r1, float)) if np.ndim(r1) == 1 else np.array(r1, float),
        r2=np.array([weight.mean()]) if control == "scalar" else weight / 3.0,
        tracking=np.broadcast_to(np.asarray(tracking, dtype=float), 3),
        **further,
    )


def study_coriolis(
    theta: Sequence[Any], rate: Sequence[Any], axes: str, lib: Any = np
) -> list[Any]:
    """(22)-(24), and along the seat's axes by the rotation of (10) at the study's seat."""
    (s1, s2, s3), (c1, c2, c3) = ([f(a) for a in theta] for f in (lib.sin, lib.cos))
    d1, d2, d3 = rate
    ab3 = -d2 * d1 * s1 - d3 * d1 * c1 * c2 + d3 * d2 * s1 * s2
    bb3 = -d2 * d1 * c1 + d3 * d1 * s1 * c2 + d3 * d2 * c1 * s2
    cb3 = -d3 * d2 * c2
    if axes == "report":
        return [ab3, bb3, cb3]
    return [
        s1 * c2 * ab3 + c1 * c2 * bb3 + s2 * cb3,
        (c1 * c3 - s1 * s2 * s3) * ab3 - (s1 * c3 + c1 * s2 * s3) * bb3 + c2 * s3 * cb3,
        (s1 * s2 * c3 + c1 * s3) * ab3 + (c1 * s2 * c3 - s1 * s3) * bb3 - c2 * c3 * cb3,
    ]


def study_rates(problem: Problem, theta: Floats, u: Floats, side: slice, rate: Floats) -> Any:
    """Adapted rates u phi, with phi on the desired angles or by inverting J_in by hand."""
    if problem.jacobian == "desired":
        return u * rate
    (s1, s2), (c1, c2) = (f(problem.desired.angle[side, :2]).T for f in (np.sin, np.cos))
    d1, d2, d3 = rate.T
    w1, w2, w3 = c1 * d2 - s1 * c2 * d3, -s1 * d2 - c1 * c2 * d3, -d1 - s2 * d3
    (t1, t2), (u1, u2) = ([f(theta[..., j]) for j in (0, 1)] for f in (np.sin, np.cos))
    cab = -(t1 * w1 + u1 * w2) / u2
    return u * np.stack([-w3 - t2 * cab, u1 * w1 - t1 * w2, cab], axis=-1)


def study_cost(problem: Problem, x: Floats) -> Any:
    """J of iterates (..., n, 3 + m), complex ones too: the definition, side by side."""
    desired = problem.desired
    angle, control = x[..., :3], x[..., 3:]
    total = 0.0
    for at, rate in ((slice(None, -1), desired.rate_start), (slice(1, None), desired.rate_end)):
        theta, u = angle[..., at, :], control[..., at, :]
        made = study_rates(problem, theta, u, at, rate)
        c = np.stack(
            study_coriolis(np.moveaxis(theta, -1, 0), np.moveaxis(made, -1, 0), problem.axes),
            axis=-1,
        )
        off = theta - desired.angle[at]
        running = np.sum((c @ problem.r1) * c, axis=-1)
        running = running + ((1.0 - u) ** 2) @ problem.r2 + off**2 @ problem.tracking
        total = total + 0.25 * running @ desired.step
    return total


def study_motion(problem: Problem, control: Floats) -> Floats:
    """Iterates (..., n, 3 + m) of factors (..., n, m): rates linear between samples."""
    desired = problem.desired
    factor = np.broadcast_to(control, (*control.shape[:-1], 3))
    before, after = factor[..., :-1, :], factor[..., 1:, :]
    half = 0.5 * desired.step[:, None]
    moved = half * (before * desired.rate_start + after * desired.rate_end)
    missed = np.diff(desired.angle, axis=0) - half * (desired.rate_start + desired.rate_end)
    missed[:, 0] = 0.0  # the arm is commanded by its velocity
    moved = moved + 0.5 * (before + after) * missed
    start = np.zeros((*control.shape[:-2], 1, 3))
    angle = desired.angle[0] + np.concatenate([start, np.cumsum(moved, axis=-2)], axis=-2)
    return np.concatenate([angle, control], axis=-1)


@pytest.fixture(scope="session")
def table_1() -> Machine:
    """The DES with the limits of Table 1 alone, which has none on the jerk."""
    return replace(DES, limits=tuple(replace(limit, jerk=np.inf) for limit in DES.limits))


@pytest.fixture(scope="session")
def cobra() -> Callable[..., Motion]:
    return make_cobra


@pytest.fixture(scope="session")
def wave() -> Callable[..., Motion]:
    return make_wave


@pytest.fixture(scope="session")
def uneven() -> Motion:
    return make_uneven()


@pytest.fixture(scope="session")
def pose() -> Callable[..., Problem]:
    return make_problem


@pytest.fixture(scope="session")
def closed_coriolis() -> Callable[..., list[Any]]:
    return study_coriolis


@pytest.fixture(scope="session")
def closed_rates() -> Callable[..., Any]:
    return study_rates


@pytest.fixture(scope="session")
def closed_cost() -> Callable[..., Any]:
    return study_cost


@pytest.fixture(scope="session")
def closed_motion() -> Callable[..., Floats]:
    return study_motion


@pytest.fixture(scope="session")
def solve_problem() -> Callable[..., Solution]:
    """Find the optimum of a problem, within so many Newton steps."""

    def find(problem: Problem, limit: int = 500, **options: Any) -> Solution:
        return find_optimum(problem, Search(limit, **options))

    return find
