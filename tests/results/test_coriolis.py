"""What became of each part of the Coriolis vector, by hand and by plain sums."""

from __future__ import annotations

import math

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.model.response import Response
from des_cli.reduction.baseline import relative_reduction
from des_cli.results.coriolis import coriolis_metrics
from tests.support.sway import coriolis_parts, integral, reduced_sway

STEP = np.array([1.0, 3.0])


def response(report: Floats, seat: Floats) -> Response:
    none = np.zeros((2, 2, 3))
    return Response(seat, none, none, none, report)


def along(axis: int, *sides: float) -> Floats:
    vectors = np.zeros((2, 2, 3))
    vectors[..., axis] = np.reshape(sides, (2, 2))
    return vectors


@pytest.mark.parametrize("part", ["bb3", "ab3", "cb3", "vector", "seat_x", "seat_y", "seat_z"])
def test_each_part_of_a_reduction_by_plain_sums(part: str) -> None:
    run = reduced_sway()
    wanted, made = run.desired, run.solution.modified
    before, after = coriolis_parts(wanted)[part], coriolis_parts(made)[part]
    found = run.metrics["coriolis"][part]
    energies = [integral(wanted, side**2) for side in (before, after)]
    assert found["reduction"] == pytest.approx(1.0 - energies[1] / energies[0], rel=1e-9)
    assert found["rms_before_rad_s2"] == pytest.approx(math.sqrt(energies[0] / 6.0), rel=1e-9)
    assert found["rms_after_rad_s2"] == pytest.approx(math.sqrt(energies[1] / 6.0), rel=1e-9)
    assert found["peak_before_rad_s2"] == pytest.approx(np.abs(before).max(), rel=1e-9)
    assert found["peak_after_rad_s2"] == pytest.approx(np.abs(after).max(), rel=1e-9)


def test_intervals_count_by_their_length_and_a_step_by_both_of_its_sides() -> None:
    # 1 s at 2, then a step to 0 and 3 s up to -4: 1 * 4 + 3 * (0 + 16) / 2 = 28 in 4 s
    before = response(along(1, 2.0, 2.0, 0.0, -4.0), along(2, 1.0, 1.0, 1.0, 1.0))
    after = response(along(1, 1.0, 1.0, 0.0, -2.0), along(2, 2.0, 2.0, 2.0, 2.0))
    found = coriolis_metrics(STEP, before, after, 0.25)
    assert found.reduction("bb3") == pytest.approx(0.75)
    assert found.parts["bb3"].sizes.rms == pytest.approx((math.sqrt(7.0), math.sqrt(7.0) / 2))
    assert found.parts["bb3"].sizes.peak == (4.0, 2.0)
    assert found.reduction("seat_z") == pytest.approx(-3.0)  # four times as much
    assert found.objective.reduction == 0.25


def test_the_whole_vector_is_its_length() -> None:
    report = along(0, 9.0, 9.0, 9.0, 9.0)
    before = response(report, along(0, *[3.0] * 4) + along(1, *[4.0] * 4))
    after = response(report, along(2, *[-1.0] * 4))
    found = coriolis_metrics(STEP, before, after, None)
    assert found.parts["vector"].sizes.peak == (5.0, 1.0)
    assert found.reduction("vector") == pytest.approx(24.0 / 25.0)
    assert found.objective.reduction is None


def test_where_there_was_nothing_there_is_no_reduction_but_a_size() -> None:
    still = response(along(0, *[0.0] * 4), along(0, *[0.0] * 4))
    made = response(along(0, *[0.0] * 4), along(0, *[2.0] * 4))
    found = coriolis_metrics(STEP, still, made, None)
    assert found.reduction("seat_x") is None
    assert found.parts["seat_x"].sizes.rms == pytest.approx((0.0, 2.0))


@pytest.mark.parametrize(
    ("before", "after", "reduction"),
    [(4.0, 1.0, 0.75), (4.0, 4.0, 0.0), (4.0, 0.0, 1.0), (1.0, 3.0, -2.0), (1e-24, 1.0, None)],
)
def test_a_reduction_is_a_share_of_what_was_there(
    before: float, after: float, reduction: float | None
) -> None:
    assert relative_reduction(before, after) == reduction
