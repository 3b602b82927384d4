"""Runs and command tables that were stored, measured again before a machine loads them.

What the release gate found when the table was written is not trusted: the files are compared
with the manifest, the table is read as strictly as by the gate, and its limits, its ride and
its start are measured from its rows.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from des_cli.errors import BrokenRunError, Complaint, DesError, UnreadableError
from des_cli.model.arrays import Floats
from des_cli.model.command_table import CommandTable
from des_cli.model.machine import JOINTS, Machine, Seat
from des_cli.model.notice import Notice
from des_cli.model.run import Check
from des_cli.profiles_in.machine_yaml import parse_machine
from des_cli.results.reading import read_metrics
from des_cli.runs_out.manifest import MANIFEST, METRICS, is_sealed
from des_cli.runs_out.stored_run import StoredRun, read_run
from des_cli.runs_out.table_reading import parse_command_table
from des_cli.verify.harm import find_harms, find_start, start_offsets
from des_cli.verify.table import check_against, check_ride, check_rows, check_times

UNKNOWN_START: Floats = np.full(len(JOINTS), np.nan)
"""Of a machine of which nobody says where it stands."""


@dataclass(frozen=True)
class Verdict:
    """What was found of a stored table.

    Parameters
    ----------
    name : str
        Of the run; empty for a table alone.
    table : CommandTable
    machine : Machine
        Against which it was measured.
    seat : Seat
        How it is fixed in the cab.
    arm_start : float
        Where the arm is at the first row [rad].
    checks : tuple of Check
    notices : tuple of Notice
        What the table does that the profile of its run does not.
    """

    name: str
    table: CommandTable
    machine: Machine
    seat: Seat
    arm_start: float
    checks: tuple[Check, ...]
    notices: tuple[Notice, ...] = ()

    @property
    def failed(self) -> tuple[Check, ...]:
        """The checks that do not hold."""
        return tuple(check for check in self.checks if not check.ok)


def check_stored_run(
    folder: str,
    machine: Machine | None = None,
    start: Floats = UNKNOWN_START,
    *,
    limits: bool = True,
) -> Verdict:
    """Measure a run folder: its files, its table against its solution and against a machine.

    A run that was made with ``limits: warn`` is held to the limits all the same.

    Parameters
    ----------
    folder : str
    machine : Machine, optional
        Another than the run's own.
    start : (3,) array
        Where the machine stands: the arm's rate [rad/s], fork and cab [rad]; what is not a
        number is not known.

    Raises
    ------
    BrokenRunError
        If a file was changed, cut or removed since the run was written.
    UnreadableError
        If nothing is known to be wrong but that a file cannot be read.
    """
    run = _intact(folder)
    own, seat, arm = _setting(run)
    table = _parse(run.commands, folder)
    metrics = read_metrics(run.metrics)
    t = run.trajectory["t_s"]
    maneuver = table.between(t[0], t[-1])
    checks = [check_times(table), *check_rows(maneuver, _rows(run.trajectory, "modified"))]
    if not all(check.ok for check in checks):
        return Verdict(run.name, table, machine or own, seat, arm, tuple(checks))
    if limits:
        checks += check_against(machine or own, seat, table, arm)
        checks += check_ride(metrics.felt, maneuver, own, seat)
    checks += _starts(start, table)
    notices = []
    if machine is not None and machine.rows != own.rows:
        what = f"the run is of the machine {own.name}: on {machine.name} its G are others"
        notices.append(Notice("geometry", what))
    asked, desired = (_rows(run.trajectory, which) for which in ("asked", "desired"))
    notices += find_start(asked.values[0, 1:], maneuver, metrics.solver.optimise)
    notices += find_harms(maneuver, desired, own, seat, metrics.felt)
    return Verdict(run.name, table, machine or own, seat, arm, tuple(checks), tuple(notices))


def check_stored_table(
    data: bytes,
    label: str,
    machine: Machine,
    seat: Seat,
    start: Floats = UNKNOWN_START,
    arm_start: float = 0.0,
) -> Verdict:
    """Measure a command table alone.

    Parameters
    ----------
    data : bytes
        In any format of tables.
    label : str
        What messages call it.
    machine, seat : Machine, Seat
    start : (3,) array
        As in `check_stored_run`.
    arm_start : float
        Where the arm stands [rad].

    Raises
    ------
    BrokenRunError
        If it is no command table.
    """
    table = _parse(data, label)
    times = check_times(table)
    if not times.ok:
        return Verdict("", table, machine, seat, arm_start, (times,))
    against = check_against(machine, seat, table, arm_start)
    checks = (times, *against, *_starts(start, table))
    return Verdict("", table, machine, seat, arm_start, checks)


def _intact(folder: str) -> StoredRun:
    try:
        run = read_run(folder)
    except UnreadableError:
        raise
    except DesError as error:
        raise BrokenRunError(error.complaints) from error
    home = run.folder
    if not is_sealed(run.manifest):
        what = "is of an earlier version, which did not seal it: reduce the profile again"
        raise BrokenRunError([Complaint(str(home / MANIFEST), what)])
    facts, profile = read_metrics(run.metrics).profile, run.manifest["profile"]
    if (facts.name, facts.sha256) != (profile["name"], profile.get("sha256")):
        what = "are the metrics of another profile than the manifest's"
        raise BrokenRunError([Complaint(str(home / METRICS), what)])
    return run


def _setting(run: StoredRun) -> tuple[Machine, Seat, float]:
    """Return the machine, how the seat is fixed, and where the arm starts [rad]."""
    label = str(run.folder / MANIFEST)
    try:
        machine = parse_machine(json.dumps(run.manifest["machine"]), label)
        seat, start = run.manifest["seat"], run.manifest["start"]
        yaw, pitch, arm = seat["yaw_rad"], seat["pitch_rad"], start["arm_rad"]
        return machine, Seat(float(yaw), float(pitch)), float(arm)
    except DesError as error:
        raise BrokenRunError(error.complaints) from error
    except (KeyError, TypeError, ValueError) as error:
        what = "does not tell the machine, its seat and where its arm starts"
        raise BrokenRunError([Complaint(label, what)]) from error


def _parse(data: bytes, label: str) -> CommandTable:
    try:
        return parse_command_table(data, label)
    except DesError as error:
        raise BrokenRunError(error.complaints) from error


def _rows(trajectory: dict[str, Floats], which: str) -> CommandTable:
    """Return the rows that play a motion of the trajectory."""
    position = [trajectory[f"{which}_{joint}_rad"] for joint in JOINTS[1:]]
    return CommandTable(
        trajectory["t_s"], trajectory[f"{which}_arm_rad_s"], np.column_stack(position)
    )


def _starts(start: Floats, table: CommandTable) -> Sequence[Check]:
    return [
        Check(f"start.{joint}", f"gap between the {joint} and the first row [{unit}]", gap, least)
        for joint, unit, off, least in start_offsets(start, table)
        for gap in [abs(off)]
    ]
