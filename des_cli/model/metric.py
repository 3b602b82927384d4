"""Measures of how far a modified motion is from the desired one, each declared once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Literal, TypeAlias

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

# Everything else in the program names a metric by these.
JOINT_DEVIATION: Final = "joint_deviation_relative"
JOINT_DEVIATION_SQUARED: Final = "joint_deviation_relative_squared"
FACTOR_DEVIATION: Final = "mean_square_one_minus_p"
SEAT_RATE_DEVIATION: Final = "seat_rate_deviation_relative"
SEAT_G_DEVIATION: Final = "seat_g_deviation_relative"
SEAT_G_ERROR: Final = "seat_g_rms_error_g"
ANGULAR_ACCELERATION_DEVIATION: Final = "seat_angular_acceleration_deviation_relative"
ANGULAR_ACCELERATION_ERROR: Final = "seat_angular_acceleration_rms_error_rad_s2"
ANGULAR_ACCELERATION_RMS_RATIO: Final = "seat_angular_acceleration_rms_ratio"
ANGULAR_ACCELERATION_PEAK_RATIO: Final = "seat_angular_acceleration_peak_ratio"
ATTITUDE_ERROR: Final = "attitude_error_max_deg"

PEAK_METRICS: frozenset[MetricKey] = frozenset({ATTITUDE_ERROR, ANGULAR_ACCELERATION_PEAK_RATIO})
"""Metrics that are a largest value over time: a budget on one bounds every instant, and no
integral."""


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
            Metric(JOINT_DEVIATION, "joints"),
            Metric(JOINT_DEVIATION_SQUARED, "joints, squared"),
            Metric(FACTOR_DEVIATION, "mean (1 - p)²"),
            Metric(SEAT_RATE_DEVIATION, "seat rate"),
            Metric(SEAT_G_DEVIATION, "G"),
            Metric(SEAT_G_ERROR, "G error", "g"),
            Metric(ANGULAR_ACCELERATION_DEVIATION, "angular acceleration"),
            Metric(ANGULAR_ACCELERATION_ERROR, "angular acceleration error", "rad/s²"),
            Metric(ANGULAR_ACCELERATION_RMS_RATIO, "angular acceleration rms", "times"),
            Metric(ANGULAR_ACCELERATION_PEAK_RATIO, "angular acceleration peak", "times"),
            Metric(ATTITUDE_ERROR, "attitude", "deg"),
        )
    }
)
"""The measures by key, in the order in which they are reported."""

UNFELT_ANGULAR_ACCELERATION: Final = 0.01
"""Total angular acceleration [rad/s^2] that is taken for nothing: about half a degree per
second squared, at the threshold of the semicircular canals. Ratios of sizes are to this at
the least, for no ride gets worse by a multiple of what nobody feels."""

STUDY_METRIC: Final = JOINT_DEVIATION
"""What a budget without a name is on: the study's measure."""


def metric_named(key: str) -> Metric | None:
    """Return the metric with a key, or None.

    >>> metric_named("attitude"), metric_named(ATTITUDE_ERROR).unit
    (None, 'deg')
    """
    return next((metric for metric in METRICS.values() if metric.key == key), None)


def label_of(key: str) -> str:
    """Return what a metric is called on a line of text; one of another version by its key."""
    metric = metric_named(key)
    return key if metric is None else metric.label


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
