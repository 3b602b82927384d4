"""The problem of uniform cubic B-splines, as data, and the splines themselves.

Interval i of K has h = T/K, u from 0 to 1, and theta = sum_a B_a(u) P_{i+a}, with
B = [(1-u)^3, 3u^3 - 6u^2 + 4, -3u^3 + 3u^2 + 3u + 1, u^3] / 6. Integrals are sums over
two Gauss points an interval, weight h/2 each. The unknowns are the control points P,
(K + 3, 3) in rad for arm, fork, cab, and on request the seat's yaw and pitch.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from tests.support.seat_forms import PITCH, YAW, Floats

INFINITE = math.inf
GAUSS = (0.5 - math.sqrt(3) / 6, 0.5 + math.sqrt(3) / 6)
BLEND = 0.1

RATE = "seat_rate_deviation_relative"
G_RMS = "seat_g_rms_error_g"
JOINTS = "joint_deviation_relative"
TURNING = "seat_angular_acceleration_rms_error_rad_s2"
ATTITUDE = "attitude_error_max_deg"
TURNING_RMS = "seat_angular_acceleration_rms_rad_s2"
TURNING_PEAK = "seat_angular_acceleration_peak_rad_s2"

ENDS = ("free", "match-start", "match-rates", "match-both")
OPTIMISE = ("seat_yaw", "seat_pitch", "fork_start", "cab_start")


@dataclass(frozen=True)
class JointLimits:
    """What each joint (3,) may do: |angle| [rad], |rate|, |acceleration|, |jerk|; or inf."""

    angle: Floats
    rate: Floats
    acceleration: Floats
    jerk: Floats


def des_limits(jerk_per_s: float = 2.0) -> JointLimits:
    """Return Table 1, with the jerk so many times the acceleration limit a second."""
    acceleration = np.array([0.63, 2.5, 5.0])
    return JointLimits(
        angle=np.array([INFINITE, 2 * math.pi, 2 * math.pi]),
        rate=np.array([5.86, 3.14, 3.14]),
        acceleration=acceleration,
        jerk=jerk_per_s * acceleration,
    )


@dataclass(frozen=True)
class Reference:
    """The desired joint states at the Gauss points, (K, 2, 3) each [rad, rad/s, rad/s^2]."""

    angle: Floats
    rate: Floats
    acceleration: Floats


@dataclass(frozen=True)
class Task:
    """One discrete problem.

    Parameters
    ----------
    duration : float
        T [s].
    reference : Reference
    base : (K + 3, 3) array
        Control points P0 of the executable desired motion [rad].
    limits : JointLimits
    budgets : mapping
        Metric to the most it may be, in the unit that its name ends in.
    objective : str
        ``coriolis``, ``blend`` or ``felt``.
    r1 : (3, 3) array
        Weight of c in seat axes.
    ends : str
        What of the base spline's ends is kept; see ``ENDS``.
    optimise : tuple of str
        What is free besides; see ``OPTIMISE``.
    seat : (yaw, pitch)
        Of the profile [rad]; the reference is always with this one.
    regularisation : float
        eps.
    """

    duration: float
    reference: Reference
    base: Floats
    limits: JointLimits = field(default_factory=des_limits)
    budgets: Mapping[str, float] = field(default_factory=dict)
    objective: str = "coriolis"
    r1: Floats = field(default_factory=lambda: np.eye(3))
    ends: str = "match-start"
    optimise: tuple[str, ...] = ()
    seat: tuple[float, float] = (YAW, PITCH)
    regularisation: float = 1e-6

    @property
    def intervals(self) -> int:
        """K."""
        return len(self.base) - 3


def basis(u: float, h: float) -> Floats:
    """Return the weights of four control points in theta, theta', theta'' and theta''' (4, 4)."""
    value = [(1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, -3 * u**3 + 3 * u**2 + 3 * u + 1, u**3]
    first = [-3 * (1 - u) ** 2, 9 * u**2 - 12 * u, -9 * u**2 + 6 * u + 3, 3 * u**2]
    second = [6 * (1 - u), 18 * u - 12, -18 * u + 6, 6 * u]
    third = [-6.0, 18.0, -18.0, 6.0]
    return (
        np.array([value, np.array(first) / h, np.array(second) / h**2, np.array(third) / h**3]) / 6
    )


def gauss_instants(duration: float, intervals: int) -> Floats:
    """Return the instants of the Gauss points (K, 2) [s]."""
    h = duration / intervals
    return h * (np.arange(intervals)[:, None] + np.array(GAUSS))


def reference_of(
    path: Callable[[Floats], tuple[Floats, ...]], duration: float, k: int
) -> Reference:
    """Return a motion, (angle, rate, acceleration) at instants (n,), at the Gauss points."""
    states = path(gauss_instants(duration, k).ravel())
    return Reference(*(each.reshape(k, 2, 3) for each in states))


def spline_states(points: Floats, duration: float, t: Floats) -> tuple[Floats, Floats, Floats]:
    """Return theta, theta', theta'' of a spline at instants (n,), each (n, 3)."""
    k = len(points) - 3
    h = duration / k
    i = np.clip((t / h).astype(int), 0, k - 1)
    rows = np.stack([basis(u, h)[:3] for u in t / h - i])
    states = rows @ points[i[:, None] + np.arange(4)]
    return states[:, 0], states[:, 1], states[:, 2]
