"""``export``: what ``verify`` passes, in other forms."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from tests.support.run_files import csv_rows
from tests.support.tables import csv_of, riding, swaying


@pytest.fixture
def table(tmp_path: Path) -> str:
    """The name of a table in the test's folder."""
    (tmp_path / "t.csv").write_bytes(csv_of(swaying(100.0, 0.5)))
    return "t.csv"


def test_without_options_it_is_the_same_table(invoke, table: str) -> None:
    result = invoke("export", table, "-o", "o.csv")
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr == "o.csv: 51 rows of t.csv\n"
    np.testing.assert_allclose(
        csv_rows(Path("o.csv").read_text()), csv_rows(Path(table).read_text()), rtol=1e-15
    )


def test_a_run_tells_where_its_arm_starts(invoke, write_profile) -> None:
    name = write_profile("turned").name
    Path(name).write_text(Path(name).read_text().replace("{arm_deg: 0}", "{arm_deg: 40}"))
    options = ("--r1", "2,2,2", "--control", "free", "--axes", "seat", "--ends", "match-start")
    budget = ("--budget", "seat_rate_deviation_relative=0.05", "--no-plots", "-o", "run")
    assert invoke("-q", "reduce", name, *options, *budget).exit_code == 0
    result = invoke("export", "run", "--columns", "t_s,arm_deg,arm_rpm", "-o", "-")
    assert result.exit_code == 0, result.stderr
    header, first, *_ = result.stdout.splitlines()
    assert header == "t_s,arm_deg,arm_rpm"
    assert float(first.split(",")[1]) == pytest.approx(40.0)


def test_other_columns_and_separators_on_stdout(invoke, table: str) -> None:
    columns = "t_ms=time,arm_rad_s,fork_deg_s=Fork rate"
    result = invoke("export", table, "--columns", columns, "--out-separator", "tab", "-o", "-")
    assert result.exit_code == 0
    lines = result.stdout.splitlines()
    assert lines[0] == "time\tarm_rad_s\tFork rate"
    found = np.array([line.split("\t") for line in lines[1:]], float)
    np.testing.assert_allclose(found[:, 0], 10.0 * np.arange(51), atol=1e-9)
    np.testing.assert_allclose(found[:, 1], swaying(100.0, 0.5).arm_rate, rtol=1e-14)
    exact = np.degrees(0.2 * 0.5 * np.cos(0.5 * found[:, 0] / 1e3))
    np.testing.assert_allclose(found[:, 2], exact, atol=1e-4)


def test_rows_on_another_clock_are_a_table_that_passes(invoke) -> None:
    Path("r.csv").write_bytes(csv_of(riding()))
    assert invoke("export", "r.csv", "--hz", "130", "-o", "o.csv").exit_code == 0
    rows = csv_rows(Path("o.csv").read_text())
    np.testing.assert_allclose(np.diff(rows[:, 0]), 1.0 / 130.0)
    assert invoke("verify", "o.csv").exit_code == 0


@pytest.mark.parametrize(
    ("preset", "name", "module"),
    [
        ("halstreamer", "o.txt", None),
        ("veristand", "o.csv", None),
        ("simulink", "o.csv", None),
        ("simulink", "o.xlsx", "openpyxl"),
        ("ros2", "o.yaml", None),
        ("xlsx", "o.xlsx", "openpyxl"),
        ("mcap", "o.mcap", "mcap"),
    ],
)
def test_presets(invoke, table: str, preset: str, name: str, module: str | None) -> None:
    if module is not None and find_spec(module) is None:
        pytest.skip(f"needs {module}")
    assert invoke("export", table, "--preset", preset, "-o", name).exit_code == 0
    written = Path(name).read_bytes()
    assert written
    assert invoke("export", table, "--preset", preset, "-o", "-").exit_code == 0
    refused = invoke("export", table, "--preset", preset, "-o", name)
    assert refused.exit_code == 1
    assert "--overwrite" in refused.stderr
    again = invoke("export", table, "--preset", preset, "-o", name, "--overwrite", "-q")
    assert (again.exit_code, again.stderr) == (0, "")
    assert Path(name).read_bytes() == written


def test_what_does_not_pass_is_not_written(invoke) -> None:
    data = csv_of(riding())
    broken = data.replace(b"\n0.4,", b"\n0.39,", 1)
    result = invoke("export", "-", "-o", "o.csv", input=broken)
    assert result.exit_code == 5
    assert result.stderr == invoke("verify", "-", input=broken).stderr
    assert invoke("export", "-", "-o", "o.csv", input=data[:-5]).exit_code == 3
    assert not Path("o.csv").exists()


def test_uneven_rows_need_a_clock_where_no_times_are_told(invoke) -> None:
    rows = csv_of(swaying(100.0, 0.5)).splitlines(keepends=True)
    data = b"".join(rows[:20] + rows[21:])
    result = invoke("export", "-", "--preset", "halstreamer", "-o", "o.txt", input=data)
    assert result.exit_code == 5
    assert result.stderr == (
        "-: its rows are not evenly spaced, and this form tells no times: give --hz\n"
    )
    clocked = ("export", "-", "--preset", "halstreamer", "--hz", "50", "-o", "o.txt")
    assert invoke(*clocked, input=data).exit_code == 0
    assert len(Path("o.txt").read_text().splitlines()) == 26


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["-o", "o.foo"], "o.foo: .foo is no format of a table"),
        (["-o", "folder/"], "-o folder/ is no file: give it a suffix, as in folder.csv."),
        (["-o", "o.csv", "--columns", "p_rad_s"], "'p_rad_s' is no column"),
        (["-o", "o.csv", "--out-separator", "xx"], "'xx' cannot stand between numbers"),
        (["-o", "o.csv", "--hz", "0"], "--hz"),
        ([], "--out"),
    ],
)
def test_wrong_use(invoke, table: str, options: list[str], words: str) -> None:
    result = invoke("export", table, *options)
    assert result.exit_code == 2
    assert words in result.stderr


def test_a_folder_that_is_not_there_is_told(invoke, table: str) -> None:
    result = invoke("export", table, "-o", "nowhere/o.csv")
    assert result.exit_code == 1
    assert result.stderr.startswith("nowhere/o.csv: ")
