"""Commands whose help lists options under headings."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Final, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])

PROFILE: Final = "Profile"
RECORD: Final = "Record"
REDUCTION: Final = "Reduction"
MACHINE: Final = "Machine"
STATE: Final = "State of the joints"
CURVE: Final = "Curve"
PACE: Final = "Pace"
OUTPUT: Final = "Output"
ROWS: Final = "Rows"
BATCH: Final = "Batch"
CLUSTER: Final = "Cluster"
STORE: Final = "Store"
GENERAL: Final = "General"

_FIRST_COLUMN = 30
"""Width of the column of options; what is longer stands on a line of its own."""


class Option(click.Option):
    """An option that knows the heading below which the help lists it.

    Parameters
    ----------
    heading : str
    """

    def __init__(self, *args: Any, heading: str = GENERAL, **values: Any) -> None:
        super().__init__(*args, **values)
        self.heading = heading


def option(heading: str, *names: str, **values: Any) -> Callable[[F], F]:
    """Return `click.option` for a heading."""
    return click.option(*names, cls=Option, heading=heading, **values)


class Command(click.Command):
    """A command of which the help lists the options by heading."""

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options below their headings, all in the same columns."""
        for heading, options in options_by_heading(self, ctx):
            records = [each.get_help_record(ctx) for each in options]
            (first, text), *rest = [record for record in records if record is not None]
            # A list is as wide as its widest name; all shall be as wide as each other.
            with formatter.section(heading):
                formatter.write_dl([(first.ljust(_FIRST_COLUMN), text), *rest])


def options_by_heading(
    command: click.Command, context: click.Context
) -> Iterator[tuple[str, list[click.Option]]]:
    """Yield the headings of a command in the order of its options, the general ones last."""
    found: dict[str, list[click.Option]] = {}
    for parameter in command.get_params(context):
        if isinstance(parameter, click.Option) and not parameter.hidden:
            found.setdefault(getattr(parameter, "heading", GENERAL), []).append(parameter)
    general = found.pop(GENERAL, [])
    yield from found.items()
    if general:
        yield GENERAL, general
