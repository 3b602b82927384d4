"""No bytes but those of the run pass: faults of every kind, each at a random place."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from des_cli.errors import NotReleasedError
from des_cli.model.arrays import Floats
from des_cli.model.motion import Motion
from des_cli.model.run import Run
from des_cli.pipeline import reduce_profile
from des_cli.profiles_in.load import load_profile
from des_cli.release.gate import check_table, require_table
from des_cli.runs_out.table_reading import COLUMNS, parse_command_table
from des_cli.runs_out.tables import TABLE_FORMATS, command_columns, encode_table

FAULTS = int(os.environ.get("DES_CORIOLIS_FAULTS", "1000"))
"""How many wrong tables are tried; docs/credibility.md tells of ten thousand."""


@pytest.fixture(scope="module")
def run() -> Run:
    return reduce_profile(load_profile("cobra_felt", settings=["time.step_s=0.05"]))


def table_of(columns: dict[str, Floats]) -> bytes:
    return encode_table(columns, "csv")


def test_a_table_as_it_is_written_passes(run: Run) -> None:
    for form in TABLE_FORMATS:
        data = encode_table(command_columns(run), form)
        require_table(run, data)
        checks = check_table(run, parse_command_table(data, "table"))
        keys = [check.key for check in checks]
        assert len(set(keys)) == len(keys)
        for needed in (
            "table.times",
            "table.rows",
            "table.cab",
            "limits.fork.jerk",
            "ride.gy_peak",
        ):
            assert needed in keys


Fault = Callable[[np.random.Generator, Floats], Floats]


def _cell(rng: np.random.Generator, rows: Floats) -> tuple[int, int]:
    return int(rng.integers(len(rows))), int(rng.integers(1, 4))


def spike(rng: np.random.Generator, rows: Floats) -> Floats:
    row, column = _cell(rng, rows)
    rows[row, column] += rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-9.0, 2.0)
    return rows


def sign(rng: np.random.Generator, rows: Floats) -> Floats:
    rows[:, int(rng.integers(1, 4))] *= -1.0
    return rows


def swapped(rng: np.random.Generator, rows: Floats) -> Floats:
    one, other = rng.choice([1, 2, 3], 2, replace=False)
    rows[:, [one, other]] = rows[:, [other, one]]
    return rows


def scaled(rng: np.random.Generator, rows: Floats) -> Floats:
    factor = rng.choice([57.3, 1 / 57.3, 9.80665, 1 / 9.80665, 6.0, 1 + 1e-9])
    rows[:, int(rng.integers(1, 4))] *= factor
    return rows


def jitter(rng: np.random.Generator, rows: Floats) -> Floats:
    rows[1:-1, 0] += 10.0 ** rng.uniform(-12.0, -2.0) * rng.normal(size=len(rows) - 2)
    return rows


def doubled(rng: np.random.Generator, rows: Floats) -> Floats:
    rows[:, 0] *= 2.0
    return rows


def cut(rng: np.random.Generator, rows: Floats) -> Floats:
    return rows[: int(rng.integers(2, len(rows)))]


def lost(rng: np.random.Generator, rows: Floats) -> Floats:
    return np.delete(rows, int(rng.integers(len(rows))), axis=0)


def twice(rng: np.random.Generator, rows: Floats) -> Floats:
    row = int(rng.integers(len(rows)))
    return np.insert(rows, row, rows[row], axis=0)


def late(rng: np.random.Generator, rows: Floats) -> Floats:
    column = int(rng.integers(1, 4))
    rows[1:, column] = rows[:-1, column]
    return rows


ALL = (spike, sign, swapped, scaled, jitter, doubled, cut, lost, twice, late)


def test_every_faulted_table_is_caught(run: Run) -> None:
    rng = np.random.default_rng(20)
    right = np.column_stack(list(command_columns(run).values()))
    missed = []
    for number in range(FAULTS):
        fault = ALL[number % len(ALL)]
        rows = fault(rng, right.copy())
        assert rows.shape != right.shape or np.any(rows != right), fault.__name__
        data = table_of(dict(zip(COLUMNS, rows.T, strict=True)))
        try:
            require_table(run, data)
        except NotReleasedError:
            continue
        missed.append((fault.__name__, float(np.max(np.abs(rows - right)))))
    assert missed == []


@pytest.mark.parametrize("value", [b"nan", b"inf", b"-inf", b"1e999", b"", b"None"])
def test_what_is_no_number_is_caught(run: Run, value: bytes) -> None:
    lines = table_of(command_columns(run)).split(b"\n")
    lines[50] = b",".join([*lines[50].split(b",")[:2], value, b"0.0"])
    with pytest.raises(NotReleasedError, match="row 50"):
        require_table(run, b"\n".join(lines))


def test_flipped_bits_are_caught(run: Run) -> None:
    """But for those in a digit that is beyond what a double holds."""
    rng = np.random.default_rng(4)
    data = table_of(command_columns(run))
    for _ in range(200):
        flipped = bytearray(data)
        flipped[int(rng.integers(len(data)))] ^= 1 << int(rng.integers(8))
        try:
            require_table(run, bytes(flipped))
        except NotReleasedError:
            continue
        cells = zip(data.split(), bytes(flipped).split(), strict=True)
        one, other = next((a, b) for a, b in cells if a != b)
        pairs = zip(one.split(b","), other.split(b","), strict=True)
        assert all(float(b) == pytest.approx(float(a), rel=4e-15) for a, b in pairs)


def test_limits_of_the_machine_hold_for_the_rows_whatever_the_run_says(run: Run) -> None:
    """A run that claims another machine's limits: the rows break them."""
    fork = replace(run.profile.machine.limits[1], rate=0.1)
    limits = (run.profile.machine.limits[0], fork, run.profile.machine.limits[2])
    machine = replace(run.profile.machine, limits=limits)
    lying = replace(run, profile=replace(run.profile, machine=machine))
    with pytest.raises(NotReleasedError, match="the fork's rate over its limit"):
        require_table(lying, table_of(command_columns(run)))


def test_a_ride_that_is_told_to_be_softer_than_it_is_does_not_pass(run: Run) -> None:
    turning = dict(run.results.felt.seat_angular_acceleration)
    turning["magnitude"] = replace(turning["magnitude"], peak_after_rad_s2=0.1)
    felt = replace(run.results.felt, seat_angular_acceleration=turning)
    lying = replace(run, results=replace(run.results, felt=felt))
    with pytest.raises(NotReleasedError, match="angular acceleration, peak"):
        require_table(lying, table_of(command_columns(run)))


def test_another_motion_than_the_verified_one_does_not_pass(run: Run) -> None:
    m = run.commands
    other = Motion(m.t, m.angle + 1e-9, m.rate_start, m.rate_end)
    with pytest.raises(NotReleasedError, match="fork"):
        require_table(run, table_of(command_columns(replace(run, commands=other))))
