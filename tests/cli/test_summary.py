"""The summary says in words what the metrics hold."""

from dataclasses import replace

import pytest

from des_cli.batch.job import JobResult
from des_cli.cli.console import Console
from des_cli.cli.summary import print_result
from des_cli.errors import ExitCode
from des_cli.model.notice import Notice
from tests.support.summaries import result, with_change


def printed(capsys: pytest.CaptureFixture[str], shown: JobResult, *, alone: bool) -> list[str]:
    print_result(Console(), shown, alone=alone)
    return capsys.readouterr().err.splitlines()


def test_a_ride_that_got_worse_is_the_first_line(capsys: pytest.CaptureFixture[str]) -> None:
    lines = printed(capsys, result(), alone=True)
    felt = "cross-coupling 45.8 % less, seat rate off by 9.1 %, G off by 0.0834 g rms"
    assert lines[0] == f"c: {felt}"
    worse = with_change("felt.seat_angular_acceleration.magnitude.rms_after_rad_s2", 2.2)
    lines = printed(capsys, worse, alone=True)
    told = "worse to sit in: total angular acceleration 0.462 -> 2.2 rad/s² rms"
    assert lines[0] == f"c: {told}"
    assert lines[1].startswith("  bounded by     a budget on seat_angular_acceleration_rms_ratio")
    assert lines[2] == f"  felt           {felt}"
    assert not any("2.2" in line for line in lines[1:]), "nothing is said twice"
    (line,) = printed(capsys, worse, alone=False)
    assert told in line
    assert f"{felt}, BB3 68.9 % less" in line
    (line,) = printed(capsys, result(), alone=False)
    assert "worse" not in line


USED = "; used at most: rate 50.0 % (arm), acceleration 50.0 % (arm)"


@pytest.mark.parametrize(
    ("violations", "words"),
    [
        ((), f"limits         all kept{USED}"),
        (("desired arm rate",), f"limits         kept by the modified motion{USED}"),
        (("desired arm rate", "modified arm rate"), None),
    ],
)
def test_who_keeps_the_limits(
    capsys: pytest.CaptureFixture[str], violations: tuple[str, ...], words: str | None
) -> None:
    print_result(Console(), result(violations=violations), alone=True)
    lines = [line.strip() for line in capsys.readouterr().err.splitlines()]
    assert [line for line in lines if "kept" in line] == ([words] if words else [])
    assert [line for line in lines if line.endswith("arm rate")] == [
        f"limits         {line}" for line in violations
    ]


def test_violations_are_named_even_when_quiet(capsys: pytest.CaptureFixture[str]) -> None:
    console = Console()
    console.verbosity = -1
    print_result(console, result(violations=("arm too fast", "cab too fast")), alone=True)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert [line.split(maxsplit=1)[1] for line in captured.err.splitlines()] == [
        "arm too fast",
        "cab too fast",
    ]


def test_a_failed_result_prints_its_problems_alone(capsys: pytest.CaptureFixture[str]) -> None:
    failed = result(exit_code=ExitCode.NO_SOLUTION, complaints=("c: infeasible",), state="failed")
    print_result(Console(), failed, alone=True)
    assert capsys.readouterr().err == "c: infeasible\n"


def test_a_result_that_is_counted_has_a_line_only_with_something_below_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    def lines(shown: JobResult) -> int:
        print_result(Console(), shown, alone=False, counted=True)
        return len(capsys.readouterr().err.splitlines())

    assert lines(result()) == 0
    assert lines(result(state="kept")) == 0
    assert lines(result(violations=("arm too fast",))) == 2
    assert lines(result(state="planned")) == 1
    assert lines(result(exit_code=ExitCode.PROFILE, complaints=("no",), state="failed")) == 1


NOTICES = (Notice("worse", "worse to sit in than the profile: much"), Notice("record", "trimmed"))


def test_a_notice_that_the_first_line_tells_is_told_only_where_there_is_no_first_line(
    capsys: pytest.CaptureFixture[str],
) -> None:
    worse = with_change("felt.seat_angular_acceleration.magnitude.rms_after_rad_s2", 2.2)
    worse = replace(worse, notices=NOTICES)
    lines = printed(capsys, worse, alone=True)
    assert [line for line in lines if " notice " in line] == ["  notice         trimmed"]
    first, *below = printed(capsys, worse, alone=False)
    assert "worse" not in first
    assert [line.split(maxsplit=1)[1] for line in below] == [str(each) for each in NOTICES]
    console = Console()
    console.verbosity = -1
    for alone, whose in ((True, ""), (False, "c: ")):
        print_result(console, worse, alone=alone)
        assert capsys.readouterr().err == f"  notice         {whose}{NOTICES[0]}\n"
