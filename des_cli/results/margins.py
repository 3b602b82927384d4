"""How much of each limit a motion uses, and which limit is nearest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import get_args

from des_cli.model.loads import Driven, JointLoad
from des_cli.model.machine import JOINTS, Joint
from des_cli.model.metrics import Metrics

ROUNDING = 1e-9
"""Share of a limit by which a peak may be over it: the solver's last step is no violation."""


@dataclass(frozen=True, slots=True)
class LimitUse:
    """What of one limit a motion uses.

    Parameters
    ----------
    joint : {"arm", "fork", "cab"}
    driven : {"rate", "acceleration", "jerk"}
    peak, limit : float
        [rad/s], [rad/s^2] or [rad/s^3]; the limit is more than zero.
    """

    joint: Joint
    driven: Driven
    peak: float
    limit: float

    @property
    def share(self) -> float:
        """The part of the limit that is used, more than 1 where it is broken."""
        return self.peak / self.limit

    @property
    def margin(self) -> float:
        """The part of the limit that is left, negative where it is broken."""
        return 1.0 - self.share

    @property
    def ok(self) -> bool:
        """Whether the limit is kept, but for rounding."""
        return self.share <= 1.0 + ROUNDING


def limit_uses(loads: Mapping[Joint, JointLoad]) -> list[LimitUse]:
    """Return the use of every limit that is known, joint by joint.

    Parameters
    ----------
    loads : mapping of joint to JointLoad
        As ``metrics.limits`` has them of the desired and of the modified motion.
    """
    return [
        LimitUse(joint, driven, peak, limit)
        for joint in JOINTS
        for driven in get_args(Driven)
        if (load := loads.get(joint)) is not None
        and (peak := load.peak(driven)) is not None
        and (limit := load.limit(driven)) is not None
        and math.isfinite(peak)
        and 0.0 < limit < math.inf
    ]


def nearest_limit(metrics: Metrics) -> tuple[LimitUse | None, LimitUse | None]:
    """Return the limit of which most is used, by the desired and by the modified motion."""
    desired, modified = (
        max(limit_uses(loads), key=lambda use: use.share, default=None)
        for loads in (metrics.limits.desired, metrics.limits.modified)
    )
    return desired, modified
