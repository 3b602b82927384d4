"""Rows in other forms: what was written is read back, and refused where it is not the rows."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
import pytest

from des_cli.errors import NotReleasedError
from des_cli.model.machine import Seat
from des_cli.release.exported import Export
from des_cli.release.playback import Playback
from des_cli.runs_out.forms import COMMANDS, PRESETS, Form, as_spreadsheet, read_columns
from des_cli.verify.table import check_against
from tests.support.tables import DES, riding, swaying, uneven

FORMS = {
    **PRESETS,
    "csv": Form(columns=COMMANDS),
    "tab": Form(columns=read_columns("t_ms=T,arm_deg,fork_rad_s2"), separator="\t", header=False),
    "ndjson": Form("ndjson", read_columns("t_s=time,arm_rad_s")),
    "json": Form("json", COMMANDS),
    "parquet": Form("parquet", COMMANDS),
    "simulink xlsx": as_spreadsheet(PRESETS["simulink"]),
}
MODULES = {"xlsx": "openpyxl", "mcap": "mcap"}


def playback(hz: float = 100.0) -> Playback:
    return Playback(swaying(hz, 0.5), DES, Seat(), 0.0, "t")


def needs(form: Form) -> None:
    module = MODULES.get(form.kind)
    if module is not None and find_spec(module) is None:
        pytest.skip(f"needs {module}")


@pytest.mark.parametrize("name", FORMS)
@pytest.mark.parametrize("hz", [None, 130.0])
def test_what_is_written_reads_back(name: str, hz: float | None) -> None:
    from dataclasses import replace

    form = replace(FORMS[name], hz=hz)
    needs(form)
    export = Export(playback(), form)
    assert len(export.rows.t) == (51 if hz is None else 66)
    export.require(export.data)


@pytest.mark.parametrize("name", FORMS)
def test_other_rows_are_refused(name: str) -> None:
    form = FORMS[name]
    needs(form)
    right, other = (Export(Playback(table, DES, Seat(), 0.0, "t"), form) for table in TWO)
    with pytest.raises(
        NotReleasedError, match=r"t: what was written is wrong: row \d+ holds other"
    ):
        right.require(other.data)
    fewer = Export(Playback(swaying(100.0, 0.4), DES, Seat(), 0.0, "t"), form)
    with pytest.raises(NotReleasedError, match="it has 41 rows, not 51"):
        right.require(fewer.data)


def _with_row(number: int) -> object:
    table = swaying(100.0, 0.5)
    arm, position = table.arm_rate.copy(), table.position.copy()
    arm[number] += 1e-9
    position[number] += 1e-9
    return type(table)(table.t, arm, position)


TWO = (swaying(100.0, 0.5), _with_row(6))


@pytest.mark.parametrize("name", FORMS)
def test_bytes_that_were_cut_or_are_others_are_refused(name: str) -> None:
    form = FORMS[name]
    needs(form)
    export = Export(playback(), form)
    for broken in (export.data[: len(export.data) // 2], b"", b"nonsense\n"):
        with pytest.raises(NotReleasedError, match="what was written is wrong"):
            export.require(broken)


def test_rows_without_times_must_be_even() -> None:
    table = Playback(uneven(swaying()), DES, Seat(), 0.0, "t")
    with pytest.raises(NotReleasedError, match="not evenly spaced, and this form tells no times"):
        Export(table, PRESETS["halstreamer"])


def test_rows_between_the_tables_keep_the_limits_or_are_refused() -> None:
    form = Form(columns=COMMANDS, hz=130.0)
    export = Export(Playback(riding(), DES, Seat(), 0.0, "t"), form)
    assert all(check.ok for check in check_against(DES, Seat(), export.rows.commands))
    table = riding()
    wild = type(table)(table.t, table.arm_rate, 3.0 * table.position)
    with pytest.raises(NotReleasedError, match="at 130 Hz: relative excess of the fork's jerk"):
        Export(Playback(wild, DES, Seat(), 0.0, "t"), form)
    # As the gate does with a profile that only wants to be told.
    assert len(Export(Playback(wild, DES, Seat(), 0.0, "t"), form, enforced=False).data) > 1000


def test_own_rows_tell_no_more_than_the_limits() -> None:
    table = riding()
    rows = Playback(table, DES, Seat(), 0.0, "t").own_rows()
    np.testing.assert_array_equal(rows.commands.values, table.values)
    for quantity in ("rate", "acceleration"):
        most = [getattr(limit, quantity) for limit in DES.limits]
        assert np.all(np.max(np.abs(getattr(rows, quantity)), axis=0) <= most)
