"""What a command reads and how: its options, each refused in words where it says nothing."""

from __future__ import annotations

import io
from types import SimpleNamespace

import click
import pytest
from click.testing import CliRunner

from des_cli.cli.source_options import (
    machine_option,
    machine_settings,
    read_stdin,
    setting_options,
    source_of,
)
from des_cli.errors import FileAccessError
from des_cli.profiles_in.caps import Caps

FOUND: dict[str, object] = {}


@click.command()
@setting_options
@machine_option
def reader(**options: object) -> None:
    """Keep what the options mean."""
    FOUND.clear()
    FOUND.update(options)


def read(*args: str) -> dict[str, object]:
    result = CliRunner().invoke(reader, args)
    assert result.exit_code == 0, result.output
    return dict(FOUND)


def test_options_mean_what_they_say() -> None:
    found = read(
        "--set", "a.b=1", "--set", "c=x=y", "--column", "t_s=time (s)", "--separator", "tab"
    )
    assert found["settings"] == ("a.b=1", "c=x=y")
    assert found["columns"] == {"t_s": "time (s)"}
    assert (found["separator"], found["decimal"], found["machine"]) == ("\t", None, None)


@pytest.mark.parametrize(
    "order", [("--gap", "split", "--set", "a=1"), ("--set", "a=1", "--gap", "split")]
)
def test_gap_is_the_last_setting_wherever_it_stands(order: tuple[str, ...]) -> None:
    settings = read(*order)["settings"]
    assert isinstance(settings, tuple)
    assert [str(each) for each in settings] == ["a=1", 'gap="split"']


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["--set", "a"], "'a' is not KEY=VALUE"),
        (["--set", " =1"], "' =1' is not KEY=VALUE"),
        (["--column", "t_s"], "'t_s' is not NAME=HEADER"),
        (["--column", "=t"], "'=t' is not NAME=HEADER"),
        (["--column", "t_s="], "'t_s=' is not NAME=HEADER"),
        (["--column", "t_s=a", "--column", "t_s=b"], "'t_s' is given twice"),
        (["--separator", "#"], "'#': "),
        (["--decimal", ";"], "';': "),
        (["--machine", " "], "is empty: name a machine or a file"),
        (["--gap", "jump"], "'jump' is not one of"),
    ],
)
def test_what_says_nothing_is_wrong_use(args: list[str], words: str) -> None:
    result = CliRunner().invoke(reader, args)
    assert result.exit_code == 2
    assert words in result.output


def test_the_machine_stands_before_the_settings_that_change_it() -> None:
    source = source_of(
        "x.csv", ("machine.gravity_m_s2=9.8",), machine="m.yaml", stdin=b"not its own"
    )
    assert [str(each) for each in source.settings] == [
        'machine="m.yaml"',
        "machine.gravity_m_s2=9.8",
    ]
    assert source.stdin is None
    assert source_of("-", (), machine=None, stdin=b"its own").stdin == b"its own"
    assert machine_settings(None) == ()


def test_stdin_is_read_once_and_only_where_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", SimpleNamespace(buffer=io.BytesIO(b"profile")))
    assert read_stdin(("a.yaml", "b.yaml"), Caps()) is None
    with pytest.raises(click.UsageError, match="only once"):
        read_stdin(("-", "-"), Caps())
    assert read_stdin(("a.yaml", "-"), Caps()) == b"profile"
    monkeypatch.setattr("sys.stdin", None)
    with pytest.raises(FileAccessError, match="stdin: is closed"):
        read_stdin(("-",), Caps())


def test_stdin_is_read_no_further_than_its_cap(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.BytesIO(bytes(3 << 20))
    monkeypatch.setattr("sys.stdin", SimpleNamespace(buffer=stream))
    with pytest.raises(FileAccessError, match="<stdin>: is larger than 1 MiB; --max-mib"):
        read_stdin(("-",), Caps(mib=1))
    assert stream.tell() == (1 << 20) + 1
