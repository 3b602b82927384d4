"""Whether the bytes of a command table are those of a run, and safe to play.

The verification checks the motion that the solver found. Between that and what a machine
reads lie a conversion of units, a text and a disk. So the bytes are read back, by code that
does not share the writer's, and measured anew.
"""

from __future__ import annotations

from collections.abc import Collection

from des_cli.errors import Complaint, NotReleasedError
from des_cli.model.command_table import CommandTable
from des_cli.model.notice import Notice
from des_cli.model.run import Check, Run
from des_cli.runs_out.table_reading import parse_command_table
from des_cli.verify.harm import find_harms, find_start
from des_cli.verify.table import check_against, check_ride, check_rows, check_times


def require_table(run: Run, data: bytes, fail_on: Collection[str] = ()) -> None:
    """Raise unless the bytes of a table are the run's, inside what the run is to keep.

    Parameters
    ----------
    run : Run
    data : bytes
        As they were read back, in any format of tables.
    fail_on : collection of str
        Names of notices, of the run or of its table, with which it is not to be released.

    Raises
    ------
    NotReleasedError
        With everything that is wrong.
    """
    name = run.profile.name
    table = parse_command_table(data, name)
    failed = [check for check in check_table(run, table) if not check.ok]
    if failed:
        raise NotReleasedError(
            [Complaint(name, f"the table that was written is wrong: {check}") for check in failed]
        )
    if fail_on:
        require_unnoticed(name, [*run.notices, *table_notices(run, table)], fail_on)


def require_unnoticed(name: str, notices: Collection[Notice], fail_on: Collection[str]) -> None:
    """Raise where there is a notice that is not to be.

    Raises
    ------
    NotReleasedError
        With all of them.
    """
    found = [notice for notice in notices if notice.name in fail_on]
    if found:
        raise NotReleasedError(
            [
                Complaint(name, f"not released for its notice {each.name}: {each.text}")
                for each in found
            ]
        )


def check_table(run: Run, table: CommandTable) -> list[Check]:
    """Measure a table, as it was read back, against the run that it is of."""
    checks = [check_times(table), *check_rows(table, CommandTable.of_motion(run.commands))]
    # What is measured along wrong times, or another motion, says nothing.
    if not all(check.ok for check in checks) or run.profile.reduction.limits == "warn":
        return checks
    machine = run.profile.machine
    return [
        *checks,
        *check_against(machine, run.seat, table, float(run.commands.angle[0, 0])),
        *check_ride(run.results.felt, _maneuver(run, table), machine, run.seat),
    ]


def table_notices(run: Run, table: CommandTable) -> list[Notice]:
    """Return what the rows of a table do that the motion they are made of does not."""
    maneuver, desired = _maneuver(run, table), CommandTable.of_motion(run.desired)
    start = CommandTable.of_motion(run.asked.motion).values[0, 1:]
    return [
        *find_start(start, maneuver, run.profile.reduction.optimise),
        *find_harms(maneuver, desired, run.profile.machine, run.seat, run.results.felt),
    ]


def _maneuver(run: Run, table: CommandTable) -> CommandTable:
    """Return the rows without the leads."""
    t = run.solution.modified.t
    return table.between(t[0], t[-1])
