"""Whether the bytes of a command table are those of a run, and safe to play.

The verification checks the motion that the solver found. Between that and what a machine
reads lie a conversion of units, a text and a disk. So the bytes are read back, by code that
does not share the writer's, and measured anew.
"""

from __future__ import annotations

from des_cli.errors import Complaint, NotReleasedError
from des_cli.model.run import Check, Run
from des_cli.runs_out.table_reading import parse_command_table
from des_cli.verify.table import check_against, check_ride, check_rows, check_times


def require_table(run: Run, data: bytes) -> None:
    """Raise unless the bytes of a table are the run's, inside what the run is to keep.

    Parameters
    ----------
    run : Run
    data : bytes
        As they were read back, in any format of tables.

    Raises
    ------
    NotReleasedError
        With everything that is wrong.
    """
    name = run.profile.name
    failed = [check for check in check_table(run, data) if not check.ok]
    if failed:
        raise NotReleasedError(
            [Complaint(name, f"the table that was written is wrong: {check}") for check in failed]
        )


def check_table(run: Run, data: bytes) -> list[Check]:
    """Measure the bytes of a table against the run that they are of.

    Raises
    ------
    NotReleasedError
        If they are no command table.
    """
    table = parse_command_table(data, run.profile.name)
    times = check_times(table)
    rows = check_rows(table, run.commands)
    checks = [times, *rows]
    # What is measured along wrong times, or another motion, says nothing.
    if not all(check.ok for check in checks) or run.profile.reduction.limits == "warn":
        return checks
    machine, t = run.profile.machine, run.solution.modified.t
    return [
        *checks,
        *check_against(machine, run.seat, table, float(run.commands.angle[0, 0])),
        *check_ride(run.results.felt, table.between(t[0], t[-1]), machine, run.seat),
    ]
