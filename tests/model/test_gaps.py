"""A gap is a step far longer than the others, and longer than a joint could hide in."""

import numpy as np
import pytest

from des_cli.model.gaps import GAP_PER_MEDIAN, SHORTEST_GAP, find_gaps, longest_step


def times(*steps: float) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(steps)])


def test_no_step_up_to_a_tenth_of_a_second_is_a_gap() -> None:
    t = times(*[0.001] * 20, SHORTEST_GAP, *[0.001] * 20)
    assert longest_step(t) == SHORTEST_GAP
    assert find_gaps(t) == []
    assert find_gaps(times(*[0.001] * 20, 1.001 * SHORTEST_GAP, 0.001)) == [20]


def test_of_coarse_samples_it_is_so_many_median_steps() -> None:
    steps = [0.5] * 5 + [0.3, 0.9]  # the median is the step of most
    assert longest_step(times(*steps)) == pytest.approx(GAP_PER_MEDIAN * 0.5)
    # ten steps to rounding are none
    assert find_gaps(times(*steps, GAP_PER_MEDIAN * 0.5)) == []
    assert find_gaps(times(*steps, 1.01 * GAP_PER_MEDIAN * 0.5)) == [7]


def test_the_row_before_each_gap_is_named() -> None:
    assert find_gaps(times(0.1, 0.1, 5.0, 0.1, 0.1, 0.1, 7.0, 0.1)) == [2, 6]
    assert find_gaps(times(0.1)) == []
