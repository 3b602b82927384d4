"""The interactive plots of a run: which curves each shows, within which limits.

A panel is data. The page's script draws it, and the words under it are made here, so that
who cannot see the plot reads what it shows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.loads import Driven
from des_cli.model.machine import JOINTS, Joint
from des_cli.model.metrics import Metrics
from des_cli.show.page.curves import Family, FamilyName
from des_cli.show.words import PAGE, listed

Pen: TypeAlias = Literal["before", "after", "total_before", "total_after", "arm", "fork", "cab"]
GroupKey: TypeAlias = Literal["turning", "rate", "g", "arm", "fork", "cab", "solver"]

GROUPS: Mapping[GroupKey, str] = {
    "turning": "Cross-coupling and total angular acceleration",
    "rate": "Rate of the seat",
    "g": "G at the seat",
    "arm": "Arm",
    "fork": "Fork",
    "cab": "Cab",
    "solver": "Factors and adjoint",
}

AT_LIMIT = 0.99
"""Share of a limit from which on a motion is marked as being at it."""

_NEAR = 3.0  # the ordinate reaches to the limit where that is no more than so many peaks
_ROOM = 1.08
_FLOOR = {"rad/s²": 2e-3, "deg/s": 0.1, "g": 2e-3, "g/s": 0.02, "deg": 0.01, "rad/s³": 0.02}

_DRIVEN: tuple[tuple[FamilyName, str, str, Driven | None], ...] = (
    ("angle", "angle", "deg", None),
    ("joint_rate", "rate", "deg/s", "rate"),
    ("acceleration", "acceleration", "rad/s²", "acceleration"),
    ("jerk", "jerk", "rad/s³", "jerk"),
)


@dataclass(frozen=True, slots=True)
class Curve:
    """One line of a panel: a column of its family, and how it is drawn."""

    label: str
    column: str
    pen: Pen


@dataclass(frozen=True, slots=True)
class Panel:
    """One plot.

    Parameters
    ----------
    key : str
        Unique in a run.
    group : str
        Of ``GROUPS``.
    title, unit : str
    family : str
        Whose times and columns the curves have.
    curves : tuple of Curve
    span : tuple of float
        The ordinate's ends.
    limit : float, optional
        Bound for both directions, in the panel's unit.
    at_limit : tuple of (float, float)
        From when to when the modified motion is at the limit [s].
    finding : str
        What the plot shows, in words.
    """

    key: str
    group: GroupKey
    title: str
    unit: str
    family: FamilyName
    curves: tuple[Curve, ...]
    span: tuple[float, float]
    limit: float | None = None
    at_limit: tuple[tuple[float, float], ...] = ()
    finding: str = ""


def panels_of(
    families: Mapping[FamilyName, Family],
    metrics: Metrics,
    angle_limits: Mapping[Joint, float] | None = None,
) -> list[Panel]:
    """Return the panels of a run, group by group.

    Parameters
    ----------
    families : mapping of str to Family
        All rows of them, not thinned.
    metrics : Metrics
    angle_limits : mapping of joint to float, optional
        [rad]; infinite for a joint that turns endlessly.
    """
    return [
        *_turning(families["turning"]),
        *_simple("rate", "rate", families["rate"], "deg/s", ("p", "q", "r"), _RATES),
        *_simple("g", "g", families["g"], "g", ("gx", "gy", "gz", "gn"), _FORCES),
        *_simple("g", "onset", families["onset"], "g/s", ("onset",), {"onset": "Onset of G"}),
        *(
            _joint(joint, driven, families, metrics, angle_limits or {})
            for joint in JOINTS
            for driven in _DRIVEN
        ),
        *_solver(families.get("solver")),
    ]


_RATES = {"p": "Roll rate p", "q": "Pitch rate q", "r": "Yaw rate r"}
_FORCES = {"gx": "Gx", "gy": "Gy", "gz": "Gz", "gn": "|G|"}


_ABOUT = (
    ("n", "Size of cross-coupling c and total α"),
    ("x", "About x: c and α"),
    ("y", "About y: c and α"),
    ("z", "About z: c and α"),
)


def _turning(family: Family) -> Iterator[Panel]:
    for axis, name in _ABOUT:
        curves = (
            Curve("c before", f"c_{axis}_before", "before"),
            Curve("c after", f"c_{axis}_after", "after"),
            Curve("α before", f"a_{axis}_before", "total_before"),
            Curve("α after", f"a_{axis}_after", "total_after"),
        )
        words = [
            f"{what} {_from_to(family, f'{letter}_{axis}')} rad/s²"
            for what, letter in (("cross-coupling", "c"), ("total", "a"))
        ]
        yield Panel(
            f"turning-{axis}",
            "turning",
            name,
            "rad/s²",
            "turning",
            curves,
            _span(family, curves, "rad/s²"),
            finding=f"Peak: {listed(words)}.",
        )


def _simple(
    group: GroupKey,
    name: FamilyName,
    family: Family,
    unit: str,
    stems: tuple[str, ...],
    titles: Mapping[str, str],
) -> Iterator[Panel]:
    for stem in stems:
        curves = _before_after(stem)
        yield Panel(
            f"{group}-{stem}",
            group,
            titles[stem],
            unit,
            name,
            curves,
            _span(family, curves, unit),
            finding=f"Peak {_from_to(family, stem)} {unit}; {_apart(family, stem, unit)}.",
        )


def _joint(
    joint: Joint,
    driven: tuple[FamilyName, str, str, Driven | None],
    families: Mapping[FamilyName, Family],
    metrics: Metrics,
    angle_limits: Mapping[Joint, float],
) -> Panel:
    name, what, unit, load = driven
    family, curves = families[name], _before_after(joint)
    limit = metrics.limits.modified[joint].limit(load) if load else angle_limits.get(joint)
    if limit is not None and unit.startswith("deg"):
        limit = math.degrees(limit)
    if limit is not None and not 0.0 < limit < math.inf:
        limit = None
    peak = _peak(family.values[f"{joint}_after"])
    stays = () if limit is None else _stays(family.t, family.values[f"{joint}_after"], limit)
    finding = f"Peak {_from_to(family, joint)} {unit}"
    if limit is None:
        finding += "; no limit."
    else:
        finding += f", {PAGE.percent(peak / limit)} of the limit of {PAGE.number(limit)}"
        total = sum(stop - start for start, stop in stays)
        finding += f"; at it for {PAGE.number(total, 2)} s." if stays else "."
    return Panel(
        f"{joint}-{what}",
        joint,
        what.capitalize(),
        unit,
        name,
        curves,
        _span(family, curves, unit, limit),
        limit,
        stays,
        finding,
    )


def _solver(family: Family | None) -> Iterator[Panel]:
    if family is None:
        return
    for stem, title, unit in (("p", "Factor p", "–"), ("adjoint", "Adjoint λ", "s/rad")):
        names = [name for name in family.values if name.split("_")[0] == stem]
        if not names:
            continue
        curves = tuple(Curve(*_named(name)) for name in names)
        parts = [
            f"{curve.label} from {PAGE.number(float(np.min(family.values[curve.column])))} to "
            f"{PAGE.number(float(np.max(family.values[curve.column])))}"
            for curve in curves
        ]
        span = _span(family, curves, unit)
        finding = f"{listed(parts)}."
        yield Panel(
            f"solver-{stem}", "solver", title, unit, "solver", curves, span, None, (), finding
        )


def _named(name: str) -> tuple[str, str, Pen]:
    for joint in JOINTS:
        if name.endswith(f"_{joint}"):
            return joint, name, joint
    return "all joints", name, "after"


def _before_after(stem: str) -> tuple[Curve, Curve]:
    return (
        Curve("before", f"{stem}_before", "before"),
        Curve("after", f"{stem}_after", "after"),
    )


def _peak(values: Floats) -> float:
    return float(np.max(np.abs(values), initial=0.0))


def _from_to(family: Family, stem: str) -> str:
    before, after = (_peak(family.values[f"{stem}_{when}"]) for when in ("before", "after"))
    return f"{_written(before)} {PAGE.arrow} {_written(after)}"


def _written(value: float) -> str:
    # the angle of an arm that turns and turns is no power of ten
    return PAGE.number(value, 3 if abs(value) < 1e3 else 6)


def _apart(family: Family, stem: str, unit: str) -> str:
    off = np.abs(family.values[f"{stem}_after"] - family.values[f"{stem}_before"])
    if not len(off) or not np.all(np.isfinite(off)):
        return "how far apart is not known"
    worst = int(np.argmax(off))
    if off[worst] < _FLOOR[unit]:
        return "no difference to speak of"
    return (
        f"farthest apart by {PAGE.number(float(off[worst]))} {unit} "
        f"at {PAGE.number(float(family.t[worst]))} s"
    )


def _span(
    family: Family, curves: tuple[Curve, ...], unit: str, limit: float | None = None
) -> tuple[float, float]:
    """Return the ends of the ordinate: what a thousandth moves is not blown up to a mountain."""
    if limit is not None:
        largest = _peak(family.values[curves[-1].column])
        if limit <= _NEAR * largest:
            # The modified motion decides: a desired one that steps would squeeze it to a line.
            reach = _ROOM * max(limit, largest)
            return -reach, reach
    values = np.concatenate([family.values[curve.column] for curve in curves])
    values = values[np.isfinite(values)]
    if not len(values):
        return -1.0, 1.0
    least, most = float(np.min(values)), float(np.max(values))
    height = max(most - least, _FLOOR.get(unit, 0.02))
    middle = 0.5 * (least + most)
    half = 0.5 * _ROOM * height
    if not math.isfinite(half):
        return -1.0, 1.0
    return middle - half, middle + half


def _stays(t: Floats, values: Floats, limit: float) -> tuple[tuple[float, float], ...]:
    """Return from when to when a quantity is at its limit, neighbours as one stay."""
    at = np.abs(values) >= AT_LIMIT * limit
    edges = np.flatnonzero(np.diff(np.concatenate([[False], at, [False]]).astype(int)))
    return tuple(
        (float(t[start]), float(t[stop - 1])) for start, stop in edges.reshape(-1, 2).tolist()
    )
