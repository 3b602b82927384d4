"""Dispatch, the exit code of every kind of ending, and the group's options."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import click
import pytest

from des_cli import __version__
from des_cli.cli import main as main_module
from des_cli.cli import schema as schema_module
from des_cli.cli.main import COMMANDS, program
from des_cli.errors import Complaint, NoSolutionError


@pytest.fixture
def failing(monkeypatch: pytest.MonkeyPatch) -> Callable[[BaseException], None]:
    """Let the command ``schema`` raise."""

    def arrange(error: BaseException) -> None:
        @click.command()
        def schema() -> None:
            raise error

        monkeypatch.setattr(schema_module, "schema", schema)

    return arrange


def test_every_command_shows_an_example_in_its_help(invoke) -> None:
    for name in COMMANDS:
        result = invoke(name, "--help")
        assert result.exit_code == 0
        assert f"des-coriolis {name}" in result.stdout.partition("Example")[2]


def test_group_lists_every_command(invoke) -> None:
    result = invoke("--help")
    assert result.exit_code == 0
    assert all(f"\n  {name} " in result.stdout for name in COMMANDS)
    assert "..." not in result.stdout.partition("Commands:")[2], "a summary is cut short"


def test_version(invoke) -> None:
    assert invoke("--version").stdout == f"des-coriolis {__version__}\n"
    assert invoke("-V").stdout == f"des-coriolis {__version__}\n"


@pytest.mark.parametrize(
    "args",
    [
        [],
        ["redcue"],
        ["--frobnicate"],
        ["reduce"],
        ["reduce", "cobra", "--method", "least"],
        ["schema", "surplus"],
        ["--color", "sometimes", "schema"],
    ],
    ids=" ".join,
)
def test_wrong_use_is_2_on_stderr(invoke, args: list[str]) -> None:
    result = invoke(*args)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert "Usage: des-coriolis" in result.stderr


def test_own_error_prints_each_problem_on_a_line(invoke, failing) -> None:
    failing(NoSolutionError([Complaint("a", "first"), Complaint("b", "second")]))
    result = invoke("schema")
    assert (result.exit_code, result.stdout, result.stderr) == (4, "", "a: first\nb: second\n")


def test_operating_system_error_is_1(invoke, failing) -> None:
    failing(PermissionError(13, "Permission denied", "x.csv"))
    result = invoke("schema")
    assert (result.exit_code, result.stderr) == (1, "x.csv: Permission denied\n")


def test_interruption_is_130(invoke, failing) -> None:
    failing(KeyboardInterrupt())
    result = invoke("schema")
    assert (result.exit_code, result.stderr) == (130, "interrupted\n")


def test_a_bug_is_70_in_one_line(invoke, failing) -> None:
    failing(RuntimeError("no such luck\nand more"))
    result = invoke("schema")
    assert result.exit_code == 70
    assert result.stderr == "bug: RuntimeError: no such luck (DES_CORIOLIS_DEBUG=1 prints where)\n"


@pytest.mark.parametrize(
    ("args", "env"),
    [(["-vv", "schema"], {}), (["schema"], {"DES_CORIOLIS_DEBUG": "1"})],
    ids=["-vv", "DES_CORIOLIS_DEBUG"],
)
def test_the_traceback_of_a_bug_is_printed_on_demand(invoke, failing, args, env) -> None:
    failing(RuntimeError("no such luck"))
    result = invoke(*args, env=env)
    assert result.exit_code == 70
    assert result.stderr.startswith("Traceback (most recent call last):\n")
    assert result.stderr.endswith("\nbug: RuntimeError: no such luck\n")


def test_colors_only_when_wanted(invoke, failing) -> None:
    failing(NoSolutionError([Complaint("a", "first")]))
    assert "\x1b[" not in invoke("schema").stderr
    assert "\x1b[" in invoke("--color", "always", "schema").stderr
    assert "\x1b[" in invoke("--color", "always", "schema", env={"NO_COLOR": "1"}).stderr
    assert "\x1b[" not in invoke("--color", "never", "schema").stderr


def test_a_terminal_has_colors_unless_no_color_is_set(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setenv("TERM", "xterm")
    for value, colored in (("", True), ("1", False)):
        monkeypatch.setenv("NO_COLOR", value)
        assert main_module.Console().color is colored
    monkeypatch.delenv("NO_COLOR")
    monkeypatch.setenv("TERM", "dumb")
    assert not main_module.Console().color


def test_every_registered_command_can_be_imported() -> None:
    context = click.Context(program)
    assert [program.get_command(context, name).name for name in COMMANDS] == list(COMMANDS)  # type: ignore[union-attr]


@pytest.mark.skipif(os.name != "posix", reason="pipes of a POSIX shell")
@pytest.mark.parametrize("args", [["schema"], ["reduce", "--help"]], ids=" ".join)
def test_a_reader_that_went_away_is_141_without_a_word(
    args: list[str], tmp_path: Path, python_environment: dict[str, str]
) -> None:
    read, write = os.pipe()
    os.close(read)
    try:
        done = subprocess.run(
            [sys.executable, "-m", "des_cli", *args],
            stdout=write,
            stderr=subprocess.PIPE,
            env=python_environment,
            cwd=tmp_path,
            check=False,
        )
    finally:
        os.close(write)
    assert (done.returncode, done.stderr) == (141, b"")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
@pytest.mark.parametrize("args", [["schema"], ["reduce", "--help"]], ids=" ".join)
def test_a_full_disk_is_1_in_one_line(command, args: list[str]) -> None:
    with open("/dev/full", "wb") as full:
        done = command(*args, stdout=full, stderr=subprocess.PIPE, capture_output=False)
    assert (done.returncode, done.stderr) == (1, b"No space left on device\n")


@pytest.mark.skipif(os.name != "posix", reason="a closed descriptor of a POSIX shell")
def test_a_closed_stdout_is_1_in_one_line(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    line = [f"{sys.executable} -m des_cli schema >&-"]
    done = subprocess.run(
        ["sh", "-c", *line],
        stderr=subprocess.PIPE,
        env=python_environment,
        cwd=tmp_path,
        check=False,
    )
    assert (done.returncode, done.stderr) == (1, b"stdout: is closed\n")


@pytest.mark.parametrize(("debug", "shown"), [("", False), ("1", True)])
def test_warnings_of_python_reach_only_who_mends_the_tool(
    python_environment: dict[str, str], tmp_path: Path, debug: str, shown: bool
) -> None:
    """Of a command here, and of whatever process it starts."""
    (tmp_path / "try.py").write_text(
        "import subprocess, sys, warnings\n"
        "from des_cli.cli import main\n"
        "def program():\n"
        "    warnings.warn('here', RuntimeWarning)\n"
        "    code = \"import warnings; warnings.warn('there', RuntimeWarning)\"\n"
        "    subprocess.run([sys.executable, '-c', code])\n"
        "main.program.main = program\n"
        "main.main()\n"
    )
    done = subprocess.run(
        [sys.executable, "try.py"],
        capture_output=True,
        cwd=tmp_path,
        env=python_environment | {"DES_CORIOLIS_DEBUG": debug},
        check=False,
    )
    assert [word in done.stderr.decode() for word in ("here", "there")] == [shown, shown]
