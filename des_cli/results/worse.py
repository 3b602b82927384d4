"""What of the ride got worse by the reduction: the first thing that a pilot should know.

Taking the cross-coupling off is no gain if hard joint accelerations turn the seat
more than the cross-coupling did. Each measure has a threshold below which nobody
in the seat could tell.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, TypeAlias

from des_cli.model.felt import (
    G_AXES,
    LEAST_START_ANGLE,
    LEAST_START_RATE,
    PEAK_SHARE,
    SHARE,
    BeforeAfter,
    Felt,
    GAxis,
)
from des_cli.model.machine import JOINTS
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_PEAK_RATIO,
    ANGULAR_ACCELERATION_RMS_RATIO,
    SEAT_G_ERROR,
    UNFELT_ANGULAR_ACCELERATION,
)
from des_cli.model.metrics import Metrics

LEAST_GY = 0.1
"""Growth of the sideways G's peak [g] that is told: it leans a 1 g pilot by six degrees."""

LEAST_ONSET = 0.1
"""Growth of the G onset on any axis [g/s] that is told: the whole onset of a gradual-onset run."""

_SMALLER = f"a smaller budget on {SEAT_G_ERROR}"

FeltNumber: TypeAlias = Literal[
    "turning rms", "turning peak", "gy peak", "gx onset", "gy onset", "gz onset", "start"
]
"""What of the ride may be told to have got worse."""

_ONSETS: Mapping[GAxis, FeltNumber] = MappingProxyType(
    {"gx": "gx onset", "gy": "gy onset", "gz": "gz onset"}
)


@dataclass(frozen=True, slots=True)
class Worse:
    """One measure of the ride that got worse.

    Parameters
    ----------
    label : str
    text : str
        Its numbers, with their unit.
    numbers : tuple of FeltNumber
        Which they are.
    cure : str
        What bounds it, as a part of a sentence.
    """

    label: str
    text: str
    numbers: tuple[FeltNumber, ...] = ()
    cure: str = ""

    def __str__(self) -> str:
        return f"{self.label} {self.text}"


def find_worse(metrics: Metrics) -> list[Worse]:
    """Return what of the ride got worse by more than its threshold.

    Parameters
    ----------
    metrics : Metrics
        What is not known of them is not told.

    Returns
    -------
    list of Worse
        Of the total angular acceleration, the peak of Gy, the G onset and the start,
        in this order.
    """
    ride = metrics.ride
    return [*_angular(ride), *_sideways(ride), *_onset(ride), *_start(metrics)]


def worse_words(metrics: Metrics, *, short: bool = False) -> str:
    """Return what got worse in one line, empty where nothing did.

    Parameters
    ----------
    metrics : Metrics
    short : bool
        Give the first measure alone, for a line among many.
    """
    found = find_worse(metrics)
    told = ", ".join(map(str, found[:1] if short else found))
    return f"worse to sit in: {told}" if told else ""


def worse_numbers(metrics: Metrics) -> frozenset[FeltNumber]:
    """Return which numbers of the ride got worse."""
    return frozenset(number for each in find_worse(metrics) for number in each.numbers)


def _grew(pair: BeforeAfter, least: float, share: float = SHARE) -> bool:
    if pair.known is None:
        return False
    before, after = pair.known
    return after - before > max(share * before, least)


def _angular(felt: Felt) -> list[Worse]:
    turning = felt.turning
    texts: list[str] = []
    numbers: list[FeltNumber] = []
    cures = []
    if _grew(turning.rms, UNFELT_ANGULAR_ACCELERATION):
        texts.append(f"{_from_to(turning.rms, 3)} rad/s² rms")
        numbers.append("turning rms")
        cures.append(ANGULAR_ACCELERATION_RMS_RATIO)
    if _grew(turning.peak, UNFELT_ANGULAR_ACCELERATION, PEAK_SHARE):
        texts.append(f"peak {_from_to(turning.peak, 3)} rad/s²")
        numbers.append("turning peak")
        cures.append(ANGULAR_ACCELERATION_PEAK_RATIO)
    if not texts:
        return []
    label, cure = "total angular acceleration", f"a budget on {' and '.join(cures)}"
    return [Worse(label, ", ".join(texts), tuple(numbers), cure)]


def _sideways(felt: Felt) -> list[Worse]:
    peak = felt.seat_g["gy"].peak
    if not _grew(peak, LEAST_GY, share=0.0):
        return []
    return [Worse("peak Gy", f"{_from_to(peak, 2)} g", ("gy peak",), "the machine's gy_g")]


def _onset(felt: Felt) -> list[Worse]:
    """Return the onset of the axis on which it grew most."""
    onsets = {axis: felt.seat_g[axis].onset for axis in G_AXES}
    grown = {
        axis: pair.known[1] - pair.known[0]
        for axis, pair in onsets.items()
        if pair.known is not None and _grew(pair, LEAST_ONSET)
    }
    if not grown:
        return []
    most = max(grown, key=lambda axis: (grown[axis], axis))
    text = f"{_from_to(onsets[most], 2)} g/s"
    numbers = tuple(_ONSETS[axis] for axis in grown)
    largest = max(pair.before or 0.0 for pair in onsets.values())
    # A bound holds for every axis: below the onset of the profile itself it cannot be kept.
    cure = "the machine's g_onset_g_s" if (onsets[most].after or 0.0) > largest else _SMALLER
    return [Worse(f"{most.capitalize()} onset", text, numbers, cure)]


def _from_to(pair: BeforeAfter, digits: int) -> str:
    return f"{pair.before:.{digits}g} -> {pair.after:.{digits}g}"


def _start(metrics: Metrics) -> list[Worse]:
    angles, rates = metrics.fidelity.offset("start")
    off = []
    for joint in JOINTS:
        angle, rate = angles.get(joint) or 0.0, rates.get(joint) or 0.0
        freed = f"{joint}_start" in metrics.solver.optimise
        if abs(angle) > LEAST_START_ANGLE and not freed:
            off.append(f"{joint} {angle:+.2g} rad")
        if abs(rate) > LEAST_START_RATE:
            off.append(f"{joint} {rate:+.2g} rad/s")
    cure = "ends: match-start"
    return [Worse("start off by", ", ".join(off), ("start",), cure)] if off else []
