"""Words for people, or for programs that run the tool, on stderr; data never passes here."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import asdict
from io import StringIO
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import click

from des_cli.cli.lines import HANG, Level, LogFormat, json_line, wrapped
from des_cli.cli.status_line import ProgressLog, StatusLine, columns_of
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


LABEL_WIDTH = 14
"""Of the labels that stand before the rows of a summary."""

_ROW_HANG = LABEL_WIDTH + 3
_LEVELS: dict[str, Level] = {"error": "error", "warning": "warning"}


class Console:
    """How much is said, in what form, and whether in color.

    Attributes
    ----------
    verbosity : int
        ``QUIET``, ``NORMAL``, ``VERBOSE`` or ``DEBUG``.
    color : bool
    log_format : {"text", "json"}
        Lines for people, or an object a line for programs.
    """

    def __init__(self) -> None:
        self.verbosity = NORMAL
        self.color = False
        self.log_format: LogFormat = "text"
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
        if not self.color or self.log_format == "json" or not _STYLES[style]:
            return text
        codes = click.style("\0", **_STYLES[style]).split("\0")  # type: ignore[arg-type]
        before, after = (code.replace("\x1b", self._escape) for code in codes)
        return before + text + after

    def say(self, text: str, kind: str = "message", **facts: Any) -> None:
        """Print unless quiet.

        Parameters
        ----------
        text : str
        kind : str
            What it is, for a program.
        **facts
            Names and numbers of the text, for a program.
        """
        if self.verbosity > QUIET:
            self._echo(text, "info", kind, facts)

    def headline(self, text: str) -> None:
        """Print the first line of a summary unless quiet."""
        if self.verbosity > QUIET:
            self._echo(text, kind="summary", hang=_ROW_HANG)

    def warn(
        self,
        lines: Iterable[str],
        style: str = "warning",
        kind: str | None = None,
        **facts: Any,
    ) -> None:
        """Print what nobody may miss, quiet or not."""
        for line in lines:
            level = _LEVELS[style]
            self._echo(self.style(line, style), level, kind or level, facts)

    def row(
        self,
        label: str,
        text: str,
        style: str = "plain",
        *,
        kind: str = "summary",
        level: Level = "info",
        **facts: Any,
    ) -> None:
        """Print a row of a summary: what is of the level info only unless quiet."""
        if self.log_format == "text":
            text = f"  {label:<{LABEL_WIDTH}} {self.style(text, style)}"
        if level != "info" or self.verbosity > QUIET:
            self._echo(text, level, kind, facts, hang=_ROW_HANG)

    def table(self, text: str) -> None:
        """Print a line of a table, whose columns stay where they are, unless quiet."""
        if self.verbosity > QUIET:
            self._print(text)

    def usage(self, error: click.ClickException) -> None:
        """Print what is wrong with a command line."""
        if self.log_format == "json":
            facts = {"exit_code": error.exit_code}
            self._echo(error.format_message(), "error", "usage", facts)
            return
        words = StringIO()
        error.show(words)
        text = words.getvalue().replace(error.message, printable(error.message))
        for line in text.splitlines():
            self._echo(line.expandtabs(4))

    def _echo(
        self,
        text: str,
        level: Level = "info",
        kind: str = "message",
        facts: Mapping[str, Any] = MappingProxyType({}),
        hang: int = HANG,
    ) -> None:
        """Print what was said as the lines or the object that it makes."""
        if self.log_format == "json":
            self._print(json_line(level, kind, text, facts))
            return
        line = "\x1b".join(map(printable, text.split(self._escape)))
        # Of a list of numbers each stays whole, of sentences only a number with its unit.
        for part in wrapped(line, columns_of(sys.stderr), hang, whole=kind == "summary"):
            self._print(part.replace("\x1b", self._escape))

    def _print(self, text: str) -> None:
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
        allowed = allowed and self.log_format == "text"
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
        with self._status_line(total, noun) as self._line:
            yield self._line

    def _status_line(self, total: int, noun: str) -> StatusLine:
        if self.log_format == "json" and self.verbosity > QUIET:
            return ProgressLog(self._progress, total=total, noun=noun)
        return StatusLine(sys.stderr if self.has_line else None, total=total, noun=noun)

    def _progress(self, text: str, **facts: Any) -> None:
        self._echo(text, "info", "progress", facts)

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

    def failure(self, failure: Failure, **facts: Any) -> None:
        """Print how something failed; a traceback only when asked for."""
        lines = failure.lines
        if failure.exit_code == ExitCode.BUG:
            if self.verbosity >= DEBUG or os.environ.get(DEBUG_VARIABLE):
                for line in failure.traceback.splitlines():
                    self._echo(line, "error", "traceback")
            else:
                lines = tuple(f"{line} ({DEBUG_VARIABLE}=1 prints where)" for line in lines)
        self.warn(lines, "error", exit_code=int(failure.exit_code), **facts)

    def iteration(self, iteration: Iteration) -> None:
        """Print one line of a solver's log, under a header before the first one."""
        if self.log_format == "json":
            self._echo(iteration_line(iteration), "debug", "iteration", asdict(iteration))
            return
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
