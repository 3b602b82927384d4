"""Manual pages, made from the commands: ``python -m des_cli.cli.man FOLDER``.

What the help of a command says, its page says: nothing is written twice.
"""

from __future__ import annotations

import os
import re
import time
from collections.abc import Iterator
from pathlib import Path
from textwrap import wrap

import click

from des_cli import __version__
from des_cli.cli.command import options_by_heading
from des_cli.cli.console import DEBUG_VARIABLE
from des_cli.cli.main import COMMANDS, PROGRAM, program
from des_cli.errors import ExitCode

ENDINGS = {
    ExitCode.DONE: "Done.",
    ExitCode.FILE: "A file could not be read or written, or a part of a batch failed.",
    ExitCode.USAGE: "Wrong use.",
    ExitCode.PROFILE: "A profile, a run or a table was rejected.",
    ExitCode.NO_SOLUTION: "No solution.",
    ExitCode.NOT_RELEASED: "Solved, but the verification, a limit or a notice stands against it.",
    ExitCode.BUG: "A bug in the program.",
    ExitCode.HUNG_UP: "Hung up.",
    ExitCode.INTERRUPTED: "Interrupted.",
    ExitCode.READER_GONE: "The reader of standard output went away.",
    ExitCode.TERMINATED: "Terminated.",
}

ENVIRONMENT = {
    "NO_COLOR": "Set and not empty: no colors, unless --color asks for them.",
    DEBUG_VARIABLE: "Set and not empty: a bug prints its traceback.",
}

_SIGNS = {"\\": "\\e", "-": "\\-", "'": "\\(aq", "^": "\\(ha", "~": "\\(ti", "`": "\\(ga"}
"""What roff would take for something else, or set as another sign."""

_WIDTH = 70
"""Columns of a line of the source."""

_TITLE = re.compile(r"^(\w+):$")


def man_pages() -> dict[str, str]:
    """Return the pages by the names of their files: one of the program, and one a command."""
    pages = {f"{PROGRAM}.1": _page(program, PROGRAM, "reduce what a pilot feels of a centrifuge")}
    for name, text in COMMANDS.items():
        command = program.get_command(click.Context(program), name)
        assert command is not None
        summary = text[0].lower() + text[1:].removesuffix(".")
        pages[f"{PROGRAM}-{name}.1"] = _page(command, f"{PROGRAM} {name}", summary)
    return pages


def _page(command: click.Command, name: str, summary: str) -> str:
    context = click.Context(command, info_name=name, max_content_width=100)
    page = name.replace(" ", "-")
    lines = [
        f'.TH "{page.upper()}" "1" "{_date()}" "{PROGRAM} {__version__}" "User Commands"',
        *(".SH NAME", f"{_roff(page)} \\- {_roff(summary)}"),
        *(
            ".SH SYNOPSIS",
            f".B {_roff(name)}",
            _roff(" ".join(command.collect_usage_pieces(context))),
        ),
        ".SH DESCRIPTION",
        *_paragraphs(command.help or ""),
    ]
    if command is program:
        lines += [".SH COMMANDS"]
        for each, text in COMMANDS.items():
            lines += _item(f"\\fB{_roff(each)}\\fR", f"{text} See {PROGRAM}-{each}(1).")
    lines += [".SH OPTIONS", *_options(command, context), *_epilog(command.epilog or "")]
    lines += [".SH EXIT STATUS"]
    for code, text in ENDINGS.items():
        lines += _item(f"\\fB{int(code)}\\fR", text)
    lines += [".SH ENVIRONMENT"]
    for variable, text in ENVIRONMENT.items():
        lines += _item(f"\\fB{_roff(variable)}\\fR", text)
    others = [f"{PROGRAM}-{each}" for each in COMMANDS] if command is program else [PROGRAM]
    lines += [".SH SEE ALSO"]
    lines += [f".BR {_roff(each)} (1)," for each in others[:-1]]
    lines += [f".BR {_roff(others[-1])} (1)"]
    return "\n".join(lines) + "\n"


def _options(command: click.Command, context: click.Context) -> Iterator[str]:
    headings = list(options_by_heading(command, context))
    for heading, options in headings:
        if len(headings) > 1:
            yield f".SS {_roff(heading)}"
        for option in options:
            record = option.get_help_record(context)
            if record is not None:
                yield from _item(_names(record[0]), record[1])


def _names(text: str) -> str:
    r"""Set options bold, and what they take in italics.

    >>> print(_names("-o, --out DIR|FILE"))
    \fB\-o\fR, \fB\-\-out\fR \fIDIR|FILE\fR
    """
    parts = [
        f"\\fB{_roff(option)}\\fR{comma or ' '}" if option else f"\\fI{_roff(value)}\\fR"
        for option, comma, value in re.findall(r"(--?[\w-]+)(, )?|(\S.*)", text)
    ]
    return "".join(parts).strip()


def _epilog(text: str) -> Iterator[str]:
    """Yield a section for each titled block of what stands below the options."""
    for block in re.split(r"\n\s*\n", text.replace("\b\n", "")):
        title, *body = block.strip("\n").split("\n")
        found = _TITLE.match(title)
        if found:
            yield f".SH {found[1].upper()}"
            yield from (".nf", *(_line(line.strip()) for line in body), ".fi")


def _paragraphs(text: str) -> Iterator[str]:
    for at, part in enumerate(re.split(r"\n\s*\n", text.strip())):
        if at:
            yield ".PP"
        yield from _lines(part)


def _item(name: str, text: str) -> list[str]:
    return [".TP", name, *_lines(text)]


def _lines(text: str) -> list[str]:
    """Write text as short lines, which roff fills."""
    words = " ".join(text.split())
    return [_line(each) for each in wrap(words, _WIDTH, break_on_hyphens=False)]


def _line(text: str) -> str:
    """Write a line of text: what begins with a sign of roff would be a request."""
    plain = _roff(text)
    return f"\\&{plain}" if plain.startswith(".") else plain


def _roff(text: str) -> str:
    r"""Write text for roff, in ASCII.

    >>> print(_roff("--r2 2^3 °"))
    \-\-r2 2\(ha3 \[u00B0]
    """
    return "".join(
        _SIGNS.get(each, each if each.isascii() else f"\\[u{ord(each):04X}]") for each in text
    )


def _date() -> str:
    """Return the day of the page; packagers set it, so that the same source gives the same page."""
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH") or time.time())
    return time.strftime("%Y-%m-%d", time.gmtime(seconds))


@click.command()
@click.argument("folder", type=click.Path(file_okay=False, path_type=Path))
def write_man_pages(folder: Path) -> None:
    """Write the manual pages into FOLDER, such as ~/.local/share/man/man1."""
    pages = man_pages()
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in pages.items():
        (folder / name).write_text(text, encoding="ascii")
    click.echo(f"{len(pages)} pages in {folder}", err=True)


if __name__ == "__main__":
    write_man_pages(prog_name="python -m des_cli.cli.man")
