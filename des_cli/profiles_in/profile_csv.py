"""Commands recorded in a CSV file, made into the commands of the model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from des_cli.errors import Problem, ProfileError
from des_cli.model.arrays import Floats
from des_cli.model.profile import BodyRates, GCommand, JointCommands
from des_cli.profiles_in.angles import unwrap
from des_cli.profiles_in.attitude import (
    ALIASES,
    EULER,
    QUATERNION,
    flown_attitude,
    rows_with_attitude,
    with_quaternions,
)
from des_cli.profiles_in.conditioning import Conditioning, in_seat_axes, resampled, rows_inside
from des_cli.profiles_in.csv_table import Header, read_columns, split_header
from des_cli.profiles_in.g_commands import sampled_g
from des_cli.profiles_in.g_schema import G_STEMS, RATE_STEMS
from des_cli.profiles_in.gaps import GapHandling, Place, find_short_steps, select_rows
from des_cli.profiles_in.interpolant import body_rates_of_samples
from des_cli.profiles_in.positions import joint_commands_of_samples
from des_cli.profiles_in.sampling import MAX_MAGNITUDE
from des_cli.profiles_in.wording import did_you_mean, one_of, plain
from des_cli.units import Unit, split_unit, suffixes

QUANTITIES: Mapping[str, str] = {
    "t": "time",
    "arm": "rate",
    "fork": "angle",
    "cab": "angle",
    "p": "rate",
    "q": "rate",
    "r": "rate",
    "gx": "specific_force",
    "gy": "specific_force",
    "gz": "specific_force",
    "roll": "angle",
    "pitch": "angle",
    "yaw": "angle",
}
"""What each column measures."""

ALSO: Mapping[str, str] = {"arm": "angle"}
"""What it may measure instead."""

_KINDS = {"rate": "a rate", "angle": "an angle", "time": "a time", "specific_force": "a G"}
_JOINTS = ("arm", "fork", "cab")
_RATES = ("p", "q", "r")
IGNORED = ("quality",)
"""Columns that recorders add and that say nothing about the motion."""


@dataclass(frozen=True, slots=True)
class _Column:
    """A column that is read.

    Parameters
    ----------
    stem : str
        Which quantity it gives.
    name : str
        Its name with the unit.
    in_file : str
        Its name in the file.
    unit : Unit, optional
    """

    stem: str
    name: str
    in_file: str
    unit: Unit | None = None


def parse_samples(
    text: str,
    label: str,
    columns: Mapping[str, str],
    conditioning: Conditioning | None = None,
    gaps: GapHandling | None = None,
    remarks: list[str] | None = None,
) -> tuple[Floats, JointCommands | BodyRates | GCommand]:
    """Read joint commands, body rates, an attitude or an asked G from the text of a CSV file.

    Parameters
    ----------
    text : str
    label : str
        What messages call the file.
    columns : mapping of str to str
        Name with its unit to the name in the file, for columns that the file
        names otherwise; with any of these, columns that mean nothing to the
        tool are ignored.
    conditioning : Conditioning, optional
        What is done to the rows.
    gaps : GapHandling, optional
        What is done where samples are missing.
    remarks : list of str, optional
        Takes what was changed of the record, a sentence each.

    Returns
    -------
    t : (n,) array
        [s]
    commands : JointCommands, BodyRates or GCommand
        Of an attitude without rates: the body rates that fly it.

    Raises
    ------
    ProfileError
        With everything that is wrong.
    """
    conditioning = conditioning or Conditioning()
    remarks = [] if remarks is None else remarks
    header = split_header(text, label)
    problems: list[Problem] = []

    def line(row: int) -> int:
        return header.lines + int(rows[row]) + 1

    chosen = _choose(header, columns, problems, euler=conditioning.euler is not None)
    if problems:
        raise ProfileError(problems)
    may_lack = [column.in_file for column in chosen if column.stem in (*QUATERNION, *EULER)]
    values = read_columns(header, [column.in_file for column in chosen], may_lack)
    by_stem = {
        column.stem: values[:, index] * (column.unit.to_si if column.unit else 1.0)
        for index, column in enumerate(chosen)
    }
    time = next(column for column in chosen if column.stem == "t")
    _check_times(header, time, values[:, chosen.index(time)], problems)
    _check_magnitudes(header, chosen, by_stem, problems)
    if problems:
        raise ProfileError(problems)
    rows = rows_inside(by_stem["t"], conditioning, label, remarks)
    by_stem = {stem: column[rows] for stem, column in by_stem.items()}
    by_stem = with_quaternions(by_stem, conditioning.euler, header, rows, problems)
    problems += find_short_steps(by_stem["t"], label, line)
    said: list[str] = []
    for column in chosen:
        if column.stem in _JOINTS and column.unit and column.unit.quantity == "angle":
            by_stem[column.stem] = _unwrapped(column, by_stem, label, line, said, problems)
    if problems:
        raise ProfileError(problems)
    by_stem = in_seat_axes(by_stem, conditioning, label)
    flies_attitude = not {"arm", "p", *G_STEMS} & set(by_stem)
    if flies_attitude:
        kept = rows_with_attitude(by_stem, label, remarks)
        by_stem = {stem: column[kept] for stem, column in by_stem.items()}
        rows = rows[kept]
    stretch = select_rows(by_stem["t"], label, line, gaps or GapHandling(), said)
    remarks += said
    by_stem = {stem: column[stretch] for stem, column in by_stem.items()}
    by_stem = resampled(by_stem, conditioning, label, remarks)
    if flies_attitude:
        return flown_attitude(by_stem, remarks)
    t = by_stem["t"]
    if any(stem in by_stem for stem in G_STEMS):
        return sampled_g(t, by_stem)
    if "arm" in by_stem:
        arm = next(column for column in chosen if column.stem == "arm")
        return t, joint_commands_of_samples(
            t,
            by_stem["arm"],
            np.column_stack([by_stem["fork"], by_stem["cab"]]),
            arm_by_angle=arm.unit is not None and arm.unit.quantity == "angle",
        )
    rates = np.column_stack([by_stem[stem] for stem in _RATES])
    recorded = np.column_stack([by_stem[q] for q in QUATERNION]) if "q0" in by_stem else None
    return t, body_rates_of_samples(t, rates, recorded)


def _choose(
    header: Header, columns: Mapping[str, str], problems: list[Problem], *, euler: bool
) -> list[_Column]:
    """Match the columns of the file with what a profile needs."""
    where = f"{header.label}:1"
    names = _renamed(header, columns, problems)
    found: list[_Column] = []
    for in_file, name in names.items():
        stem, unit = split_unit(name)
        if name in ALIASES:
            found.append(_Column(ALIASES[name], name, in_file))
        elif unit is not None and unit.quantity in (QUANTITIES.get(stem), ALSO.get(stem)):
            found.append(_Column(stem, name, in_file, unit))
        elif name not in IGNORED and (name in columns or not columns):
            problems.append(Problem(where, _unknown(name, stem)))
    by_user = {column.stem for column in found if column.name in columns}
    if by_user & {*QUATERNION, *EULER} and not by_user & set(_RATES):
        # who names an attitude, and no rates, means the attitude
        found = [column for column in found if column.stem not in _RATES]
    _check_complete(found, names.values(), where, problems)
    kept = _kept({column.stem for column in found}, euler=euler)
    return [column for column in found if column.stem in kept]


def _kept(stems: set[str], *, euler: bool) -> set[str]:
    """Return which of the quantities that a file has are read."""
    if "arm" in stems:
        return {"t", *_JOINTS}
    if stems & set(G_STEMS):
        return {"t", *G_STEMS, *RATE_STEMS}
    kept = {"t", *(stems & set(_RATES))}
    if stems >= set(QUATERNION):
        return kept | set(QUATERNION)
    # Beside rates an attitude is only compared with: there, without an order, it is left out.
    if stems >= set(EULER) and (euler or len(kept) == 1):
        return kept | set(EULER)
    return kept


def _renamed(header: Header, columns: Mapping[str, str], problems: list[Problem]) -> dict[str, str]:
    """Return the name that each column of the file has after renaming."""
    names = {name: name for name in header.names}
    for name, in_file in columns.items():
        where = f"{header.label}: column {plain(name)}={plain(in_file)}"
        if in_file not in names:
            hint = did_you_mean(in_file, header.names) or f"; there are {_some(header.names)}"
            problems.append(Problem(where, f"the file has no column {plain(in_file)}{hint}"))
        elif list(columns.values()).count(in_file) > 1:
            problems.append(Problem(where, f"the column {plain(in_file)} is named twice"))
        elif name != in_file and name in header.names and name not in columns.values():
            problems.append(Problem(where, f"the file has a column {plain(name)} already"))
        else:
            names[in_file] = name
    return names


def _unknown(name: str, stem: str) -> str:
    quantity = QUANTITIES.get(name) or QUANTITIES.get(stem)
    if quantity:
        base = name if name in QUANTITIES else stem
        units = one_of([f"{base}_{suffix}" for suffix in suffixes(quantity)])
        kind = _KINDS[quantity]
        return (
            f"the column {plain(name)}: {base} is {kind} and needs its unit in the name: {units} "
            f"(rename with --column {base}_{suffixes(quantity)[0]}={plain(name)})"
        )
    known = [f"{s}_{suffix}" for s, kind in QUANTITIES.items() for suffix in suffixes(kind)]
    hint = did_you_mean(name, [*known, *QUATERNION])
    return f"the column {plain(name)} is not known{hint}; name the columns to read with --column"


def _check_complete(
    found: list[_Column], names: object, where: str, problems: list[Problem]
) -> None:
    stems = [column.stem for column in found]
    for stem in (*QUANTITIES, *QUATERNION):
        if stems.count(stem) > 1:
            same = [column.name for column in found if column.stem == stem]
            problems.append(Problem(where, f"{stem} is given twice: {' and '.join(same)}"))
    joints, rates, asked = (
        [stem for stem in kind if stem in stems] for kind in (_JOINTS, _RATES, G_STEMS)
    )
    if asked:
        _check_beside_g(joints, rates, asked, stems, where, problems)
        return
    if joints and rates:
        what = f"holds both joint commands ({', '.join(joints)}) and body rates"
        problems.append(Problem(where, f"{what} ({', '.join(rates)}); choose with --column"))
        return
    if problems:
        return  # a column that is not understood may be the one that seems to be missing
    kinds = (_RATES if rates else (), _JOINTS if joints else (), QUATERNION, EULER)
    kind = next((kind for kind in kinds if set(kind) & set(stems)), None)
    if kind is None:
        what = "has neither joint commands (t_s,arm_rpm,fork_deg,cab_deg) nor body rates"
        what += " (t_s,p_rad_s,q_rad_s,r_rad_s) nor an attitude (t_s,q0,q1,q2,q3)"
        problems.append(Problem(where, f"{what} nor G (t_s,gz_g)"))
        return
    for stem in ("t", *kind):
        if stem not in stems:
            units = suffixes(QUANTITIES[stem]) if stem in QUANTITIES else ()
            names = one_of([f"{stem}_{suffix}" for suffix in units]) or stem
            problems.append(Problem(where, f"a column is missing: {names}"))


def _check_beside_g(
    joints: list[str],
    rates: list[str],
    asked: list[str],
    stems: list[str],
    where: str,
    problems: list[Problem],
) -> None:
    """Say what cannot stand beside an asked G, and whether its times are missing."""
    choose = "choose with --column"
    if joints:
        what = f"holds both joint commands ({', '.join(joints)}) and G ({', '.join(asked)})"
        problems.append(Problem(where, f"{what}; {choose}"))
    elif "r" in rates:
        what = f"holds all body rates beside G ({', '.join(asked)}); {choose}: p and q can be"
        problems.append(Problem(where, f"{what} followed beside it, and no joint is left for r"))
    elif "t" not in stems and not problems:
        units = one_of([f"t_{suffix}" for suffix in suffixes("time")])
        problems.append(Problem(where, f"a column is missing: {units}"))


def _check_times(header: Header, column: _Column, times: Floats, problems: list[Problem]) -> None:
    if len(times) < 2:
        what = "has one row; a motion needs two or more"
        problems.append(Problem(header.label, what))
        return
    in_si = times * column.unit.to_si if column.unit else times
    late = np.flatnonzero(~(np.diff(in_si) > 0))
    name = plain(column.in_file)
    for index in late[:20].tolist():
        problems.append(
            Problem(
                f"{header.label}:{header.lines + index + 2}",
                f"{name}: {times[index + 1]:.12g} does not increase (previous {times[index]:.12g})",
            )
        )
    if len(late) > 20:
        problems.append(Problem(header.label, f"… and {len(late) - 20} more times like these"))


def _unwrapped(
    column: _Column,
    by_stem: Mapping[str, Floats],
    label: str,
    line: Place,
    remarks: list[str],
    problems: list[Problem],
) -> Floats:
    """Return a joint's angle without jumps by full turns, saying what was done."""
    assert column.unit is not None, "an angle has a unit"
    angle, unit = by_stem[column.stem], column.unit
    found = unwrap(angle)
    name = plain(column.in_file)

    def jump(row: int) -> str:
        before, after = angle[row] / unit.to_si, angle[row + 1] / unit.to_si
        return f"from {before:.6g} to {after:.6g} {unit.suffix}"

    if found.unclear:
        row = found.unclear[0]
        what = (
            f"{name}: jumps {jump(row)} within a row ({len(found.unclear)} such jumps), which no "
            "joint follows and which is no full turn: give the angle without jumps, or more rows"
        )
        problems.append(Problem(f"{label}:{line(row + 1)}", what))
    elif found.jumps:
        row = found.jumps[0]
        others = f" and {len(found.jumps) - 1} more" if len(found.jumps) > 1 else ""
        remarks.append(
            f"line {line(row + 1)}: {name} jumps {jump(row)}{others}; "
            "the angle wraps there, and full turns were added so that it goes on"
        )
    return found.angle


def _check_magnitudes(
    header: Header,
    chosen: list[_Column],
    by_stem: Mapping[str, Floats],
    problems: list[Problem],
) -> None:
    """Say where a command is beyond any machine."""
    for column in chosen:
        if column.stem == "t" or column.unit is None:
            continue
        wrong = np.flatnonzero(np.abs(by_stem[column.stem]) > MAX_MAGNITUDE)
        if len(wrong):
            place = f"{header.label}:{header.lines + int(wrong[0]) + 1}"
            what = f"is beyond {MAX_MAGNITUDE:g} rad or rad/s ({len(wrong)} such cells)"
            problems.append(Problem(place, f"{plain(column.in_file)}: {what}"))


def _some(names: list[str], most: int = 12) -> str:
    words = ", ".join(plain(name) for name in names[:most])
    return f"{words}, …" if len(names) > most else words
