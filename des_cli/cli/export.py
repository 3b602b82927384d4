"""``des-coriolis export``: a table that passes, in the form of another program."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from des_cli.batch.source import STANDARD_STREAM
from des_cli.cli.command import MACHINE, OUTPUT, Command, option
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.completion import complete_files, complete_targets
from des_cli.cli.console import Console
from des_cli.cli.form_options import FormWords, form_of, form_options, hz_option
from des_cli.cli.options import TABLE_FORMATS, fail_on_option, overwrite_option
from des_cli.cli.outputs import files_held
from des_cli.cli.source_options import machine_option_below, read_stdin
from des_cli.cli.state_options import in_si, state_options
from des_cli.cli.stdout import refuse_binary_on_terminal, write_data
from des_cli.cli.targets import LARGEST, STANDING, check_target, tell_verdict
from des_cli.errors import ExitCode

if TYPE_CHECKING:
    from des_cli.release.stored import Verdict
    from des_cli.runs_out.forms import Form


@click.command(
    cls=Command,
    short_help="Write a run or a command table in the form of another program.",
    epilog="""\b
Examples:
  des-coriolis export runs/cobra_felt -o cobra.xlsx
  des-coriolis export runs/cobra_felt --preset ros2 -o cobra.yaml
  des-coriolis export runs/cobra_felt --preset halstreamer --hz 1000 -o cobra.txt
  des-coriolis export commands.csv --columns t_ms=time,arm_rad_s,fork_rad --out-separator tab -o -
""",
)
@click.argument("target", metavar="RUN|TABLE", shell_complete=complete_targets)
@option(
    OUTPUT,
    "-o",
    "--out",
    metavar="FILE|-",
    required=True,
    shell_complete=complete_files,
    help="The file, or stdout.",
)
@option(
    OUTPUT,
    "-f",
    "--format",
    "table_format",
    type=click.Choice(TABLE_FORMATS),
    help="Format of a command table.  [default: by suffix, or csv]",
)
@form_options
@hz_option
@overwrite_option("Replace a file that exists.")
@machine_option_below(MACHINE)
@state_options(STANDING, MACHINE)
@fail_on_option
@verbosity_options
@click.pass_obj
def export(
    console: Console,
    target: str,
    out: str,
    table_format: str | None,
    words: FormWords,
    hz: float | None,
    overwrite: bool,
    machine: str | None,
    fail_on: frozenset[str],
    **numbers: float | None,
) -> ExitCode:
    """Write the rows of a RUN folder or a command TABLE in another form.

    First the target is checked as by the command verify: nothing is written
    otherwise, and the exit code is that of verify. The form is told by the
    suffix of the file, or by --preset; --columns changes what its rows hold.
    What was written is read back before the file gets its name.
    """
    from des_cli.profiles_in.machine_file import load_machine

    form = form_of(out, table_format, words, hz)
    if form is None:
        raise click.UsageError(
            f"-o {out} is no file: give it a suffix, as in {out.rstrip('/')}.csv."
        )
    if out == STANDARD_STREAM:
        refuse_binary_on_terminal(form.kind)
    names = [] if out == STANDARD_STREAM else [out]
    with files_held(names, overwrite):
        given = in_si({name: value for name, value in numbers.items() if value is not None})
        other = None if machine is None else load_machine(machine, "--machine")
        verdict = check_target(target, read_stdin((target,), LARGEST), other, given)
        code = tell_verdict(console, target, verdict, fail_on)
        if code == ExitCode.DONE:
            _write(console, target, verdict, form, out, overwrite=overwrite)
    return code


def _write(
    console: Console, target: str, verdict: Verdict, form: Form, out: str, *, overwrite: bool
) -> None:
    from des_cli.release.exported import Export
    from des_cli.release.playback import Playback
    from des_cli.runs_out.atomic import write_file

    playback = Playback(verdict.table, verdict.machine, verdict.seat, verdict.arm_start, target)
    rows = Export(playback, form)
    if out == STANDARD_STREAM:
        rows.require(rows.data)
        write_data(rows.data)
        return
    write_file(Path(out), rows.data, overwrite=overwrite, accept=rows.require)
    console.say(f"{out}: {len(rows.rows.t)} rows of {target}")
