"""Whatever a file holds: one line for each problem, the right exit code, and no table."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.hostile import HEADER, ROWS, YAML, Case, cases, csv_of

CASES = list(cases())


def test_what_they_are_made_of_is_good(invoke, tmp_path: Path) -> None:
    (tmp_path / "good.yaml").write_text(YAML)
    (tmp_path / "good.csv").write_text(csv_of(ROWS, HEADER))
    result = invoke("validate", "good.yaml", "good.csv")
    assert (result.exit_code, result.stderr) == (0, "")
    assert len(CASES) >= 150


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_it_is_refused_in_words_and_leaves_nothing(invoke, tmp_path: Path, case: Case) -> None:
    (tmp_path / case.name).write_bytes(case.data)
    result = invoke("reduce", case.name, "-o", "out.csv")
    assert result.exit_code == 3, result.stderr
    lines = result.stderr.splitlines()
    assert lines
    assert all(line.startswith((f"{case.name}:", "…")) for line in lines), lines
    assert all(line.isprintable() and len(line) < 1000 for line in lines)
    assert case.word in result.stderr
    assert "Traceback" not in result.stderr
    assert result.stdout == ""
    assert [path.name for path in tmp_path.iterdir()] == [case.name]
