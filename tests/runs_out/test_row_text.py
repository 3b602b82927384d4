"""Rows as lines, read back by the grammar that each program publishes."""

from __future__ import annotations

import csv
import io
import re

import numpy as np
import pytest

from des_cli.model.joint_rows import JointRows
from des_cli.runs_out.forms import PRESETS, Column, Form, read_columns
from des_cli.runs_out.row_text import column_values, header_lines, row_lines
from tests.support.joint_rows import rows

RPM, DEG = 30.0 / np.pi, 180.0 / np.pi


def text_of(given: JointRows, form: Form) -> str:
    return (header_lines(form) + b"".join(row_lines(given, form))).decode()


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("t_s", rows().t),
        ("t_min", rows().t / 60.0),
        ("elapsed_ms", 10.0 * np.arange(25)),
        ("arm_rpm", rows().rate[:, 0] * RPM),
        ("arm_deg", rows().angle[:, 0] * DEG),
        ("fork_rad_s2", rows().acceleration[:, 1]),
        ("cab_deg_s", rows().rate[:, 2] * DEG),
        ("cab_deg_s2", rows().acceleration[:, 2] * DEG),
    ],
)
def test_values(name: str, values: np.ndarray) -> None:
    np.testing.assert_allclose(column_values(rows(), name), values, rtol=1e-14, atol=1e-14)


def test_elapsed_time_is_rounded_to_nanoseconds() -> None:
    given = rows(count=1001, hz=130.0)
    elapsed = column_values(given, "elapsed_s")
    assert elapsed[0] == 0.0
    np.testing.assert_allclose(elapsed, np.arange(1001) / 130.0, atol=5.1e-10)
    assert all(round(value, 9) == value for value in elapsed.tolist())


def test_a_later_part_counts_from_the_first_row_of_all() -> None:
    whole = rows()
    part = JointRows(whole.t[10:], whole.angle[10:], whole.rate[10:], whole.acceleration[10:])
    form = PRESETS["veristand"]
    lines = list(row_lines(part, form, float(whole.t[0])))
    assert lines == list(row_lines(whole, form))[10:]


def test_numbers_read_back_as_the_same_doubles() -> None:
    form = Form(columns=read_columns("t_s,arm_rad,fork_rad_s,cab_rad_s2"), separator="\t")
    lines = text_of(rows(), form).splitlines()
    assert lines[0] == "t_s\tarm_rad\tfork_rad_s\tcab_rad_s2"
    found = np.array([[float(cell) for cell in line.split("\t")] for line in lines[1:]])
    given = rows()
    columns = (given.t, given.angle[:, 0], given.rate[:, 1], given.acceleration[:, 2])
    np.testing.assert_array_equal(found, np.column_stack(columns))


# halstreamer(1): a line for each sample, floats as strtod(3) reads them, whitespace between them;
# lines that begin with # would be comments.
STRTOD = r"[-+]?[0-9]+(\.[0-9]*)?([eE][-+]?[0-9]+)?"


def test_halstreamer() -> None:
    text = text_of(rows(), PRESETS["halstreamer"])
    lines = text.split("\n")
    assert lines.pop() == ""
    assert len(lines) == 25
    assert all(re.fullmatch(f"{STRTOD}( {STRTOD}){{2}}", line) for line in lines)
    found = np.array([line.split() for line in lines], dtype=float)
    given = rows()
    expected = np.column_stack([given.rate[:, 0] * RPM, given.angle[:, 1:] * DEG])
    np.testing.assert_allclose(found, expected, rtol=1e-14)


def test_veristand() -> None:
    """A header with ``timestamp``, in milliseconds from the start of the test, and parameters."""
    table = list(csv.reader(io.StringIO(text_of(rows(), PRESETS["veristand"]))))
    assert table[0] == ["timestamp", "arm_rpm", "fork_deg", "cab_deg"]
    assert [row[0] for row in table[1:]] == [str(10 * n) for n in range(25)]
    assert not any(name.startswith("#") for name in table[0])
    np.testing.assert_allclose(
        [float(row[1]) for row in table[1:]], rows().rate[:, 0] * RPM, rtol=1e-14
    )


def test_simulink() -> None:
    """``time`` first, names in the first row, then labels ``Unit:``, none below the time."""
    table = list(csv.reader(io.StringIO(text_of(rows(), PRESETS["simulink"]))))
    names, units, *numbers = table
    assert names[:4] == ["time", "arm_rad", "arm_rad_s", "arm_rad_s2"]
    assert units[:4] == ["", "Unit: rad", "Unit: rad/s", "Unit: rad/s^2"]
    assert len(names) == len(units) == 10
    time = [float(row[0]) for row in numbers]
    assert time[0] == 0.0
    assert np.all(np.diff(time) > 0.0)


def test_no_header() -> None:
    form = Form(columns=(Column("t_s", "t_s"),), header=False)
    assert header_lines(form) == b""
