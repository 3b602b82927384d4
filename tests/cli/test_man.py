"""Every command has a manual page that names its options, in roff that has no faults."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from des_cli.cli.main import COMMANDS, PROGRAM, program
from des_cli.cli.man import ENDINGS, man_pages, write_man_pages
from des_cli.errors import ExitCode

PAGES = {f"{PROGRAM}.1": program} | {
    f"{PROGRAM}-{name}.1": program.get_command(click.Context(program), name) for name in COMMANDS
}


@pytest.fixture(scope="module")
def pages() -> dict[str, str]:
    return man_pages()


def plain(page: str) -> str:
    """Take the signs of roff out of a page."""
    signs = {
        r"\[u2026]": "…",
        r"\-": "-",
        r"\fB": "",
        r"\fI": "",
        r"\fR": "",
        r"\(aq": "'",
        r"\(ha": "^",
    }
    for sign, text in signs.items():
        page = page.replace(sign, text)
    return page


@pytest.mark.parametrize("name", PAGES)
def test_a_page_names_every_option_and_what_it_is_for(pages: dict[str, str], name: str) -> None:
    command = PAGES[name]
    assert command is not None
    text = plain(pages[name])
    for parameter in command.get_params(click.Context(command)):
        if isinstance(parameter, click.Option):
            for option in parameter.opts:
                assert re.search(rf"^(-\w, )?{re.escape(option)}\b", text, re.M), option
            # Roff fills lines anew.
            said = " ".join((parameter.help or "").split())
            assert said in " ".join(text.split())
    for section in ("NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "SEE ALSO"):
        assert f"\n.SH {section}\n" in text


def test_there_is_a_page_for_each_command_and_no_other(pages: dict[str, str]) -> None:
    assert pages.keys() == PAGES.keys()
    assert all(f"{PROGRAM}-{name}(1)" in plain(pages[f"{PROGRAM}.1"]) for name in COMMANDS)
    assert all(code in ENDINGS for code in ExitCode)


def test_pages_are_ascii_and_the_same_for_a_date(
    pages: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert all(page.isascii() for page in pages.values())
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    assert '"1970-01-02"' in man_pages()[f"{PROGRAM}.1"].splitlines()[0]


def test_examples_stay_as_they_are(pages: dict[str, str]) -> None:
    text = plain(pages[f"{PROGRAM}-reduce.1"])
    block = text.partition(".SH EXAMPLES\n.nf\n")[2].partition(".fi")[0]
    assert "des-coriolis reduce log.csv --column t_s=time -o commands.csv\n" in block


@pytest.mark.parametrize(
    "checker",
    [("mandoc", "-Tlint", "-Wwarning"), ("groff", "-man", "-Tutf8", "-wall", "-z")],
    ids=lambda checker: checker[0],
)
def test_what_reads_manual_pages_finds_no_fault(checker: tuple[str, ...], tmp_path: Path) -> None:
    if shutil.which(checker[0]) is None:
        pytest.skip(f"there is no {checker[0]}")
    result = CliRunner().invoke(write_man_pages, [str(tmp_path / "man1")])
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr == f"{len(PAGES)} pages in {tmp_path / 'man1'}\n"
    for page in sorted((tmp_path / "man1").iterdir()):
        done = subprocess.run([*checker, str(page)], capture_output=True, text=True, check=False)
        assert done.stdout + done.stderr == ""
