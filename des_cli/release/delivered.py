"""Whether a run that another machine computed is the one that was asked for, and safe to play.

Its files are read back from where they were built, and nothing of them is taken on trust but
the solution itself, which the other machine verified: its table is measured anew.
"""

from __future__ import annotations

import json
from collections.abc import Collection
from pathlib import Path

from des_cli.errors import BrokenRunError, Complaint, NotReleasedError
from des_cli.model.notice import Notice
from des_cli.model.profile import Profile
from des_cli.profiles_in.machine_yaml import machine_mapping
from des_cli.release.gate import require_unnoticed
from des_cli.release.stored import check_stored_run
from des_cli.runs_out.manifest import encode_json, read_manifest


def require_delivered(
    folder: Path, profile: Profile, notices: Collection[Notice] = (), fail_on: Collection[str] = ()
) -> None:
    """Raise unless a folder holds a run of a profile, inside what it is to keep.

    Parameters
    ----------
    folder : Path
        Where the files were written.
    profile : Profile
        That was asked for.
    notices : collection of Notice
        What was told of the run.
    fail_on : collection of str
        Names of notices, of the run or of its table, with which it is not to be released.

    Raises
    ------
    NotReleasedError
        With everything that is wrong.
    """
    name = profile.name
    try:
        # Also what breaks a limit is played where the profile only wants to be told.
        verdict = check_stored_run(str(folder), limits=profile.reduction.limits != "warn")
    except BrokenRunError as error:
        raise _wrong(name, [complaint.what for complaint in error.complaints]) from error
    wrong = [str(check) for check in verdict.failed]
    manifest = read_manifest(folder)
    if manifest["profile"] != {"name": name, "sha256": profile.sha256}:
        wrong.append("it is of another profile")
    if manifest["machine"] != json.loads(encode_json(machine_mapping(profile.machine))):
        wrong.append("it is of another machine")
    if wrong:
        raise _wrong(name, wrong)
    if fail_on:
        require_unnoticed(name, [*notices, *verdict.notices], fail_on)


def _wrong(name: str, what: list[str]) -> NotReleasedError:
    return NotReleasedError(
        [Complaint(name, f"the run that a worker sent is wrong: {each}") for each in what]
    )
