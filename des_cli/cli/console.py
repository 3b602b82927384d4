"""Words for people, on stderr; data never passes through here."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from io import StringIO
from typing import TYPE_CHECKING

import click

from des_cli.cli.status_line import StatusLine
from des_cli.cli.terminal import give_up, printable, without_broken_pipe_signal
from des_cli.errors import ExitCode, Failure

if TYPE_CHECKING:
    from des_cli.model.solution import Iteration

DEBUG_VARIABLE = "DES_CORIOLIS_DEBUG"
"""In the environment, and not empty: the traceback of a bug is printed."""

QUIET, NORMAL, VERBOSE, DEBUG = -1, 0, 1, 2

_STYLES = {
    "title": {"bold": True},
    "good": {"fg": "green"},
    "warning": {"fg": "yellow"},
    "error": {"fg": "red"},
    "faint": {"dim": True},
    "plain": {},
}


class Console:
    """How much is said, and whether in color.

    Attributes
    ----------
    verbosity : int
        ``QUIET``, ``NORMAL``, ``VERBOSE`` or ``DEBUG``.
    color : bool
    """

    def __init__(self) -> None:
        self.verbosity = NORMAL
        self.color = False
        self._log_open = False
        # Stands for the escape character of our own colors; nobody else can know it.
        self._escape = f"\0{os.urandom(8).hex()}\0"
        self._line = StatusLine(None)
        self.choose_color("auto")

    def choose_color(self, choice: str) -> None:
        """Take the value of ``--color``: auto, always or never."""
        if choice == "auto":
            # https://no-color.org: set and not empty, whatever the value.
            allowed = not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
            self.color = allowed and sys.stderr is not None and sys.stderr.isatty()
        else:
            self.color = choice == "always"

    def style(self, text: str, style: str) -> str:
        """Return the text in a style of the table, for this console to print."""
        if not self.color:
            return text
        codes = click.style("\0", **_STYLES[style]).split("\0")  # type: ignore[arg-type]
        before, after = (code.replace("\x1b", self._escape) for code in codes)
        return before + text + after

    def say(self, text: str) -> None:
        """Print unless quiet."""
        if self.verbosity > QUIET:
            self._echo(text)

    def warn(self, lines: Iterable[str], style: str = "warning") -> None:
        """Print what nobody may miss, quiet or not."""
        for line in lines:
            self._echo(self.style(line, style))

    def usage(self, error: click.ClickException) -> None:
        """Print what is wrong with a command line."""
        words = StringIO()
        error.show(words)
        text = words.getvalue().replace(error.message, printable(error.message))
        for line in text.splitlines():
            self._echo(line.expandtabs(4))

    def _echo(self, text: str) -> None:
        """Print a line, the one way to stderr; a lost word is no reason to end otherwise."""
        line = "\x1b".join(map(printable, text.split(self._escape)))
        try:
            with self.aside(), without_broken_pipe_signal():
                click.echo(line, err=True, color=self.color)
        except (OSError, ValueError):
            give_up(sys.stderr)

    @property
    def has_line(self) -> bool:
        """Whether a line tells what is being done: on a terminal, and unless quiet."""
        allowed = self.verbosity > QUIET and os.environ.get("TERM") != "dumb"
        return allowed and sys.stderr is not None and sys.stderr.isatty()

    @contextmanager
    def working(self, total: int = 1, noun: str = "profiles") -> Iterator[StatusLine]:
        """Offer a line that tells what is being done, on a terminal and unless quiet.

        Parameters
        ----------
        total : int
            How many there are to do.
        noun : str
            What they are, in the plural.
        """
        stream = sys.stderr if self.has_line else None
        with StatusLine(stream, total=total, noun=noun) as self._line:
            yield self._line

    def follow(self, line: StatusLine, *, log: bool) -> Callable[[Iteration], None]:
        """Return what takes a solver's iterations: the line, and the log if it is asked for."""

        def note(iteration: Iteration) -> None:
            line.iteration(iteration)
            if log:
                self.iteration(iteration)

        return note

    def aside(self) -> AbstractContextManager[None]:
        """Keep that line away while something is printed, also on stdout."""
        return self._line.hidden()

    def failure(self, failure: Failure) -> None:
        """Print how something failed; a traceback only when asked for."""
        lines = failure.lines
        if failure.exit_code == ExitCode.BUG:
            if self.verbosity >= DEBUG or os.environ.get(DEBUG_VARIABLE):
                for line in failure.traceback.splitlines():
                    self._echo(line)
            else:
                lines = tuple(f"{line} ({DEBUG_VARIABLE}=1 prints where)" for line in lines)
        self.warn(lines, "error")

    def iteration(self, iteration: Iteration) -> None:
        """Print one line of a solver's log, under a header before the first one."""
        if not self._log_open:
            self.say(self.style(ITERATION_HEADER, "faint"))
            self._log_open = True
        self.say(iteration_line(iteration))

    def end_log(self) -> None:
        """Let the next iteration begin with a header."""
        self._log_open = False


ITERATION_HEADER = "  iter            cost  infeasibility     optimality      step"


def iteration_line(iteration: Iteration) -> str:
    """Return an iteration in the columns of ``ITERATION_HEADER``."""
    return (
        f"{iteration.number:6d}  {iteration.cost:14.8g}  {iteration.infeasibility:13.3e}"
        f"  {iteration.optimality:13.3e}  {iteration.step:8.4f}"
    )
