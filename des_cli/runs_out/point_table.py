"""The points of a trade-off curve in the bytes of each format.

Unlike the tables of ``tables``, these mix numbers and words and have gaps: a point
without a solution has no numbers. Doubles read back exactly here too.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, fields
from typing import Any

from des_cli.model.tradeoff import TradePoint
from des_cli.runs_out.mixed_csv import encode_mixed_csv
from des_cli.runs_out.tables import TableFormat

COLUMNS = tuple(field.name for field in fields(TradePoint))
"""Names of the columns, in their order."""

_WORDS = ("algorithm", "control", "swept", "status", "message")


def encode_points(points: Sequence[TradePoint], format: TableFormat) -> bytes:
    """Return points as a table, a row a point.

    Parameters
    ----------
    points : sequence of TradePoint
    format : {"csv", "ndjson", "json", "parquet"}
        What is not known is an empty cell in ``csv`` and null elsewhere; a truth
        in ``csv`` is ``true`` or ``false``.
    """
    rows = [asdict(point) for point in points]
    if format == "csv":
        return encode_mixed_csv(COLUMNS, rows)
    if format == "parquet":
        return _parquet(rows)
    lines = [json.dumps(row, allow_nan=False, ensure_ascii=False) for row in rows]
    if format == "json":
        return ("[\n" + ",\n".join(lines) + "\n]\n").encode()
    return "".join(line + "\n" for line in lines).encode()


def _parquet(rows: Sequence[dict[str, Any]]) -> bytes:
    # Imported here: it costs a tenth of a second that a CSV table does not need.
    import pyarrow as pa
    import pyarrow.parquet as pq

    kinds = dict.fromkeys(_WORDS, pa.string())
    kinds |= {"iterations": pa.int64(), "limits_ok": pa.bool_()}
    schema = pa.schema([(name, kinds.get(name, pa.float64())) for name in COLUMNS])
    sink = pa.BufferOutputStream()
    pq.write_table(pa.Table.from_pylist(list(rows), schema=schema), sink, store_schema=False)
    return bytes(sink.getvalue())
