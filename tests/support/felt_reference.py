"""An evaluation of a command table that shares no code with the tool.

    python -m tests.support.felt_reference commands.csv
    python -m tests.support.felt_reference commands.csv --seat-deg 87.1 -12

It reads ``t_s,arm_rpm,fork_deg,cab_deg``, rebuilds the motion, and compares it with the
Cobra of (34)-(37), taken as formulas, by 4-point Gauss quadrature between the rows.
"""

from __future__ import annotations

import argparse
import csv
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from tests.support.cobra import COBRA_STEP_S, RPM, States, cobra
from tests.support.seat_forms import PITCH, YAW, Felt, Floats, by_chain, by_closed_forms

JOINTS = ("arm", "fork", "cab")
COLUMNS = ("t_s", "arm_rpm", "fork_deg", "cab_deg")
Path3 = Callable[[Floats], States]


@dataclass(frozen=True)
class Table:
    """The rows of a command table [s, rad/s, rad]."""

    t: Floats
    arm_rate: Floats
    position: Floats


@dataclass(frozen=True)
class Evaluation:
    """A modified motion against the desired one; peaks are over the quadrature points."""

    reduction: float
    cross_rms_before: float
    cross_rms_after: float
    joint_deviation_relative: float
    seat_rate_deviation_relative: float
    seat_g_rms_error_g: float
    turning_rms_before: float
    turning_rms_after: float
    turning_peak_before: float
    turning_peak_after: float
    turning_rms_error: float
    attitude_error_max_deg: float
    g_peak_before: Floats
    g_peak_after: Floats
    rate_peak: Floats
    acceleration_peak: Floats
    jerk_peak: Floats
    acceleration_sign_changes: tuple[int, ...]
    start_angle: Floats
    start_rate: Floats
    end_angle: Floats
    end_rate: Floats


def read_table(path: Path) -> Table:
    """Return the rows of ``commands.csv``."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    t, arm, fork, cab = (np.array([float(row[name]) for row in rows]) for name in COLUMNS)
    return Table(t, arm * RPM, np.radians(np.stack([fork, cab], axis=-1)))


def by_parabolas(table: Table) -> Path3:
    """Return the motion whose rates are linear between the rows.

    Positions leave one rate of each joint open, and an error in it alternates in sign from
    row to row. The rate taken has the least sum of |jerk|, which a few corners of the motion
    do not move as they would a sum of squares. A rate that jumps is no such motion: its
    positions leave an alternation behind, and only ``by_splines`` reads it.
    """
    t, x = table.t, table.position
    step = np.diff(t)[:, None]
    rate = np.zeros_like(x)
    for k in range(len(step)):
        rate[k + 1] = 2 * (x[k + 1] - x[k]) / step[k] - rate[k]
    sign = np.where(np.arange(len(t)) % 2, -1.0, 1.0)
    for joint in range(rate.shape[1]):
        rate[:, joint] -= sign * _least_absolute(_jerk(t, rate[:, joint]), _jerk(t, sign))

    rates = np.concatenate([table.arm_rate[:, None], rate], axis=1)
    steps = step * (rates[:-1] + rates[1:]) / 2
    angles = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    angles[:, 1:] = x
    growth = np.diff(rates, axis=0) / step

    def at(instants: Floats) -> States:
        k = np.clip(np.searchsorted(t, instants, side="right") - 1, 0, len(step) - 1)
        s = (instants - t[k])[:, None]
        return angles[k] + s * rates[k] + s**2 / 2 * growth[k], rates[k] + s * growth[k], growth[k]

    return at


def _jerk(t: Floats, rate: Floats) -> Floats:
    """Return the change of acceleration from interval to interval, over the time between."""
    middle = (t[:-1] + t[1:]) / 2
    return np.asarray(np.diff(np.diff(rate) / np.diff(t)) / np.diff(middle))


def _least_absolute(values: Floats, shape: Floats) -> float:
    """Return the factor x that minimises sum |values - x shape|: a weighted median."""
    ratio, weight = values / shape, np.abs(shape)
    order = np.argsort(ratio)
    reached = np.cumsum(weight[order])
    return float(ratio[order][np.searchsorted(reached, reached[-1] / 2)])


def by_splines(table: Table) -> Path3:
    """Return the motion of a C2 cubic spline through the positions and the arm's rate."""
    arm = CubicSpline(table.t, table.arm_rate)
    angle = arm.antiderivative()
    joints = CubicSpline(table.t, table.position)

    def at(instants: Floats) -> States:
        first = (angle(instants) - angle(table.t[0]), arm(instants), arm(instants, 1))
        rest = (joints(instants), joints(instants, 1), joints(instants, 2))
        return tuple(  # type: ignore[return-value]
            np.concatenate([one[:, None], two], axis=1)
            for one, two in zip(first, rest, strict=True)
        )

    return at


def gauss_points(edges: Floats, count: int = 4) -> tuple[Floats, Floats]:
    """Return the instants and weights of Gauss quadrature on every interval, flat."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    half = np.diff(edges)[:, None] / 2
    middle = (edges[:-1] + edges[1:])[:, None] / 2
    return (middle + half * nodes).ravel(), (half * weights).ravel()


def evaluate(
    modified: Path3,
    rows: Floats,
    *,
    desired: Path3 = cobra,
    kinks: Sequence[float] = (COBRA_STEP_S,),
    seat: tuple[float, float] = (YAW, PITCH),
    modified_seat: tuple[float, float] | None = None,
) -> Evaluation:
    """Return the modified motion's measures against the desired one.

    Parameters
    ----------
    modified, desired : callable
        Joint states (angle, rate, acceleration), each (n, 3), at instants (n,).
    rows : (n,) array
        Instants between which the modified motion is smooth [s].
    kinks : sequence of float
        Instants at which the desired motion is not smooth [s].
    seat, modified_seat : (yaw, pitch)
        [rad]; the modified motion's is the desired one's unless given.
    """
    edges = np.union1d(rows, [kink for kink in kinks if rows[0] < kink < rows[-1]])
    # a kink that misses a row by rounding makes no interval of its own
    edges = edges[np.concatenate([[True], np.diff(edges) > 1e-9])]
    t, weight = gauss_points(edges)
    before, after = desired(t), modified(t)
    felt = by_closed_forms(*before, *seat), by_closed_forms(*after, *(modified_seat or seat))
    span = edges[-1] - edges[0]

    def total(values: Floats) -> float:
        return float(weight @ (values**2).sum(axis=-1))

    def relative(one: Floats, other: Floats) -> float:
        return math.sqrt(total(one - other) / total(other))

    def rms(values: Floats) -> float:
        return math.sqrt(total(values) / span)

    def peak(values: Floats) -> float:
        return float(np.linalg.norm(values, axis=-1).max())

    # acceleration is sampled once an interval: linear rates make it constant there
    middle = (rows[:-1] + rows[1:]) / 2
    acceleration = modified(middle)[2]
    ends = np.array([edges[0] + 1e-9, edges[-1] - 1e-9])
    at_ends = [one - other for one, other in zip(modified(ends), desired(ends), strict=True)]
    return Evaluation(
        reduction=1 - total(felt[1].cross) / total(felt[0].cross),
        cross_rms_before=rms(felt[0].cross),
        cross_rms_after=rms(felt[1].cross),
        joint_deviation_relative=relative(after[0], before[0]),
        seat_rate_deviation_relative=relative(felt[1].rate, felt[0].rate),
        seat_g_rms_error_g=rms(felt[1].g - felt[0].g),
        turning_rms_before=rms(felt[0].turning),
        turning_rms_after=rms(felt[1].turning),
        turning_peak_before=peak(felt[0].turning),
        turning_peak_after=peak(felt[1].turning),
        turning_rms_error=rms(felt[1].turning - felt[0].turning),
        attitude_error_max_deg=math.degrees(attitude_error(*felt).max()),
        g_peak_before=np.abs(felt[0].g).max(axis=0),
        g_peak_after=np.abs(felt[1].g).max(axis=0),
        rate_peak=np.abs(after[1]).max(axis=0),
        acceleration_peak=np.abs(after[2]).max(axis=0),
        jerk_peak=np.abs(np.diff(acceleration, axis=0) / np.diff(middle)[:, None]).max(axis=0),
        acceleration_sign_changes=tuple(sign_changes(each) for each in acceleration.T),
        start_angle=at_ends[0][0],
        start_rate=at_ends[1][0],
        end_angle=at_ends[0][1],
        end_rate=at_ends[1][1],
    )


def attitude_error(one: Felt, other: Felt) -> Floats:
    """Return the angle of the turn between two attitudes (n,) [rad]."""
    # |R - R_ref|_F^2 = 8 sin^2(angle / 2); arccos of the trace loses half the digits
    apart = ((one.attitude - other.attitude) ** 2).sum(axis=(-1, -2))
    return np.asarray(2 * np.arcsin(np.minimum(np.sqrt(apart / 8), 1.0)))


def sign_changes(values: Floats, floor: float = 1e-3) -> int:
    """Return how often values change sign, those within ``floor`` of the largest left out."""
    size = np.abs(values)
    signs = np.sign(values[size > floor * size.max()]) if size.any() else size[:0]
    return int((np.diff(signs) != 0).sum())


def main() -> None:
    parser = argparse.ArgumentParser(description="Evaluate a command table of the Cobra.")
    parser.add_argument("table", type=Path)
    parser.add_argument("--seat-deg", type=float, nargs=2, metavar=("YAW", "PITCH"))
    options = parser.parse_args()
    table = read_table(options.table)
    seat = tuple(math.radians(each) for each in options.seat_deg or (90.0, 0.0))
    columns = {
        name: evaluate(rebuild(table), table.t, modified_seat=seat)  # type: ignore[arg-type]
        for name, rebuild in (("parabolas", by_parabolas), ("splines", by_splines))
    }
    print(f"{'':32}" + "".join(f"{name:>34}" for name in columns))
    for key in Evaluation.__dataclass_fields__:
        cells = []
        for column in columns.values():
            values = np.atleast_1d(getattr(column, key))
            cells.append(" ".join(f"{value:10.6g}" for value in values))
        print(f"{key:32}" + "".join(f"{cell:>34}" for cell in cells))
    t, _ = gauss_points(table.t)
    states = by_parabolas(table)(t)
    two = by_closed_forms(*states, *seat), by_chain(*states, *seat)
    apart = max(float(np.abs(getattr(two[0], k) - getattr(two[1], k)).max()) for k in vars(two[0]))
    print(f"\nclosed forms against the product of Table 2: {apart:.1e}")


if __name__ == "__main__":
    main()
