"""The six numbers of a run that matter, as tiles at the head of its section."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from des_cli.model.felt import BeforeAfter
from des_cli.model.metric import SEAT_G_ERROR, SEAT_RATE_DEVIATION
from des_cli.model.metrics import Metrics
from des_cli.results.ends import end_words
from des_cli.results.margins import nearest_limit
from des_cli.results.worse import FeltNumber, worse_numbers
from des_cli.show.page.curves import Family, FamilyName
from des_cli.show.words import PAGE


@dataclass(frozen=True, slots=True)
class Tile:
    """One number that matters.

    Parameters
    ----------
    label, value, detail : str
    mark, detail_mark : str
        ``bad`` where the value, or the detail, got worse, else empty.
    """

    label: str
    value: str
    detail: str = ""
    mark: str = ""
    detail_mark: str = ""


def run_tiles(metrics: Metrics, families: Mapping[FamilyName, Family]) -> list[Tile]:
    """Return the tiles of a run; a number that is not known is a dash."""
    worse = worse_numbers(metrics)
    return [
        _cross_coupling(metrics),
        _turning(metrics, worse),
        _rate(metrics),
        _force(metrics, families["g"], worse),
        _margin(metrics),
        _ends(metrics, worse),
    ]


def _cross_coupling(metrics: Metrics) -> Tile:
    vector = metrics.coriolis.parts["vector"]
    grew = vector.reduction is not None and vector.reduction < 0
    detail = f"rad/s² rms; {PAGE.change(vector.reduction)} squared"
    return Tile("Cross-coupling", _pair(vector.sizes.rms), detail, _mark(grew))


def _turning(metrics: Metrics, worse: frozenset[FeltNumber]) -> Tile:
    peak = PAGE.from_to(metrics.felt.turning.peak)
    detail = f"rad/s² rms; peak {peak}" if peak else "rad/s² rms"
    marks = (_mark(f"turning {size}" in worse) for size in ("rms", "peak"))
    return Tile("Total angular acceleration", _pair(metrics.felt.turning.rms), detail, *marks)


def _rate(metrics: Metrics) -> Tile:
    rms = metrics.felt.seat_rate["magnitude"].rms
    known = rms.known and BeforeAfter(*map(math.degrees, rms.known))
    detail = f"{PAGE.from_to(known)} deg/s rms" if known else ""
    value = PAGE.percent(metrics.fidelity.value(SEAT_RATE_DEVIATION))
    return Tile("Seat rate off by", value, detail)


def _force(metrics: Metrics, family: Family, worse: frozenset[FeltNumber]) -> Tile:
    peaks = [float(np.max(np.abs(family.values[f"gn_{when}"]))) for when in ("before", "after")]
    sideways, off = metrics.felt.seat_g["gy"].peak, metrics.fidelity.value(SEAT_G_ERROR)
    detail = f"g; Gy {_pair(sideways)}; off by {PAGE.number(off)} rms"
    value = PAGE.from_to(BeforeAfter(peaks[0], peaks[1]))
    return Tile("Peak G", value, detail, detail_mark=_mark("gy peak" in worse))


def _margin(metrics: Metrics) -> Tile:
    desired, modified = nearest_limit(metrics)
    if modified is None:
        return Tile("Smallest limit margin", PAGE.unknown)
    value = PAGE.percent(max(0.0, modified.margin) if modified.ok else modified.margin)
    detail = f"of the {modified.joint}'s {modified.driven}"
    if desired is not None:
        detail += f"; {PAGE.percent(desired.margin)} before"
    return Tile("Smallest limit margin", value, detail, _mark(not modified.ok))


def _ends(metrics: Metrics, worse: frozenset[FeltNumber]) -> Tile:
    start, end = (PAGE.sentence(end_words(metrics.fidelity, when)) for when in ("start", "end"))
    value = "as in the profile" if start == end == "as in the profile" else start
    detail = "both" if value == end else f"end {'' if end.startswith('as') else 'off by '}{end}"
    label = (
        "Start and end" if value == end else "Start" if start.startswith("as") else "Start off by"
    )
    return Tile(label, value or PAGE.unknown, detail if end else "", _mark("start" in worse))


def _pair(pair: BeforeAfter) -> str:
    return PAGE.from_to(pair) or PAGE.unknown


def _mark(bad: bool) -> str:
    return "bad" if bad else ""
