"""``des-coriolis feed``: the rows of a table, each at its time."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import chain, count, islice
from typing import TYPE_CHECKING

import click

from des_cli.cli.command import MACHINE, OUTPUT, PACE, Command, option
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.completion import complete_targets
from des_cli.cli.console import Console
from des_cli.cli.form_options import FormWords, line_options, lines_form
from des_cli.cli.options import fail_on_option
from des_cli.cli.source_options import machine_option_below, read_stdin
from des_cli.cli.state_options import in_si, state_options
from des_cli.cli.stdout import write_data
from des_cli.cli.targets import LARGEST, STANDING, check_target, tell_verdict
from des_cli.errors import ExitCode, Stopped

if TYPE_CHECKING:
    from des_cli.release.clocked import Clock, Clocked, End
    from des_cli.runs_out.forms import Form

MOST_ROWS = 10_000_000
"""That are sent: more than a day of them at 100 Hz."""


@click.command(
    cls=Command,
    short_help="Send the rows of a run or a command table, each at its time.",
    epilog="""\b
Examples:
  des-coriolis feed runs/cobra_felt | nc console 5000
  des-coriolis feed commands.csv --machine ours.yaml --hz 250 --rate 0.5
  des-coriolis feed runs/cobra_felt --preset halstreamer --hz 1000 | halstreamer
  des-coriolis feed runs/cobra_felt --at-end hold --hold-s 30 > /dev/ttyUSB0
""",
)
@click.argument("target", metavar="RUN|TABLE", shell_complete=complete_targets)
@option(
    PACE,
    "--hz",
    type=click.FloatRange(1.0, 1000.0),
    metavar="RATE",
    default=100.0,
    show_default=True,
    help="Rows a second.",
)
@option(
    PACE,
    "--rate",
    type=click.FloatRange(0.01, 100.0),
    metavar="RATE",
    default=1.0,
    show_default=True,
    help="Seconds of the table in a second: 0.5 plays at half the speed.",
)
@option(
    PACE,
    "--at-end",
    type=click.Choice(["ramp", "hold", "stop"]),
    default="ramp",
    show_default=True,
    help="After the last row: bring all joints to rest, repeat it, or end.",
)
@option(
    PACE,
    "--hold-s",
    type=click.FloatRange(0.0, min_open=True),
    metavar="SECONDS",
    help="End so long after the last row.  [default: hold until interrupted]",
)
@option(OUTPUT, "--dry-run", is_flag=True, help="Check all rows, and send none.")
@line_options
@machine_option_below(MACHINE)
@state_options(STANDING, MACHINE)
@fail_on_option
@verbosity_options
@click.pass_obj
def feed(
    console: Console,
    target: str,
    hz: float,
    rate: float,
    at_end: End,
    hold_s: float | None,
    dry_run: bool,
    words: FormWords,
    machine: str | None,
    fail_on: frozenset[str],
    **numbers: float | None,
) -> ExitCode:
    """Send the rows of a RUN folder or a command TABLE to stdout, each at its time.

    First the target is checked as by the command verify, then all rows that
    are to be sent, which lie between those of the table, against the same
    limits. Nothing is sent otherwise, and the exit code is that of verify.

    Rows are those of a command table, or what --preset and --columns make of
    it; times go on in seconds of the clock.
    How late rows were is told on stderr at the end. Ctrl-C ends at once with
    130, a reader that goes away with 141.
    """
    from des_cli.cli.feed_text import broken_lines, plan_line
    from des_cli.profiles_in.machine_file import load_machine
    from des_cli.release.clocked import Clock
    from des_cli.release.playback import Playback

    if hold_s is not None and at_end != "hold":
        raise click.UsageError("--hold-s is for --at-end hold.")
    given = in_si({name: value for name, value in numbers.items() if value is not None})
    other = None if machine is None else load_machine(machine, "--machine")
    verdict = check_target(target, read_stdin((target,), LARGEST), other, given)
    code = tell_verdict(console, target, verdict, fail_on)
    if code != ExitCode.DONE:
        return code
    played = Playback(verdict.table, verdict.machine, verdict.seat, verdict.arm_start, target)
    clock = Clock(hz, rate, at_end)
    if played.count(clock) > MOST_ROWS:
        raise click.UsageError(f"these are more than {MOST_ROWS:,} rows: give a lower --hz.")
    clocked = played.on(clock)
    if clocked.failed:
        console.warn(broken_lines(target, played, clock, clocked), "error")
        return ExitCode.NOT_RELEASED
    if rate != 1.0:
        share = f"the arm turns at {rate:g} of its speed and makes {rate**2:.3g} of its G"
        console.warn([f"{target}: --rate {rate:g}: {share}"])
    console.say(plan_line(target, clock, clocked, hold_s))
    if not dry_run:
        _send(console, target, _lines(clocked, clock, lines_form(words), hold_s), hz)
    return ExitCode.DONE


def _send(console: Console, target: str, lines: Iterator[bytes], hz: float) -> None:
    from des_cli.feed.lateness import Lateness
    from des_cli.feed.pace import SystemClock, feed

    lateness = Lateness()
    try:
        feed(lines, hz, write_data, lateness, SystemClock())
    except ConnectionError:
        # Of a socket: a reader that went away as that of a pipe does.
        raise Stopped(ExitCode.READER_GONE) from None
    finally:
        console.say(f"{target}: sent {lateness}")


def _lines(clocked: Clocked, clock: Clock, form: Form, hold_s: float | None) -> Iterator[bytes]:
    """Yield a line for each row, the first with what stands above it."""
    from des_cli.release.clocked import HELD_BLOCK
    from des_cli.runs_out.row_text import header_lines, row_lines

    start = float(clocked.rows.t[0])
    lines = row_lines(clocked.rows, form, start)
    if clock.end == "hold":
        more = map(partial(clocked.held, clock), count(len(clocked.rows.t), HELD_BLOCK))
        held = chain.from_iterable(row_lines(rows, form, start) for rows in more)
        most = None if hold_s is None else clocked.table_rows + round(hold_s * clock.hz)
        lines = islice(chain(lines, held), most)
    yield header_lines(form) + next(lines)
    yield from lines
