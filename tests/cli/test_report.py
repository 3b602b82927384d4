"""``report``: one page of runs."""

import os
from pathlib import Path

import pytest


@pytest.fixture
def two_runs(invoke, write_profile) -> None:
    for name in ("one", "two"):
        assert invoke("-q", "reduce", write_profile(name).name, "--no-plots").exit_code == 0


@pytest.mark.slow
@pytest.mark.usefixtures("two_runs")
def test_without_arguments_every_run_under_runs(invoke, tmp_path: Path) -> None:
    result = invoke("report")
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr == "2 runs in report.html\n"
    page = (tmp_path / "report.html").read_text()
    assert "one" in page
    assert "two" in page


@pytest.mark.usefixtures("two_runs")
def test_a_second_report_replaces_the_first_only_where_that_is_asked(
    invoke, tmp_path: Path
) -> None:
    (tmp_path / "report.html").write_text("old")
    result = invoke("report")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr == "report.html: exists; --overwrite replaces it\n"
    assert (tmp_path / "report.html").read_text() == "old"
    assert invoke("report", "--overwrite").exit_code == 0
    assert "two" in (tmp_path / "report.html").read_text()


@pytest.mark.usefixtures("two_runs")
def test_named_runs_to_a_file_or_stdout(invoke, tmp_path: Path) -> None:
    assert invoke("report", "runs/one", "-o", "page.html").exit_code == 0
    result = invoke("report", "runs/one", "-o", "-")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout == (tmp_path / "page.html").read_text()
    assert result.stdout != invoke("report", "runs/two", "-o", "-").stdout


@pytest.mark.usefixtures("two_runs")
def test_a_run_named_twice_is_on_the_page_once(invoke) -> None:
    result = invoke("report", "runs", "runs/one", "-o", "page.html")
    assert result.stderr == "2 runs in page.html\n"


@pytest.mark.usefixtures("two_runs")
@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_a_page_is_not_kept_waiting_by_a_pipe(invoke, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "page.html")
    result = invoke("report", "-o", "page.html")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr.startswith("page.html: is a pipe, not a file; ")


def test_no_run_is_1_and_says_how_to_make_one(invoke, tmp_path: Path) -> None:
    result = invoke("report")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr == "runs: does not exist; make a run with: des-coriolis reduce cobra\n"
    (tmp_path / "empty").mkdir()
    result = invoke("report", "empty", "nowhere")
    assert result.exit_code == 1
    assert [line.partition(":")[0] for line in result.stderr.splitlines()] == ["empty", "nowhere"]
    assert not (tmp_path / "report.html").exists()


@pytest.mark.usefixtures("two_runs")
def test_a_changed_run_is_refused(invoke, tmp_path: Path) -> None:
    commands = tmp_path / "runs" / "one" / "commands.csv"
    commands.write_text(commands.read_text().replace("t_s", "t_ms"))
    result = invoke("report")
    assert result.exit_code == 1
    assert "commands.csv" in result.stderr
    assert not (tmp_path / "report.html").exists()
