"""``reduce --store`` adds runs, and ``report --store`` finds them."""

from __future__ import annotations

import csv
import io

import pytest

from des_cli.batch import store as batch_store
from des_cli.cli import report_store
from tests.support.run_files import metrics_of


def rows_of(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text)))


def test_runs_are_added_and_found_with_the_numbers_of_their_metrics(
    invoke, write_profile, tmp_path
) -> None:
    files = [write_profile("bad", fork_deg="sin(").name, write_profile("good").name]
    line = ("reduce", *files, "--grid", "r2=1,4", "--no-plots", "--keep-going", "--store", "st")
    assert invoke(*line).exit_code == 1
    result = invoke("report", "--store", "st")
    assert (result.exit_code, result.stderr) == (0, "2 runs\n")
    rows = rows_of(result.stdout)
    for row in rows:
        metrics = metrics_of(tmp_path / row["folder"])
        assert (row["profile.name"], row["machine"]) == (metrics["profile"]["name"], "des")
        assert (
            float(row["coriolis.vector.reduction"]) == (metrics["coriolis"]["vector"]["reduction"])
        )
    assert {row["folder"] for row in rows} == {"runs/good__r2_1", "runs/good__r2_4"}
    least = min(rows, key=lambda row: float(row["fidelity.seat_g_rms_error_g"]))
    where = f"seat_g_rms_error_g <= {least['fidelity.seat_g_rms_error_g']}"
    result = invoke("report", "--store", "st", "--where", where)
    assert rows_of(result.stdout) == [least]
    # kept runs are the same rows, and add nothing
    assert invoke(*line, "--resume").exit_code == 1
    assert len(list((tmp_path / "st").rglob("*.parquet"))) == 1


def test_a_batch_that_is_stopped_has_added_what_was_done(
    invoke, write_profile, tmp_path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(batch_store, "_ROWS_A_PART", 1)
    small, bad = write_profile("small").name, write_profile("bad", fork_deg="sin(").name
    assert invoke("reduce", small, bad, "--no-plots", "--store", "st").exit_code == 1
    assert rows_of(invoke("report", "--store", "st").stdout)[0]["profile.name"] == "small"
    assert invoke("reduce", small, "--dry-run", "--overwrite", "--store", "no").exit_code == 0
    assert not (tmp_path / "no").exists()


def test_a_person_sees_few_columns(invoke, small: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert invoke("reduce", small, "--no-plots", "--store", "st").exit_code == 0
    rows = [{"profile.name": "small", "fidelity.seat_g_rms_error_g": 0.05004999, "folder": "x"}]
    head, line = report_store._lines(rows)
    assert head.split()[:3] == ["profile", "machine", "status"]
    assert line.split() == ["small", "-", "-", "-", "-", "0.05005", "-", "x"]


def test_a_file_takes_the_rows(invoke, small: str, tmp_path) -> None:
    assert invoke("reduce", small, "--no-plots", "--store", "st").exit_code == 0
    result = invoke("report", "--store", "st", "-o", "rows.csv")
    assert (result.exit_code, result.stdout) == (0, "")
    assert (tmp_path / "rows.csv").read_text() == invoke("report", "--store", "st").stdout


@pytest.mark.parametrize(
    ("args", "code", "words"),
    [
        (["report", "--where", "a = 1"], 2, "--where needs --store"),
        (["report", "runs", "--store", "st"], 2, "leave out RUN"),
        (["report", "--store", "nowhere"], 1, "holds no runs"),
        (["reduce", "small.yaml", "--store", "st", "-o", "x.csv"], 2, "needs run folders"),
    ],
)
def test_what_is_refused(invoke, small: str, args: list[str], code: int, words: str) -> None:
    result = invoke(*args)
    assert (result.exit_code, words in result.stderr) == (code, True)
