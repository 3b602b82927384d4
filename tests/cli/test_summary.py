"""The summary says in words what the metrics hold."""

import copy
from typing import Any

import pytest

from des_cli.batch.job import JobResult
from des_cli.cli import summary_rows as rows_of
from des_cli.cli.console import Console
from des_cli.cli.summary import exit_code_of, print_closing, print_result
from des_cli.errors import ExitCode
from des_cli.results.reading import read_metrics

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
        "tilt_error_max_deg": 4.5,
        "start_error": {
            **{f"{joint}_rad": 0.0 for joint in ("arm", "fork", "cab")},
            **{"arm_rad_s": 0.001, "fork_rad_s": 0.0, "cab_rad_s": -0.01},
        },
        "end_error_rad": {"arm": -0.5, "fork": 0.1, "cab": 0.0},
        "end_error_rad_s": {"arm": 0.0, "fork": 0.0, "cab": 0.0},
    },
    "felt": {
        "seat_angular_acceleration": {
            "magnitude": {
                "rms_before_rad_s2": 0.462,
                "rms_after_rad_s2": 0.447,
                "peak_before_rad_s2": 0.539,
                "peak_after_rad_s2": 0.561,
            }
        },
        "seat_g": {
            axis: {
                "peak_before_g": 0.37,
                "peak_after_g": 0.45,
                "onset_before_g_s": before,
                "onset_after_g_s": before + 0.09,
            }
            for axis, before in (("gx", 0.5), ("gy", 0.6), ("gz", 0.7))
        },
    },
    "limits": {
        "modified": {
            joint: {
                "rate_peak_rad_s": 0.5,
                "rate_limit_rad_s": limit,
                "acceleration_peak_rad_s2": 0.5,
                "acceleration_limit_rad_s2": limit,
                "jerk_peak_rad_s3": 0.5,
                "jerk_limit_rad_s3": None,
            }
            for joint, limit in (("arm", 1.0), ("fork", 2.0), ("cab", 5.0))
        }
    },
    "baseline": {
        "report_sweep": {"reduction": 0.639, "joint_deviation_relative": 0.24},
        "constant_p": {"p": 0.767, "joint_deviation_relative": 0.233},
    },
}


def result(**changes: object) -> JobResult:
    values = {"source": "c.yaml", "name": "c", "metrics": METRICS, "objective": ("bb3",)}
    return JobResult(**values | {"written": "runs/c"} | changes)  # type: ignore[arg-type]


def summary_rows(shown: JobResult) -> list[tuple[str, str]]:
    return rows_of.summary_rows(read_metrics(shown.metrics), shown.objective)


def with_change(path: str, value: object) -> JobResult:
    metrics = copy.deepcopy(METRICS)
    *parents, last = path.split(".")
    place: Any = metrics
    for key in parents:
        place = place[key]
    place[last] = value
    return result(metrics=metrics)


def printed(capsys: pytest.CaptureFixture[str], shown: JobResult, *, alone: bool) -> list[str]:
    print_result(Console(), shown, alone=alone)
    return capsys.readouterr().err.splitlines()


def test_rows_lead_with_what_is_felt() -> None:
    assert summary_rows(result()) == [
        ("cross-coupling", "whole vector 45.8 % less, BB3 68.9 % less"),
        ("", "seat x 40.1 % less, seat y 34.0 % less, seat z 3.1 % more"),
        (
            "turning",
            "total angular acceleration 0.462 -> 0.447 rad/s² rms, peak 0.539 -> 0.561, "
            "seat rate off by 9.1 %",
        ),
        (
            "seat G",
            "off by 0.0834 g rms, tilt 4.5 deg at most, peak Gy 0.37 -> 0.45 g, "
            "Gz onset 0.7 -> 0.79 g/s",
        ),
        ("ends", "start off by cab -0.573 deg/s, end off by arm -28.6 deg"),
        (
            "study",
            "joints off by 12.8 % (squared 1.6 %); its sweep: 63.9 % less at 24.0 %; "
            "a constant factor: as much by p = 0.767 at 23.3 %",
        ),
    ]


def test_the_size_of_the_vector_stands_beside_its_change() -> None:
    vector = {"reduction": 0.458, "rms_before_rad_s2": 0.351, "rms_after_rad_s2": 0.258}
    rows = summary_rows(with_change("coriolis.vector", vector))
    assert rows[0][1] == ("whole vector 45.8 % less (0.351 -> 0.258 rad/s² rms), BB3 68.9 % less")


def test_a_start_that_is_matched_is_told_so() -> None:
    rows = dict(summary_rows(with_change("fidelity.start_error.cab_rad_s", 0.0001)))
    assert rows["ends"].startswith("start off by arm +0.0573 deg/s")
    matched = with_change("fidelity.start_error", {"arm_rad": 0.0, "arm_rad_s": 1e-9})
    assert dict(summary_rows(matched))["ends"].startswith("start as in the profile, end off")


def test_a_weight_on_several_components_names_the_vector_alone() -> None:
    rows = summary_rows(result(objective=("seat_x", "seat_y", "seat_z")))
    assert rows[0] == ("cross-coupling", "whole vector 45.8 % less")


def test_every_budget_stands_beside_what_is_spent_of_it() -> None:
    budget = {"seat_g_rms_error_g": 0.0835, "seat_rate_deviation_relative": 0.1}
    rows = summary_rows(with_change("solver.budget", budget))
    assert ("budgets", "G error 0.0834 of 0.0835 g, seat rate 9.11 of 10 %") in rows


def test_metrics_without_what_is_felt_leave_their_rows_out() -> None:
    bare = {key: METRICS[key] for key in ("solver", "coriolis")} | {"fidelity": {}}
    assert [label for label, _ in summary_rows(result(metrics=bare))] == [
        "cross-coupling",
        "",
        "study",
    ]


def test_a_ride_that_got_worse_is_the_first_line(capsys: pytest.CaptureFixture[str]) -> None:
    lines = printed(capsys, result(), alone=True)
    assert lines[0] == (
        "c: converged in 6 iterations "
        "(minimum cross-coupling by optimum, scalar control, report axes)"
    )
    worse = with_change("felt.seat_angular_acceleration.magnitude.rms_after_rad_s2", 2.2)
    lines = printed(capsys, worse, alone=True)
    told = "worse to sit in: total angular acceleration 0.462 -> 2.2 rad/s² rms"
    assert lines[0] == f"c: {told}"
    assert lines[1].startswith("  solved         converged in 6 iterations (minimum")
    (line,) = printed(capsys, worse, alone=False)
    assert told in line
    assert "whole vector 45.8 % less, BB3 68.9 % less, seat rate 9.1 %, G 0.0834 g rms" in line
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
