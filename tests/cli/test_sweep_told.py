"""``sweep``: what is told of its points, and how it ends."""

from dataclasses import replace
from pathlib import Path

import pytest

from des_cli.batch.source import Source
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
from tests.support.trade_points import GONE, POINT

RATE, G = "seat_rate_deviation_relative", "seat_g_rms_error_g"


def test_a_point_is_named_after_what_is_swept(
    small: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("des_cli.tradeoff.point.trade_point", lambda *_: replace(POINT, swept=G))
    plans = [PointPlan((), "scalar", RATE, 0.2)]
    [job] = make_jobs(small, plans, load_points(Source(str(tmp_path / small)), plans))
    [point] = run_point(job).points
    assert (point.swept, point.value) == (RATE, 0.2)


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
