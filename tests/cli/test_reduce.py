"""``reduce``: destinations, formats, and options."""

import json
import re

import numpy as np
import pyarrow.parquet as pq
import pytest

from des_cli.kinematics.commanded_motion import make_desired
from des_cli.profiles_in.load import load_profile
from des_cli.reduction.limits import find_violations
from tests.support.run_files import HEADER, RUN_FILES, csv_rows, metrics_of


def test_default_is_a_run_folder_named_after_the_profile(invoke, small: str, tmp_path) -> None:
    result = invoke("reduce", small)
    assert (result.exit_code, result.stdout) == (0, "")
    folder = tmp_path / "runs" / "small"
    assert {path.name for path in folder.iterdir()} == RUN_FILES | {"plots", "source"}
    assert list((folder / "plots").glob("*.png"))
    assert result.stderr.startswith("small: ")
    assert "converged in" in result.stderr
    assert "runs/small" in result.stderr
    assert csv_rows((folder / "commands.csv").read_text()).shape == (21, 4)


def test_summary_names_gain_and_cost(invoke, small: str, tmp_path) -> None:
    result = invoke("reduce", small, "--no-plots")
    metrics = metrics_of(tmp_path / "runs" / "small")
    gained = 100 * metrics["coriolis"]["bb3"]["reduction"]
    assert f"BB3 {gained:.1f} % less" in result.stderr
    for label in ("cross-coupling", "turning", "seat G", "ends", "study", "limits", "written"):
        assert f"\n  {label}" in result.stderr


def test_no_plots(invoke, small: str, tmp_path) -> None:
    assert invoke("reduce", small, "--no-plots", "-o", "here").exit_code == 0
    assert {path.name for path in (tmp_path / "here").iterdir()} == RUN_FILES | {"source"}


def test_out_is_the_folder_itself_for_one_profile(invoke, small: str, tmp_path) -> None:
    assert invoke("reduce", small, "--no-plots", "-o", "a/b").exit_code == 0
    assert (tmp_path / "a" / "b" / "manifest.json").is_file()


def test_a_table_on_stdout_and_words_on_stderr(invoke, small: str, tmp_path) -> None:
    result = invoke("reduce", small, "-o", "-")
    assert result.exit_code == 0
    rows = csv_rows(result.stdout)
    assert rows.shape == (21, 4)
    assert rows[0, 0] == 0
    assert rows[-1, 0] == 1
    assert "converged in" in result.stderr
    assert {path.name for path in tmp_path.iterdir()} == {small}


def test_every_format_holds_the_same_numbers(invoke, small: str, tmp_path) -> None:
    for form in ("csv", "json", "ndjson", "parquet"):
        assert invoke("reduce", small, "-o", f"x.{form}").exit_code == 0
    rows = csv_rows((tmp_path / "x.csv").read_text())
    as_json = json.loads((tmp_path / "x.json").read_text())
    as_lines = [json.loads(line) for line in (tmp_path / "x.ndjson").read_text().splitlines()]
    assert as_json == as_lines
    assert list(as_json[0]) == HEADER.split(",")
    np.testing.assert_array_equal([list(row.values()) for row in as_json], rows)
    table = pq.read_table(tmp_path / "x.parquet")
    np.testing.assert_array_equal(np.column_stack([table[c] for c in HEADER.split(",")]), rows)


def test_format_by_name(invoke, small: str, tmp_path) -> None:
    result = invoke("reduce", small, "-o", "-", "-f", "ndjson")
    assert json.loads(result.stdout.splitlines()[0])["t_s"] == 0
    assert invoke("reduce", small, "-o", "x.txt", "-f", "csv").exit_code == 0
    assert csv_rows((tmp_path / "x.txt").read_text()).shape == (21, 4)


def test_an_unknown_suffix_is_refused_and_none_is_a_folder(invoke, small: str, tmp_path) -> None:
    result = invoke("reduce", small, "-o", "x.foo")
    assert result.exit_code == 2
    assert ".foo is no format of a table: name it .csv, .ndjson, .json, .parquet" in result.stderr
    assert not (tmp_path / "x.foo").exists()
    for name in ("x", "v1.2", "x.foo/"):
        assert invoke("-q", "reduce", small, "--no-plots", "-o", name).exit_code == 0
        assert (tmp_path / name / "commands.csv").is_file()


def test_a_table_in_the_form_of_another_program(invoke, small: str, tmp_path) -> None:
    options = ("--control", "free", "--axes", "seat", "--r1", "2,2,2", "--limits", "enforce")
    budget = ("--budget", "seat_rate_deviation_relative=0.05")
    reduce = ("reduce", small, *options, *budget)
    assert invoke(*reduce, "-o", "plain.csv").exit_code == 0
    assert invoke(*reduce, "-o", "x.txt", "--preset", "halstreamer").exit_code == 0
    plain = csv_rows((tmp_path / "plain.csv").read_text())
    np.testing.assert_allclose(np.loadtxt(tmp_path / "x.txt"), plain[:, 1:], rtol=1e-14)
    columns = ("--columns", "t_s,arm_rad,fork_rad_s", "--hz", "130")
    result = invoke(*reduce, "-o", "-", *columns)
    assert result.stdout.startswith("t_s,arm_rad,fork_rad_s\n")
    assert len(result.stdout.splitlines()) == 1 + 131
    failed = invoke(*reduce, "-o", "x.txt", "--preset", "halstreamer", "--fail-on", "start")
    assert failed.exit_code == 1
    two = invoke("reduce", small, "cobra", "-o", "x.yaml", "--preset", "ros2")
    assert two.exit_code == 2
    assert "one command table cannot hold several profiles" in two.stderr


def test_stdin_is_a_profile(invoke, small: str, tmp_path) -> None:
    result = invoke("reduce", "-", "-o", "-", input=(tmp_path / small).read_bytes())
    assert result.exit_code == 0
    assert result.stdout == invoke("reduce", small, "-o", "-").stdout


def test_a_built_in_profile_by_name(invoke) -> None:
    result = invoke("reduce", "cobra", "--set", "time.step_s=0.25", "-o", "-")
    assert result.exit_code == 0
    assert csv_rows(result.stdout).shape == (41, 4)


def test_a_command_table_is_itself_a_profile(invoke, small: str) -> None:
    assert invoke("reduce", small, "-o", "x.csv").exit_code == 0
    result = invoke("reduce", "x.csv", "--limits", "warn", "-o", "-")
    assert result.exit_code == 0, result.stderr
    assert csv_rows(result.stdout).shape == (21, 4)


def test_leads_take_the_table_from_rest_to_rest_and_it_reads_back(
    invoke, small: str, tmp_path
) -> None:
    args = ("reduce", small, "--limits", "enforce", "-o")
    assert invoke(*args, "bare.csv").exit_code == 0
    result = invoke(*args, "led.csv", "--lead-in", "3", "--lead-out", "4")
    assert result.exit_code == 0, result.stderr
    bare, led = (csv_rows((tmp_path / name).read_text()) for name in ("bare.csv", "led.csv"))
    assert (led[0, 0], led[-1, 0]) == (-3.0, 5.0)
    inside = (led[:, 0] >= 0.0) & (led[:, 0] <= 1.0)
    np.testing.assert_allclose(led[inside], bare, rtol=0, atol=1e-9)
    assert invoke("validate", "led.csv").exit_code == 0
    profile = load_profile(str(tmp_path / "led.csv"))
    motion = make_desired(profile).motion
    # rates of fork and cab are estimated from their positions
    np.testing.assert_allclose(motion.rate[[0, -1]], 0.0, atol=1e-5)
    assert np.abs(motion.rate[inside]).max(axis=0).min() > 1e-2  # every joint moves in between
    assert find_violations(profile.machine, motion, "modified") == ()


def test_leads_that_are_too_short_are_4_with_the_time_it_takes(
    invoke, small: str, tmp_path
) -> None:
    args = ("reduce", small, "--limits", "enforce", "-o", "x.csv", "--lead-in")
    result = invoke(*args, "0.5")
    assert (result.exit_code, (tmp_path / "x.csv").exists()) == (4, False)
    found = re.search(r"lead_in_s: in 0.5 s the arm cannot .+; in (\S+) s it can", result.stderr)
    assert found
    assert invoke(*args, found[1]).exit_code == 0


def test_column_renames_a_header(invoke, small: str, tmp_path) -> None:
    text = invoke("reduce", small, "-o", "-").stdout
    (tmp_path / "log.csv").write_text(text.replace("t_s,", "clock,", 1))
    assert invoke("reduce", "log.csv", "-o", "-").exit_code == 3
    args = ("--limits", "warn", "-o", "-")
    assert invoke("reduce", "log.csv", "--column", "t_s=clock", *args).exit_code == 0


def test_a_spreadsheet_s_dialect_is_asked_for_and_read(invoke, small: str, tmp_path) -> None:
    text = invoke("reduce", small, "-o", "-").stdout
    (tmp_path / "plain.csv").write_text(text)
    (tmp_path / "log.csv").write_text(text.replace(",", ";").replace(".", ","))
    refused = invoke("reduce", "log.csv", "-o", "-")
    assert (refused.exit_code, refused.stdout) == (3, "")
    (line,) = refused.stderr.splitlines()
    assert "give --separator ';' --decimal ," in line
    args = ("--limits", "warn", "-o", "-")
    read = invoke("reduce", "log.csv", "--separator", ";", "--decimal", ",", *args)
    assert read.exit_code == 0
    assert read.stdout == invoke("reduce", "plain.csv", *args).stdout


@pytest.mark.parametrize(
    ("args", "key", "value"),
    [
        (["--set", "reduction.control=per-joint"], "control", "per-joint"),
        (["--control", "per-joint"], "control", "per-joint"),
        (["--algorithm", "report-sweep"], "algorithm", "report-sweep"),
        (["--axes", "seat"], "axes", "seat"),
        (["--jacobian", "adapted"], "jacobian", "adapted"),
        (["--method", "zero", "--control", "per-joint"], "method", "zero"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else None,
)
def test_options_reach_the_solver(invoke, small: str, tmp_path, args, key, value) -> None:
    result = invoke("reduce", small, "--no-plots", *args)
    assert result.exit_code == 0, result.stderr
    assert metrics_of(tmp_path / "runs" / "small")["solver"][key] == value


@pytest.mark.parametrize(
    ("args", "same"),
    [
        (["--r1", "0,4,0"], ["--set", "reduction.r1=[0,4,0]"]),
        (["--r2", "1,1,1"], ["--r2", "1"]),
        (["--tracking", "0.5"], ["--set", "reduction.tracking=0.5"]),
        (["--set", "reduction.r2=7", "--r2", "2"], ["--r2", "2"]),
    ],
    ids=" ".join,
)
def test_weights_by_name_are_those_of_the_profile(invoke, small, args, same) -> None:
    named = invoke("reduce", small, "-o", "-", *args)
    assert named.exit_code == 0, named.stderr
    assert named.stdout == invoke("reduce", small, "-o", "-", *same).stdout
    changed = args != ["--r2", "1,1,1"]
    assert (named.stdout != invoke("reduce", small, "-o", "-").stdout) is changed


def test_more_sweeps_change_the_motion(invoke, small: str) -> None:
    sweep = ("reduce", small, "-o", "-", "--algorithm", "report-sweep", "--iterations")
    assert invoke(*sweep, "1").stdout != invoke(*sweep, "2").stdout


def test_verbose_prints_a_line_for_each_iteration(invoke, small: str, tmp_path) -> None:
    result = invoke("reduce", small, "--no-plots", "-v")
    lines = result.stderr.splitlines()
    assert lines[0].split() == ["iter", "cost", "infeasibility", "optimality", "step"]
    log = [line.split() for line in lines[1:] if line.split()[0].isdecimal()]
    solver = metrics_of(tmp_path / "runs" / "small")["solver"]
    assert len(log) >= solver["iterations"] > 0
    assert all(len(line) == 5 for line in log)
    assert float(log[-1][1]) == pytest.approx(solver["cost"], rel=1e-6)


def test_quiet_says_nothing_of_a_clean_run(invoke, write_profile) -> None:
    clean = write_profile("clean", r2="100").name
    result = invoke("-q", "reduce", clean, "-o", "x.csv")
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "")


def test_every_violation_is_named_even_when_quiet(invoke, write_profile, tmp_path) -> None:
    fast = write_profile("fast", arm_rpm='"8.8 + 20*t"').name
    result = invoke("-q", "reduce", fast, "--no-plots")
    assert result.exit_code == 0
    assert "desired arm acceleration" in result.stderr
    limits = metrics_of(tmp_path / "runs" / "fast")["limits"]
    assert limits["desired"]["arm"]["ok"] is False


def test_violations_and_notices_are_the_same_everywhere(invoke, write_profile, tmp_path) -> None:
    fast = write_profile("fast", arm_rpm='"8.8 + 20*t"', limits="enforce", r2="0.01").name
    command = ("reduce", fast, "--no-plots", "--control", "per-joint")
    result = invoke(*command)
    assert result.exit_code == 5
    assert "the record is changed by" in result.stderr
    assert not (tmp_path / "runs").exists()
    result = invoke(*command, "--allow-change", "0.5")
    assert result.exit_code == 0, result.stderr
    assert "changed first  limits seat rate" in result.stderr
    metrics = metrics_of(tmp_path / "runs" / "fast")
    assert metrics["executable"]["replaced"] is True
    assert metrics["solver"]["allow_change"] == 0.5
    assert metrics["executable"]["joint_change_max_rad"]["arm"] > 0.1
    assert any("desired arm acceleration" in line for line in metrics["violations"])
    assert not any(line.startswith("modified") for line in metrics["violations"])
    assert any("replaced by the nearest one" in line for line in metrics["notices"])
    for line in metrics["violations"] + metrics["notices"]:
        # What got worse is in the first line, and what bounds it in the second.
        parts = line.removeprefix("worse to sit in than the profile: ").removesuffix(" bound that")
        assert all(part in result.stderr for part in parts.split("; "))
    assert "kept by the modified motion" in result.stderr


def test_a_budget_replaces_the_weights_of_the_profile(invoke, small: str, tmp_path) -> None:
    result = invoke("reduce", small, "--no-plots", "--budget", "seat_g_rms_error_g=0.01")
    assert result.exit_code == 0, result.stderr
    metrics = metrics_of(tmp_path / "runs" / "small")
    assert metrics["solver"]["budget"] == {"seat_g_rms_error_g": 0.01}
    assert metrics["solver"]["limits"] == "enforce"
    assert 0.009 < metrics["fidelity"]["seat_g_rms_error_g"] <= 0.01
    spent = metrics["fidelity"]["seat_g_rms_error_g"]
    assert f"budgets        G error {spent:.4g} of 0.01 g" in result.stderr


def test_the_tolerance_of_zero(invoke, small: str, tmp_path) -> None:
    zero = ("reduce", small, "--no-plots", "--method", "zero", "--control", "per-joint")
    assert invoke(*zero, "--tolerance", "1e-3").exit_code == 0
    left = metrics_of(tmp_path / "runs" / "small")["coriolis"]["bb3"]["peak_after_rad_s2"]
    assert 0.0 < left <= 1e-3
