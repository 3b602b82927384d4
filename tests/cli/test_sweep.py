"""``sweep``: options, formats, and what is refused."""

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from PIL import Image

from des_cli.batch.source import Source
from des_cli.cli import sweep as module
from des_cli.cli.console import Console
from des_cli.errors import ExitCode
from des_cli.model.profile import Profile
from des_cli.runs_out.point_table import COLUMNS
from des_cli.tradeoff.baselines import CONSTANT_FACTORS
from des_cli.tradeoff.jobs import PointPlan, load_points
from tests.support.points import curve, rows_of


def test_the_study_takes_the_weight_of_the_profile(invoke, small: str) -> None:
    args = ("sweep", small, "--controls", "scalar", "--budgets", "0.01")
    [given] = curve(rows_of(invoke(*args, "--r2", "4").stdout), "report-sweep")
    [own] = curve(rows_of(invoke(*args).stdout), "report-sweep")
    assert (float(given["value"]), float(own["value"])) == (4.0, 1.0)
    assert float(given["joint_deviation_relative"]) < float(own["joint_deviation_relative"])


def test_another_metric_is_a_budget(invoke, small: str) -> None:
    metric = "seat_rate_deviation_relative"
    result = invoke("sweep", small, "--controls", "scalar", "--budgets", f"{metric}=0.02")
    [point] = curve(rows_of(result.stdout), "optimum")
    assert (result.exit_code, point["swept"]) == (0, metric)
    assert 0.9 * 0.02 < float(point[metric]) <= 0.02 * (1 + 1e-9)


def test_every_format_holds_the_same_numbers(invoke, small: str, tmp_path) -> None:
    args = ("sweep", small, "--r2s", "2,1", "--controls", "scalar")
    rows = rows_of(invoke(*args).stdout)
    for form in ("csv", "json", "ndjson", "parquet"):
        assert invoke(*args, "-o", f"x.{form}").exit_code == 0
    assert rows_of((tmp_path / "x.csv").read_text()) == rows
    found = json.loads((tmp_path / "x.json").read_text())
    assert [json.loads(line) for line in (tmp_path / "x.ndjson").read_text().splitlines()] == found
    assert pq.read_table(tmp_path / "x.parquet").to_pylist() == found
    for row, point in zip(rows, found, strict=True):
        assert tuple(point) == COLUMNS
        for name, value in point.items():
            if isinstance(value, bool):
                assert row[name] == str(value).lower()
            elif isinstance(value, float):
                assert float(row[name]) == value
            else:
                assert row[name] == ("" if value is None else str(value))


@pytest.mark.slow
def test_more_jobs_give_the_same_bytes(command, small: str) -> None:
    args = ("sweep", small, "--r2s", "2,1")
    one, two = (command(*args, "--jobs", jobs) for jobs in ("1", "2"))
    assert (one.returncode, two.returncode) == (0, 0), two.stderr
    assert one.stdout == two.stdout
    assert one.stderr == two.stderr


# Tells, when the points are about to be computed, whether numpy is there already: its
# BLAS would have taken its number of threads from the user, and --jobs 1 other last
# bits than a worker.
EARLY = """
import sys
import des_cli.batch.pool as pool
from des_cli.cli.main import program

def local_executor(workers, make=pool.local_executor):
    print("numpy" in sys.modules)
    raise SystemExit(0)

pool.local_executor = local_executor
program.main(["sweep", "cobra"])
"""


def test_numpy_is_not_imported_before_the_number_of_threads_is_set(
    python_environment: dict[str, str], tmp_path: Path
) -> None:
    done = subprocess.run(
        [sys.executable, "-c", EARLY],
        capture_output=True,
        text=True,
        env=python_environment,
        cwd=tmp_path,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "False\n"), done.stderr


def planned(invoke, monkeypatch: pytest.MonkeyPatch, *args: str) -> list[tuple]:
    """Control, swept value and budgets of every point that a sweep would compute."""
    points: list[tuple[PointPlan, Profile]] = []

    def load(_: Console, source: Source, plans: list[PointPlan], *rest: object) -> ExitCode:
        points.extend(zip(plans, load_points(source, plans), strict=True))
        return ExitCode.DONE

    with monkeypatch.context() as patch:
        patch.setattr(module, "_run", load)
        result = invoke("sweep", *args)
    assert result.exit_code == 0, result.stderr
    return [
        (plan.control, plan.value, {b.metric: b.most for b in profile.reduction.budget})
        for plan, profile in points
        if not plan.baselines
    ]


RATE, G = "seat_rate_deviation_relative", "seat_g_rms_error_g"


def test_budgets_on_other_metrics_stay_beside_the_swept_one(
    invoke, small: str, write_profile: Callable[..., Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    swept = ("--budgets", f"{RATE}=5%,0.2", "--controls", "free,scalar")
    beside = [
        (control, most, {G: 0.1, RATE: most})
        for control in ("free", "scalar")
        for most in (0.05, 0.2)
    ]
    assert planned(invoke, monkeypatch, small, *swept, "--budget", f"{G}=0.1") == beside
    path = write_profile("felt")
    path.write_text(path.read_text().replace("r2: 1", f"budget: {{{G}: 0.1, {RATE}: 0.9}}"))
    assert planned(invoke, monkeypatch, path.name, *swept) == beside
    alone = [(control, most, {RATE: most}) for control, most, _ in beside]
    assert planned(invoke, monkeypatch, small, *swept) == alone  # it has weights


def test_a_profile_on_stdin(invoke, small: str, tmp_path) -> None:
    args = ("--r2s", "1", "--controls", "scalar")
    piped = invoke("sweep", "-", *args, input=(tmp_path / small).read_bytes())
    assert piped.exit_code == 0
    assert piped.stdout == invoke("sweep", small, *args).stdout


def test_the_plot_is_written_beside_the_points(invoke, small: str, tmp_path) -> None:
    args = ("sweep", small, "--r2s", "2,1", "--plot", "curve.png", "-o", "points.csv")
    assert invoke(*args).exit_code == 0
    with Image.open(tmp_path / "curve.png") as image:
        title = image.info["Title"]
    assert title.endswith("small, r1 = 0, 2, 0 in report axes")
    assert (tmp_path / "points.csv").is_file()


def test_a_point_that_does_not_converge_keeps_its_row(invoke, small: str) -> None:
    result = invoke("sweep", small, "--r2s", "1", "--set", "reduction.max_iterations=1")
    assert result.exit_code == 4
    for control in ("scalar", "per-joint"):
        [point] = curve(rows_of(result.stdout), "optimum", control)
        assert point["status"] == "iteration-limit"
        assert "max_iterations" in point["message"]
        assert {point[name] for name in COLUMNS if name.endswith("_reduction")} == {""}
        assert point["limits_ok"] == ""
    assert len(curve(rows_of(result.stdout), "constant-p")) == len(CONSTANT_FACTORS)
    assert "iteration-limit" in result.stderr


def test_a_maneuver_that_cannot_be_flown_is_infeasible_with_a_reason(
    invoke, write_profile: Callable[..., Path]
) -> None:
    path = write_profile(fork_deg='"-400 - t"')
    result = invoke("sweep", path.name, "--budgets", "0.05")
    assert result.exit_code == 4
    for control in ("scalar", "per-joint"):
        [point] = curve(rows_of(result.stdout), "optimum", control)
        assert point["status"] == "infeasible"  # 400 degrees; the limit is a full turn
        assert "the fork is 6.981 rad at the start, outside its limit" in point["message"]


def test_a_faulty_profile_is_told_once(invoke, small: str) -> None:
    result = invoke("sweep", small, "--set", "time.step_s=-1")
    assert (result.exit_code, result.stdout) == (3, "")
    assert len(result.stderr.splitlines()) == 1


def test_the_page_of_commands_names_every_column() -> None:
    page = (Path(__file__).parents[2] / "docs" / "cli.md").read_text(encoding="utf-8")
    section = page.partition("\n## sweep\n")[2].partition("\n## ")[0]
    table = section.partition("| column |")[2]
    first = [line.split("|")[1] for line in table.splitlines() if line.startswith("| `")]
    assert [name for cell in first for name in re.findall(r"`(\w+)`", cell)] == list(COLUMNS)


def test_quiet_leaves_the_data_alone(invoke, small: str) -> None:
    args = ("sweep", small, "--r2s", "1", "--controls", "scalar")
    loud, quiet = invoke(*args), invoke(*args, "-q")
    assert loud.stdout == quiet.stdout
    assert loud.stderr.startswith("scalar, r2 1: converged in ")
    assert quiet.stderr == ""


def test_verbose_shows_the_iterations(invoke, small: str) -> None:
    result = invoke("sweep", small, "--r2s", "1", "--controls", "scalar", "-v")
    assert "infeasibility" in result.stderr.splitlines()[0]
