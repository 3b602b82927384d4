"""The closing table of a batch has a line a run, and the last line counts them."""

import pytest

from des_cli.batch.summary import SummaryRow
from des_cli.cli.console import QUIET, Console
from des_cli.cli.summary_table import print_closing, print_table
from des_cli.errors import ExitCode
from tests.support.summaries import result, with_change

FAILED = result(
    exit_code=ExitCode.NO_SOLUTION, complaints=("c: infeasible",), metrics=None, state="failed"
)
TURNING = "fidelity.seat_angular_acceleration_peak_ratio"


def test_a_line_a_run(capsys: pytest.CaptureFixture[str]) -> None:
    kept = with_change(TURNING, 1.0996)
    rows = [SummaryRow.of(each) for each in (result(name="longer"), FAILED, kept)]
    print_table(Console(), rows)
    assert [line.split("  ", 1)[0] for line in capsys.readouterr().err.splitlines()] == [
        "",
        "profile",
        "longer",
        "c",
        "c",
    ]
    print_table(Console(), rows)
    assert capsys.readouterr().err == (
        "                           cross-  seat rate    G off  turning\n"
        "profile  status          coupling        off  [g rms]     peak  exit\n"
        "longer   converged    45.8 % less      9.1 %   0.0834        -     0\n"
        "c        no solution            -          -        -        -     4\n"
        "c        converged    45.8 % less      9.1 %   0.0834   1.10 x     0\n"
    )


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({"state": "kept"}, "converged, kept"),
        ({"state": "kept", "metrics": None}, "kept"),
        ({"state": "failed", "exit_code": ExitCode.PROFILE}, "rejected"),
        ({"state": "failed", "exit_code": ExitCode.FILE}, "failed"),
        ({"state": "failed", "exit_code": ExitCode.NOT_RELEASED}, "not released"),
    ],
)
def test_how_a_run_ended(
    capsys: pytest.CaptureFixture[str], changes: dict[str, object], status: str
) -> None:
    print_table(Console(), [SummaryRow.of(result(**changes))])
    assert f" {status}  " in capsys.readouterr().err.splitlines()[2]


def test_what_is_planned_or_quiet_has_no_table(capsys: pytest.CaptureFixture[str]) -> None:
    print_table(Console(), [SummaryRow.of(result(state="planned", metrics=None))])
    console = Console()
    console.verbosity = QUIET
    print_table(console, [SummaryRow.of(result())])
    assert capsys.readouterr().err == ""


def test_closing_counts_every_profile_once(capsys: pytest.CaptureFixture[str]) -> None:
    ends = [result(), result(state="kept"), result(exit_code=ExitCode.PROFILE, state="failed")]
    print_closing(Console(), [SummaryRow.of(end) for end in ends], 5)
    words = "5 profiles: 1 done, 1 already done, 1 failed, 2 not run (--keep-going runs them all)\n"
    assert capsys.readouterr().err == words
