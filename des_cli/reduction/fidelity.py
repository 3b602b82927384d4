"""The fidelity metrics, measured on motions as their tables play them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from des_cli.kinematics.attitude import geodesic_angle, rotation
from des_cli.kinematics.chain import Chain, seat_rotation
from des_cli.kinematics.response import respond_on, with_shortfall
from des_cli.model.arrays import Floats, inner, length
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_DEVIATION,
    ANGULAR_ACCELERATION_ERROR,
    ANGULAR_ACCELERATION_PEAK_RATIO,
    ANGULAR_ACCELERATION_RMS_RATIO,
    ATTITUDE_ERROR,
    FACTOR_DEVIATION,
    JOINT_DEVIATION,
    JOINT_DEVIATION_SQUARED,
    SEAT_G_DEVIATION,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
    UNFELT_ANGULAR_ACCELERATION,
    MetricKey,
)
from des_cli.model.motion import Motion, Shortfall, integrate_sides
from des_cli.model.response import SeatResponse


class Deviation:
    """How far a modified motion is from its reference, by each metric.

    Parameters
    ----------
    reference, modified : Motion
        On the same samples.
    before, after : SeatResponse
        Of the two.
    chains : tuple of Chain
        Of the two: the seat may be fixed otherwise in the modified one.
    control : (n, m) array, optional
        Factors on the rates; of a free motion there are none.
    shortfall : Shortfall, optional
        What is asked for beyond the reference; ``before`` holds it already.
    """

    def __init__(
        self,
        reference: Motion,
        modified: Motion,
        before: SeatResponse,
        after: SeatResponse,
        chains: tuple[Chain, Chain],
        control: Floats | None = None,
        shortfall: Shortfall | None = None,
    ) -> None:
        self.reference, self.modified = reference, modified
        self.before, self.after = before, after
        self.chains, self.control, self.shortfall = chains, control, shortfall

    @classmethod
    def between(
        cls,
        reference: Motion,
        modified: Motion,
        chains: tuple[Chain, Chain],
        gravity: float,
        control: Floats | None = None,
        shortfall: Shortfall | None = None,
    ) -> Deviation:
        """Evaluate both responses under a gravity [m/s^2] and compare."""
        before, after = (
            respond_on(chain, gravity, motion)
            for chain, motion in zip(chains, (reference, modified), strict=True)
        )
        before = with_shortfall(before, shortfall)
        return cls(reference, modified, before, after, chains, control, shortfall)

    def value(self, metric: MetricKey) -> float:
        """Return a metric, in its unit."""
        return _VALUES[metric](self)

    @property
    def _turning(self) -> tuple[Floats, Floats]:
        return self.before.seat_angular_acceleration, self.after.seat_angular_acceleration

    @property
    def _g_error(self) -> Floats:
        return self.after.seat_g - self.before.seat_g

    @property
    def _turning_error(self) -> Floats:
        return self.after.seat_angular_acceleration - self.before.seat_angular_acceleration

    def _energy(self, vectors: Floats) -> float:
        return float(integrate_sides(self.reference.step, inner(vectors, vectors)))

    def _share(self, off: Floats, size: Floats) -> float:
        return float(np.sqrt(self._energy(off) / max(self._energy(size), 1e-300)))

    def _rms(self, off: Floats) -> float:
        return float(np.sqrt(self._energy(off) / self.reference.step.sum()))

    def _joints(self) -> float:
        reference = self.reference.angle_sides
        return self._share(self.modified.angle_sides - reference, reference)

    def _seat_rate(self) -> float:
        return self._share(self.after.seat_rate - self.before.seat_rate, self.before.seat_rate)

    def _turning_rms_ratio(self) -> float:
        before, after = (self._rms(turning) for turning in self._turning)
        return after / max(before, UNFELT_ANGULAR_ACCELERATION)

    def _turning_peak_ratio(self) -> float:
        before, after = (float(np.max(length(turning))) for turning in self._turning)
        return after / max(before, UNFELT_ANGULAR_ACCELERATION)

    def _attitude(self) -> float:
        motions = (self.reference, self.modified)
        one, other = (
            seat_rotation(chain, motion.angle)
            for chain, motion in zip(self.chains, motions, strict=True)
        )
        if self.shortfall is not None:
            one = one @ rotation(self.shortfall.attitude)
        return float(np.degrees(np.max(geodesic_angle(one, other))))

    def _factors(self) -> float:
        if self.control is None or not self.control.shape[1]:
            return float("nan")
        idle = (1.0 - np.stack([self.control[:-1], self.control[1:]], axis=1)) ** 2
        step = self.reference.step
        return float(integrate_sides(step, idle.mean(axis=2)) / step.sum())


_VALUES: Mapping[MetricKey, Callable[[Deviation], float]] = MappingProxyType(
    {
        JOINT_DEVIATION: Deviation._joints,
        JOINT_DEVIATION_SQUARED: lambda off: off._joints() ** 2,
        FACTOR_DEVIATION: Deviation._factors,
        SEAT_RATE_DEVIATION: Deviation._seat_rate,
        SEAT_G_DEVIATION: lambda off: off._share(off._g_error, off.before.seat_g),
        SEAT_G_ERROR: lambda off: off._rms(off._g_error),
        ANGULAR_ACCELERATION_DEVIATION: lambda off: off._share(
            off._turning_error, off.before.seat_angular_acceleration
        ),
        ANGULAR_ACCELERATION_ERROR: lambda off: off._rms(off._turning_error),
        ANGULAR_ACCELERATION_RMS_RATIO: Deviation._turning_rms_ratio,
        ANGULAR_ACCELERATION_PEAK_RATIO: Deviation._turning_peak_ratio,
        ATTITUDE_ERROR: Deviation._attitude,
    }
)
