"""What is checked of a record's numbers before they are made into commands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from des_cli.errors import Complaint
from des_cli.model.arrays import Floats
from des_cli.model.profile import BodyRates
from des_cli.profiles_in.column_kinds import RATES, Column
from des_cli.profiles_in.csv_header import Header
from des_cli.profiles_in.csv_table import Rows
from des_cli.profiles_in.g_schema import MOST_G
from des_cli.profiles_in.sample_times import SampleTimes
from des_cli.profiles_in.sampling import LONGEST, MAX_MAGNITUDE, SHORTEST_STEP
from des_cli.profiles_in.wording import option, plain
from des_cli.units import STANDARD_GRAVITY_M_S2

FASTEST = 20.0
"""Rate [rad/s] above which no aircraft turns and no centrifuge: three turns a second. A
record that is beyond it on most of its rows is one in deg/s under another name."""

FOLLOWED = 1.0
"""Turn [rad] from row to row that rows may be added for without a bound."""

MOST_UNFOLLOWED = 300.0
"""Turning [rad] in all, on steps of more than that, which is the work of some seconds: fifty
turns that nobody recorded."""

_TOLD = 20
"""Times described before the rest is only counted."""


def check_times(
    header: Header, column: Column, times: SampleTimes, rows: Rows, complaints: list[Complaint]
) -> None:
    """Say where times do not increase, and where there are too few of them."""
    if len(times.t) < 2:
        what = "has one row; a motion needs two or more"
        complaints.append(Complaint(header.label, what))
        return
    with np.errstate(over="ignore", invalid="ignore"):
        step = np.diff(times.t)
    late = np.flatnonzero(~(step > 0))
    name = plain(column.in_file)
    for index in late[:_TOLD].tolist():
        cure = (
            "remove one of the two rows"
            if step[index] == 0.0
            else "put the rows in order, or cut the file in two where its clock was set back"
        )
        complaints.append(
            Complaint(
                f"{header.label}:{rows.lines[index + 1]}",
                f"{name}: {times.written(index + 1)} does not increase "
                f"(previous {times.written(index)}); {cure}",
            )
        )
    if len(late) > _TOLD:
        what = f"… and {len(late) - _TOLD} more times like these"
        complaints.append(Complaint(header.label, what))
    if not len(late):
        _check_lengths(header, name, times, rows, complaints)


def _check_lengths(
    header: Header, name: str, times: SampleTimes, rows: Rows, complaints: list[Complaint]
) -> None:
    """Say where times are so far apart, or so near, that their unit must be another."""
    lasts = float(times.t[-1]) - float(times.t[0])
    if lasts > LONGEST:
        what = f"the record lasts {lasts:.3g} s, longer than {LONGEST:g} s: correct its unit"
        complaints.append(Complaint(header.where, f"{name}: {what}"))
        return
    step = np.diff(times.t)
    if np.median(step) < SHORTEST_STEP:
        row = int(np.argmin(step))
        what = f"a step of {step[row]:.3g} s is shorter than {SHORTEST_STEP:g} s: correct its unit"
        complaints.append(Complaint(f"{header.label}:{rows.lines[row + 1]}", f"{name}: {what}"))


def unfollowed_turning(t: Floats, rates: BodyRates) -> str:
    """Say that a body turns too far between rows that are too far apart to follow it.

    Rows are added there, with each turn, until they hold the turning: without a bound a
    record of three rows could take hours.

    Parameters
    ----------
    t : (n,) array
        [s]
    rates : BodyRates

    Returns
    -------
    str
        Empty where the rows can be added.
    """
    fastest = np.max([np.linalg.norm(w, axis=1) for w in (rates.start, rates.middle, rates.end)], 0)
    turn = np.diff(t) * fastest
    coarse = turn > FOLLOWED
    if turn[coarse].sum() <= MOST_UNFOLLOWED:
        return ""
    return (
        f"the body turns by up to {turn.max():.3g} rad from one row to the next, and by "
        f"{turn[coarse].sum():.3g} rad in all where it turns by more than {FOLLOWED:g}: that is "
        f"no record of it; sample at least every {FOLLOWED / fastest.max():.2g} s, or correct units"
    )


def check_magnitudes(
    header: Header,
    chosen: Sequence[Column],
    by_stem: Mapping[str, Floats],
    rows: Rows,
    complaints: list[Complaint],
) -> None:
    """Say where a command is beyond any machine."""
    for column in chosen:
        if column.stem == "t" or column.unit is None:
            continue
        most, words = MAX_MAGNITUDE, f"{MAX_MAGNITUDE:g} rad or rad/s"
        if column.unit.quantity == "specific_force":
            most, words = MOST_G * STANDARD_GRAVITY_M_S2, f"{MOST_G:g} g"
        wrong = np.flatnonzero(np.abs(by_stem[column.stem]) > most)
        if len(wrong):
            place = f"{header.label}:{rows.lines[int(wrong[0])]}"
            what = f"is beyond {words} ({len(wrong)} such cells)"
            complaints.append(Complaint(place, f"{plain(column.in_file)}: {what}"))


def tell_doubtful_units(
    chosen: Sequence[Column], by_stem: Mapping[str, Floats], remarks: list[str]
) -> None:
    """Ask whether rates in rad/s that nothing reaches are in deg/s; they are read as they are.

    One line for all of them, of the fastest: who mends one header mends the others.
    """
    stems = [stem for stem in (*RATES, "arm") if stem in by_stem]
    rates = [c for c in chosen if c.stem in stems and c.unit and c.unit.suffix == "rad_s"]
    if not rates:
        return
    fastest = np.max([np.abs(by_stem[column.stem]) for column in rates], axis=0)
    if np.median(fastest) <= FASTEST:
        return
    peaks = [float(np.max(np.abs(by_stem[column.stem]))) for column in rates]
    column = rates[int(np.argmax(peaks))]
    name = plain(column.in_file)
    remarks.append(
        f"{name} reaches {max(peaks):.3g} rad/s; is it in deg/s? "
        f"{option('--column', f'{column.stem}_deg_s={column.in_file}')} reads it so"
    )
