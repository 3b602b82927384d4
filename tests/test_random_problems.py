"""Random problems: what is released is inside the machine's limits, by its rows alone."""

from __future__ import annotations

import os
from collections import Counter

import numpy as np
import pytest

from des_cli.errors import DesError, ExitCode
from des_cli.model.machine import Machine
from des_cli.model.profile import Profile
from des_cli.pipeline import reduce_profile
from des_cli.release.gate import require_table
from des_cli.runs_out.tables import command_columns, encode_table
from tests.support.random_problems import random_profile

PROBLEMS = int(os.environ.get("DES_CORIOLIS_PROBLEMS", "150"))
"""How many are drawn; CONTRIBUTING.md tells of more."""

FIRST = int(os.environ.get("DES_CORIOLIS_PROBLEMS_FROM", "0"))
"""The first one's seed."""

GROUPS = 4
ALLOWED = 1e-6
"""Relative excess of divided differences that rounding of doubles makes."""

pytestmark = pytest.mark.slow


def excess(data: bytes, machine: Machine) -> float:
    """Return the largest relative excess over a limit, by divided differences of a CSV table."""
    lines = data.decode().splitlines()
    assert lines[0] == "t_s,arm_rpm,fork_deg,cab_deg"
    rows = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    h = np.diff(rows[:, 0])
    assert np.all(h > 0.0)
    between = 0.5 * (h[1:] + h[:-1])
    worst = -1.0
    for column, limit in enumerate(machine.limits, start=1):
        values = rows[:, column] * (2.0 * np.pi / 60.0 if column == 1 else np.pi / 180.0)
        if column == 1:
            rate, after = values, h
        else:
            worst = max(worst, np.max(np.abs(values)) / limit.angle - 1.0)
            rate, after = np.diff(values) / h, between
        acceleration = np.diff(rate) / after
        # No longer than the way over which an acceleration may change by the jerk limit.
        apart = between if column == 1 else np.maximum(h[1:-1], 0.5 * (h[:-2] + h[2:]))
        jerk = np.diff(acceleration) / apart
        for found, most in (
            (rate, limit.rate),
            (acceleration, limit.acceleration),
            (jerk, limit.jerk),
        ):
            worst = max(worst, float(np.max(np.abs(found), initial=0.0)) / most - 1.0)
    return worst


def released(profile: Profile) -> bytes | DesError:
    """Return the command table of a profile, or why it has none."""
    try:
        run = reduce_profile(profile)
        run.require_release()
        data = encode_table(command_columns(run), "csv")
        require_table(run, data)
    except DesError as error:
        return error
    return data


@pytest.mark.parametrize("group", range(GROUPS))
def test_what_is_released_keeps_the_limits(group: int) -> None:
    ends: Counter[ExitCode] = Counter()
    for seed in range(FIRST + group, FIRST + PROBLEMS, GROUPS):
        profile = random_profile(seed)
        data = released(profile)
        if isinstance(data, DesError):
            ends[data.exit_code] += 1
            verdicts = (ExitCode.USAGE, ExitCode.NO_SOLUTION, ExitCode.NOT_RELEASED)
            assert data.exit_code in verdicts, seed
            continue
        ends[ExitCode.DONE] += 1
        assert excess(data, profile.machine) < ALLOWED, seed
    print({code.name: count for code, count in ends.items()})
    assert ends[ExitCode.DONE] > 0.3 * sum(ends.values())
