"""The summary says in words what the metrics hold."""

import pytest

from des_cli.cli.console import Console
from des_cli.cli.summary import (
    change,
    exit_code_of,
    number,
    percent,
    print_closing,
    print_result,
    summary_rows,
)
from des_cli.errors import ExitCode
from des_cli.job import JobResult

METRICS = {
    "solver": {
        "method": "minimum",
        "algorithm": "optimum",
        "control": "scalar",
        "axes": "report",
        "status": "converged",
        "iterations": 6,
    },
    "coriolis": {
        key: {"reduction": value}
        for key, value in {
            "ab3": 0.3,
            "bb3": 0.689,
            "cb3": 0.1,
            "vector": 0.458,
            "seat_x": 0.401,
            "seat_y": 0.34,
            "seat_z": -0.031,
        }.items()
    },
    "fidelity": {
        "joint_deviation_relative": 0.1277,
        "joint_deviation_relative_squared": 0.0163,
        "seat_rate_deviation_relative": 0.0911,
        "seat_g_deviation_relative": 0.042,
        "seat_g_rms_error_g": 0.0834,
    },
    "baseline": {
        "report_sweep": {"reduction": 0.639, "joint_deviation_relative": 0.24},
        "constant_p": {"p": 0.767, "joint_deviation_relative": 0.233},
    },
}


def result(**changes: object) -> JobResult:
    values = {"source": "c.yaml", "name": "c", "metrics": METRICS, "objective": ("bb3",)}
    return JobResult(**values | {"written": "runs/c"} | changes)  # type: ignore[arg-type]


def test_rows_hold_the_component_the_vector_and_both_deviations() -> None:
    assert summary_rows(result()) == [
        ("Coriolis", "BB3 68.9 % less, whole vector 45.8 % less"),
        ("", "seat x 40.1 % less, seat y 34.0 % less, seat z 3.1 % more"),
        ("deviation", "joints 12.8 % (squared 1.6 %)"),
        ("felt", "seat rate 9.1 %, G 4.2 % (0.0834 g rms)"),
        ("compare", "the study's sweep: 63.9 % less at joints 24.0 %"),
        ("", "as much by a constant p = 0.767: joints 23.3 %"),
    ]


def test_a_weight_on_several_components_names_the_vector_alone() -> None:
    rows = summary_rows(result(objective=("seat_x", "seat_y", "seat_z")))
    assert rows[0] == ("Coriolis", "whole vector 45.8 % less")


def test_a_budget_stands_beside_what_is_spent_of_it() -> None:
    solver = METRICS["solver"] | {"budget": {"seat_g_rms_error_g": 0.0835}}
    rows = summary_rows(result(metrics=METRICS | {"solver": solver}))
    assert ("budget", "seat_g_rms_error_g at most 0.0835, is 0.0834") in rows


@pytest.mark.parametrize(
    ("violations", "words"),
    [
        ((), "limits      all kept"),
        (("desired arm rate",), "limits      kept by the modified motion"),
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
        f"limits      {line}" for line in violations
    ]


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.5, "50.0 %"), (0.0016, "0.16 %"), (12.0, "1200 %"), (None, "not known")],
)
def test_percent(value: float | None, text: str) -> None:
    assert percent(value) == text


def test_what_is_no_number_is_not_known() -> None:
    assert change(float("nan")) == percent(float("inf")) == number(None) == "not known"


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
    failed = result(exit_code=ExitCode.NO_SOLUTION, problems=("c: infeasible",), state="failed")
    print_result(Console(), failed, alone=True)
    assert capsys.readouterr().err == "c: infeasible\n"


def test_closing_counts_every_profile_once(capsys: pytest.CaptureFixture[str]) -> None:
    ends = [result(), result(state="kept"), result(exit_code=ExitCode.PROFILE, state="failed")]
    print_closing(Console(), ends, 5)
    words = "5 profiles: 1 done, 1 already done, 1 failed, 2 not run (--keep-going runs them all)\n"
    assert capsys.readouterr().err == words


def test_exit_code_of_a_batch() -> None:
    bad = result(exit_code=ExitCode.NO_SOLUTION, state="failed")
    assert exit_code_of([bad], 1) == 4
    assert exit_code_of([result(), bad], 2) == 1
    assert exit_code_of([result()], 2) == 1
    assert exit_code_of([result(), result()], 2) == 0
