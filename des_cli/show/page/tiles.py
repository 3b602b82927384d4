"""What the pilot feels of a run, as a row of tiles at the head of its section."""

from __future__ import annotations

from dataclasses import dataclass

from des_cli.model.metric import SEAT_G_ERROR, SEAT_RATE_DEVIATION
from des_cli.model.metrics import Metrics, When
from des_cli.results.ends import end_words
from des_cli.results.worse import FeltNumber, worse_numbers
from des_cli.show.words import PAGE, axis_name


@dataclass(frozen=True, slots=True)
class Tile:
    """One number that matters.

    Parameters
    ----------
    label, value, detail : str
    mark : str
        ``bad`` for what got worse, else empty.
    """

    label: str
    value: str
    detail: str = ""
    mark: str = ""


def felt_tiles(metrics: Metrics) -> list[Tile]:
    """Return the tiles of a run; one whose number is not known is left out."""
    worse, gy = worse_numbers(metrics), metrics.felt.seat_g["gy"]
    tiles = [
        _cross_coupling(metrics),
        _turning(metrics, worse),
        Tile("Seat rate off by", PAGE.percent(metrics.fidelity.value(SEAT_RATE_DEVIATION))),
        _force(metrics),
        Tile("Peak Gy", PAGE.from_to(gy.peak), "g", _mark("gy peak" in worse)),
        _onset(metrics, worse),
        _end(metrics, "start", worse),
        _end(metrics, "end", worse),
    ]
    return [tile for tile in tiles if tile.value not in ("", PAGE.unknown)]


def _cross_coupling(metrics: Metrics) -> Tile:
    vector = metrics.coriolis.parts["vector"]
    grew = vector.reduction is not None and vector.reduction < 0
    sizes = PAGE.from_to(vector.sizes.rms)
    detail = f"{sizes} rad/s² rms" if sizes else ""
    return Tile("Cross-coupling, squared", PAGE.change(vector.reduction), detail, _mark(grew))


def _turning(metrics: Metrics, worse: frozenset[FeltNumber]) -> Tile:
    peak = PAGE.from_to(metrics.felt.turning.peak)
    detail = f"rad/s² rms; peak {peak}" if peak else "rad/s² rms"
    mark = _mark(bool({"turning rms", "turning peak"} & worse))
    return Tile("Total angular acceleration", PAGE.from_to(metrics.felt.turning.rms), detail, mark)


def _force(metrics: Metrics) -> Tile:
    tilt = metrics.fidelity.tilt_error_max_deg
    detail = "g rms" if tilt is None else f"g rms; tilt {PAGE.number(tilt, 2)}° at most"
    return Tile("Seat G off by", PAGE.number(metrics.fidelity.value(SEAT_G_ERROR), 3), detail)


def _onset(metrics: Metrics, worse: frozenset[FeltNumber]) -> Tile:
    """Return the onset on the axis where it is largest afterwards."""
    axis = metrics.felt.hardest_onset
    value = PAGE.from_to(metrics.felt.seat_g[axis].onset)
    return Tile(f"{axis_name(axis)} onset", value, "g/s", _mark(f"{axis} onset" in worse))


def _end(metrics: Metrics, when: When, worse: frozenset[FeltNumber]) -> Tile:
    words = end_words(metrics.fidelity, when)
    off = words and not words.startswith("as")
    label = f"{when.capitalize()}{' off by' if off else ''}"
    return Tile(label, PAGE.sentence(words), "", _mark(when in worse))


def _mark(bad: bool) -> str:
    return "bad" if bad else ""
