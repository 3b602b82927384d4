"""A store: parts are added whole, and what is there twice is read once."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from des_cli.errors import FileAccessError
from des_cli.runs_out.store import append_rows, flat_metrics, read_rows
from des_cli.runs_out.store_filter import parse_condition


def row(folder: str, machine: str = "des", **more: Any) -> dict[str, Any]:
    return {"folder": folder, "machine": machine, **more}


def found(store: Path, condition: str | None = None) -> list[dict[str, Any]]:
    parse = None if condition is None else lambda kinds: parse_condition(condition, kinds)
    return list(read_rows(store, parse)[1])


def test_rows_read_back_by_machine(tmp_path: Path) -> None:
    rows = [row("a", cost=0.1, ok=True), row("b", "my/machine ä", cost=None, ok=False)]
    parts = append_rows(tmp_path / "store", rows)
    assert [part.parent.name for part in parts] == ["machine=des", "machine=my%2Fmachine %C3%A4"]
    assert found(tmp_path / "store") == [
        {"folder": "a", "cost": 0.1, "ok": True, "machine": "des"},
        {"folder": "b", "cost": None, "ok": False, "machine": "my/machine ä"},
    ]
    assert [each["folder"] for each in found(tmp_path / "store", "machine != des")] == ["b"]


def test_what_is_added_again_is_there_once(tmp_path: Path) -> None:
    append_rows(tmp_path, [row("a", cost=1.0)])
    append_rows(tmp_path, [row("a", cost=1.0)])
    assert len(list(tmp_path.rglob("*.parquet"))) == 1
    append_rows(tmp_path, [row("a", cost=1.0), row("b", cost=2.0), row("a", cost=3.0)])
    assert sorted((each["folder"], each["cost"]) for each in found(tmp_path)) == [
        ("a", 1.0),
        ("a", 3.0),
        ("b", 2.0),
    ]


def test_parts_may_have_other_columns(tmp_path: Path) -> None:
    append_rows(tmp_path, [row("a", old=1.0)])
    append_rows(tmp_path, [row("b", new="x")])
    columns, rows = read_rows(tmp_path)
    assert set(columns) == {"folder", "machine", "old", "new"}
    assert sorted((each["folder"], each["old"], each["new"]) for each in rows) == [
        ("a", 1.0, None),
        ("b", None, "x"),
    ]
    assert [each["folder"] for each in found(tmp_path, "old > 0")] == ["a"]


def test_what_is_half_written_is_not_read(tmp_path: Path) -> None:
    append_rows(tmp_path, [row("a")])
    (tmp_path / "machine=des" / ".part-x.parquet.partial-01234567").write_bytes(b"PAR1")
    (tmp_path / "notes.txt").write_text("mine")
    assert [each["folder"] for each in found(tmp_path)] == ["a"]


def test_what_is_no_store_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileAccessError, match="holds no runs"):
        read_rows(tmp_path)
    append_rows(tmp_path, [row("a", cost=1.0)])
    broken = tmp_path / "machine=des" / "part-broken.parquet"
    broken.write_bytes(b"no Parquet")
    with pytest.raises(FileAccessError, match="cannot be read"):
        read_rows(tmp_path)
    pq.write_table(pa.table({"cost": ["text"]}), broken)
    with pytest.raises(FileAccessError, match="cannot be read"):
        read_rows(tmp_path)


def test_numbers_that_are_none_have_no_value() -> None:
    flat = flat_metrics({"a": {"b": math.inf, "c": math.nan, "d": True, "e": 2}, "f": [1]})
    assert flat == {"a.b": None, "a.c": None, "a.d": True, "a.e": 2.0, "f": "[1]"}
