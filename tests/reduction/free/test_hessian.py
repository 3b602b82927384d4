"""Parts of a Hessian against dense matrices."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.twist import VARIABLES
from des_cli.model.arrays import Floats
from des_cli.reduction.free.hessian import (
    BorderedBand,
    ConstantBand,
    HessianPart,
    IntervalSquares,
    PointBlocks,
    ScaledSlope,
    SeatBlocks,
    SeatCurvature,
    SeatWeight,
)
from des_cli.reduction.free.unknowns import Unknowns
from des_cli.reduction.free.windows import POINTS, Windows
from des_cli.solver.band import SymmetricBand
from des_cli.solver.spline import SplineGrid
from tests.support.bands import dense

ANGLES = 2
UNKNOWNS = Unknowns(SplineGrid(0.0, 0.3, 7), ANGLES)
FIRST, LAST = 2, 6
M = POINTS * (LAST - FIRST)
SIZE = UNKNOWNS.size - ANGLES
SHARES = pytest.mark.parametrize("share", [0.0, 0.25, 1.0])


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(12)


def added(part: HessianPart, share: float) -> Floats:
    """What a part adds to a bordered matrix that is not empty, as a whole."""
    total = BorderedBand.zero(UNKNOWNS.grid.points, ANGLES)
    for array in (total.band.data, total.border, total.corner):
        array += 0.5
    before = whole(total)
    part.add_to(total, share)
    return whole(total) - before


def whole(matrix: BorderedBand) -> Floats:
    return np.block([[dense(matrix.band), matrix.border.T], [matrix.border, matrix.corner]])


def gathering(windows: Windows) -> Floats:
    """The local variables of the span's points by the control points, (v, M, SIZE)."""
    columns = [windows.gather(e.reshape(-1, 3), FIRST, LAST) for e in np.eye(SIZE)]
    return np.stack(columns, axis=-1)


def symmetric(upper: Floats, v: int) -> Floats:
    """Symmetric (v, v, m) blocks of their upper triangle."""
    blocks = np.zeros((v, v, upper.shape[1]))
    rows, columns = np.triu_indices(v)
    blocks[rows, columns] = blocks[columns, rows] = upper
    return blocks


def bordered(motion: Floats, border: Floats | None = None, corner: Floats | None = None) -> Floats:
    border = np.zeros((ANGLES, SIZE)) if border is None else border
    corner = np.zeros((ANGLES, ANGLES)) if corner is None else corner
    return np.block([[motion, border.T], [border, corner]])


def same(found: Floats, expected: Floats) -> None:
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("angles", [0, 2])
def test_a_matrix_to_add_to_is_empty(angles: int) -> None:
    empty = BorderedBand.zero(10, angles)
    assert empty.border.shape == (angles, 30)
    assert not whole(empty).any()
    assert whole(empty).shape == (30 + angles, 30 + angles)


@SHARES
def test_what_is_convex_is_added_whole_whatever_the_share(
    share: float, rng: np.random.Generator
) -> None:
    band = SymmetricBand(UNKNOWNS.grid.points, 3)
    band.add_differences(rng.random((9, 3)), 1, 0.3)
    same(added(ConstantBand(band, 0.7), share), bordered(0.7 * dense(band)))
    same(
        added(SeatWeight(3.0), share),
        bordered(np.zeros((SIZE, SIZE)), corner=3.0 * np.eye(ANGLES)),
    )


@SHARES
def test_blocks_at_points(share: float, rng: np.random.Generator) -> None:
    windows = UNKNOWNS.angle_windows
    convex, curvature = rng.normal(size=(2, 6, M))
    local, matrix = gathering(windows), symmetric(convex + share * curvature, 3)
    expected = np.einsum("kps,klp,lpt->st", local, matrix, local)
    same(added(PointBlocks(windows, FIRST, convex, curvature), share), bordered(expected))


@SHARES
@pytest.mark.parametrize("curvature", [False, True], ids=["always", "by the share"])
def test_squares_of_rows_of_an_interval(
    share: float, curvature: bool, rng: np.random.Generator
) -> None:
    windows, count = UNKNOWNS.seat_windows, LAST - FIRST
    slope, corner = rng.normal(size=(12, 2, count)), rng.normal(size=(ANGLES, ANGLES))
    across = rng.normal(size=(ANGLES, VARIABLES, M))
    jacobian = np.zeros((2, count, SIZE))
    for k in range(count):
        at = 3 * (FIRST + k)
        jacobian[:, k, at : at + 12] = slope[:, :, k].T
    counted = share if curvature else 1.0
    motion = counted * np.einsum("rks,rkt->st", jacobian, jacobian)
    border = counted * np.einsum("avp,vps->as", across, gathering(windows))
    part = IntervalSquares(windows, FIRST, slope, across, corner, curvature)
    same(added(part, share), bordered(motion, border, counted * corner))


@SHARES
def test_squares_of_residuals_that_the_seats_angles_move_too(
    share: float, rng: np.random.Generator
) -> None:
    slopes, jacobian = [], []
    local = gathering(UNKNOWNS.seat_windows)
    for variables in (5, VARIABLES, VARIABLES):
        slope, by_seat = rng.normal(size=(variables, 3, M)), rng.normal(size=(ANGLES, 3, M))
        slopes.append(ScaledSlope(slope, by_seat))
        by_motion = np.einsum("vrp,vps->rps", slope, local[:variables])
        jacobian.append(np.concatenate([by_motion, by_seat.transpose(1, 2, 0)], axis=2))
    expected = sum(np.einsum("rps,rpt->st", j, j) for j in jacobian)
    part = SeatBlocks(UNKNOWNS.seat_windows, FIRST, slopes, np.zeros((36, M)), SeatCurvature())
    same(added(part, share), expected)


@SHARES
def test_curvature_of_the_seat_counts_by_its_share(share: float, rng: np.random.Generator) -> None:
    windows, local = UNKNOWNS.seat_windows, gathering(UNKNOWNS.seat_windows)
    curvature = rng.normal(size=(36, M))
    of_rate, of_force = rng.normal(size=(5, M)), rng.normal(size=(VARIABLES, M))
    by_seat = SeatCurvature([(0, of_rate), (1, of_force)], [(0, 0, 1.3), (0, 1, -0.4)])
    part = SeatBlocks(windows, FIRST, [], curvature, by_seat)
    blocks = symmetric(share * curvature, VARIABLES)
    motion = np.einsum("kps,klp,lpt->st", local, blocks, local)
    border = share * np.stack(
        [np.einsum("vp,vps->s", of_rate, local[:5]), np.einsum("vp,vps->s", of_force, local)]
    )
    corner = share * np.array([[1.3, -0.4], [-0.4, 0.0]])
    same(added(part, share), bordered(motion, border, corner))


def test_a_part_adds_the_same_again(rng: np.random.Generator) -> None:
    slopes = [ScaledSlope(rng.normal(size=(5, 3, M)), rng.normal(size=(ANGLES, 3, M)))]
    part = SeatBlocks(
        UNKNOWNS.seat_windows, FIRST, slopes, rng.normal(size=(36, M)), SeatCurvature()
    )
    once = added(part, 0.5)
    added(part, 1.0)
    np.testing.assert_array_equal(added(part, 0.5), once)


@SHARES
def test_a_seat_that_stays_has_the_same_band_and_no_border(
    share: float, rng: np.random.Generator
) -> None:
    slopes = [rng.normal(size=(variables, 3, M)) for variables in (5, VARIABLES)]
    curvature, bands = rng.normal(size=(36, M)), []
    for angles in (0, ANGLES):
        scaled = [ScaledSlope(slope, np.zeros((angles, 3, M))) for slope in slopes]
        total = BorderedBand.zero(UNKNOWNS.grid.points, angles)
        windows = UNKNOWNS.seat_windows
        SeatBlocks(windows, FIRST, scaled, curvature, SeatCurvature()).add_to(total, share)
        bands.append(total.band.data)
    np.testing.assert_allclose(bands[0], bands[1], rtol=0, atol=1e-12 * np.abs(bands[1]).max())
