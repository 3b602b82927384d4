"""docs/howto: every command runs, ends as the page says, and prints what the page shows."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

from tests.support.console_blocks import LAST_CODE, Shell, commands_of, missing, write_files

ROOT = Path(__file__).parents[1]
PAGES = sorted((ROOT / "docs" / "howto").glob("*.md"))

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="the pages are written for a POSIX shell"),
]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_command_does_what_the_page_shows(
    page: Path, tmp_path: Path, python_environment: dict[str, str]
) -> None:
    text = page.read_text(encoding="utf-8")
    shutil.copytree(ROOT / "profiles", tmp_path / "profiles")
    write_files(text, tmp_path)
    shell = Shell(tmp_path, python_environment)
    commands = list(commands_of(text))
    assert commands
    before = ""
    for shown in commands:
        if shown.command != LAST_CODE:
            assert shell.code == 0, f"ends with {shell.code}: {before}"
        printed = shell.run(shown.command)
        assert not missing(shown, printed), (shown.command, printed)
        before = shown.command
    assert shell.code == 0, f"ends with {shell.code}: {before}"
