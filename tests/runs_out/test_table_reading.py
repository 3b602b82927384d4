"""A table reads back as it was written, and nothing else reads at all."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np
import pytest

from des_cli.errors import NotReleasedError
from des_cli.model.run import Run
from des_cli.runs_out import table_reading, tables
from des_cli.runs_out.table_reading import COLUMNS, parse_command_table
from des_cli.runs_out.tables import (
    LONG_TABLE,
    TABLE_FORMATS,
    TableFormat,
    command_columns,
    encode_table,
)

HEADER = "t_s,arm_rpm,fork_deg,cab_deg\n"
GOOD = HEADER + "0.0,30.0,180.0,-90.0\n0.5,60.0,1e-05,0.0\n"


@pytest.mark.parametrize("form", TABLE_FORMATS)
def test_every_format_reads_back(form: TableFormat, synthetic_run: Callable[..., Run]) -> None:
    columns = command_columns(synthetic_run(101))
    table = parse_command_table(encode_table(columns, form), "cobra")
    assert tuple(columns) == COLUMNS
    np.testing.assert_array_equal(table.t, columns["t_s"])
    # From the columns by hand: a rpm is pi / 30 rad/s, a degree pi / 180 rad.
    np.testing.assert_allclose(table.arm_rate, columns["arm_rpm"] * math.pi / 30, rtol=1e-15)
    positions = np.column_stack([columns["fork_deg"], columns["cab_deg"]])
    np.testing.assert_allclose(table.position, positions * math.pi / 180, rtol=1e-15)


def test_numbers_by_hand() -> None:
    table = parse_command_table(GOOD.encode(), "x")
    np.testing.assert_allclose(table.values[0], [0, math.pi, math.pi, -math.pi / 2], rtol=1e-15)
    np.testing.assert_allclose(table.values[1], [0.5, 2 * math.pi, math.radians(1e-5), 0])


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (GOOD[:-1], "its last line does not end: it was cut"),
        (GOOD[:-6], "its last line does not end: it was cut"),
        (GOOD.replace("t_s", "t_ms"), "its first line is not t_s,arm_rpm,fork_deg,cab_deg"),
        (GOOD.replace("arm_rpm,fork_deg", "fork_deg,arm_rpm"), "its first line is not"),
        ("\ufeff" + GOOD, "its first line is not"),
        ("# made by\n" + GOOD, "its first line is not"),
        (GOOD.replace("30.0", "nan"), "row 1 is not 4 plain numbers"),
        (GOOD.replace("30.0", "inf"), "row 1 is not 4 plain numbers"),
        (GOOD.replace("30.0", "1e400"), "row 1 is not 4 plain numbers"),
        (GOOD.replace("30.0", "1e+400"), "row 1 holds a number that is not finite"),
        (GOOD.replace("30.0", "+30.0"), "row 1 is not 4 plain numbers"),
        (GOOD.replace("30.0", " 30.0"), "row 1 is not 4 plain numbers"),
        (GOOD.replace("30.0", "3_0.0"), "row 1 is not 4 plain numbers"),
        (GOOD.replace("30.0", "٣٠.0"), "row 1 is not 4 plain numbers"),
        (GOOD.replace("30.0", "0x1e"), "row 1 is not 4 plain numbers"),
        (GOOD.replace("30.0", ""), "row 1 is not 4 plain numbers"),
        (GOOD.replace("60.0", "60.0,1.0"), "row 2 is not 4 plain numbers"),
        (GOOD.replace(",0.0\n", "\n"), "row 2 is not 4 plain numbers"),
        (GOOD.replace("\n", "\r\n"), "its first line is not"),
        (GOOD + "\n", "row 3 is not 4 plain numbers"),
        (HEADER, "it has fewer than two rows"),
        (HEADER + "0.0,1.0,2.0,3.0\n", "it has fewer than two rows"),
        ("", "its last line does not end"),
        ("[]\n", "it has fewer than two rows"),
        ("[1]\n", "row 1 is not an object of numbers"),
        ('[{"t_s": 1.0}]\n', "row 1 is not an object of numbers"),
        ('{"t_s": 0.0, "t_s": 1.0, "arm_rpm": 1.0, "fork_deg": 1.0, "cab_deg": 1.0}\n', "row 1"),
        ('{"t_s": "0", "arm_rpm": 1.0, "fork_deg": 1.0, "cab_deg": 1.0}\n', "row 1"),
        ('{"t_s": true, "arm_rpm": 1.0, "fork_deg": 1.0, "cab_deg": 1.0}\n', "row 1"),
        ("[" * 100_000 + "\n", "it is not the JSON of rows"),
        ("{\n", "it is not the JSON of rows"),
        ("PAR1 and no more", "it is not Parquet"),
    ],
)
def test_what_is_spelled_otherwise_is_refused(
    text: str, why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for long in (LONG_TABLE, 0):
        monkeypatch.setattr(table_reading, "LONG_TABLE", long)
        with pytest.raises(NotReleasedError) as caught:
            parse_command_table(text.encode(), "x.csv")
        assert str(caught.value).startswith(f"x.csv: is no command table: {why}")


@pytest.mark.parametrize(
    "number",
    ["1.", ".5", "-.5", "1.e+5", "1e5", "1e+.5", "--1", "1-2", "007", "-0", "1e+5", "2e-7"],
)
@pytest.mark.parametrize("column", [0, 1, 3])
def test_a_long_table_has_the_grammar_of_a_short_one(
    number: str, column: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = [["5.0", "1.0", "2.0", "3.0"], ["6.0", "1.0", "2.0", "3.0"]]
    rows[0][column] = number
    data = (HEADER + "".join(",".join(row) + "\n" for row in rows)).encode()
    outcomes = []
    for long in (LONG_TABLE, 0):
        monkeypatch.setattr(table_reading, "LONG_TABLE", long)
        try:
            outcomes.append(parse_command_table(data, "x").values.tolist())
        except NotReleasedError as error:
            outcomes.append(str(error))
    assert outcomes[0] == outcomes[1]
    assert isinstance(outcomes[0], list) == bool(re.fullmatch(r"-?\d+(e[+-]\d+)?", number))


def test_a_long_table_is_written_and_read_by_arrow(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(3)
    size = 10.0 ** rng.uniform(-320, 300, (4, 2000))
    columns = dict(zip(COLUMNS, rng.choice([-1.0, 1.0], size.shape) * size, strict=True))
    columns["t_s"] = np.arange(2000.0)
    short = parse_command_table(encode_table(columns, "csv"), "x")
    monkeypatch.setattr(tables, "LONG_TABLE", 0)
    monkeypatch.setattr(table_reading, "LONG_TABLE", 0)
    data = encode_table(columns, "csv")
    assert data.startswith(HEADER.encode() + b"0,")
    np.testing.assert_array_equal(parse_command_table(data, "x").values, short.values)
    monkeypatch.setattr(table_reading, "LONG_TABLE", LONG_TABLE)
    np.testing.assert_array_equal(parse_command_table(data, "x").values, short.values)


def test_parquet_of_other_columns_or_kinds_is_refused(synthetic_run: Callable[..., Run]) -> None:
    columns = command_columns(synthetic_run(11))
    renamed = {name.replace("deg", "rad"): values for name, values in columns.items()}
    with pytest.raises(NotReleasedError, match="its columns are not t_s"):
        parse_command_table(encode_table(renamed, "parquet"), "x")


@pytest.mark.parametrize("form", TABLE_FORMATS)
def test_cut_anywhere_it_is_refused(form: TableFormat, synthetic_run: Callable[..., Run]) -> None:
    data = encode_table(command_columns(synthetic_run(4)), form)
    whole = parse_command_table(data, "x").values
    for length in range(len(data)):
        try:
            read = parse_command_table(data[:length], "x").values
        except NotReleasedError:
            continue
        # At the end of a row a text cannot tell; whoever knows how many there are does.
        assert form in ("csv", "ndjson")
        assert len(read) < len(whole)
