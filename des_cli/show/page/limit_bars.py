"""The limits of a run in percent, as bars."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from des_cli.model.loads import JointLoad
from des_cli.model.machine import JOINTS, Joint
from des_cli.model.metrics import Metrics
from des_cli.results.margins import LimitUse, limit_uses
from des_cli.show.words import PAGE

_UNITS = {"rate": "rad/s", "acceleration": "rad/s²", "jerk": "rad/s³"}
_NEAR = 0.9


@dataclass(frozen=True, slots=True)
class Bar:
    """How much of one limit is used.

    Parameters
    ----------
    label : str
    before, after : str
        In percent of the limit.
    width_before, width_after : float
        Of the bars [%]; a motion beyond the limit fills its bar.
    detail : str
        The numbers, with their unit.
    mark : str
        ``bad`` beyond the limit, ``near`` close to it, else empty.
    """

    label: str
    before: str
    after: str
    width_before: float
    width_after: float
    detail: str
    mark: str


def limit_bars(metrics: Metrics) -> list[Bar]:
    """Return a bar for every limit on a rate or its derivatives, joint by joint."""
    uses = {
        when: {(use.joint, use.driven): use for use in limit_uses(loads)}
        for when, loads in _loads(metrics).items()
    }
    bars = []
    for joint in JOINTS:
        for driven in ("rate", "acceleration", "jerk"):
            if (after := uses["after"].get((joint, driven))) is not None:
                bars.append(_bar(after, uses["before"].get((joint, driven))))
    return bars


def _loads(metrics: Metrics) -> dict[str, Mapping[Joint, JointLoad]]:
    return {"before": metrics.limits.desired, "after": metrics.limits.modified}


def _bar(after: LimitUse, before: LimitUse | None) -> Bar:
    unit = _UNITS[after.driven]
    numbers = PAGE.number(after.peak)
    if before is not None:
        numbers = f"{PAGE.number(before.peak)} {PAGE.arrow} {numbers}"
    return Bar(
        f"{after.joint} {after.driven}",
        PAGE.percent(before.share) if before else PAGE.unknown,
        PAGE.percent(after.share),
        _width(before.share) if before else 0.0,
        _width(after.share),
        f"{numbers} of {PAGE.number(after.limit)} {unit}",
        "" if after.ok and after.share < _NEAR else "near" if after.ok else "bad",
    )


def _width(share: float) -> float:
    return round(100.0 * min(1.0, share), 1) if math.isfinite(share) else 100.0
