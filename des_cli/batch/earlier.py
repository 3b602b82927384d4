"""What becomes of an earlier output where a job was to write one and did not.

A console would find, under the name that it asked for, commands that are not this
profile's. So a profile that is answered by "no" takes the earlier output away, if
``--overwrite`` allows it; where it stays, that is said, quiet or not. A table that could not
be written says nothing about the profile: then the earlier one stays.
"""

from __future__ import annotations

import os
from pathlib import Path

from des_cli.batch.job import JobResult, Output
from des_cli.errors import DesError, ExitCode, Failure

# With these a job leaves no command table under its name, not even an older one.
_NO_TABLE = (ExitCode.PROFILE, ExitCode.NO_SOLUTION, ExitCode.NOT_RELEASED)


def stands(output: Output, target: Path) -> bool:
    """Tell whether a command table may be found where a job writes."""
    from des_cli.runs_out.manifest import is_run

    return _table_stands(output, target) or (not output.one_file and is_run(target))


def settle(output: Output, target: Path, result: JobResult) -> tuple[str, ...]:
    """Withdraw the earlier output of a job that failed, or say that it is still there.

    Parameters
    ----------
    output : Output
    target : Path
        Where the job writes.
    result : JobResult
        How it ended.

    Returns
    -------
    tuple of str
        Sentences for the user's attention.
    """
    refused = result.exit_code in _NO_TABLE
    if result.ok or not (refused or output.overwrite) or not stands(output, target):
        return ()
    left = f"left the earlier {target} as it is: it is not what this profile asks for"
    if not output.overwrite:
        return (left,)
    if not refused:
        return (f"left the earlier {target} as it is: nothing was written",)
    try:
        if _withdraw(output, target):
            return (f"withdrew the earlier {target}: it is not what this profile asks for",)
    except (DesError, OSError) as error:
        if not _table_stands(output, target):
            left = f"withdrew the command table of the earlier {target}, and left the rest of it"
        return (*Failure.of(error).lines, left)
    return (f"{left}, and it has no manifest of a run by which to remove it",)


def unnamed(output: Output, result: JobResult) -> tuple[str, ...]:
    """Say that an earlier run, if there is one, was not found for want of the profile's name."""
    if result.exit_code not in _NO_TABLE or not Path(output.out).is_dir():
        return ()
    return (
        f"left an earlier run of {result.source} in {output.out}, if it is there, as it is: "
        "the name of the profile cannot be read",
    )


def _table_stands(output: Output, target: Path) -> bool:
    from des_cli.runs_out.manifest import COMMANDS

    if output.one_file:
        return target.is_file()
    return os.path.lexists(target / COMMANDS)


def _withdraw(output: Output, target: Path) -> bool:
    """Remove an earlier output; tell whether that could be done."""
    from des_cli.runs_out.manifest import is_run
    from des_cli.runs_out.run_folder import discard_run

    if output.one_file:
        # A link stays one, for what is written next.
        Path(os.path.realpath(target)).unlink(missing_ok=True)
        return True
    if not is_run(target):
        return False
    discard_run(target)
    return not stands(output, target)
