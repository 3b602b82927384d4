"""The suffix of a name tells its unit: ``arm_rpm``, ``fork_deg``, ``t_s``.

Everything inside the project is SI and radians; this table is the only place
where another unit is turned into them. A share becomes a percentage here too.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

Write: TypeAlias = Callable[[float], str]
"""How a number becomes text."""

FOOT_M = 0.3048
"""International foot [m]."""

STANDARD_GRAVITY_M_S2 = 32.2 * FOOT_M
"""1 g as the study takes it, 32.2 ft/s^2 [m/s^2]; the unit of every G here."""


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit that a name can end with.

    Parameters
    ----------
    suffix : str
        As it stands at the end of a name, without the leading underscore.
    quantity : str
        What it measures: ``time``, ``angle``, ``rate``, ``acceleration``, ``jerk``
        (the latter three angular), ``length`` or ``specific_force``.
    to_si : float
        A value in this unit times ``to_si`` is the value in SI (s, rad, rad/s,
        rad/s^2, rad/s^3, m, m/s^2).
    """

    suffix: str
    quantity: str
    to_si: float


_TURN = 2.0 * math.pi
UNITS: tuple[Unit, ...] = (
    Unit("s", "time", 1.0),
    Unit("ms", "time", 1e-3),
    Unit("us", "time", 1e-6),
    Unit("ns", "time", 1e-9),
    Unit("min", "time", 60.0),
    Unit("rad", "angle", 1.0),
    Unit("deg", "angle", math.pi / 180.0),
    Unit("rad_s", "rate", 1.0),
    Unit("deg_s", "rate", math.pi / 180.0),
    Unit("rpm", "rate", _TURN / 60.0),
    Unit("rad_s2", "acceleration", 1.0),
    Unit("deg_s2", "acceleration", math.pi / 180.0),
    Unit("rad_s3", "jerk", 1.0),
    Unit("deg_s3", "jerk", math.pi / 180.0),
    Unit("m", "length", 1.0),
    Unit("ft", "length", FOOT_M),
    Unit("m_s2", "specific_force", 1.0),
    Unit("ft_s2", "specific_force", FOOT_M),
    Unit("g", "specific_force", STANDARD_GRAVITY_M_S2),
)

_BY_SUFFIX = {unit.suffix: unit for unit in UNITS}


def split_unit(name: str) -> tuple[str, Unit | None]:
    """Split a name into its stem and the unit that it ends with.

    The longest suffix wins, so ``arm_rad_s2`` is an acceleration and not a
    time. A name that ends with no unit of the table comes back whole.

    >>> split_unit("arm_rpm")[0], split_unit("arm_rad_s2")[1].quantity
    ('arm', 'acceleration')
    >>> split_unit("arm")
    ('arm', None)
    """
    parts = name.split("_")
    for start in range(1, len(parts)):
        unit = _BY_SUFFIX.get("_".join(parts[start:]))
        if unit is not None:
            return "_".join(parts[:start]), unit
    return name, None


def unit_named(suffix: str) -> Unit | None:
    """Return the unit with a suffix, or None.

    >>> unit_named("rpm").quantity, unit_named("furlong")
    ('rate', None)
    """
    return _BY_SUFFIX.get(suffix)


def suffixes(quantity: str) -> tuple[str, ...]:
    """Return every suffix that measures a quantity, in the table's order."""
    return tuple(unit.suffix for unit in UNITS if unit.quantity == quantity)


def percent(share: float, digits: int | None = None) -> str:
    """Write a share in percent: one decimal, two below 1 %, none from 100 % on.

    Parameters
    ----------
    share : float
    digits : int, optional
        Significant digits instead: of a number that somebody gave, or that is set beside one.

    >>> percent(0.6892), percent(0.0163), percent(0.00163), percent(7.5)
    ('68.9 %', '1.6 %', '0.16 %', '750 %')
    >>> percent(0.125, 6), percent(0.05, 6), percent(0.0999912, 4)
    ('12.5 %', '5 %', '9.999 %')
    """
    hundredths = 100.0 * share
    if digits is not None:
        return f"{hundredths:.{digits}g} %"
    size = abs(hundredths)
    # As it is rounded: 99.96 is 100 and has no decimal.
    decimals = 0 if size >= 99.95 else 1 if size >= 0.995 else 2
    return f"{hundredths:.{decimals}f} %"
