"""Commands recorded in a CSV file, made into the commands of the model."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from des_cli.errors import Problem, ProfileError
from des_cli.model.arrays import Floats
from des_cli.model.profile import BodyRates, JointCommands
from des_cli.profiles_in.column_kinds import QUATERNION, RATES, Column
from des_cli.profiles_in.columns import choose_columns
from des_cli.profiles_in.csv_header import Header, comment_lines, split_header
from des_cli.profiles_in.csv_table import Rows, read_columns
from des_cli.profiles_in.positions import middles_of_samples, rates_of_positions
from des_cli.profiles_in.sample_times import SampleTimes, sample_times
from des_cli.profiles_in.sampling import MAX_MAGNITUDE
from des_cli.profiles_in.wording import plain

_UNIT_NORM = 0.01
"""How far a recorded attitude's norm may be from 1, as printing rounds it."""


def parse_samples(
    text: str,
    label: str,
    columns: Mapping[str, str],
    *,
    separator: str | None = None,
    decimal: str | None = None,
    remarks: list[str] | None = None,
) -> tuple[Floats, JointCommands | BodyRates]:
    """Read joint commands or body rates from the text of a CSV file.

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
    remarks : list of str, optional
        Takes sentences on what was done to read the file.

    Returns
    -------
    t : (n,) array
        [s]
    commands : JointCommands or BodyRates

    Raises
    ------
    ProfileError
        With everything that is wrong.
    """
    header = split_header(text, label, separator, decimal, columns.values())
    told = [*header.remarks]
    problems: list[Problem] = []
    chosen = choose_columns(header, columns, problems, told)
    if problems:
        raise ProfileError(problems)
    attitude = [column.place for column in chosen if column.stem in QUATERNION]
    time = next(column for column in chosen if column.stem == "t")
    rows = read_columns(header, [column.place for column in chosen], attitude, time.place)
    values = rows.values
    by_stem = {
        column.stem: values[:, index] * (column.unit.to_si if column.unit else 1.0)
        for index, column in enumerate(chosen)
    }
    if rows.comments:
        told.append(f"{comment_lines(rows.comments)} skipped between the rows")
    times = sample_times(header, time, values[:, chosen.index(time)], rows, problems, told)
    if times is not None:
        by_stem["t"] = times.t
        _check_times(header, time, times, rows, problems)
    _check_magnitudes(header, chosen, by_stem, rows, problems)
    quaternions = _attitude(header, by_stem, rows, problems) if attitude else None
    if problems:
        raise ProfileError(problems)
    if remarks is not None:
        remarks += told
    t = by_stem["t"]
    if "arm" in by_stem:
        position = np.column_stack([by_stem["fork"], by_stem["cab"]])
        rate = rates_of_positions(t, position)
        return t, JointCommands(by_stem["arm"], position, rate[:-1], rate[1:])
    rates = np.column_stack([by_stem[stem] for stem in RATES])
    return t, BodyRates(rates[:-1], middles_of_samples(t, rates), rates[1:], quaternions)


def _check_times(
    header: Header, column: Column, times: SampleTimes, rows: Rows, problems: list[Problem]
) -> None:
    if len(times.t) < 2:
        what = "has one row; a motion needs two or more"
        problems.append(Problem(header.label, what))
        return
    late = np.flatnonzero(~(np.diff(times.t) > 0))
    name = plain(column.in_file)
    for index in late[:20].tolist():
        problems.append(
            Problem(
                f"{header.label}:{rows.lines[index + 1]}",
                f"{name}: {times.written(index + 1)} does not increase "
                f"(previous {times.written(index)})",
            )
        )
    if len(late) > 20:
        problems.append(Problem(header.label, f"… and {len(late) - 20} more times like these"))


def _check_magnitudes(
    header: Header,
    chosen: list[Column],
    by_stem: Mapping[str, Floats],
    rows: Rows,
    problems: list[Problem],
) -> None:
    """Say where a command is beyond any machine."""
    for column in chosen:
        if column.stem == "t" or column.unit is None:
            continue
        wrong = np.flatnonzero(np.abs(by_stem[column.stem]) > MAX_MAGNITUDE)
        if len(wrong):
            place = f"{header.label}:{rows.lines[int(wrong[0])]}"
            what = f"is beyond {MAX_MAGNITUDE:g} rad or rad/s ({len(wrong)} such cells)"
            problems.append(Problem(place, f"{plain(column.in_file)}: {what}"))


def _attitude(
    header: Header, by_stem: Mapping[str, Floats], rows: Rows, problems: list[Problem]
) -> Floats | None:
    """Return unit quaternions, (n, 4), NaN where none was recorded."""
    recorded = np.column_stack([by_stem[name] for name in QUATERNION])
    norm = np.sqrt(np.sum(recorded**2, axis=1))
    wrong = np.flatnonzero(np.abs(norm - 1.0) > _UNIT_NORM)
    if len(wrong):
        first = int(wrong[0])
        problems.append(
            Problem(
                f"{header.label}:{rows.lines[first]}",
                f"q0..q3: the attitude's norm is {norm[first]:.6g}, not 1 "
                f"({len(wrong)} such row{'s' * (len(wrong) > 1)})",
            )
        )
        return None
    unit: Floats = recorded / norm[:, None]
    unit[np.isnan(norm)] = np.nan
    return unit
