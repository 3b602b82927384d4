"""Smooth curves along the rows of a command table, to be read between its rows.

A table says nothing of what happens between two rows, and its limits are those of divided
differences. The cubic spline through the rows meets each of them, but its third derivative
overshoots by a tenth or so where the rows ride a limit of jerk: for such rows there is no curve
through all of them that keeps it. The cubic B-spline whose control points are the rows passes
beside them, by a sixth of the acceleration times the step squared (a few microradians), and each
of its derivatives is a mean of the rows' divided differences: whatever limit these keep, it keeps.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from des_cli.model.arrays import Floats

EVEN = 1e-6
"""Relative difference of steps up to which they are even: times are rounded to nanoseconds."""

LEAST_CONTROLS = 3
"""Rows from which a curve beside them has an acceleration at its ends."""


@dataclass(frozen=True)
class RowCurve:
    """A piecewise cubic of several columns.

    Parameters
    ----------
    spline : scipy piecewise polynomial
        Of time [s].
    """

    spline: Any

    def at(self, t: Floats, derivative: int = 0) -> Floats:
        """Return the columns, or a derivative of them, at times, (k, m).

        Parameters
        ----------
        t : (k,) array
            [s]
        derivative : int
            -1 is the integral from the first row on.
        """
        if derivative < 0:
            return np.asarray(self.spline.antiderivative()(t), dtype=np.float64)
        return np.asarray(self.spline(t, nu=derivative), dtype=np.float64)


def through_rows(t: Floats, values: Floats) -> RowCurve:
    """Return the cubic spline through all rows.

    Parameters
    ----------
    t : (n,) array
        Rising times, n >= 2 [s].
    values : (n, m) array
    """
    # Imported here: it costs a tenth of a second that other commands do not need.
    from scipy.interpolate import CubicSpline

    return RowCurve(CubicSpline(t, values, bc_type="not-a-knot"))


def beside_rows(
    t: Floats, values: Floats, spread: float = 2.0, slack: float = 1.0, *, rates: bool = False
) -> RowCurve:
    """Return the cubic B-spline whose control points are the rows.

    It begins and ends at the first and the last row where these are at rest, or next to it.
    Elsewhere its ends keep the acceleration of the first and the last three rows.

    Parameters
    ----------
    t : (n,) array
        Rising times, n >= 2 [s]. Where all steps but the last are even, the rows themselves are
        the control points; otherwise points between them are.
    values : (n, m) array
    spread : float
        Distance between these points, over the median step.
    slack : float
        How much more than anywhere else the jerk may be at an end at rest; with 1 every
        derivative is a mean of the rows' divided differences.
    rates : bool
        Whether the points are to lie on the straight lines between the rows, which keep a limit of
        the first derivative, and not on the spline through them, which keeps the higher ones
        better.
    """
    from scipy.interpolate import PPoly

    if len(t) <= LEAST_CONTROLS:
        return through_rows(t, values)
    step, controls = _controls(t, values, spread, rates=rates)
    first, last = _beyond(controls[::-1], slack), _beyond(controls, slack)
    c0, c1, c2, c3 = (
        np.vstack([first, controls, last])[i : i + len(controls) - 1] for i in range(4)
    )
    # The pieces of a uniform cubic B-spline, highest power first.
    pieces = [
        (c3 - 3.0 * (c2 - c1) - c0) / (6.0 * step**3),
        (c2 - 2.0 * c1 + c0) / (2.0 * step**2),
        (c2 - c0) / (2.0 * step),
        (c2 + 4.0 * c1 + c0) / 6.0,
    ]
    return RowCurve(PPoly(np.stack(pieces), t[0] + step * np.arange(len(controls))))


def _beyond(controls: Floats, slack: float) -> Floats:
    """Return the control point after the last one, (m,).

    Without acceleration at the end the curve ends at the last point. Where taking that back
    needs a third difference of more than so many times the largest, the acceleration goes on as
    it was.
    """
    before, last = controls[-2], controls[-1]
    bend = last - 2.0 * before + controls[-3]
    most = np.max(np.abs(np.diff(controls, 3, axis=0)), axis=0, initial=0.0)
    return np.asarray(2.0 * last - before + np.where(np.abs(bend) <= slack * most, 0.0, bend))


def _controls(t: Floats, values: Floats, spread: float, *, rates: bool) -> tuple[float, Floats]:
    """Return the distance between control points [s], and the points from the first row on."""
    steps = np.diff(t)
    step = (t[-2] - t[0]) / (len(t) - 2)
    even = np.max(np.abs(steps[:-1] - step)) <= EVEN * step
    if even and abs(steps[-1] - step) <= EVEN * step:
        return float(step), values
    if even and steps[-1] < step:
        # One more than the last row: where that is, the acceleration goes on as it was.
        beyond = 3.0 * (values[-2] - values[-3]) + values[-4]
        return float(step), np.vstack([values[:-1], beyond])
    length = t[-1] - t[0]
    count = max(round(length / (spread * float(np.median(steps)))), LEAST_CONTROLS)
    times = np.linspace(t[0], t[-1], count + 1)
    if rates:
        lines = [np.interp(times, t, column) for column in values.T]
        return float(length / count), np.column_stack(lines)
    return float(length / count), through_rows(t, values).at(times)
