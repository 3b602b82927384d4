"""A spreadsheet, read back by openpyxl."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest

from des_cli.errors import FileAccessError
from des_cli.runs_out import spreadsheet
from des_cli.runs_out.forms import PRESETS, Form, as_spreadsheet
from des_cli.runs_out.row_text import values_of
from des_cli.runs_out.spreadsheet import encode_spreadsheet
from tests.support.joint_rows import rows

openpyxl = pytest.importorskip("openpyxl")


def cells_of(data: bytes) -> list[tuple[object, ...]]:
    book = openpyxl.load_workbook(BytesIO(data))
    assert book.sheetnames == ["commands"]
    return list(book.active.iter_rows(values_only=True))


@pytest.mark.parametrize("form", [PRESETS["xlsx"], as_spreadsheet(PRESETS["simulink"])])
def test_names_stand_above_numbers(form: Form) -> None:
    names, *numbers = cells_of(encode_spreadsheet(rows(), form))
    assert list(names) == [column.header for column in form.columns]
    np.testing.assert_allclose(np.array(numbers, float), values_of(rows(), form), rtol=1e-15)


def test_the_same_rows_are_the_same_bytes() -> None:
    one, other = (encode_spreadsheet(rows(), PRESETS["xlsx"]) for _ in range(2))
    assert one == other
    book = openpyxl.load_workbook(BytesIO(one))
    assert book.properties.created.year == book.properties.modified.year == 1980


def test_more_rows_than_a_sheet_has_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(spreadsheet, "MOST_ROWS", 24)
    with pytest.raises(FileAccessError, match="has room for 24 rows, these are 25"):
        encode_spreadsheet(rows(), PRESETS["xlsx"])
