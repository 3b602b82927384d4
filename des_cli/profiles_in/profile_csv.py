"""Commands recorded in a CSV file, made into the commands of the model."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from des_cli.errors import Complaint, ProfileError
from des_cli.model.arrays import Floats
from des_cli.model.machine import Machine
from des_cli.model.profile import BodyRates, GCommand, JointCommands
from des_cli.profiles_in.angles import sudden_steps, unwrap
from des_cli.profiles_in.attitude import flown_attitude, rows_with_attitude, with_quaternions
from des_cli.profiles_in.caps import DEFAULT_CAPS
from des_cli.profiles_in.column_kinds import EULER, JOINTS, QUATERNION, RATES, Column
from des_cli.profiles_in.columns import choose_columns
from des_cli.profiles_in.conditioning import Conditioning, in_seat_axes, resampled, rows_inside
from des_cli.profiles_in.csv_header import Header, comment_lines, split_header
from des_cli.profiles_in.csv_table import Rows, read_columns, require_few_rows
from des_cli.profiles_in.g_commands import STEP, sampled_g
from des_cli.profiles_in.g_schema import G_STEMS
from des_cli.profiles_in.gaps import GapHandling, Place, find_short_steps, select_rows
from des_cli.profiles_in.interpolant import body_rates_of_samples
from des_cli.profiles_in.rates_of_positions import STEP_ACCELERATION, joint_commands_of_samples
from des_cli.profiles_in.record_checks import check_magnitudes, check_times, tell_doubtful_units
from des_cli.profiles_in.sample_times import sample_times
from des_cli.profiles_in.wording import plain

_LINES_ABOVE = 1000
"""Lines that may stand above the rows, before these are counted exactly."""

_TOLD = 20
"""Jumps described."""


def parse_samples(
    text: str,
    label: str,
    columns: Mapping[str, str],
    *,
    separator: str | None = None,
    decimal: str | None = None,
    conditioning: Conditioning | None = None,
    gaps: GapHandling | None = None,
    remarks: list[str] | None = None,
    most_rows: int = DEFAULT_CAPS.rows,
    machine: Machine | None = None,
) -> tuple[Floats, JointCommands | BodyRates | GCommand]:
    """Read joint commands, body rates, an attitude or an asked G from the text of a CSV file.

    Parameters
    ----------
    text : str
    label : str
        What messages call the file.
    columns : mapping of str to str
        Our name to the name in the file, for columns that the file names
        otherwise.
    separator, decimal : str, optional
        How the file is written; a comma and a point.
    conditioning : Conditioning, optional
        What is done to the rows.
    gaps : GapHandling, optional
        What is done where samples are missing.
    remarks : list of str, optional
        Takes sentences on what was done to read the file, and on what was
        changed of the record.
    most_rows : int
        Of the file, and of what it is resampled to.
    machine : Machine, optional
        Whose joints' accelerations tell a step of a rate from a fast change.

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
    require_few_rows(max(text.count("\n"), text.count("\r")) - _LINES_ABOVE, label, most_rows)
    conditioning = conditioning or Conditioning()
    remarks = [] if remarks is None else remarks
    header = split_header(text, label, separator, decimal, columns.values())
    said = [*header.remarks]
    complaints: list[Complaint] = []
    euler = conditioning.euler is not None
    chosen = choose_columns(header, columns, complaints, said, euler=euler)
    if complaints:
        raise ProfileError(complaints)
    table, by_stem = _read(header, chosen, most_rows, complaints, said)
    if complaints:
        raise ProfileError(complaints)
    remarks += said
    rows = rows_inside(by_stem["t"], conditioning, label, remarks)

    def line(row: int) -> int:
        return table.lines[int(rows[row])]

    by_stem = {stem: column[rows] for stem, column in by_stem.items()}
    by_stem = with_quaternions(by_stem, conditioning.euler, header, line, complaints)
    by_lines = any(stem in by_stem for stem in G_STEMS)
    drawn_every = STEP if by_lines else np.inf
    complaints += find_short_steps(by_stem["t"], label, line, drawn_every=drawn_every)
    said = []
    for column in chosen:
        if column.stem in JOINTS and column.unit and column.unit.quantity == "angle":
            by_stem[column.stem] = _unwrapped(column, by_stem, label, line, said, complaints)
    if complaints:
        raise ProfileError(complaints)
    by_stem = in_seat_axes(by_stem, conditioning, label)
    flies_attitude = not {"arm", "p", *G_STEMS} & set(by_stem)
    if flies_attitude:
        kept = rows_with_attitude(by_stem, label, remarks)
        by_stem = {stem: column[kept] for stem, column in by_stem.items()}
        rows = rows[kept]
    gaps = gaps or GapHandling()
    stretch = select_rows(by_stem["t"], label, line, gaps, said, straight=by_lines)
    remarks += said
    by_stem = {stem: column[stretch] for stem, column in by_stem.items()}
    by_stem = resampled(by_stem, conditioning, label, remarks, most_rows)
    if flies_attitude:
        return flown_attitude(by_stem, remarks)
    t = by_stem["t"]
    if by_lines:
        return sampled_g(t, by_stem, conditioning.washout)
    if "arm" in by_stem:
        arm = next(column for column in chosen if column.stem == "arm")
        return t, joint_commands_of_samples(
            t,
            by_stem["arm"],
            np.column_stack([by_stem["fork"], by_stem["cab"]]),
            arm_by_angle=arm.unit is not None and arm.unit.quantity == "angle",
            fastest=_fastest(machine),
        )
    rates = np.column_stack([by_stem[stem] for stem in RATES])
    recorded = np.column_stack([by_stem[q] for q in QUATERNION]) if "q0" in by_stem else None
    return t, body_rates_of_samples(t, rates, recorded)


def _fastest(machine: Machine | None) -> tuple[float, float]:
    """Return the accelerations beyond which the rates of fork and cab step [rad/s^2]."""
    if machine is None:
        return STEP_ACCELERATION, STEP_ACCELERATION
    _, fork, cab = (min(limit.acceleration, STEP_ACCELERATION) for limit in machine.limits)
    return fork, cab


def _read(
    header: Header,
    chosen: list[Column],
    most_rows: int,
    complaints: list[Complaint],
    remarks: list[str],
) -> tuple[Rows, dict[str, Floats]]:
    """Return the rows of the file, and the columns in SI by their stems."""
    time = next(column for column in chosen if column.stem == "t")
    may_lack = [column.place for column in chosen if column.stem in (*QUATERNION, *EULER)]
    places = [column.place for column in chosen]
    rows = read_columns(header, places, may_lack, time.place, most_rows=most_rows)
    with np.errstate(over="ignore"):  # what is infinite is beyond any machine
        by_stem = {
            column.stem: rows.values[:, index] * (column.unit.to_si if column.unit else 1.0)
            for index, column in enumerate(chosen)
        }
    if rows.comments:
        remarks.append(f"{comment_lines(rows.comments)} skipped between the rows")
    recorded = rows.values[:, chosen.index(time)]
    times = sample_times(header, time, recorded, rows, complaints, remarks)
    if times is not None:
        by_stem["t"] = times.t
        check_times(header, time, times, rows, complaints)
    check_magnitudes(header, chosen, by_stem, rows, complaints)
    tell_doubtful_units(chosen, by_stem, remarks)
    return rows, by_stem


def _unwrapped(
    column: Column,
    by_stem: Mapping[str, Floats],
    label: str,
    line: Place,
    remarks: list[str],
    complaints: list[Complaint],
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
        complaints.append(Complaint(f"{label}:{line(row + 1)}", what))
    elif found.jumps:
        row = found.jumps[0]
        others = f" and {len(found.jumps) - 1} more" if len(found.jumps) > 1 else ""
        remarks.append(
            f"line {line(row + 1)}: {name} jumps {jump(row)}{others}; "
            "the angle wraps there, and full turns were added so that it goes on"
        )
    for row in [] if found.unclear else sudden_steps(by_stem["t"], found.angle)[:_TOLD]:
        time = f"t = {by_stem['t'][row + 1]:.12g} s"
        remarks.append(
            f"line {line(row + 1)}: {name} jumps {jump(row)} at {time}, which no joint follows: "
            "mend the record, or --trim it to one side"
        )
    return found.angle
