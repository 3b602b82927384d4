"""States as columns and as objects: one name for each number, and the same numbers."""

from __future__ import annotations

import csv
import io
import json

import numpy as np

from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.runs_out.state_tables import QUANTITIES, encode_state, encode_states
from des_cli.study.state import report_states

ANGLE = np.array([[0.1, -0.7, 0.4], [0.0, 0.2, 0.3]])
RATE = np.array([[2.0, 0.5, -1.0], [1.0, 0.0, 0.0]])
REPORT = report_states(DES, Seat(), ANGLE, RATE, 0.1 * RATE)


def test_names_are_unique_and_a_quantity_has_as_many_as_it_has_numbers() -> None:
    names = [name for quantity in QUANTITIES for name in quantity.names]
    assert len(set(names)) == len(names)
    assert len({quantity.key for quantity in QUANTITIES}) == len(QUANTITIES)
    for quantity in QUANTITIES:
        value = getattr(REPORT, quantity.field)[0]
        assert len(quantity.names) == np.size(value), quantity.key


def test_columns_are_the_numbers_of_the_report() -> None:
    t = np.array([0.0, 0.5])
    rows = list(csv.DictReader(io.StringIO(encode_states(REPORT, "csv", t).decode())))
    assert [float(row["t_s"]) for row in rows] == [0.0, 0.5]
    for quantity in QUANTITIES:
        for number, row in enumerate(rows):
            value = np.ravel(getattr(REPORT, quantity.field)[number])
            assert [float(row[name]) for name in quantity.names] == value.tolist()


def test_one_state_is_an_object_of_whole_quantities() -> None:
    report = report_states(DES, Seat(), ANGLE[:1], RATE[:1], 0.1 * RATE[:1])
    about = {"machine": "des", "seat_yaw_rad": 1.0, "seat_pitch_rad": 0.0}
    found = json.loads(encode_state(report, "json", about))
    assert list(found)[:3] == list(about)
    assert {quantity.key for quantity in QUANTITIES} <= set(found)
    np.testing.assert_array_equal(np.ravel(found["j2"]), np.ravel(report.j2[0]))
    [line] = encode_state(report, "ndjson", about).decode().splitlines()
    assert json.loads(line) == {key: found[key] for key in found if key not in about}
