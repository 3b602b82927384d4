"""One word on a run: fly it, look at it first, or don't.

The word is read from the metrics alone, so that the same metrics always give the same word.
It speaks of what the tool measured; whether a person may ride it is for those who operate
the machine to say.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, TypeAlias

from des_cli.model.machine import JOINTS
from des_cli.model.metric import SEAT_RATE_DEVIATION
from des_cli.model.metrics import Metrics
from des_cli.model.notice import HARMS, Notice, NoticeName
from des_cli.results.margins import limit_uses
from des_cli.results.worse import find_worse

Word: TypeAlias = Literal["fly", "look", "don't"]

END_ANGLE = math.radians(5.0)
"""Difference of fork or cab at the end [rad] that is told. The arm's is not: it turns
endlessly, and nobody feels where it stands."""

END_RATE = math.radians(5.0)
"""Difference of a joint's rate at the end [rad/s] that is told: what follows the maneuver
starts from another rate, by more than twice what is noticed as a turn."""

ASKED_G = 0.1
"""How far the machine's own motion may be from an asked G [g rms], beside the reduction."""

LIMITS_CHANGE = 0.05
"""How far keeping the limits may move the seat's rate, relative to the profile's."""

_TOLD: Mapping[NoticeName, str] = MappingProxyType(
    {
        "felt": "what the pilot feels is changed",
        "ill-posed": "the budgets leave the rates free",
        "damped": "the inverse was damped near the singularity",
        "bought": "one component was bought with another",
        "noisy": "the record is noisy",
        "uncoupled": "there is no cross-coupling to reduce",
    }
)
"""Notices in a few words each; the whole sentence stands beside them."""

_ASKING = (frozenset(HARMS) | _TOLD.keys()) - {"worse"}
"""Notices that ask for a look. What got worse is read from the numbers."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """A word and why.

    Parameters
    ----------
    word : {"fly", "look", "don't"}
    reasons : tuple of str
        Parts of sentences, the gravest first; never empty.
    """

    word: Word
    reasons: tuple[str, ...]


def find_verdict(metrics: Metrics) -> Verdict:
    """Return the verdict on a run.

    Parameters
    ----------
    metrics : Metrics
        Of a stored run. What is not known speaks against flying it.

    Returns
    -------
    Verdict
        ``don't`` if the solver did not converge, or the modified motion breaks a limit;
        else ``look`` if the ride got worse, an end is off, or something about the record
        or the request needs a person; else ``fly``.
    """
    against = tuple(_against(metrics))
    if against:
        return Verdict("don't", against)
    doubts = tuple(dict.fromkeys(_doubts(metrics)))
    if doubts:
        return Verdict("look", doubts)
    return Verdict("fly", ("verified, inside all limits, and no worse to sit in",))


def _against(metrics: Metrics) -> Iterator[str]:
    status = metrics.solver.status
    if status not in ("converged", "acceptable"):
        yield f"the solver did not converge ({status})" if status else "how it ended is not known"
    verdicts = [metrics.limits.modified[joint].ok for joint in JOINTS]
    broken = [joint for joint, ok in zip(JOINTS, verdicts, strict=True) if ok is False]
    uses = [use for use in limit_uses(metrics.limits.modified) if not use.ok]
    if uses:
        most = max(uses, key=lambda use: use.share)
        yield f"the modified motion breaks the {most.joint}'s limit of {most.driven}"
    elif broken:
        yield f"the modified motion breaks a limit of the {broken[0]}"
    elif None in verdicts:
        yield "whether it keeps the limits is not known"
    # Of the occupant's bounds the metrics have no more than the sentence.
    if any(each.startswith("modified seat ") for each in metrics.violations):
        yield "the modified motion breaks a bound for the occupant"


def _doubts(metrics: Metrics) -> Iterator[str]:
    yield from map(str, find_worse(metrics))
    if metrics.solver.status == "acceptable":
        yield "the solver stopped short of its tolerance"
    reduction = metrics.coriolis.reduction("vector")
    if reduction is not None and reduction <= 0.0:
        yield "nothing was taken off the whole cross-coupling"
    for notice in metrics.named_notices:
        yield from _told(notice)
    change = metrics.executable.change.value(SEAT_RATE_DEVIATION)
    if metrics.executable.replaced and change is not None and change > LIMITS_CHANGE:
        yield "keeping the limits changed the maneuver"
    asked = metrics.asked_g
    if asked is not None and asked.rms_g is not None and asked.rms_g > ASKED_G:
        yield f"the machine misses the asked G by {asked.rms_g:.2g} g rms"
    yield from _end(metrics)


def _told(notice: Notice) -> Iterator[str]:
    name = next((each for each in _ASKING if each == notice.name), None)
    if name:
        yield _TOLD.get(name) or notice.text.partition(";")[0]


def _end(metrics: Metrics) -> Iterator[str]:
    angles, rates = metrics.fidelity.offset("end")
    off = []
    for joint in JOINTS:
        angle, rate = angles.get(joint) or 0.0, rates.get(joint) or 0.0
        if joint != "arm" and abs(angle) > END_ANGLE:
            off.append(f"{joint} {math.degrees(angle):+.2g} deg")
        if abs(rate) > END_RATE:
            off.append(f"{joint} {math.degrees(rate):+.2g} deg/s")
    if off:
        yield f"end off by {', '.join(off)}"
