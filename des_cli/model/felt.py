"""What the pilot feels, before and after a reduction: the section ``felt`` of the metrics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, NamedTuple, TypeAlias, get_args

RateAxis: TypeAlias = Literal["p", "q", "r", "magnitude"]
TurningAxis: TypeAlias = Literal["x", "y", "z", "magnitude"]
GAxis: TypeAlias = Literal["gx", "gy", "gz"]

G_AXES: tuple[GAxis, ...] = get_args(GAxis)

SHARE = 0.05
"""Relative growth of the total angular acceleration's rms, or of the G onset, that is told:
a twentieth is what two runs of one maneuver may differ by on a machine."""

PEAK_SHARE = 0.1
"""The same of the total angular acceleration's peak: one instant says less than a mean."""

LEAST_START_RATE = 0.02
"""Difference of a joint's rate at the start [rad/s] that is told: about a degree per second,
under the 1.5 to 2 degrees per second at which a turn is noticed (Benson 1989)."""

LEAST_START_ANGLE = 0.01
"""Difference of a joint's angle at the start [rad] that is told, of a joint whose start
is not among the constants to be found: half a degree, more than rounding by far."""


class BeforeAfter(NamedTuple):
    """A number of the motion that the profile asks for, and of the modified one."""

    before: float | None
    after: float | None

    @property
    def known(self) -> tuple[float, float] | None:
        """Both numbers, None where one of them is not known."""
        return None if self.before is None or self.after is None else (self.before, self.after)


@dataclass(frozen=True, slots=True)
class RateSizes:
    """RMS and peak of an angular rate."""

    rms_before_rad_s: float | None = None
    rms_after_rad_s: float | None = None
    peak_before_rad_s: float | None = None
    peak_after_rad_s: float | None = None

    @property
    def rms(self) -> BeforeAfter:
        """Root mean square over time [rad/s]."""
        return BeforeAfter(self.rms_before_rad_s, self.rms_after_rad_s)

    @property
    def peak(self) -> BeforeAfter:
        """Largest magnitude [rad/s]."""
        return BeforeAfter(self.peak_before_rad_s, self.peak_after_rad_s)


@dataclass(frozen=True, slots=True)
class TurningSizes:
    """RMS and peak of an angular acceleration, total or cross-coupling."""

    rms_before_rad_s2: float | None = None
    rms_after_rad_s2: float | None = None
    peak_before_rad_s2: float | None = None
    peak_after_rad_s2: float | None = None

    @property
    def rms(self) -> BeforeAfter:
        """Root mean square over time [rad/s^2]."""
        return BeforeAfter(self.rms_before_rad_s2, self.rms_after_rad_s2)

    @property
    def peak(self) -> BeforeAfter:
        """Largest magnitude [rad/s^2]."""
        return BeforeAfter(self.peak_before_rad_s2, self.peak_after_rad_s2)


@dataclass(frozen=True, slots=True)
class GSizes:
    """Extremes, onset and largest jump of a component of the G-vector."""

    peak_before_g: float | None = None
    min_before_g: float | None = None
    max_before_g: float | None = None
    onset_before_g_s: float | None = None
    jump_before_g: float | None = None
    peak_after_g: float | None = None
    min_after_g: float | None = None
    max_after_g: float | None = None
    onset_after_g_s: float | None = None
    jump_after_g: float | None = None
    rms_error_g: float | None = None

    @property
    def peak(self) -> BeforeAfter:
        """Largest magnitude [g]."""
        return BeforeAfter(self.peak_before_g, self.peak_after_g)

    @property
    def least(self) -> BeforeAfter:
        """Smallest value [g]."""
        return BeforeAfter(self.min_before_g, self.min_after_g)

    @property
    def largest(self) -> BeforeAfter:
        """Largest value [g]."""
        return BeforeAfter(self.max_before_g, self.max_after_g)

    @property
    def onset(self) -> BeforeAfter:
        """Largest change over a tenth of a second, per second [g/s]."""
        return BeforeAfter(self.onset_before_g_s, self.onset_after_g_s)

    @property
    def jump(self) -> BeforeAfter:
        """Largest difference of the two sides of a sample [g]."""
        return BeforeAfter(self.jump_before_g, self.jump_after_g)


@dataclass(frozen=True, slots=True)
class Felt:
    """The seat's rate, its total angular acceleration and its G-vector, by component."""

    seat_rate: Mapping[RateAxis, RateSizes] = field(
        default_factory=lambda: {axis: RateSizes() for axis in get_args(RateAxis)}
    )
    seat_angular_acceleration: Mapping[TurningAxis, TurningSizes] = field(
        default_factory=lambda: {axis: TurningSizes() for axis in get_args(TurningAxis)}
    )
    seat_g: Mapping[GAxis, GSizes] = field(
        default_factory=lambda: {axis: GSizes() for axis in G_AXES}
    )

    @property
    def turning(self) -> TurningSizes:
        """Sizes of the whole total angular acceleration."""
        return self.seat_angular_acceleration["magnitude"]

    @property
    def hardest_onset(self) -> GAxis:
        """The axis on which the onset of the G is largest afterwards."""
        return max(G_AXES, key=lambda axis: self.seat_g[axis].onset.after or 0.0)
