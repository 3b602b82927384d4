"""The help of a command lists its options under headings."""

import re

import click
import pytest

from des_cli.cli.command import GENERAL, options_by_heading
from des_cli.cli.main import COMMANDS, program


def command(name: str) -> click.Command:
    found = program.get_command(click.Context(program), name)
    assert found is not None
    return found


def headings(name: str) -> dict[str, list[str]]:
    shown = command(name)
    found = options_by_heading(shown, click.Context(shown))
    return {heading: [each.opts[-1] for each in options] for heading, options in found}


def test_the_options_of_reduce_stand_by_what_they_are_for() -> None:
    found = headings("reduce")
    assert list(found) == [
        *("Profile", "Record", "Reduction", "Output", "Rows", "Batch", "Cluster", "General")
    ]
    assert {"--budget", "--r2", "--ends"} < set(found["Reduction"])
    assert {"--out", "--overwrite", "--no-plots"} < set(found["Output"])
    assert found["Cluster"] == ["--scheduler"]


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_listed_once_and_only_what_all_have_is_general(name: str) -> None:
    found = headings(name)
    listed = [option for options in found.values() for option in options]
    options = [each for each in command(name).params if isinstance(each, click.Option)]
    assert sorted(listed) == sorted(["--help", *(each.opts[-1] for each in options)])
    assert found[GENERAL] == headings("schema")[GENERAL]
    assert list(found)[-1] == GENERAL


def test_all_lists_have_the_same_columns(invoke) -> None:
    text = invoke("reduce", "--help").stdout
    begins = {len(match[0]) for match in re.finditer(r"^  -.{1,27}  +(?=[A-Z])", text, re.M)}
    assert begins == {34}
    assert "RANGE" not in text
