"""What of the ride got worse by the reduction: the first thing that a pilot should know.

Taking the cross-coupling off is no gain if hard joint accelerations turn the seat
more than the cross-coupling did. Each measure has a threshold below which nobody
in the seat could tell.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from des_cli.model.machine import JOINTS
from des_cli.model.metric import UNFELT_ANGULAR_ACCELERATION
from des_cli.results.reading import lookup, number, section

SHARE = 0.05
"""Relative growth of the total angular acceleration's rms, or of the G onset, that is told:
a twentieth is what two runs of one maneuver may differ by on a machine."""

PEAK_SHARE = 0.1
"""The same of the total angular acceleration's peak: one instant says less than a mean."""

LEAST_GY = 0.1
"""Growth of the sideways G's peak [g] that is told: it leans a 1 g pilot by six degrees."""

LEAST_ONSET = 0.1
"""Growth of the G onset on any axis [g/s] that is told: the whole onset of a gradual-onset run."""

LEAST_START_RATE = 0.02
"""Difference of a joint's rate at the start [rad/s] that is told: about a degree per second,
under the 1.5 to 2 degrees per second at which a turn is noticed (Benson 1989)."""

LEAST_START_ANGLE = 0.01
"""Difference of a joint's angle at the start [rad] that is told, of a joint whose start
is not among the constants to be found: half a degree, more than rounding by far."""

AXES = ("gx", "gy", "gz")

_SMALLER = "a smaller budget on seat_g_rms_error_g"

_TOTAL = "felt.seat_angular_acceleration.magnitude"


@dataclass(frozen=True, slots=True)
class Worse:
    """One measure of the ride that got worse.

    Parameters
    ----------
    label : str
    text : str
        Its numbers, with their unit.
    paths : tuple of str
        Where the worse numbers stand in the metrics.
    cure : str
        What bounds it, as a part of a sentence.
    """

    label: str
    text: str
    paths: tuple[str, ...] = ()
    cure: str = ""

    def __str__(self) -> str:
        return f"{self.label} {self.text}"


def find_worse(metrics: Mapping[str, Any]) -> list[Worse]:
    """Return what of the ride got worse by more than its threshold.

    Parameters
    ----------
    metrics : mapping
        The content of ``metrics.json``; what is not known is not told.

    Returns
    -------
    list of Worse
        Of the total angular acceleration, the peak of Gy, the G onset and the start,
        in this order.
    """
    # A ride is compared with the one that was reduced: the noise of a record is no ride.
    felt = section(metrics, "added.felt") or section(metrics, "felt")
    compared = {**metrics, "felt": felt}
    return [*_angular(compared), *_sideways(compared), *_onset(compared), *_start(metrics)]


def worse_words(metrics: Mapping[str, Any], *, short: bool = False) -> str:
    """Return what got worse in one line, empty where nothing did.

    Parameters
    ----------
    metrics : mapping
    short : bool
        Give the first measure alone, for a line among many.
    """
    found = find_worse(metrics)
    told = ", ".join(map(str, found[:1] if short else found))
    return f"worse to sit in: {told}" if told else ""


def worse_paths(metrics: Mapping[str, Any]) -> frozenset[str]:
    """Return where the numbers stand in the metrics that got worse."""
    return frozenset(path for each in find_worse(metrics) for path in each.paths)


def _grew(before: float, after: float, least: float, share: float = SHARE) -> bool:
    return after - before > max(share * before, least)


def _angular(metrics: Mapping[str, Any]) -> list[Worse]:
    texts, paths = [], []
    for kind, share in (("rms", SHARE), ("peak", PEAK_SHARE)):
        path = f"{_TOTAL}.{kind}_after_rad_s2"
        before, after = number(metrics, f"{_TOTAL}.{kind}_before_rad_s2"), number(metrics, path)
        if before is None or after is None:
            continue
        if _grew(before, after, UNFELT_ANGULAR_ACCELERATION, share):
            numbers = f"{before:.3g} -> {after:.3g} rad/s²"
            texts.append(f"{numbers} rms" if kind == "rms" else f"peak {numbers}")
            paths.append(path)
    label = "total angular acceleration"
    kinds = [kind for kind in ("rms", "peak") if any(f".{kind}_" in path for path in paths)]
    cure = "a budget on " + " and ".join(
        f"seat_angular_acceleration_{kind}_ratio" for kind in kinds
    )
    return [Worse(label, ", ".join(texts), tuple(paths), cure)] if texts else []


def _sideways(metrics: Mapping[str, Any]) -> list[Worse]:
    path = "felt.seat_g.gy.peak_after_g"
    before, after = number(metrics, "felt.seat_g.gy.peak_before_g"), number(metrics, path)
    if before is None or after is None or after - before <= LEAST_GY:
        return []
    return [Worse("peak Gy", f"{before:.2g} -> {after:.2g} g", (path,), "the machine's gy_g")]


def _onset(metrics: Mapping[str, Any]) -> list[Worse]:
    """Return the onset of the axis on which it grew most."""
    grown = []
    for axis in AXES:
        path = f"felt.seat_g.{axis}.onset_after_g_s"
        before = number(metrics, f"felt.seat_g.{axis}.onset_before_g_s")
        after = number(metrics, path)
        if before is not None and after is not None and _grew(before, after, LEAST_ONSET):
            grown.append((after - before, axis, f"{before:.2g} -> {after:.2g} g/s", path))
    if not grown:
        return []
    _, axis, text, _ = max(grown)
    paths = tuple(path for *_, path in grown)
    largest = max(number(metrics, f"felt.seat_g.{each}.onset_before_g_s") or 0.0 for each in AXES)
    after = number(metrics, f"felt.seat_g.{axis}.onset_after_g_s") or 0.0
    # A bound holds for every axis: below the onset of the profile itself it cannot be kept.
    cure = "the machine's g_onset_g_s" if after > largest else _SMALLER
    return [Worse(f"{axis.capitalize()} onset", text, paths, cure)]


def _start(metrics: Mapping[str, Any]) -> list[Worse]:
    optimise = lookup(metrics, "solver.optimise")
    freed = optimise if isinstance(optimise, list) else []
    off = []
    for joint in JOINTS:
        angle = number(metrics, f"fidelity.start_error.{joint}_rad") or 0.0
        rate = number(metrics, f"fidelity.start_error.{joint}_rad_s") or 0.0
        if abs(angle) > LEAST_START_ANGLE and f"{joint}_start" not in freed:
            off.append(f"{joint} {angle:+.2g} rad")
        if abs(rate) > LEAST_START_RATE:
            off.append(f"{joint} {rate:+.2g} rad/s")
    return [Worse("start off by", ", ".join(off), cure="ends: match-start")] if off else []
