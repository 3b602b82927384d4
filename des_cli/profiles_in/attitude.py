"""A recorded attitude: quaternions or Euler angles, made into unit quaternions.

Attitudes are body to inertial: they take a vector along the body's axes to one
along the inertial ones.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from des_cli.errors import Complaint, ProfileError
from des_cli.kinematics.attitude_rates import LARGEST_TURN, rates_of_attitude, turns_between
from des_cli.model.arrays import Floats, Indices
from des_cli.model.profile import BodyRates
from des_cli.profiles_in.column_kinds import EULER, QUATERNION
from des_cli.profiles_in.conditioning_schema import EULER_ORDERS, EulerOrder
from des_cli.profiles_in.csv_header import Header
from des_cli.profiles_in.gaps import Place
from des_cli.profiles_in.wording import one_of

_UNIT_NORM = 0.01
"""How far a recorded attitude's norm may be from 1, as printing rounds it."""


def with_quaternions(
    record: Mapping[str, Floats],
    euler: EulerOrder | None,
    header: Header,
    line: Place,
    complaints: list[Complaint],
) -> dict[str, Floats]:
    """Return a record whose attitude, if it has one, is unit quaternions.

    Parameters
    ----------
    record : mapping of str to (n,) array
        Columns by their stem; `EULER` [rad] or `QUATERNION`, not a number where
        none was recorded.
    euler : str, optional
        The order of `EULER`.
    header : Header
        Of the file, for places.
    line : callable
        From a row of the record to its line.
    complaints : list of Complaint
        Takes what is wrong.
    """
    rest = {stem: column for stem, column in record.items() if stem not in EULER}
    if EULER[0] in record:
        if euler is None:
            complaints.append(Complaint(header.where, _without_order()))
            return rest
        attitude = _of_euler(np.column_stack([record[stem] for stem in EULER]), euler)
    elif QUATERNION[0] in record:
        recorded = np.column_stack([record[name] for name in QUATERNION])
        attitude = _normalised(recorded, header.label, line, complaints)
    else:
        return rest
    return rest | {stem: attitude[:, k] for k, stem in enumerate(QUATERNION)}


def _without_order() -> str:
    return (
        "roll, pitch and yaw are an attitude only in an order: give --euler zyx (yaw, then pitch, "
        "then roll, as in aviation; each about the axis already turned), or "
        f"{one_of([order for order in EULER_ORDERS if order != 'zyx'])}; "
        "in a YAML profile samples: {euler: zyx}"
    )


def _of_euler(angles: Floats, order: EulerOrder) -> Floats:
    """Return the quaternions of roll, pitch and yaw, (n, 4), NaN where an angle is."""
    from scipy.spatial.transform import Rotation

    known = np.all(np.isfinite(angles), axis=1)
    in_order = angles[known][:, ["xyz".index(axis) for axis in order]]
    found = np.full((len(angles), 4), np.nan)
    # Capitals are scipy's word for axes that turn with the body.
    found[known] = Rotation.from_euler(order.upper(), in_order).as_quat()[:, [3, 0, 1, 2]]
    return found


def _normalised(recorded: Floats, label: str, line: Place, complaints: list[Complaint]) -> Floats:
    norm = np.sqrt(np.sum(recorded**2, axis=1))
    wrong = np.flatnonzero(np.abs(norm - 1.0) > _UNIT_NORM)
    if len(wrong):
        first = int(wrong[0])
        complaints.append(
            Complaint(
                f"{label}:{line(first)}",
                f"q0..q3: the attitude's norm is {norm[first]:.6g}, not 1 "
                f"({len(wrong)} such row{'s' * (len(wrong) > 1)})",
            )
        )
        return np.full_like(recorded, np.nan)
    return np.asarray(recorded / norm[:, None])


def rows_with_attitude(record: Mapping[str, Floats], label: str, remarks: list[str]) -> Indices:
    """Return which rows have an attitude, where that is what is flown.

    Parameters
    ----------
    record : mapping of str to (n,) array
    label : str
        What messages call the file.
    remarks : list of str
        Takes how many rows were left out.

    Raises
    ------
    ProfileError
        If fewer than two rows are left, or one is turned too far from the one before it.
    """
    attitude = np.column_stack([record[name] for name in QUATERNION])
    rows = np.flatnonzero(np.all(np.isfinite(attitude), axis=1))
    if len(rows) < 2:
        what = f"has an attitude in {len(rows)} of {len(attitude)} rows, two are needed"
        raise ProfileError([Complaint(label, what)])
    if lacking := len(attitude) - len(rows):
        remarks.append(f"{lacking} of {len(attitude)} rows have no attitude and were left out")
    t, turn = record["t"][rows], turns_between(attitude[rows])
    if wide := np.flatnonzero(turn > LARGEST_TURN).tolist():
        k = wide[0]
        what = (
            f"the attitude turns by {math.degrees(turn[k]):.0f}° from t = {t[k]:.6g} to "
            f"{t[k + 1]:.6g} s ({len(wide)} such step{'s' * (len(wide) > 1)}): beyond "
            f"{math.degrees(LARGEST_TURN):.0f}° a record does not tell which way; record more often"
        )
        raise ProfileError([Complaint(label, what)])
    return rows


def flown_attitude(record: Mapping[str, Floats], remarks: list[str]) -> tuple[Floats, BodyRates]:
    """Return the times and body rates that fly a record's attitude.

    Parameters
    ----------
    record : mapping of str to (n,) array
        With an attitude in every row.
    remarks : list of str
        Takes how many rows had to be inserted.
    """
    recorded = record["t"]
    t, rates = rates_of_attitude(recorded, np.column_stack([record[name] for name in QUATERNION]))
    if inserted := len(t) - len(recorded):
        remarks.append(
            f"{inserted} rows were inserted between the {len(recorded)} recorded, "
            "so that the body rates turn the seat through every recorded attitude"
        )
    return t, rates


def interpolate_attitude(t: Floats, attitude: Floats, at: Floats) -> Floats:
    """Interpolate unit quaternions by the rotation spline.

    Parameters
    ----------
    t : (n,) array
        Increasing times [s].
    attitude : (n, 4) array
        Not a number where none was recorded.
    at : (m,) array
        Times [s].

    Returns
    -------
    (m, 4) array
        Not a number before the first recorded attitude and after the last one.
    """
    from scipy.spatial.transform import Rotation, RotationSpline

    known = np.all(np.isfinite(attitude), axis=1)
    found = np.full((len(at), 4), np.nan)
    if np.count_nonzero(known) >= 2:
        since = t[known]
        spline = RotationSpline(since - t[0], Rotation.from_quat(attitude[known][:, [1, 2, 3, 0]]))
        inside = (at >= since[0]) & (at <= since[-1])
        found[inside] = spline(at[inside] - t[0]).as_quat()[:, [3, 0, 1, 2]]
    return found
