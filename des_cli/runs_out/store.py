"""A store of runs to ask questions of: Parquet files with a row a run, by machine.

Parts are only added, each under a name of its content and whole or not at all; so two batches
may write at a time, and one that is repeated adds nothing. What is in several parts is read once.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

from des_cli.errors import Complaint, FileAccessError
from des_cli.runs_out.atomic import write_file
from des_cli.runs_out.plain_words import plain_words

MACHINE = "machine"
"""The column by which the store is partitioned; it is in the names of folders, not in files."""

_PART = "machine=*/part-*.parquet"
_ROWS_AT_ONCE = 1024


def flat_metrics(metrics: Mapping[str, Any], path: str = "") -> dict[str, Any]:
    """Return metrics by their paths; a list as JSON.

    >>> flat_metrics({"solver": {"cost": 1, "r2": [1, 2], "status": "converged", "ends": None}})
    {'solver.cost': 1.0, 'solver.r2': '[1, 2]', 'solver.status': 'converged', 'solver.ends': None}
    """
    found: dict[str, Any] = {}
    for key, value in metrics.items():
        name = f"{path}{key}"
        if isinstance(value, Mapping):
            found |= flat_metrics(value, f"{name}.")
        elif isinstance(value, list | tuple):
            found[name] = json.dumps(value)
        elif isinstance(value, int | float) and not isinstance(value, bool):
            found[name] = float(value) if math.isfinite(value) else None
        else:
            found[name] = value
    return found


def append_rows(store: Path, rows: Sequence[Mapping[str, Any]]) -> list[Path]:
    """Add rows to a store: one part for each machine.

    Parameters
    ----------
    store : Path
        Made where it is missing.
    rows : sequence of mapping
        Texts, truths and numbers by column; `MACHINE` is one of them.

    Raises
    ------
    FileAccessError
        If a part cannot be written.
    """
    parts = []
    for machine in sorted({str(row[MACHINE]) for row in rows}):
        own = [row for row in rows if str(row[MACHINE]) == machine]
        data = _encode(own)
        folder = store / f"{MACHINE}={quote(machine, safe=' ')}"
        path = folder / f"part-{hashlib.sha256(data).hexdigest()[:32]}.parquet"
        with plain_words(path, "cannot be written"):
            folder.mkdir(parents=True, exist_ok=True)
        parts.append(write_file(path, data, overwrite=True))
    return parts


def read_rows(
    store: Path, condition: Callable[[Mapping[str, str]], Any] | None = None
) -> tuple[list[str], Iterator[dict[str, Any]]]:
    """Read the rows of a store that fulfil a condition, each once.

    Parameters
    ----------
    store : Path
    condition : callable, optional
        Given the kind of each column (``text``, ``truth`` or ``number``) by its name, returns
        an expression of ``pyarrow.compute``.

    Returns
    -------
    list of str
        The columns of all parts, in their order.
    iterator of dict
        What a run has not is None.

    Raises
    ------
    FileAccessError
        If it is no store, or its parts do not fit together.
    """
    import pyarrow as pa
    import pyarrow.dataset as ds

    paths = sorted(store.glob(_PART))
    if not paths:
        what = "holds no runs; add some with: des-coriolis reduce ... --store"
        raise FileAccessError([Complaint(str(store), what)])
    by_machine = ds.partitioning(pa.schema([(MACHINE, pa.string())]), flavor="hive")
    how: dict[str, Any] = {"format": "parquet", "partitioning": by_machine}
    how["partition_base_dir"] = str(store)
    try:
        first = ds.dataset(list(map(str, paths)), **how)
        schemas = [fragment.physical_schema for fragment in first.get_fragments()]
        schema = pa.unify_schemas([*schemas, pa.schema([(MACHINE, pa.string())])])
        data = ds.dataset(list(map(str, paths)), schema=schema, **how)
    except (pa.ArrowException, OSError) as error:
        words = str(error).splitlines()[0]
        raise FileAccessError([Complaint(str(store), f"cannot be read: {words}")]) from error
    kinds = {each.name: _KINDS.get(str(each.type), "other") for each in schema}
    expression = None if condition is None else condition(kinds)
    # Without threads of its own: one that still ends when the process does aborts it.
    batches = data.to_batches(filter=expression, batch_size=_ROWS_AT_ONCE, use_threads=False)
    return schema.names, _each_once(batches)


_KINDS = {"string": "text", "bool": "truth", "double": "number"}


def _each_once(batches: Iterator[Any]) -> Iterator[dict[str, Any]]:
    seen: set[bytes] = set()
    for batch in batches:
        for row in batch.to_pylist():
            digest = hashlib.sha256(repr(list(row.values())).encode()).digest()
            if digest not in seen:
                seen.add(digest)
                yield row


def _encode(rows: Sequence[Mapping[str, Any]]) -> bytes:
    """Return rows of one machine as Parquet; a column without any value is left out."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    types = {str: pa.string(), bool: pa.bool_(), float: pa.float64()}
    names = dict.fromkeys(name for row in rows for name in row if name != MACHINE)
    columns: dict[str, Any] = {}
    for name in names:
        values = [row.get(name) for row in rows]
        known = [value for value in values if value is not None]
        if not known:
            continue
        kind = type(known[0])
        own = [value if isinstance(value, kind) else None for value in values]
        columns[name] = pa.array(own, types[kind])
    sink = pa.BufferOutputStream()
    pq.write_table(pa.table(columns), sink, store_schema=False)
    return bytes(sink.getvalue())
