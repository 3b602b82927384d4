"""Zero-phase smoothing of recorded commands: what is faster than a cutoff goes, without a lag.

A Butterworth low-pass of order four runs over the record forward and backward,
so that nothing is delayed and the amplitude at the cutoff is halved. A filter
must know what lies beyond the ends. Repeating the record there, as in a mirror,
bends a ramp; turning it about its first and last sample lets the noise of two
samples move everything near them. Here it is turned about the ends of straight
lines, fitted over half a period of the cutoff: a constant stays a constant, a
ramp a ramp, and the noise of one sample hardly counts.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.motion import mean_of_sides
from des_cli.model.profile import BodyRates, GCommand, JointCommands

ORDER = 4
"""Order of the Butterworth low-pass, each way."""

SHORTEST = 2.0
"""Shortest record, and how far it is continued beyond its ends, in periods of the cutoff: by
then the slowest pole has decayed to 1 %, of what little the continuation lacks of rest."""

END_LINE = 0.5
"""Time over which the lines at the ends are fitted, in periods of the cutoff."""

_ROUNDING = 1e-6
"""Relative error of a step between two late times."""

MOST_CELLS = 5_000_000
"""Samples of the uniform grid at the most."""


def smooth_command(
    t: Floats, command: JointCommands | BodyRates | GCommand, cutoff_hz: float
) -> JointCommands | BodyRates | GCommand:
    """Return a command without what is faster than a cutoff.

    Parameters
    ----------
    t : (n,) array
        Sample times [s].
    command : JointCommands, BodyRates or GCommand
        Joint commands: the arm's rate and the positions are smoothed, and the
        rates of fork and cab are the derivatives of the smoothed positions. Body
        rates: their values at samples, the mean of both sides where they step; a
        recorded attitude is kept. A requested G, and rates beside it, likewise.
    cutoff_hz : float
        [Hz]; infinite for the command as it is.

    Raises
    ------
    ValueError
        If `why_not_smooth` has a sentence on it.
    """
    if np.isinf(cutoff_hz):
        return command
    if isinstance(command, JointCommands):
        values = np.column_stack([command.arm_rate, command.position])
        value, _, slope = smooth_samples(t, values, cutoff_hz)
        return replace(
            command,
            arm_rate=value[:, 0],
            position=value[:, 1:],
            rate_start=slope[:-1, 1:],
            rate_end=slope[1:, 1:],
        )
    sides = mean_of_sides(np.stack([command.start, command.end], axis=1))
    value, middle, _ = smooth_samples(t, sides, cutoff_hz)
    if isinstance(command, GCommand):
        beside = None if command.rates is None else smooth_command(t, command.rates, cutoff_hz)
        assert beside is None or isinstance(beside, BodyRates), "rates stay rates"
        return replace(command, start=value[:-1], end=value[1:], rates=beside)
    return BodyRates(value[:-1], middle, value[1:], command.attitude)


def smooth_samples(t: Floats, values: Floats, cutoff_hz: float) -> tuple[Floats, Floats, Floats]:
    """Smooth columns of samples.

    Parameters
    ----------
    t : (n,) array
        Increasing times, of any spacing [s].
    values : (n, k) array
    cutoff_hz : float
        Where the amplitude is halved [Hz].

    Returns
    -------
    value : (n, k) array
        At the samples.
    middle : (n - 1, k) array
        In the middles between them.
    slope : (n, k) array
        Derivative by time at the samples [1/s].

    Raises
    ------
    ValueError
        If `why_not_smooth` has a sentence on it.
    """
    from scipy.interpolate import CubicSpline, PchipInterpolator

    if trouble := why_not_smooth(t, cutoff_hz):
        raise ValueError(trouble)
    # Times from the first one: late starts must not cost digits.
    since = t - t[0]
    grid = np.linspace(0.0, since[-1], _grid_size(t))
    uniform = np.array_equal(grid, since) or np.allclose(
        np.diff(since), grid[1], rtol=1e-6, atol=0.0
    )
    on_grid = values if uniform else PchipInterpolator(since, values)(grid)
    # On what is slow against its grid a cubic spline is exact to fourth order.
    spline = CubicSpline(grid, _low_pass(on_grid, 1.0 / grid[1], cutoff_hz))
    middle = 0.5 * (since[:-1] + since[1:])
    return np.asarray(spline(since)), np.asarray(spline(middle)), np.asarray(spline(since, 1))


def why_not_smooth(t: Floats, cutoff_hz: float) -> str:
    """Say why a record cannot be smoothed, or nothing.

    Parameters
    ----------
    t : (n,) array
        Sample times [s].
    cutoff_hz : float
        [Hz]
    """
    duration, size = float(t[-1] - t[0]), _grid_size(t)
    # that of the grid which is filtered: the median step is a little off it
    step = duration / (size - 1)
    nyquist = 0.5 / step
    if cutoff_hz >= nyquist * (1.0 - _ROUNDING):
        return (
            f"{cutoff_hz:g} Hz is not below {nyquist:.4g} Hz, the fastest that samples "
            f"{step:.4g} s apart can tell; give a lower cutoff"
        )
    if duration < SHORTEST / cutoff_hz:
        return (
            f"a cutoff of {cutoff_hz:g} Hz needs a record of {SHORTEST / cutoff_hz:.4g} s or more "
            f"and this one has {duration:.4g} s; give a cutoff of {SHORTEST / duration:.3g} Hz "
            "or more"
        )
    if size > MOST_CELLS:
        return f"the record is {duration / step:.3g} of its usual steps long; close its gaps first"
    return ""


def _grid_size(t: Floats) -> int:
    """Return how many samples the record has at its median step."""
    return 1 + max(1, round(float(t[-1] - t[0]) / float(np.median(np.diff(t)))))


def _low_pass(values: Floats, rate: float, cutoff_hz: float) -> Floats:
    """Filter uniform samples (n, k) forward and backward.

    Parameters
    ----------
    values : (n, k) array
    rate : float
        Of the samples [1/s].
    cutoff_hz : float
        [Hz]
    """
    from scipy.signal import butter, sosfiltfilt

    n = len(values)
    fitted = max(2, round(END_LINE * rate / cutoff_hz))
    first, last = _end_of_line(values[:fitted]), _end_of_line(values[-fitted:][::-1])
    line = first + (last - first) * np.linspace(0.0, 1.0, n)[:, None]
    rest = values - line
    beyond = min(n - 1, int(np.ceil(SHORTEST * rate / cutoff_hz)))
    continued = np.concatenate([-rest[beyond:0:-1], rest, -rest[-2 : -beyond - 2 : -1]])
    # At the cutoff two passes take half of the amplitude, each by itself a factor of sqrt(1/2).
    sections = butter(ORDER, cutoff_hz, fs=rate, output="sos")
    smooth = sosfiltfilt(sections, continued, axis=0, padlen=0)
    return np.asarray(line + smooth[beyond : beyond + n])


def _end_of_line(values: Floats) -> Floats:
    """Return the first value, (k,), of the straight line fitted to samples (m, k)."""
    m = len(values)
    place = np.arange(m) - 0.5 * (m - 1)
    slope = place @ values / (place @ place)
    return np.asarray(values.mean(axis=0) + slope * place[0])
