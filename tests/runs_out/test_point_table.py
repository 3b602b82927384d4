"""The points of a curve read back from every format as they were."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import asdict, replace

import pyarrow.parquet as pq
import pytest

from des_cli.runs_out.point_table import COLUMNS, encode_points
from tests.support.trade_points import GONE, POINT

POINTS = [replace(POINT, value=0.1 + 0.2, message='wörds, and "quotes"\nof two lines'), GONE]
ROWS = [asdict(point) for point in POINTS]


def test_json_and_ndjson_hold_the_points() -> None:
    assert json.loads(encode_points(POINTS, "json")) == ROWS
    lines = encode_points(POINTS, "ndjson").decode().splitlines()
    assert [json.loads(line) for line in lines] == ROWS
    assert tuple(json.loads(lines[0])) == COLUMNS


def test_parquet_holds_the_points_with_their_kinds() -> None:
    table = pq.read_table(io.BytesIO(encode_points(POINTS, "parquet")))
    assert table.to_pylist() == ROWS
    kinds = {name: str(table.schema.field(name).type) for name in ("status", "cost", "limits_ok")}
    assert kinds == {"status": "string", "cost": "double", "limits_ok": "bool"}


def test_csv_leaves_what_is_not_known_empty() -> None:
    reader = csv.DictReader(io.StringIO(encode_points(POINTS, "csv").decode(), newline=""))
    solved, gone = reader
    assert tuple(solved) == COLUMNS
    assert float(solved["value"]) == 0.1 + 0.2
    assert (solved["limits_ok"], gone["limits_ok"], gone["cost"]) == ("true", "", "")
    assert solved["message"] == POINTS[0].message


@pytest.mark.parametrize(
    "text", ["=1+1", "+1", "-1", "@SUM(A1)", "\tx", "\rx", "=cmd|' /C calc'!A0"]
)
def test_no_text_is_a_formula_of_a_spreadsheet_and_no_number_is_another(text: str) -> None:
    point = replace(POINT, message=text, value=-0.25)
    data = encode_points([point], "csv").decode()
    (row,) = csv.DictReader(io.StringIO(data.replace("\r", "\\r"), newline=""))
    assert row["message"] == f"'{text}".replace("\r", "\\r")
    assert row["value"] == "-0.25"
    assert json.loads(encode_points([point], "ndjson"))["message"] == text


@pytest.mark.parametrize("form", ["csv", "ndjson", "json", "parquet"])
def test_no_points_are_a_table_without_rows(form) -> None:
    data = encode_points([], form)
    if form == "csv":
        assert data.decode() == ",".join(COLUMNS) + "\n"
    elif form == "parquet":
        assert pq.read_table(io.BytesIO(data)).num_rows == 0
    else:
        assert "".join(data.decode().split()) in ("", "[]")
