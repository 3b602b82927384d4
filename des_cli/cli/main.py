"""The command ``des-coriolis``: parses, dispatches, and ends with an exit code.

The commands live in one module each, imported when it is asked for. Their
errors come here, and nowhere else in the command line are they turned into an
exit code.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence
from importlib import import_module
from typing import Any, NoReturn

import click

from des_cli import __version__
from des_cli.cli.common_options import color_option, verbosity_options
from des_cli.cli.console import DEBUG_VARIABLE, Console
from des_cli.cli.lines import asked_log_format
from des_cli.cli.terminal import give_up
from des_cli.errors import ExitCode, Failure
from des_cli.signals import cause_of, stopping

COMMANDS = {
    "reduce": "Reduce the cross-coupling of profiles; write command tables.",
    "report": "Put runs on one HTML page.",
    "plot": "Draw one figure of a run, as SVG, PDF or PNG.",
    "sweep": "Trade deviation for cross-coupling: a curve of optima.",
    "validate": "Check profiles and name all of their problems.",
    "verify": "Check a run or a command table before a machine loads it.",
    "feed": "Send the rows of a run or a command table, each at its time.",
    "export": "Write a run or a command table in the form of another program.",
    "kinematics": "Show the kinematics of a state, or of a profile's motion.",
    "new": "Write a commented profile to start from.",
    "profiles": "List the built-in profiles, or print one.",
    "machines": "List the built-in machines, or print one.",
    "schema": "Print the JSON Schema of YAML profiles.",
}
"""What ``--help`` says of each, in the order of use; each is the module and the command of that
name, which ``--help`` need not import."""

PROGRAM = "des-coriolis"


class Program(click.Group):
    """The group of commands, and the one place where their errors end."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Name the commands in the order of use."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command by its name."""
        if cmd_name not in COMMANDS:
            return None
        command = getattr(import_module(f"des_cli.cli.{cmd_name}"), cmd_name)
        assert isinstance(command, click.Command)
        return command

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[Any]:
        """Complete a command without importing any, or an option."""
        from click.shell_completion import CompletionItem

        found = [
            CompletionItem(name, help=text)
            for name, text in COMMANDS.items()
            if name.startswith(incomplete)
        ]
        return [*found, *click.Command.shell_complete(self, ctx, incomplete)]

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        complete_var: str | None = None,
        standalone_mode: bool = True,
        **extra: Any,
    ) -> NoReturn:
        """Run a command line and exit.

        click's own ``main`` is passed by: it ends a broken pipe with 1.
        """
        name = prog_name or PROGRAM
        if any(key.endswith("_COMPLETE") for key in os.environ):
            from des_cli.cli.completion_shells import register_shells

            register_shells()
            self._main_shell_completion(extra, name, complete_var)
        console = Console()
        words = list(sys.argv[1:] if args is None else args)
        # A command line may be wrong before its options count.
        console.log_format = asked_log_format(words)
        try:
            code = self._dispatch(words, name, console)
            # A full disk or a reader that went away shows only now.
            if sys.stdout is not None:
                sys.stdout.flush()
        except click.exceptions.Exit as end:
            code = end.exit_code
        except click.ClickException as error:
            console.usage(error)
            code = error.exit_code
        except click.Abort:
            code = _end(console, KeyboardInterrupt())
        except (Exception, KeyboardInterrupt) as error:
            code = _end(console, error)
        sys.exit(int(code))

    def _dispatch(self, args: list[str], name: str, console: Console) -> int:
        with self.make_context(name, args, obj=console) as context:
            code = self.invoke(context)
        return ExitCode.DONE if code is None else code


def _end(console: Console, error: BaseException) -> ExitCode:
    """Print how an exception ends, and return its exit code."""
    failure = Failure.of(cause_of(error))
    console.failure(failure)
    if isinstance(error, OSError) or failure.exit_code == ExitCode.READER_GONE:
        give_up(sys.stdout)
    return failure.exit_code


def _keep_warnings() -> None:
    """Keep Python's warnings, which name lines of the source, from who uses a command.

    What concerns a user is a sentence of the tool's own. Workers read the environment.
    """
    if not sys.warnoptions and not os.environ.get(DEBUG_VARIABLE):
        os.environ["PYTHONWARNINGS"] = "ignore"
        warnings.simplefilter("ignore")


@click.command(
    PROGRAM,
    cls=Program,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="""\b
Example:
  des-coriolis reduce cobra_felt
""",
)
@verbosity_options
@color_option
@click.version_option(
    __version__, "-V", "--version", prog_name=PROGRAM, message="%(prog)s %(version)s"
)
def program() -> None:
    """Reduce the Coriolis cross-coupling that a pilot feels in a three-axis human centrifuge.

    A maneuver profile goes in; a command table for the arm, the fork and the
    cab comes out, verified, with what it cost. Data goes to stdout, words to
    stderr; "-" is stdin or stdout.
    """


def main() -> NoReturn:
    """Run the command line of this process, until it is done or a signal ends it."""
    _keep_warnings()
    try:
        with stopping():
            program.main()
    except KeyboardInterrupt as error:
        # Between two steps of the ending itself; what is to be put away is.
        sys.exit(int(Failure.of(error).exit_code))
