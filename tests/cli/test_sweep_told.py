"""``sweep``: what is told of its points, and how it ends."""

from dataclasses import replace
from pathlib import Path

import pytest

from des_cli.batch.source import Source
from des_cli.cli.tradeoff_text import point_line, points_text
from des_cli.errors import ExitCode, Failure
from des_cli.model.tradeoff import TradePoint
from des_cli.tradeoff.jobs import (
    PointPlan,
    PointResult,
    exit_code_of,
    load_points,
    make_jobs,
    run_point,
)

RATE, G = "seat_rate_deviation_relative", "seat_g_rms_error_g"


POINT = TradePoint(
    "optimum",
    "scalar",
    "joint_deviation_relative",
    0.05,
    "converged",
    **{f"{part}_reduction": 0.5 for part in ("objective", "bb3", "vector")},
    seat_x_reduction=-0.25,
    seat_y_reduction=0.5,
    seat_z_reduction=0.5,
    joint_deviation_relative=0.0499,
    seat_rate_deviation_relative=0.2,
    seat_g_rms_error_g=0.3,
    seat_angular_acceleration_rms_error_rad_s2=0.143,
    seat_angular_acceleration_rms_before_rad_s2=0.462,
    seat_angular_acceleration_rms_rad_s2=0.447,
    seat_angular_acceleration_peak_before_rad_s2=0.539,
    seat_angular_acceleration_peak_rad_s2=0.561,
    attitude_error_max_deg=20.0,
    cost=0.1,
    iterations=7,
    limits_ok=True,
)
TURNING = ("α error", "α rms", "α peak")
GONE = TradePoint("optimum", "scalar", "r2", 1.0, "iteration-limit", message="too few steps")


def test_a_point_is_named_after_what_is_swept(
    small: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("des_cli.tradeoff.point.trade_point", lambda *_: replace(POINT, swept=G))
    plans = [PointPlan((), "scalar", RATE, 0.2)]
    [job] = make_jobs(small, plans, load_points(Source(str(tmp_path / small)), plans))
    [point] = run_point(job).points
    assert (point.swept, point.value) == (RATE, 0.2)


def test_text_is_aligned_and_says_why_there_is_nothing() -> None:
    lines = points_text(
        [POINT, replace(POINT, value=0.1, objective_reduction=None), GONE], "cobra"
    ).splitlines()
    heads, first, second = lines[4:7]
    ends = [heads.index(word) + len(word) for word in ("objective", "seat x", "joints")]
    assert [first[:end].split()[-2:] for end in ends] == [
        ["50.0", "%"],
        ["-25.0", "%"],
        ["5.0", "%"],
    ]
    assert second[: ends[0]].endswith("not known")
    assert "α at the seat [rad/s²], before 0.462 rms and 0.539 peak" in lines[1]
    assert [first[: heads.index(word) + len(word)].split()[-1] for word in TURNING] == [
        "0.143",
        "0.447",
        "0.561",
    ]
    assert point_line(POINT).endswith(
        "50.0 % less at joints 5.0 %, seat rate 20.0 %, α 0.447 rad/s² rms"
    )
    assert lines[-1].endswith("1  iteration-limit: too few steps")
    assert point_line(GONE) == "scalar, r2 1: iteration-limit: too few steps"


def test_how_a_sweep_ends() -> None:
    def end(*points: TradePoint, failure: Failure | None = None) -> ExitCode:
        return exit_code_of([PointResult((point,), failure=failure) for point in points])

    infeasible = replace(GONE, status="infeasible")
    baseline = replace(POINT, algorithm="constant-p", status="baseline")
    assert end(POINT, POINT, baseline) == ExitCode.DONE
    assert end(POINT, infeasible) == ExitCode.DONE
    assert end(POINT, replace(POINT, status="acceptable")) == ExitCode.DONE
    assert end(POINT, GONE) == ExitCode.FILE
    assert end(POINT, replace(POINT, status="unverified")) == ExitCode.FILE
    assert end(GONE, infeasible, baseline) == ExitCode.NO_SOLUTION
    assert end(POINT, failure=Failure.of(RuntimeError("x"))) == ExitCode.BUG
    assert end(POINT, failure=Failure.of(MemoryError())) == ExitCode.FILE
