"""Conditioning of a record: trimmed, turned to other body axes, put on a uniform grid.

Smoothing is no step of reading: the record stays the reference that fidelity is
measured against. Its cutoff is only checked.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from des_cli.errors import Complaint, ProfileError
from des_cli.kinematics.attitude import quaternion_product
from des_cli.kinematics.smoothing import why_not_smooth
from des_cli.model.arrays import Floats, Indices
from des_cli.model.profile import WASHOUT, GCommand
from des_cli.profiles_in.attitude import interpolate_attitude
from des_cli.profiles_in.caps import DEFAULT_CAPS
from des_cli.profiles_in.column_kinds import QUATERNION, RATES
from des_cli.profiles_in.conditioning_schema import EulerOrder
from des_cli.profiles_in.findings import Findings
from des_cli.profiles_in.g_schema import G_STEMS

OF_SAMPLES = ("gap", "trim", "axes", "resample")
"""Keys that only recorded samples have a use for."""

_ROUNDING = 1e-9
"""Part of a step that a last sample may lie beyond the record's end."""


@dataclass(frozen=True)
class Conditioning:
    """What is done to recorded samples; the defaults leave them alone.

    Parameters
    ----------
    start, stop : float
        Rows between these times are kept, both included [s].
    turn : (3, 3) array
        Takes a vector along the recorder's x, y, z to one along the seat's.
    step : float
        Of the uniform grid [s]; 0 for the recorded times.
    cutoff_hz : float
        Of the smoothing before the reduction [Hz].
    euler : str, optional
        Order of recorded roll, pitch and yaw.
    washout : float
        Of the rates beside a recorded G [s].
    """

    start: float = -math.inf
    stop: float = math.inf
    turn: Floats = field(default_factory=lambda: np.eye(3))
    step: float = 0.0
    cutoff_hz: float = math.inf
    euler: EulerOrder | None = None
    washout: float = WASHOUT


def read_conditioning(document: Any, findings: Findings) -> Conditioning:
    """Return the conditioning that a profile asks for, after saying what is wrong with it."""
    values: dict[str, Any] = {}
    if (trim := document.trim) is not None:
        start, stop = trim.si("from", -math.inf), trim.si("to", math.inf)
        if not trim.model_fields_set:
            findings.add(["trim"], "keeps everything: give from_s, to_s or both")
        elif stop > start:
            values |= {"start": start, "stop": stop}
        else:
            key = str(trim.given_key("to"))
            findings.add(["trim", key], f"must be greater than {trim.written('from')}")
    if document.axes is not None:
        values["turn"] = _turn(document.axes, findings)
    if document.resample is not None:
        values["step"] = document.resample.si("step")
    if document.smooth is not None:
        values["cutoff_hz"] = document.smooth.cutoff_hz
    if document.samples is not None:
        values["euler"] = document.samples.euler
        values["washout"] = document.samples.si("washout", WASHOUT)
    return Conditioning(**values)


def _turn(axes: Any, findings: Findings) -> Floats:
    """Return the signed permutation that a profile's axes describe, (3, 3)."""
    turn = np.zeros((3, 3))
    for row, name in enumerate(RATES):
        said = getattr(axes, name)
        turn[row, "xyz".index(said[-1])] = -1.0 if said.startswith("-") else 1.0
    if np.any(np.sum(np.abs(turn), axis=0) != 1.0):
        findings.add(["axes"], "must name each of x, y and z once")
    elif round(float(np.linalg.det(turn))) != 1:
        words = (
            "is a reflection, which no turn of the body makes; change one sign, or swap two axes"
        )
        findings.add(["axes"], words)
    return turn


def check_smoothing(conditioning: Conditioning, t: Floats, findings: Findings) -> None:
    """Say where a record cannot be smoothed as asked."""
    if math.isinf(conditioning.cutoff_hz):
        return
    if trouble := why_not_smooth(t, conditioning.cutoff_hz):
        findings.add(["smooth", "cutoff_hz"], trouble)


def check_washout(section: Any, command: Any, findings: Findings) -> None:
    """Say that a washout time below ``samples:`` has no rates that it could wash out."""
    key = section.given_key("washout") if section is not None else None
    if key is None or (isinstance(command, GCommand) and command.rates is not None):
        return
    what = "washes out nothing: the samples are no G with p or q beside it; leave this out"
    findings.add(["samples", key], what, of_key=True)


def refuse_beside_expressions(present: Mapping[str, Any], name: str, findings: Findings) -> None:
    """Say that what conditions samples means nothing beside commands that are expressions."""
    for key in OF_SAMPLES:
        if key in present:
            words = f"is for samples; the commands below {name} say by themselves what is flown"
            findings.add([key], words, of_key=True)


def rows_inside(t: Floats, conditioning: Conditioning, label: str, remarks: list[str]) -> Indices:
    """Return which rows of a record are kept by the trim.

    Parameters
    ----------
    t : (n,) array
        Times [s].
    conditioning : Conditioning
    label : str
        What messages call the file.
    remarks : list of str
        Takes what the user should know.

    Raises
    ------
    ProfileError
        If fewer than two rows are left.
    """
    rows = np.flatnonzero((t >= conditioning.start) & (t <= conditioning.stop))
    if len(rows) == len(t):
        return rows
    if len(rows) < 2:
        reach = f"the record reaches from {t[0]:.6g} to {t[-1]:.6g} s"
        what = f"leaves {len(rows)} of {len(t)} rows, two are needed; {reach}"
        raise _refused(label, "trim", what)
    first, last = t[rows[0]], t[rows[-1]]
    remarks.append(f"trim: {len(rows)} of {len(t)} rows kept, {first:.6g} to {last:.6g} s")
    return rows


def in_seat_axes(
    record: Mapping[str, Floats], conditioning: Conditioning, label: str
) -> dict[str, Floats]:
    """Return a record whose rates and attitude are those of the seat's axes.

    The rates are ``A w``; the attitude, which takes the body's axes to the
    inertial ones, is ``R A^T``.

    Parameters
    ----------
    record : mapping of str to (n,) array
        Columns by their stem.
    conditioning : Conditioning
    label : str
        What messages call the file.

    Raises
    ------
    ProfileError
        If the record has joint commands.
    """
    turned = dict(record)
    if np.array_equal(conditioning.turn, np.eye(3)):
        return turned
    if set(G_STEMS) & set(record):
        raise _refused(label, "axes", "is for body rates or an attitude; this is an asked G")
    if "p" not in record and QUATERNION[0] not in record:
        raise _refused(label, "axes", "is for body rates or an attitude; these are joint commands")
    if "p" in record:
        rates = _columns(record, RATES) @ conditioning.turn.T
        turned |= {stem: rates[:, axis] for axis, stem in enumerate(RATES)}
    if QUATERNION[0] in record:
        from scipy.spatial.transform import Rotation

        back = Rotation.from_matrix(conditioning.turn.T).as_quat()[[3, 0, 1, 2]]
        attitude = quaternion_product(_columns(record, QUATERNION), back)
        turned |= {stem: attitude[:, axis] for axis, stem in enumerate(QUATERNION)}
    return turned


def resampled(
    record: Mapping[str, Floats],
    conditioning: Conditioning,
    label: str,
    remarks: list[str],
    most_rows: int = DEFAULT_CAPS.rows,
) -> dict[str, Floats]:
    """Return a record on a uniform grid from its first time on.

    Rates and positions by the shape-preserving cubic (PCHIP), an attitude by
    the rotation spline, an asked G and what stands beside it by the straight lines
    that its rows mean. The grid ends with the last step inside the record.

    Parameters
    ----------
    record : mapping of str to (n,) array
        Columns by their stem, among them ``t`` [s].
    conditioning, label, remarks
        As of `rows_inside`.
    most_rows : int

    Raises
    ------
    ProfileError
        If the grid has fewer than two samples, or too many.
    """
    if not conditioning.step:
        return dict(record)
    t = record["t"]
    grid = _uniform(t, conditioning.step, label, most_rows)
    others = [stem for stem in record if stem not in ("t", *QUATERNION)]
    found = {"t": grid}
    if set(G_STEMS) & set(record):
        found |= {stem: np.interp(grid, t, record[stem]) for stem in others}
    elif others:
        from scipy.interpolate import PchipInterpolator

        # Times from the first one: late starts must not cost digits.
        values = PchipInterpolator(t - t[0], _columns(record, others))(grid - t[0])
        found |= {stem: values[:, k] for k, stem in enumerate(others)}
    if QUATERNION[0] in record:
        attitude = interpolate_attitude(t, _columns(record, QUATERNION), grid)
        found |= {stem: attitude[:, k] for k, stem in enumerate(QUATERNION)}
    remarks.append(_resampling_remark(t, grid, conditioning.step))
    return found


def _uniform(t: Floats, step: float, label: str, most: int) -> Floats:
    steps = (float(t[-1]) - float(t[0])) / step + _ROUNDING
    if not 1.0 <= steps < most:
        lasts = f"the record lasts {t[-1] - t[0]:.6g} s"
        what = "fewer than 2" if steps < 1.0 else f"more than {most}"
        raise _refused(label, "resample.step_s", f"makes {what} samples: {lasts}")
    return np.minimum(t[0] + step * np.arange(int(steps) + 1), t[-1])


def _resampling_remark(t: Floats, grid: Floats, step: float) -> str:
    remark = f"resample: {len(t)} rows made {len(grid)}, one every {step:.6g} s"
    if t[-1] - grid[-1] > _ROUNDING * step:
        remark += f", to {grid[-1]:.6g} of {t[-1]:.6g} s"
    usual = float(np.median(np.diff(t)))
    if step > usual * (1.0 + _ROUNDING):
        remark += (
            f"; the record's usual step is {usual:.4g} s: what is faster than {0.5 / step:.3g} Hz "
            "is lost and leaves errors in what is slower; smooth (--smooth HZ) without a longer "
            "step keeps the record"
        )
    return remark


def _columns(record: Mapping[str, Floats], stems: Sequence[str]) -> Floats:
    return np.column_stack([record[stem] for stem in stems])


def _refused(label: str, key: str, what: str) -> ProfileError:
    return ProfileError([Complaint(f"{label}: {key}", what)])
