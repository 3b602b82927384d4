"""What is said, to whom, and in which colour."""

from __future__ import annotations

import io

import pytest

from des_cli.cli.console import DEBUG_VARIABLE, QUIET, VERBOSE, Console, iteration_line
from des_cli.errors import ExitCode, Failure
from des_cli.model.solution import Iteration

BUG = Failure(ExitCode.BUG, ("ZeroDivisionError: division by zero",), "Traceback of it\n")
STEP = Iteration(number=3, cost=0.25, infeasibility=1e-6, optimality=2e-3, step=0.5)


@pytest.fixture
def console(monkeypatch: pytest.MonkeyPatch) -> Console:
    for name in (DEBUG_VARIABLE, "NO_COLOR", "TERM"):
        monkeypatch.delenv(name, raising=False)
    return Console()


def test_words_go_to_stderr_and_quiet_keeps_what_warns(
    console: Console, capsys: pytest.CaptureFixture[str]
) -> None:
    console.say("plain")
    console.verbosity = QUIET
    console.say("unsaid")
    console.warn(["first", "second"])
    out, err = capsys.readouterr()
    assert (out, err) == ("", "plain\nfirst\nsecond\n")


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(
    ("environment", "choice", "colored"),
    [
        ({}, "auto", True),
        ({"NO_COLOR": "1"}, "auto", False),
        ({"NO_COLOR": ""}, "auto", True),
        ({"TERM": "dumb"}, "auto", False),
        ({"NO_COLOR": "1"}, "always", True),
        ({}, "never", False),
    ],
)
def test_colour_is_for_terminals_that_want_it(
    console: Console,
    monkeypatch: pytest.MonkeyPatch,
    environment: dict[str, str],
    choice: str,
    colored: bool,
) -> None:
    monkeypatch.setattr("sys.stderr", Terminal())
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    console.choose_color(choice)
    assert console.color is colored
    assert (console.style("x", "error") != "x") is colored


def test_no_terminal_no_colour(console: Console, monkeypatch: pytest.MonkeyPatch) -> None:
    for stream in (io.StringIO(), None):
        monkeypatch.setattr("sys.stderr", stream)
        console.choose_color("auto")
        assert not console.color


def test_a_bug_says_how_to_see_where(
    console: Console, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    console.failure(BUG)
    assert capsys.readouterr().err == (
        "ZeroDivisionError: division by zero (DES_CORIOLIS_DEBUG=1 prints where)\n"
    )
    monkeypatch.setenv(DEBUG_VARIABLE, "1")
    console.failure(BUG)
    assert capsys.readouterr().err == "Traceback of it\nZeroDivisionError: division by zero\n"


def test_a_mistake_of_the_user_never_shows_a_traceback(
    console: Console, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(DEBUG_VARIABLE, "1")
    console.failure(Failure(ExitCode.PROFILE, ("p.yaml:1: a", "p.yaml:2: b"), "never shown"))
    assert capsys.readouterr().err == "p.yaml:1: a\np.yaml:2: b\n"


def test_a_log_has_one_header_until_it_ends(
    console: Console, capsys: pytest.CaptureFixture[str]
) -> None:
    console.verbosity = VERBOSE
    for _ in range(2):
        console.iteration(STEP)
        console.iteration(STEP)
        console.end_log()
    lines = capsys.readouterr().err.splitlines()
    assert [line.split()[0] for line in lines] == ["iter", "3", "3", "iter", "3", "3"]
    assert len(lines[0]) == len(lines[1]) == len(iteration_line(STEP))
    assert iteration_line(STEP).split() == ["3", "0.25", "1.000e-06", "2.000e-03", "0.5000"]


def test_on_a_terminal_words_are_wrapped_and_tables_are_not(
    console: Console, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("des_cli.cli.console.columns_of", lambda stream: 40)
    console.choose_color("always")
    console.row("seat G", "tilt 4 deg at most, peak Gy 0.3 -> 0.4 g", "good")
    console.row("notice", "what was said of a \x1b[31mforged\nname", "warning", kind="notice")
    lines = capsys.readouterr().err.splitlines()
    assert lines[:2] == [
        "  seat G         \x1b[32mtilt 4 deg at most,",
        "                 peak Gy 0.3 -> 0.4 g\x1b[0m",
    ]
    assert "\\x1b[31mforged\\nname" in " ".join(lines[2:])
    console.table("a " * 30)
    assert len(capsys.readouterr().err.splitlines()) == 1
