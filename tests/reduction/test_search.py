"""One log and one limit over several minimisations."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from des_cli.model.motion import Motion
from des_cli.model.solution import Iteration
from des_cli.reduction.search import COARSE, TOLERANCE, Search
from des_cli.reduction.transcription import Transcription


@pytest.fixture
def grid(wave: Callable[..., Motion], pose: Callable[..., Any]) -> Transcription:
    motion = wave([[0.5, 0.2, 0.1], [0.2, 0.3, 0.1], [0.2, -0.2, 0.15]], intervals=12)
    return Transcription(pose(motion, control="per-joint", r1=(2, 2, 2)))


def test_the_lines_of_all_minimisations_are_numbered_on_and_told(grid: Transcription) -> None:
    told: list[Iteration] = []
    search = Search(200, told.append)
    rough = search.minimise(grid, grid.desired, COARSE)
    fine = search.minimise(grid, rough.x, TOLERANCE, barrier=1e-3)
    assert (rough.status, fine.status) == ("converged", "converged")
    assert search.lines == told == [*rough.log, *fine.log]
    assert [line.number for line in told] == list(range(len(told)))
    assert search.left == 200 - len(told)
    assert fine.optimality <= TOLERANCE
    assert fine.cost < grid.cost(grid.desired)


def test_the_limit_is_shared(grid: Transcription) -> None:
    search = Search(2)
    first = search.minimise(grid, grid.desired, 0.0)
    assert first.status == "iteration-limit"
    assert search.left == 0
    second = search.minimise(grid, first.x, 0.0)
    assert second.status == "iteration-limit"
    np.testing.assert_array_equal(second.x, first.x)  # no step was left
    assert search.left == 0


@pytest.mark.parametrize(("limit", "most"), [(50, 2), (2, 50)])
def test_one_minimisation_takes_neither_more_than_it_may_nor_than_are_left(
    grid: Transcription, limit: int, most: int
) -> None:
    outcome = Search(limit).minimise(grid, grid.desired, 0.0, most=most)
    assert outcome.status == "iteration-limit"
    assert sum(line.step > 0.0 for line in outcome.log) == 2


def test_the_rough_tolerance_takes_fewer_steps(grid: Transcription) -> None:
    steps = [len(Search(200).minimise(grid, grid.desired, each).log) for each in (COARSE, 1e-12)]
    assert steps[0] < steps[1]
