"""The points of a sweep, read back."""

import csv
import io

from des_cli.runs_out.point_table import COLUMNS

Rows = list[dict[str, str]]
STUDY = ("--axes", "report", "--r1", "0,2,0")
COARSE = ("--set", "time.step_s=0.05")


def rows_of(text: str) -> Rows:
    """The points of a CSV table, as text by column."""
    reader = csv.DictReader(io.StringIO(text))
    assert tuple(reader.fieldnames or ()) == COLUMNS
    return list(reader)


def curve(rows: Rows, algorithm: str, control: str = "scalar") -> Rows:
    """The points of one algorithm and control."""
    return [row for row in rows if (row["algorithm"], row["control"]) == (algorithm, control)]


def column(rows: Rows, name: str) -> list[float]:
    """The numbers of a column."""
    return [float(row[name]) for row in rows]
