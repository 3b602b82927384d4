"""``summary.csv``: a row a run, whole or not at all, and over nobody's file."""

import csv
import io
from pathlib import Path

import pytest

from des_cli.batch import summary
from des_cli.batch.summary import COLUMNS, SummaryRow, encode_summary, exit_code_of, write_summary
from des_cli.errors import ExitCode, FileAccessError
from tests.support.summaries import result

BAD = result(
    name="",
    exit_code=ExitCode.NO_SOLUTION,
    state="failed",
    metrics=None,
    written="",
    complaints=("c: infeasible", "=c: twice"),
)


def test_a_row_tells_the_numbers_of_the_metrics() -> None:
    row = SummaryRow.of(result())
    assert (row.vector_reduction, row.seat_rate_deviation_relative) == (0.458, 0.0911)
    assert (row.seat_g_rms_error_g, row.status, row.iterations) == (0.0834, "converged", 6)
    assert (row.folder, row.state, row.exit_code) == ("c", "reduced", 0)


def test_the_bytes_read_back() -> None:
    data = encode_summary([SummaryRow.of(result()), SummaryRow.of(BAD)]).decode()
    first, second = csv.DictReader(io.StringIO(data))
    assert tuple(first) == COLUMNS
    assert float(first["seat_g_rms_error_g"]) == 0.0834
    assert (second["name"], second["folder"], second["exit_code"]) == ("", "", "4")
    assert second["message"] == "c: infeasible; =c: twice"
    assert second["status"] == ""


def test_it_replaces_an_earlier_one_and_nothing_else(tmp_path: Path) -> None:
    out = tmp_path / "new" / "runs"
    write_summary(str(out), [SummaryRow.of(BAD)])
    path = write_summary(str(out), [SummaryRow.of(result())])
    assert path.read_bytes() == encode_summary([SummaryRow.of(result())])
    path.write_text("mine\n")
    with pytest.raises(FileAccessError, match="is not the summary of a batch"):
        write_summary(str(out), [])
    assert path.read_text() == "mine\n"
    assert [each.name for each in out.iterdir()] == ["summary.csv"]


def test_one_that_cannot_be_written_leaves_the_earlier_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write_summary(str(tmp_path), [SummaryRow.of(BAD)])
    before = path.read_bytes()

    def fail(*_: object) -> bytes:
        raise MemoryError

    monkeypatch.setattr(summary, "encode_summary", fail)
    with pytest.raises(MemoryError):
        write_summary(str(tmp_path), [])
    assert path.read_bytes() == before
    path.unlink()
    path.mkdir()
    monkeypatch.undo()
    with pytest.raises(FileAccessError):
        write_summary(str(tmp_path), [])


def test_exit_code_of_a_batch() -> None:
    good, bad = SummaryRow.of(result()), SummaryRow.of(BAD)
    assert exit_code_of([bad], 1) == 4
    assert exit_code_of([good, bad], 2) == 1
    assert exit_code_of([good], 2) == 1
    assert exit_code_of([good, good], 2) == 0
