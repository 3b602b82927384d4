"""Check what the documentation promises against the tool.

Relative links resolve, headings that links point at exist, every command of a
``console`` block exists with its options, every command has a section in
``docs/cli.md`` that names each of its options and figures, the tables of
``docs/architecture.md`` name the modules of their rooms, sessions of nox that pages name
exist, ``docs/formats.md`` names every key of a profile and of a machine, every preset and
every exit code, and the pages of ``docs/reference`` are what ``reference.py`` writes.
"""

from __future__ import annotations

import ast
import re
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
from reference import pages as written_pages
from reference import stale

from des_cli.cli.main import COMMANDS, PROGRAM, program
from des_cli.cli.plot import FIGURES
from des_cli.errors import ExitCode
from des_cli.profiles_in.schema import profile_json_schema
from des_cli.runs_out.forms import PRESETS
from des_cli.units import split_unit

ROOT = Path(__file__).resolve().parent.parent
CLI_PAGE = ROOT / "docs" / "cli.md"
FORMATS = ROOT / "docs" / "formats.md"
ARCHITECTURE = ROOT / "docs" / "architecture.md"

FENCE = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)[^)]*\)")
HEADING = re.compile(r"^#+ +(.+?) *$", re.MULTILINE)
ROOM = re.compile(r"^\| module of `([\w/]+)` \|[^\n]*\n\|[-|]+\n((?:\|[^\n]*\n)+)", re.MULTILINE)
SESSIONS = re.compile(r"`nox -s ((?:\w+ ?)+)")
SHELL_BREAKS = {"|", "||", "&&", ";", ">", ">>", "<", "2>"}


def main() -> int:
    """Print every finding as a line; the exit code tells whether there was one."""
    pages = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])
    findings = []
    for page in pages:
        text = page.read_text(encoding="utf-8")
        findings += [f"{page.relative_to(ROOT)}: {what}" for what in _findings(page, text)]
    findings += [f"{CLI_PAGE.relative_to(ROOT)}: {what}" for what in _undocumented()]
    findings += [f"{ARCHITECTURE.relative_to(ROOT)}: {what}" for what in _misplaced()]
    findings += [f"{FORMATS.relative_to(ROOT)}: {what}" for what in _unnamed()]
    findings += stale(written_pages())
    for finding in findings:
        print(finding, file=sys.stderr)
    if not findings:
        print(f"{len(pages)} pages: links, commands, options, keys, columns and modules are right")
    return bool(findings)


def _findings(page: Path, text: str) -> Iterator[str]:
    for target in LINK.findall(FENCE.sub("", text)):
        if not re.match(r"[a-z]+:", target):
            yield from _check_link(page, target)
    for language, block in FENCE.findall(text):
        if language == "console":
            for line in _command_lines(block):
                yield from _check_command(line)
    for name in {name for names in SESSIONS.findall(text) for name in names.split()}:
        if name not in _sessions():
            yield f"nox has no session {name}"


def _check_link(page: Path, target: str) -> Iterator[str]:
    name, _, anchor = target.partition("#")
    linked = (page.parent / name).resolve() if name else page
    if not linked.exists():
        yield f"the link to {target} leads nowhere"
    elif anchor and linked.suffix == ".md":
        headings = HEADING.findall(FENCE.sub("", linked.read_text(encoding="utf-8")))
        if anchor not in map(_anchor, headings):
            yield f"the link to {target} names no heading"


def _anchor(heading: str) -> str:
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def _command_lines(block: str) -> Iterator[list[str]]:
    """Yield the arguments of every call of the tool after a ``$`` prompt."""
    for line in block.replace("\\\n", " ").splitlines():
        if not line.startswith("$ "):
            continue
        words = shlex.split(line[2:], comments=True)
        while words:
            end = next((i for i, word in enumerate(words) if word in SHELL_BREAKS), len(words))
            if Path(words[0]).name == PROGRAM:
                yield words[1:end]
            words = words[end + 1 :]


def _check_command(words: list[str]) -> Iterator[str]:
    shown = shlex.join([PROGRAM, *words])
    context = click.Context(program, info_name=PROGRAM)
    known = _options(program)
    while words and words[0] not in COMMANDS:
        option = words.pop(0)
        if option.partition("=")[0] not in known:
            yield f"{shown}: {option} is neither a command nor an option of the group"
            return
        if option == "--color":
            words.pop(0)
    if not words:
        return
    command = program.get_command(context, words[0])
    assert command is not None
    known = _options(command)
    for word in words[1:]:
        if re.match(r"--?[a-zA-Z]", word) and word.partition("=")[0] not in known:
            yield f"{shown}: there is no option {word}"


def _undocumented() -> Iterator[str]:
    """Yield what docs/cli.md does not say about a command."""
    text = CLI_PAGE.read_text(encoding="utf-8") if CLI_PAGE.exists() else ""
    sections = dict(re.findall(r"^## (.+?) *\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL))
    context = click.Context(program, info_name=PROGRAM)
    common = "\n".join(body for title, body in sections.items() if title not in COMMANDS)
    for name in COMMANDS:
        if name not in sections:
            yield f"has no section '## {name}'"
            continue
        command = program.get_command(context, name)
        assert command is not None
        said = sections[name] + common
        for option in sorted(_options(command)):
            if option.startswith("--") and f"`{option}" not in said:
                yield f"'## {name}' does not name `{option}`"
    for name in FIGURES:
        if f"`{name}`" not in sections["plot"]:
            yield f"'## plot' does not name the figure `{name}`"


def _unnamed() -> Iterator[str]:
    """Yield what docs/formats.md does not say of what may stand in a file."""
    text = FORMATS.read_text(encoding="utf-8")
    quoted = [block for _, block in FENCE.findall(text)]
    quoted += re.findall(r"`([^`\n]+)`", FENCE.sub("", text))
    # Any unit of the quantity may stand where a key is named with one.
    named = {split_unit(word)[0] for words in quoted for word in re.findall(r"\w+", words)}
    for key in sorted(_keys(profile_json_schema())):
        if split_unit(key)[0] not in named:
            yield f"does not name the key `{key}`"
    for preset in PRESETS:
        if f"| `{preset}` |" not in text:
            yield f"does not name the preset `{preset}`"
    codes = text.partition("\n## Exit codes\n")[2]
    for code in ExitCode:
        if f"\n| {int(code)} |" not in codes:
            yield f"does not name the exit code {int(code)}"


def _keys(schema: Any) -> set[str]:
    """Return the names of all properties in a JSON Schema, wherever they stand."""
    if isinstance(schema, list):
        return set().union(*map(_keys, schema))
    if not isinstance(schema, dict):
        return set()
    own = set(schema.get("properties", {}))
    return own.union(*map(_keys, schema.values()))


def _misplaced() -> Iterator[str]:
    """Yield which modules a table of the rooms names wrongly, or lacks."""
    text = ARCHITECTURE.read_text(encoding="utf-8")
    for room, rows in ROOM.findall(text):
        cells = re.findall(r"^\| (.+?) \|", rows, re.MULTILINE)
        named = {name for cell in cells for name in re.findall(r"`(\w+)`", cell)}
        modules = {path.stem for path in (ROOT / "des_cli" / room).glob("*.py")} - {"__init__"}
        for name in sorted(named - modules):
            yield f"there is no module {name} in {room}"
        for name in sorted(modules - named):
            yield f"the table of {room} lacks {name}"


def _sessions() -> set[str]:
    """Return the names of the sessions of nox."""
    tree = ast.parse((ROOT / "noxfile.py").read_text(encoding="utf-8"))
    return {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}


def _options(command: click.Command) -> set[str]:
    with click.Context(command) as context:
        parameters = command.get_params(context)
    return {
        name for parameter in parameters for name in (*parameter.opts, *parameter.secondary_opts)
    }


if __name__ == "__main__":
    sys.exit(main())
