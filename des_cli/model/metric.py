"""Measures of how far a modified motion is from the desired one, each declared once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, TypeAlias

MetricKey: TypeAlias = Literal[
    "joint_deviation_relative",
    "joint_deviation_relative_squared",
    "mean_square_one_minus_p",
    "seat_rate_deviation_relative",
    "seat_g_deviation_relative",
    "seat_g_rms_error_g",
    "seat_angular_acceleration_deviation_relative",
    "seat_angular_acceleration_rms_error_rad_s2",
    "seat_angular_acceleration_rms_ratio",
    "seat_angular_acceleration_peak_ratio",
    "attitude_error_max_deg",
]


@dataclass(frozen=True, slots=True)
class Metric:
    """One measure of fidelity, under ``fidelity`` of the metrics; a budget may be set on it.

    Parameters
    ----------
    key : str
        Its name in ``metrics.json``, in a profile's ``budget`` and on the command line.
    label : str
        What it is called on a line of text.
    unit : str
        Its unit as it is printed, empty for a share.
    """

    key: MetricKey
    label: str
    unit: str = ""

    @property
    def relative(self) -> bool:
        """Whether it is a share, which a budget bounds below one."""
        return not self.unit


METRICS: Mapping[MetricKey, Metric] = MappingProxyType(
    {
        metric.key: metric
        for metric in (
            Metric("joint_deviation_relative", "joints"),
            Metric("joint_deviation_relative_squared", "joints, squared"),
            Metric("mean_square_one_minus_p", "mean (1 - p)²"),
            Metric("seat_rate_deviation_relative", "seat rate"),
            Metric("seat_g_deviation_relative", "G"),
            Metric("seat_g_rms_error_g", "G error", "g"),
            Metric("seat_angular_acceleration_deviation_relative", "angular acceleration"),
            Metric(
                "seat_angular_acceleration_rms_error_rad_s2", "angular acceleration error", "rad/s²"
            ),
            Metric("seat_angular_acceleration_rms_ratio", "angular acceleration rms", "times"),
            Metric("seat_angular_acceleration_peak_ratio", "angular acceleration peak", "times"),
            Metric("attitude_error_max_deg", "attitude", "deg"),
        )
    }
)
"""The measures by key, in the order in which they are reported."""

UNFELT_ANGULAR_ACCELERATION = 0.01
"""Total angular acceleration [rad/s^2] that is taken for nothing: about half a degree per
second squared, at the threshold of the semicircular canals. Ratios of sizes are to this at
the least, for no ride gets worse by a multiple of what nobody feels."""

STUDY_METRIC: MetricKey = "joint_deviation_relative"
"""What a budget without a name is on: the study's measure."""


@dataclass(frozen=True, slots=True)
class Budget:
    """The largest value allowed of a metric.

    Parameters
    ----------
    metric : str
    most : float
        In the metric's unit; positive.
    """

    metric: MetricKey
    most: float
