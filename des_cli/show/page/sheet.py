"""Small still pictures of a run as SVG: for paper, and for who has no script."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.show.page.curves import Family, FamilyName
from des_cli.show.page.packing import thin_family
from des_cli.show.words import PAGE

WIDTH, HEIGHT = 240, 96
_LEFT, _TOP, _BOTTOM = 2, 4, 92
_COLUMNS = 90  # every second unit of the picture

_PICTURES: tuple[tuple[str, FamilyName, str, str, float], ...] = (
    ("Gx", "g", "gx", "g", 1.0),
    ("Gy", "g", "gy", "g", 1.0),
    ("Gz", "g", "gz", "g", 1.0),
    ("Arm rate", "joint_rate", "arm", "rpm", 1.0 / 6.0),
    ("Fork angle", "angle", "fork", "deg", 1.0),
    ("Cab angle", "angle", "cab", "deg", 1.0),
)
_LEAST_HEIGHT = 0.02


@dataclass(frozen=True, slots=True)
class Still:
    """One small picture: before dashed, after solid.

    Parameters
    ----------
    title, unit : str
    before, after : str
        Points of the polylines, in units of a picture of WIDTH by HEIGHT.
    least, most : str
        What the lower and the upper edge stand for.
    zero : float, optional
        Where zero is, if it is inside.
    alt : str
        What it shows, in words.
    """

    title: str
    unit: str
    before: str
    after: str
    least: str
    most: str
    zero: float | None
    alt: str


def stills_of(families: Mapping[FamilyName, Family]) -> list[Still]:
    """Return the pictures of the G-vector and of the commands."""
    return [
        _still(title, unit, families[name], stem, scale)
        for title, name, stem, unit, scale in _PICTURES
    ]


def _still(title: str, unit: str, family: Family, stem: str, scale: float) -> Still:
    names = (f"{stem}_before", f"{stem}_after")
    thin = thin_family(Family(family.t, {name: family.values[name] for name in names}), _COLUMNS)
    before, after = (scale * thin.values[name] for name in names)
    both = np.concatenate([before, after])
    both = both[np.isfinite(both)] if np.any(np.isfinite(both)) else np.zeros(1)
    least, most = float(np.min(both)), float(np.max(both))
    room = max(0.0, _LEAST_HEIGHT - (most - least)) / 2 + 0.04 * (most - least)
    low, high = least - room, most + room
    lift = (_BOTTOM - _TOP) / (high - low)
    zero = _TOP + high * lift
    return Still(
        title,
        unit,
        _points(thin.t, before, high, lift),
        _points(thin.t, after, high, lift),
        _edge(least),
        _edge(most),
        round(zero, 1) if _TOP < zero < _BOTTOM else None,
        f"{title}: {_range(before)} {unit} before, {_range(after)} {unit} after.",
    )


def _range(values: Floats) -> str:
    return f"from {_edge(float(np.min(values)))} to {_edge(float(np.max(values)))}"


def _edge(value: float) -> str:
    # what is left of a zero by rounding is a zero
    return PAGE.number(0.0 if math.isclose(value, 0.0, abs_tol=1e-9) else value)


def _points(t: Floats, values: Floats, high: float, lift: float) -> str:
    span = float(t[-1] - t[0]) or 1.0
    x = _LEFT + (t - t[0]) * ((WIDTH - 2 * _LEFT) / span)
    y = _TOP + (high - values) * lift
    good = np.isfinite(y)
    return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x[good], y[good], strict=True))
