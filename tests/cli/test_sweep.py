"""``sweep``: the points against numbers found elsewhere, formats, and how each sweep ends."""

import csv
import io
import json
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from PIL import Image

from des_cli.batch import load_job
from des_cli.cli import sweep as module
from des_cli.cli.tradeoff_text import point_line, points_text
from des_cli.errors import ExitCode
from des_cli.failure import Failure
from des_cli.job import Job
from des_cli.kinematics.desired import make_desired
from des_cli.model.motion import Motion, integrate_sides
from des_cli.model.tradeoff import TradePoint
from des_cli.profiles_in.load import load_profile
from des_cli.runs_out.point_table import COLUMNS
from des_cli.sweep import PointJob, PointResult, exit_code_of, run_point
from des_cli.tradeoff import CONSTANT_FACTORS, doubts

Rows = list[dict[str, str]]
STUDY = ("--axes", "report", "--r1", "0,2,0")
COARSE = ("--set", "time.step_s=0.05")


def rows_of(text: str) -> Rows:
    reader = csv.DictReader(io.StringIO(text))
    assert tuple(reader.fieldnames or ()) == COLUMNS
    return list(reader)


def curve(rows: Rows, algorithm: str, control: str = "scalar") -> Rows:
    return [row for row in rows if (row["algorithm"], row["control"]) == (algorithm, control)]


def column(rows: Rows, name: str) -> list[float]:
    return [float(row[name]) for row in rows]


@pytest.fixture(scope="module")
def by_weight(tmp_path_factory: pytest.TempPathFactory) -> Rows:
    from click.testing import CliRunner

    from des_cli.cli.main import program

    args = ["sweep", "cobra", *STUDY, *COARSE, "--limits", "warn", "--r2s", "8,1,0.2", "-f", "csv"]
    result = CliRunner().invoke(program, args)
    assert result.exit_code == 0, result.stderr
    return rows_of(result.stdout)


def test_weights_give_the_known_optima(by_weight: Rows) -> None:
    # Three independent codes on this profile: reductions 29.5, 68.9 and 84.9 %,
    # J 0.4484, 0.25906 and 0.1391; per joint J 0.2144 and 74.5 % at r2 = 1.
    scalar = curve(by_weight, "optimum")
    assert column(scalar, "value") == [8.0, 1.0, 0.2]
    assert column(scalar, "bb3_reduction") == pytest.approx([0.295, 0.689, 0.849], abs=1e-3)
    assert column(scalar, "cost") == pytest.approx([0.4484, 0.25906, 0.1391], rel=1e-3)
    assert column(scalar, "objective_reduction") == column(scalar, "bb3_reduction")
    per_joint = curve(by_weight, "optimum", "per-joint")[1]
    assert float(per_joint["cost"]) == pytest.approx(0.2144, rel=1e-3)
    assert float(per_joint["bb3_reduction"]) == pytest.approx(0.745, abs=1e-3)
    assert {row["swept"] for row in scalar} == {"r2"}
    assert {row["status"] for row in scalar} == {"converged"}


def test_every_point_has_the_felt_price(by_weight: Rows) -> None:
    # An independent study (CasADi, 4-point Gauss) has 0.462 and 0.539 before any reduction;
    # the grid of 0.05 s holds the acceleration over each interval.
    stem = "seat_angular_acceleration"
    before = {"rms": 0.462, "peak": 0.539}
    for kind, size in before.items():
        sizes = column(by_weight, f"{stem}_{kind}_before_rad_s2")
        assert sizes == pytest.approx([size] * len(by_weight), abs=3e-3)
    slowed = curve(by_weight, "constant-p")
    # Slowed by p everywhere, c falls with p squared and the rest with p: the whole lies between.
    for row, p in zip(slowed, CONSTANT_FACTORS, strict=True):
        assert p**2 < float(row[f"{stem}_rms_rad_s2"]) / 0.462 < 1.0
        off = float(row[f"{stem}_rms_error_rad_s2"])
        assert off >= 0.462 - float(row[f"{stem}_rms_rad_s2"]) - 2e-3  # the triangle's inequality
    errors = column(slowed, f"{stem}_rms_error_rad_s2")
    assert errors == sorted(errors)


def test_the_study_is_there_for_each_weight(by_weight: Rows) -> None:
    # Its single sweep on this profile: 13.5, 63.9 and 11.4 %.
    study = curve(by_weight, "report-sweep")
    assert column(study, "value") == [8.0, 1.0, 0.2]
    assert column(study, "bb3_reduction") == pytest.approx([0.135, 0.639, 0.114], abs=3e-3)
    assert {row["status"] for row in study} == {"baseline"}


def bb3(motion: Motion, p: float) -> np.ndarray:
    """BB3 of (23) for angles and rates that a constant factor slows down."""
    start = motion.angle[0]
    (a1, a2, _), rates = (
        np.moveaxis(start + p * (motion.angle_sides - start), -1, 0),
        p * np.moveaxis(motion.rate_sides, -1, 0),
    )
    s1, c1, s2, c2 = np.sin(a1), np.cos(a1), np.sin(a2), np.cos(a2)
    return -c1 * rates[0] * rates[1] + (s1 * c2 * rates[0] + c1 * s2 * rates[1]) * rates[2]


def test_constant_factors_are_those_of_the_formula(by_weight: Rows) -> None:
    motion = make_desired(load_profile("cobra", settings=["time.step_s=0.05"])).motion
    before = integrate_sides(motion.step, bb3(motion, 1.0) ** 2)
    away = motion.angle_sides - motion.angle[0]
    energy = [
        integrate_sides(motion.step, np.sum(v**2, axis=-1)) for v in (away, motion.angle_sides)
    ]
    per_slowing = np.sqrt(energy[0] / energy[1])
    points = curve(by_weight, "constant-p")
    assert column(points, "value") == list(CONSTANT_FACTORS)
    for point, p in zip(points, CONSTANT_FACTORS, strict=True):
        left = integrate_sides(motion.step, bb3(motion, p) ** 2) / before
        # The solver's own motion between samples is linear in the rates, as here.
        assert float(point["bb3_reduction"]) == pytest.approx(1.0 - left, abs=2e-3)
        deviation = float(point["joint_deviation_relative"])
        assert deviation == pytest.approx((1.0 - p) * per_slowing, rel=1e-3)
        assert point["cost"] == ""


@pytest.fixture(scope="module")
def by_budget() -> Rows:
    from click.testing import CliRunner

    from des_cli.cli.main import program

    args = ["sweep", "cobra", "--axes", "seat", "--r1", "2,2,2", "--set", "time.step_s=0.1"]
    result = CliRunner().invoke(program, [*args, "--budgets", "0.02,0.05"])
    assert result.exit_code == 0, result.stderr
    return rows_of(result.stdout)


def test_budgets_are_kept_and_spent_inside_the_limits(by_budget: Rows) -> None:
    for control in ("scalar", "per-joint"):
        points = curve(by_budget, "optimum", control)
        assert column(points, "value") == [0.02, 0.05]
        for point in points:
            share = float(point["joint_deviation_relative"]) / float(point["value"])
            assert 0.9 < share <= 1.0 + 1e-9
            assert point["limits_ok"] == "true"
            assert point["swept"] == "joint_deviation_relative"


def test_more_deviation_and_more_factors_buy_more(by_budget: Rows) -> None:
    scalar, joint = (
        column(curve(by_budget, "optimum", control), "objective_reduction")
        for control in ("scalar", "per-joint")
    )
    assert scalar[0] < scalar[1]
    assert joint[0] < joint[1]
    assert all(more > less for more, less in zip(joint, scalar, strict=True))


def test_the_optimum_beats_a_constant_factor_of_the_same_deviation(by_budget: Rows) -> None:
    constant = curve(by_budget, "constant-p")
    slow = np.interp(
        0.05, column(constant, "joint_deviation_relative"), column(constant, "objective_reduction")
    )
    assert float(curve(by_budget, "optimum")[1]["objective_reduction"]) > slow + 0.1


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
import des_cli.pool as pool
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
    jobs: list[PointJob] = []
    with monkeypatch.context() as patch:
        patch.setattr(module, "_run", lambda _, points, *rest: jobs.extend(points) or ExitCode.DONE)
        result = invoke("sweep", *args)
    assert result.exit_code == 0, result.stderr
    return [
        (job.control, job.value, {b.metric: b.most for b in load_job(job.job).reduction.budget})
        for job in jobs
        if not job.baselines
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


def test_a_point_is_named_after_what_is_swept(
    small: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("des_cli.tradeoff.trade_point", lambda *_: replace(POINT, swept=G))
    job = PointJob(Job(str(tmp_path / small)), "scalar", RATE, 0.2)
    [point] = run_point(job).points
    assert (point.swept, point.value) == (RATE, 0.2)


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


@pytest.mark.parametrize("taken", ["points.csv", "curve.png"])
def test_what_exists_is_refused_before_anything_is_computed(
    invoke, small: str, tmp_path, monkeypatch: pytest.MonkeyPatch, taken: str
) -> None:
    (tmp_path / taken).write_bytes(b"mine")
    args = ("sweep", small, "--r2s", "1", "--plot", "curve.png", "-o", "points.csv")
    with monkeypatch.context() as patch:
        patch.setattr(module, "_plan", lambda *_: pytest.fail("went on"))
        result = invoke(*args)
    assert (result.exit_code, (tmp_path / taken).read_bytes()) == (1, b"mine")
    assert result.stderr == f"{taken}: exists; --overwrite replaces it\n"
    assert invoke(*args, "--overwrite").exit_code == 0
    assert (tmp_path / taken).read_bytes() != b"mine"


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


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["--budgets", "0.1", "--r2s", "1"], "exclude each other"),
        (["--r2", "1", "--r2s", "1"], "exclude each other"),
        (["--tracking", "1"], "--tracking needs --r2s"),
        (["--budgets", "0.1,x"], "not a list of numbers"),
        (["--budgets", "0.1,-1"], "above 0"),
        (["--r2s", "inf"], "above 0"),
        (["--budgets", "seat_rate=0.1"], "is not a metric"),
        (["--controls", "both"], "is not free, scalar or per-joint"),
        (["--plot", "curve.pdf"], "FILE.png"),
        (["-o", "x.csv", "-f", "json"], "contradicts"),
        (["--budget", "0.1"], "joint_deviation_relative, which is swept"),
        (["--budget", "0.1", "--r2s", "1"], "--budget and --r2s exclude"),
        (["--budgets", "seat_g_rms_error_g=5%"], "is no share: give it in g"),
        (["--r2s", "1", "--controls", "free"], "r2 and tracking weigh factors"),
        (["--ends", "match-rates"], "match-rates needs control: free"),
        (["--set", "reduction.hold=[arm]"], "hold needs control: per-joint"),
    ],
    ids=lambda value: value if isinstance(value, str) else " ".join(value),
)
def test_wrong_use(invoke, small: str, args: list[str], words: str) -> None:
    result = invoke("sweep", small, *args)
    assert (result.exit_code, result.stdout) == (2, "")
    assert words in result.stderr


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


def test_a_local_minimum_is_named() -> None:
    looser = replace(POINT, value=0.1, objective_reduction=0.45)
    joint = replace(POINT, control="per-joint", objective_reduction=0.4)
    assert doubts([POINT, replace(looser, objective_reduction=0.6)]) == []
    [budget] = doubts([looser, POINT])
    assert "scalar at joint_deviation_relative = 0.1 takes off less than" in budget
    [factors] = doubts([POINT, joint])
    assert factors.startswith("per-joint at joint_deviation_relative = 0.05 is worse than scalar")
    weighed = [replace(point, swept="r2", value=1.0) for point in (POINT, joint)]
    assert doubts(weighed) == []  # by the cost, which is equal
    assert len(doubts([weighed[0], replace(weighed[1], cost=0.11)])) == 1
    assert doubts([replace(POINT, status="unverified"), joint]) == []


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
