"""The curves of a run that the page plots, in the units that it plots them in.

Curves that share their times make a family: they are thinned together, so that they stay
one table. ``before`` is the motion that the profile asks for, ``after`` the modified one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from des_cli.kinematics.onset import onsets
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS

FamilyName: TypeAlias = Literal[
    "turning", "rate", "g", "onset", "angle", "joint_rate", "acceleration", "jerk", "solver"
]
WHEN = ("before", "after")

_JOINT_UNITS: tuple[tuple[FamilyName, str, float], ...] = (
    ("angle", "rad", float(np.degrees(1.0))),
    ("joint_rate", "rad_s", float(np.degrees(1.0))),
    ("acceleration", "rad_s2", 1.0),
    ("jerk", "rad_s3", 1.0),
)
_ASKED = {"before": "asked", "after": "modified"}


@dataclass(frozen=True, slots=True)
class Family:
    """Curves over common times.

    Parameters
    ----------
    t : (n,) array
        [s]
    values : mapping of str to (n,) array
    """

    t: Floats
    values: Mapping[str, Floats]


def families_of(trajectory: Mapping[str, Floats]) -> dict[FamilyName, Family]:
    """Return the curves of a run.

    Parameters
    ----------
    trajectory : mapping of str to (n,) array
        The columns of ``trajectory.parquet``.

    Returns
    -------
    dict of str to Family
        ``turning``: cross-coupling ``c`` and total angular acceleration ``a`` along the
        seat's axes, and their sizes ``c_n``, ``a_n`` [rad/s^2]. ``rate``: p, q, r [deg/s].
        ``g``: the G-vector and its size [g]. ``onset``: the largest onset of a component,
        over the window that begins there [g/s]. Of the joints ``angle`` [deg],
        ``joint_rate`` [deg/s], ``acceleration`` [rad/s^2], ``jerk`` [rad/s^3]. ``solver``:
        factors and adjoint, where there are any.
    """
    t = trajectory["t_s"]
    families: dict[FamilyName, Family] = {
        "turning": Family(t, _turning(trajectory)),
        "rate": Family(t, _rates(trajectory)),
        "g": Family(t, forces := _forces(trajectory)),
        "onset": _onset(t, forces),
    }
    for name, suffix, scale in _JOINT_UNITS:
        families[name] = Family(
            t,
            {
                f"{joint}_{when}": scale * trajectory[f"{_ASKED[when]}_{joint}_{suffix}"]
                for joint in JOINTS
                for when in WHEN
            },
        )
    solver = {
        name: values
        for name, values in trajectory.items()
        if name == "p" or name.startswith(("p_", "adjoint_"))
    }
    if solver:
        families["solver"] = Family(t, solver)
    return families


def _turning(trajectory: Mapping[str, Floats]) -> dict[str, Floats]:
    values: dict[str, Floats] = {}
    for letter, stem in (("c", "coriolis_seat"), ("a", "seat_angular_acceleration")):
        for when in WHEN:
            parts = [trajectory[f"{stem}_{axis}_{when}_rad_s2"] for axis in "xyz"]
            values |= {
                f"{letter}_{axis}_{when}": part for axis, part in zip("xyz", parts, strict=True)
            }
            values[f"{letter}_n_{when}"] = np.linalg.norm(parts, axis=0)
    return values


def _rates(trajectory: Mapping[str, Floats]) -> dict[str, Floats]:
    return {
        f"{name}_{when}": np.degrees(trajectory[f"seat_{name}_{when}_rad_s"])
        for name in "pqr"
        for when in WHEN
    }


def _forces(trajectory: Mapping[str, Floats]) -> dict[str, Floats]:
    values: dict[str, Floats] = {}
    for when in WHEN:
        parts = [trajectory[f"seat_g{axis}_{when}_g"] for axis in "xyz"]
        values |= {f"g{axis}_{when}": part for axis, part in zip("xyz", parts, strict=True)}
        values[f"gn_{when}"] = np.linalg.norm(parts, axis=0)
    return values


def _onset(t: Floats, forces: Mapping[str, Floats]) -> Family:
    values, begin = {}, t
    for when in WHEN:
        samples = np.stack([forces[f"g{axis}_{when}"] for axis in "xyz"], axis=1)
        begin, each = onsets(t, np.stack([samples[:-1], samples[1:]], axis=1))
        values[f"onset_{when}"] = np.max(each, axis=0)
    return Family(begin, values)
