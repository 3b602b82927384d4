"""Runs and command tables as commands are given them: checked before anything else is done."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import click

from des_cli.batch.source import STANDARD_STREAM
from des_cli.cli.console import Console
from des_cli.errors import ExitCode
from des_cli.profiles_in.caps import Caps

if TYPE_CHECKING:
    from des_cli.model.machine import Machine
    from des_cli.release.stored import Verdict

STANDING = (
    ("arm", "angle"),
    ("arm", "rate"),
    ("fork", "angle"),
    ("cab", "angle"),
    ("seat_yaw", "angle"),
    ("seat_pitch", "angle"),
)
"""What is told of the machine that is to play a table."""

LARGEST = Caps(mib=1024)
"""Table that is read: ten million rows are no ride."""

_STARTS = (("arm", "rate"), ("fork", "angle"), ("cab", "angle"))
"""What the first row of a table says."""


def check_target(
    target: str,
    stdin: bytes | None,
    machine: Machine | None,
    given: dict[tuple[str, str], float],
) -> Verdict:
    """Measure a run folder or a command table.

    Parameters
    ----------
    target : str
        A folder, a file, or ``-``.
    stdin : bytes, optional
        What ``-`` stands for.
    machine : Machine, optional
        Of ``--machine``.
    given : dict
        The options of `STANDING` that were given, in SI units.

    Raises
    ------
    BrokenRunError
        If it is no whole run or no command table.
    FileAccessError
        If it cannot be read.
    click.UsageError
        If an option is given that a run tells itself.
    """
    import numpy as np

    from des_cli.model.machine import Seat
    from des_cli.model.machines import MACHINES
    from des_cli.profiles_in.machine_schema import DEFAULT_MACHINE
    from des_cli.profiles_in.source import STDIN_LABEL, read_source
    from des_cli.release.stored import check_stored_run, check_stored_table

    start = np.array([given.get(quantity, math.nan) for quantity in _STARTS])
    if target == STANDARD_STREAM:
        assert stdin is not None, "it was read"
        data, label = stdin, STDIN_LABEL
    elif Path(target).is_dir():
        _refuse_of_run(given)
        return check_stored_run(target, machine, start)
    else:
        data, label = read_source(Path(target), target, LARGEST.mib, pipes=True), target
    seat = Seat()
    return check_stored_table(
        data,
        label,
        machine or MACHINES[DEFAULT_MACHINE],
        Seat(
            given.get(("seat_yaw", "angle"), seat.yaw),
            given.get(("seat_pitch", "angle"), seat.pitch),
        ),
        start,
        given.get(("arm", "angle"), 0.0),
    )


def tell_verdict(
    console: Console, target: str, verdict: Verdict, fail_on: frozenset[str]
) -> ExitCode:
    """Print what is wrong with a target, and what it does to the occupant.

    Returns
    -------
    ExitCode
        ``DONE`` where a machine may play it.
    """
    for check in verdict.failed:
        facts = {"name": check.key, "value": check.value, "tolerance": check.tolerance}
        text = f"{target}: {check.key}: {check}"
        console.warn([text], "error", kind="check", target=target, **facts)
    refused = [notice for notice in verdict.notices if notice.name in fail_on]
    for notice in verdict.notices:
        style = "error" if notice in refused else "warning"
        text = f"{target}: {notice.name}: {notice.text}"
        console.warn([text], style, kind="notice", target=target, name=notice.name)
    return ExitCode.NOT_RELEASED if verdict.failed or refused else ExitCode.DONE


def _refuse_of_run(given: dict[tuple[str, str], float]) -> None:
    own = [stem.replace("_", " ") for stem, kind in given if (stem, kind) not in _STARTS]
    if own:
        raise click.UsageError(
            f"the {' and the '.join(own)} angle is a run's own: give it for a table alone."
        )
