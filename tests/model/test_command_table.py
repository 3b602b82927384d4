"""The command table as data."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.model.command_table import CommandTable


def table() -> CommandTable:
    t = np.array([0.0, 0.5, 2.0])
    return CommandTable(t, 10.0 * t, np.column_stack([t, -t]))


def test_rows_are_times_arm_fork_cab() -> None:
    np.testing.assert_array_equal(
        table().values, [[0, 0, 0, 0], [0.5, 5, 0.5, -0.5], [2, 20, 2, -2]]
    )
    np.testing.assert_array_equal(table().step, [0.5, 1.5])


def test_a_part_has_both_its_ends() -> None:
    np.testing.assert_array_equal(table().between(0.5, 2.0).values, table().values[1:])
    assert len(table().between(0.6, 1.9).t) == 0


def test_nobody_changes_a_row_and_lengths_agree() -> None:
    with pytest.raises(ValueError, match="read-only"):
        table().position[0, 0] = 1.0
    with pytest.raises(ValueError, match="shape"):
        CommandTable(np.zeros(3), np.zeros(2), np.zeros((3, 2)))
