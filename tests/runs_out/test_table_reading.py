"""A table reads back as it was written, and nothing else reads at all."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from des_cli.errors import NotReleasedError
from des_cli.model.run import Run
from des_cli.runs_out.table_reading import COLUMNS, parse_command_table
from des_cli.runs_out.tables import TABLE_FORMATS, TableFormat, command_columns, encode_table

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
def test_what_is_spelled_otherwise_is_refused(text: str, why: str) -> None:
    with pytest.raises(NotReleasedError) as caught:
        parse_command_table(text.encode(), "x.csv")
    assert str(caught.value).startswith(f"x.csv: is no command table: {why}")


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
