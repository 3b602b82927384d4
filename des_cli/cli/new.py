"""``des-coriolis new``: a commented profile to start from."""

from __future__ import annotations

import os
import shlex
from pathlib import Path

import click

from des_cli.batch.source import STANDARD_STREAM
from des_cli.cli.command import OUTPUT, Command, option
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.console import Console
from des_cli.cli.stdout import write_data
from des_cli.errors import Complaint, FileAccessError

DEFAULT_NAME = "maneuver"


@click.command(
    cls=Command,
    short_help="Write a commented profile to start from.",
    epilog="""\b
Examples:
  des-coriolis new turn
  des-coriolis reduce turn.yaml
""",
)
@click.argument("name", required=False)
@option(
    OUTPUT,
    "-o",
    "--out",
    metavar="FILE|-",
    help="Where it goes; never over a file.  [default: NAME.yaml]",
)
@verbosity_options
@click.pass_obj
def new(console: Console, name: str | None, out: str | None) -> None:
    """Write a profile called NAME to start from, with a comment on every key.

    It is valid as it is, and its maneuver breaks no limit of the machine. What it does not
    set is there as a comment. Without NAME it is called after FILE, or "maneuver".
    """
    name = _name_of(out) if name is None else name
    target = f"{name}.yaml" if out is None else out
    if target != STANDARD_STREAM and Path(target).suffix not in (".yaml", ".yml"):
        raise click.UsageError(f"-o {target}: a profile's file ends in .yaml or .yml.")

    from des_cli.profiles_in.starter import starter_text

    try:
        text = starter_text(name)
    except ValueError as error:
        raise click.UsageError(f"NAME {error}.") from None
    if target == STANDARD_STREAM:
        write_data(text)
        return

    from des_cli.runs_out.atomic import write_file

    if os.path.lexists(target):
        raise FileAccessError([Complaint(target, "exists, and is left as it is; name another")])
    write_file(target, text.encode())
    command = f"des-coriolis reduce {shlex.quote(target)}"
    console.say(f"{console.style(target, 'good')}: reduce it with {command}")


def _name_of(out: str | None) -> str:
    """Return what a profile without a name is called: as its file, if it has one."""
    if out is None or out == STANDARD_STREAM:
        return DEFAULT_NAME
    return Path(out).stem
