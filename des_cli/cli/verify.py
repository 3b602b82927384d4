"""``des-coriolis verify``: may this table be loaded."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import click

from des_cli.cli.command import MACHINE, Command
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.completion import complete_targets
from des_cli.cli.console import Console
from des_cli.cli.options import fail_on_option, text_or_json_option
from des_cli.cli.source_options import machine_option_below, read_stdin
from des_cli.cli.state_options import in_si, state_options
from des_cli.cli.stdout import write_line, write_words
from des_cli.cli.targets import LARGEST, STANDING, check_target, tell_verdict
from des_cli.errors import DesError, ExitCode, Failure

if TYPE_CHECKING:
    from des_cli.release.stored import Verdict


@click.command(
    cls=Command,
    short_help="Check a run or a command table before a machine loads it.",
    epilog="""\b
Examples:
  des-coriolis verify runs/cobra_felt
  des-coriolis verify commands.csv --machine ours.yaml --fork-deg 0 --cab-deg 30 --arm-rpm 8.8
  des-coriolis verify runs/* --fail-on notice --format json
""",
)
@click.argument(
    "targets",
    metavar="RUN|TABLE...",
    nargs=-1,
    required=True,
    shell_complete=complete_targets,
)
@machine_option_below(MACHINE)
@state_options(STANDING, MACHINE)
@fail_on_option
@text_or_json_option("json prints one object a line, with every check.")
@verbosity_options
@click.pass_obj
def verify(
    console: Console,
    targets: tuple[str, ...],
    machine: str | None,
    fail_on: frozenset[str],
    form: str,
    **numbers: float | None,
) -> ExitCode:
    """Measure each RUN folder or command TABLE anew, and say whether a machine may play it.

    Of a RUN, every file is compared with the manifest, and the table with the
    solution and with what the metrics tell. Of any table, the limits of the
    joints, the bounds for the occupant, and whether the first row can be
    reached from rest and the last one left to rest are measured from its rows
    alone. "-" is a table on stdin.

    Options say where the machine stands: the first row must be there. The seat
    and the arm's angle are a run's own; a table alone does not tell them.

    The exit code is 0, 3 for what is no whole run or no command table, or 5
    for what is not to be played.
    """
    from des_cli.profiles_in.machine_file import load_machine

    given = in_si({name: value for name, value in numbers.items() if value is not None})
    other = None if machine is None else load_machine(machine, "--machine")
    stdin = read_stdin(targets, LARGEST)
    codes = [ExitCode.DONE]
    for target in targets:
        try:
            verdict = check_target(target, stdin, other, given)
        except (DesError, OSError) as error:
            failure = Failure.of(error)
            codes.append(failure.exit_code)
            console.failure(failure, target=target)
            facts: dict[str, Any] = {"exit_code": failure.exit_code, "problems": failure.lines}
        else:
            codes.append(tell_verdict(console, target, verdict, fail_on))
            if form == "text" and codes[-1] == ExitCode.DONE:
                write_words(_line(target, verdict))
            facts = _facts(verdict, codes[-1])
        if form == "json":
            write_line(json.dumps({"target": target, "ok": not facts["exit_code"], **facts}))
    # The worst of several: a table that is not to be played before a file that is none.
    return max(codes)


def _line(target: str, verdict: Verdict) -> str:
    table = verdict.table
    name = f"{verdict.name}, " if verdict.name else ""
    return (
        f"{target}: ok: {name}{len(table.t)} rows, {table.t[-1] - table.t[0]:g} s, machine "
        f"{verdict.machine.name}; {len(verdict.checks)} checks"
    )


def _facts(verdict: Verdict, code: ExitCode) -> dict[str, Any]:
    table = verdict.table
    return {
        "exit_code": code,
        "name": verdict.name or None,
        "machine": verdict.machine.name,
        "rows": len(table.t),
        "duration_s": float(table.t[-1] - table.t[0]),
        "problems": [f"{check.key}: {check}" for check in verdict.failed],
        "notices": [{"name": each.name, "text": each.text} for each in verdict.notices],
        "checks": [
            {
                "key": check.key,
                "name": check.name,
                "value": check.value if math.isfinite(check.value) else None,
                "tolerance": check.tolerance,
                "ok": check.ok,
            }
            for check in verdict.checks
        ],
    }
