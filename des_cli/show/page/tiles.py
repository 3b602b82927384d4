"""What the pilot feels of a run, as a row of tiles at the head of its section."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from des_cli.results.ends import When, end_words
from des_cli.results.reading import number
from des_cli.results.worse import find_worse, worse_paths
from des_cli.show.page.numbers import DASH, change, percent, plain

_TOTAL = "felt.seat_angular_acceleration.magnitude"


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


def felt_tiles(metrics: Mapping[str, Any]) -> list[Tile]:
    """Return the tiles of a run; one whose number is not known is left out.

    Parameters
    ----------
    metrics : mapping
        The content of ``metrics.json``.
    """
    tiles = [
        _cross_coupling(metrics),
        _turning(metrics),
        Tile("Seat rate off by", percent(number(metrics, "fidelity.seat_rate_deviation_relative"))),
        _force(metrics),
        _pair(metrics, "Peak Gy", "felt.seat_g.gy.peak", "g", "g"),
        _onset(metrics),
        _end(metrics, "start"),
        _end(metrics, "end"),
    ]
    return [tile for tile in tiles if tile.value != DASH]


def _cross_coupling(metrics: Mapping[str, Any]) -> Tile:
    reduction = number(metrics, "coriolis.vector.reduction")
    grew = reduction is not None and reduction < 0
    sizes = _sizes(metrics, "coriolis.vector.rms", "rad_s2")
    detail = "" if sizes == DASH else f"{sizes} rad/s² rms"
    return Tile("Cross-coupling, squared", change(reduction), detail, "bad" if grew else "")


def _turning(metrics: Mapping[str, Any]) -> Tile:
    paths = {f"{_TOTAL}.{kind}_after_rad_s2" for kind in ("rms", "peak")}
    peak = _sizes(metrics, f"{_TOTAL}.peak", "rad_s2")
    detail = "rad/s² rms" if peak == DASH else f"rad/s² rms; peak {peak}"
    mark = "bad" if paths & worse_paths(metrics) else ""
    value = _sizes(metrics, f"{_TOTAL}.rms", "rad_s2")
    return Tile("Total angular acceleration", value, detail, mark)


def _force(metrics: Mapping[str, Any]) -> Tile:
    error = number(metrics, "fidelity.seat_g_rms_error_g")
    tilt = number(metrics, "fidelity.tilt_error_max_deg")
    detail = "g rms" if tilt is None else f"g rms; tilt {plain(tilt, 2)}° at most"
    return Tile("Seat G off by", plain(error, 3), detail)


def _onset(metrics: Mapping[str, Any]) -> Tile:
    """Return the onset on the axis where it is largest afterwards."""
    axes = ("gx", "gy", "gz")
    after = {axis: number(metrics, f"felt.seat_g.{axis}.onset_after_g_s") for axis in axes}
    axis = max(axes, key=lambda name: after[name] or 0.0)
    return _pair(metrics, f"{axis.capitalize()} onset", f"felt.seat_g.{axis}.onset", "g_s", "g/s")


def _end(metrics: Mapping[str, Any], when: When) -> Tile:
    words = end_words(metrics, when)
    off = words and not words.startswith("as")
    label = f"{when.capitalize()}{' off by' if off else ''}"
    worse = when == "start" and any(each.label.startswith("start") for each in find_worse(metrics))
    return Tile(label, words.replace("-", "−") or DASH, "", "bad" if worse else "")


def _pair(metrics: Mapping[str, Any], label: str, stem: str, suffix: str, unit: str) -> Tile:
    mark = "bad" if f"{stem}_after_{suffix}" in worse_paths(metrics) else ""
    return Tile(label, _sizes(metrics, stem, suffix), unit, mark)


def _sizes(metrics: Mapping[str, Any], stem: str, suffix: str) -> str:
    before, after = (number(metrics, f"{stem}_{when}_{suffix}") for when in ("before", "after"))
    return DASH if before is None or after is None else f"{plain(before, 3)} → {plain(after, 3)}"
