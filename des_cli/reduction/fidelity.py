"""The fidelity metrics, measured on motions as their tables play them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from des_cli.kinematics.attitude import geodesic_angle, rotation
from des_cli.kinematics.chain import Chain, seat_rotation
from des_cli.kinematics.response import respond_on, with_shortfall
from des_cli.model.arrays import Floats
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
from des_cli.model.motion import Motion, Shortfall
from des_cli.model.response import SeatResponse
from des_cli.model.sides import in_pieces, largest_of, square_of


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

    def _share(self, before: Floats, after: Floats) -> float:
        """Return the norm of a difference over that of what was there before."""
        step = self.reference.step
        return float(np.sqrt(square_of(step, after, before) / max(square_of(step, before), 1e-300)))

    def _rms(self, vectors: Floats, less: Floats | None = None) -> float:
        step = self.reference.step
        return float(np.sqrt(square_of(step, vectors, less) / step.sum()))

    def _joints(self) -> float:
        return joint_deviation(self.reference, self.modified)

    def _seat_rate(self) -> float:
        return self._share(self.before.seat_rate, self.after.seat_rate)

    def _turning_rms_ratio(self) -> float:
        before, after = (self._rms(turning) for turning in self._turning)
        return after / max(before, UNFELT_ANGULAR_ACCELERATION)

    def _turning_peak_ratio(self) -> float:
        before, after = (largest_of(turning) for turning in self._turning)
        return after / max(before, UNFELT_ANGULAR_ACCELERATION)

    def _attitude(self) -> float:
        largest = []
        for part in in_pieces(len(self.reference.t)):
            one, other = (
                seat_rotation(chain, motion.angle[part])
                for chain, motion in zip(self.chains, (self.reference, self.modified), strict=True)
            )
            if self.shortfall is not None:
                one = one @ rotation(self.shortfall.attitude[part])
            largest.append(np.max(geodesic_angle(one, other)))
        return float(np.degrees(np.max(largest)))

    def _factors(self) -> float:
        if self.control is None or not self.control.shape[1]:
            return float("nan")
        idle = np.mean((1.0 - self.control) ** 2, axis=1)
        return float(self.reference.weight @ idle / self.reference.step.sum())


def joint_deviation(reference: Motion, motion: Motion) -> float:
    """Return ||theta - Theta|| / ||Theta|| over the joint angles."""
    return angle_deviation(reference, motion.angle)


def angle_deviation(reference: Motion, angle: Floats) -> float:
    """Return the same of joint angles (n, 3) [rad]."""
    lost, size = (
        float(np.einsum("n,nj,nj->", reference.weight, each, each))
        for each in (angle - reference.angle, reference.angle)
    )
    return float(np.sqrt(lost / max(size, 1e-300)))


_VALUES: Mapping[MetricKey, Callable[[Deviation], float]] = MappingProxyType(
    {
        JOINT_DEVIATION: Deviation._joints,
        JOINT_DEVIATION_SQUARED: lambda off: off._joints() ** 2,
        FACTOR_DEVIATION: Deviation._factors,
        SEAT_RATE_DEVIATION: Deviation._seat_rate,
        SEAT_G_DEVIATION: lambda off: off._share(off.before.seat_g, off.after.seat_g),
        SEAT_G_ERROR: lambda off: off._rms(off.after.seat_g, off.before.seat_g),
        ANGULAR_ACCELERATION_DEVIATION: lambda off: off._share(*off._turning),
        ANGULAR_ACCELERATION_ERROR: lambda off: off._rms(*off._turning[::-1]),
        ANGULAR_ACCELERATION_RMS_RATIO: Deviation._turning_rms_ratio,
        ANGULAR_ACCELERATION_PEAK_RATIO: Deviation._turning_peak_ratio,
        ATTITUDE_ERROR: Deviation._attitude,
    }
)
