"""Rows as a spreadsheet (``.xlsx``): a row of names, then a row of numbers for each row.

They have sixteen digits, which is what openpyxl writes, and one or two less than a double has.
"""

from __future__ import annotations

import re
import zipfile
from io import BytesIO
from itertools import chain

from des_cli.errors import Complaint, FileAccessError
from des_cli.model.joint_rows import JointRows
from des_cli.runs_out.forms import Form
from des_cli.runs_out.row_text import values_of

MOST_ROWS = 1_048_575
"""That a sheet has room for, below the row of names."""

SHEET = "commands"

_DAY = (1980, 1, 1, 0, 0, 0)
"""Of everything in the file: the same rows are the same bytes."""

_DATES = re.compile(rb"(<dcterms:(?:created|modified)[^>]*>)[^<]*")


def encode_spreadsheet(rows: JointRows, form: Form) -> bytes:
    """Return the bytes of a spreadsheet.

    Raises
    ------
    FileAccessError
        If there are more rows than it has room for.
    """
    from openpyxl import Workbook

    if len(rows.t) > MOST_ROWS:
        what = f"a spreadsheet has room for {MOST_ROWS:,} rows, these are {len(rows.t):,}"
        raise FileAccessError([Complaint("", what)])
    book = Workbook(write_only=True)
    sheet = book.create_sheet(SHEET)
    names = [column.header for column in form.columns]
    for line in chain([names], values_of(rows, form).tolist()):
        sheet.append(line)
    sink = BytesIO()
    book.save(sink)
    return _undated(sink.getvalue())


def _undated(data: bytes) -> bytes:
    """Take the time of writing out of a spreadsheet."""
    sink = BytesIO()
    with zipfile.ZipFile(BytesIO(data)) as old, zipfile.ZipFile(sink, "w") as new:
        for name in old.namelist():
            part = _DATES.sub(rb"\g<1>1980-01-01T00:00:00Z", old.read(name))
            new.writestr(zipfile.ZipInfo(name, _DAY), part, zipfile.ZIP_DEFLATED)
    return sink.getvalue()
