"""How hard a motion drives the joints: the section ``limits`` of the metrics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from des_cli.model.machine import JOINTS, Joint

Driven: TypeAlias = Literal["rate", "acceleration", "jerk"]


@dataclass(frozen=True, slots=True)
class JointLoad:
    """How hard a motion drives a joint; a limit that the machine does not have is None.

    ``at_acceleration_limit`` is the share of the time.
    """

    rate_peak_rad_s: float | None = None
    rate_limit_rad_s: float | None = None
    acceleration_peak_rad_s2: float | None = None
    acceleration_limit_rad_s2: float | None = None
    jerk_peak_rad_s3: float | None = None
    jerk_limit_rad_s3: float | None = None
    rate_step_rad_s: float | None = None
    at_acceleration_limit: float | None = None
    acceleration_sign_changes: int | None = None
    ok: bool | None = None

    def peak(self, driven: Driven) -> float | None:
        """Return the peak of a rate [rad/s] or of one of its derivatives."""
        return {
            "rate": self.rate_peak_rad_s,
            "acceleration": self.acceleration_peak_rad_s2,
            "jerk": self.jerk_peak_rad_s3,
        }[driven]

    def limit(self, driven: Driven) -> float | None:
        """Return the machine's limit on it."""
        return {
            "rate": self.rate_limit_rad_s,
            "acceleration": self.acceleration_limit_rad_s2,
            "jerk": self.jerk_limit_rad_s3,
        }[driven]


def _idle() -> dict[Joint, JointLoad]:
    return {joint: JointLoad() for joint in JOINTS}


@dataclass(frozen=True, slots=True)
class Loads:
    """How hard the joints are driven by what the profile asks for, and by the modified motion."""

    desired: Mapping[Joint, JointLoad] = field(default_factory=_idle)
    modified: Mapping[Joint, JointLoad] = field(default_factory=_idle)
