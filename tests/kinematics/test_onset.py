"""The onset of G is that of its curve, whatever the grid."""

import numpy as np
import pytest

from des_cli.kinematics.onset import WINDOW, largest_onset, onsets


def sides_of(values):
    """Values on sides of a curve without jumps, (n - 1, 2, 1)."""
    return np.stack([values[:-1], values[1:]], axis=1)[..., None]


@pytest.mark.parametrize("intervals", [40, 400, 4000])
def test_a_slow_curve_has_its_slope(intervals):
    t = np.linspace(0.0, 4.0, intervals + 1)
    (found,) = largest_onset(t, sides_of(np.sin(t)))
    # the mean slope of a sine over the window, where it is steepest
    assert found == pytest.approx(2.0 * np.sin(WINDOW / 2) / WINDOW, rel=1e-3)


@pytest.mark.parametrize("intervals", [30, 100, 1000, 10000])
def test_a_jump_has_the_same_onset_on_every_grid(intervals):
    t = np.linspace(0.0, 10.0, intervals + 1)
    sides = np.where(t[:-1, None] < 5.0 - 1e-9, 0.0, 0.3) * np.ones((1, 2))
    (found,) = largest_onset(t, sides[..., None])
    assert found == pytest.approx(0.3 / WINDOW, rel=1e-6)


def test_uneven_grids_and_samples_further_apart_than_the_window():
    t = np.array([0.0, 1.0, 1.03, 1.06, 3.0])
    values = np.array([0.0, 0.0, 0.6, 0.0, 1.0])
    fine = np.linspace(0.0, 3.0, 30001)
    curve = np.interp(fine, t, values)
    (found,) = largest_onset(t, sides_of(values))
    assert found == pytest.approx(np.abs(curve[1000:] - curve[:-1000]).max() / WINDOW, rel=1e-4)


def test_a_short_maneuver_is_one_window():
    (found,) = largest_onset(np.array([0.0, 0.05]), sides_of(np.array([1.0, 1.2])))
    assert found == pytest.approx(0.2 / 0.05)


@pytest.mark.parametrize("step", [0.1, 0.05, 0.02, 0.01])
def test_rounding_of_times_does_not_say_which_jumps_count(step):
    """Samples are a whole fraction of the window apart, and jump at every one."""
    rng = np.random.default_rng(5)
    count = round(3.0 / step)
    sides = rng.normal(size=(count, 2, 3))
    whole = round(WINDOW / step)
    rises = [
        np.abs(sides[k + whole, side] - sides[k, side]) / WINDOW
        for k in range(count - whole)
        for side in (0, 1)
    ]
    # the first and the last sample have one side
    rises += [np.abs(sides[whole - 1, 1] - sides[0, 0]) / WINDOW]
    rises += [np.abs(sides[-1, 1] - sides[count - whole, 0]) / WINDOW]
    expected = np.max(rises, axis=0)
    for start in (0.0, 0.1, 1.0 / 3.0, 17.3, 1234.567):
        t = start + step * np.arange(count + 1)
        assert largest_onset(t, sides) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("length", [1, 3, 50, 2000])
def test_what_needs_no_look_is_not_the_largest(length, monkeypatch):
    """The largest of all windows, whatever blocks of them are passed over."""
    monkeypatch.setattr("des_cli.kinematics.onset.BLOCK", length)
    for seed in range(8):
        rng = np.random.default_rng(seed)
        t = np.cumsum(rng.choice([0.001, 0.01, 0.04], 150))
        jumps = rng.normal(size=(149, 2, 3)) * rng.choice([0.0, 0.1, 1.0], (149, 1, 1))
        sides = np.sin(3.0 * t)[:-1, None, None] + jumps
        begin, onset = onsets(t, sides)
        assert np.all(np.diff(begin) >= 0.0)
        np.testing.assert_array_equal(largest_onset(t, sides), onset.max(axis=1))


def test_a_value_that_is_no_number_is_no_onset():
    t = np.linspace(0.0, 10.0, 5001)
    sides = np.zeros((5000, 2, 2))
    sides[4000, 0, 1] = np.nan
    assert np.isnan(largest_onset(t, sides)[1])
