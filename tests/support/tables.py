"""Command tables of closed forms, for the machine DES."""

from __future__ import annotations

import numpy as np

from des_cli.model.command_table import CommandTable
from des_cli.model.machines import MACHINES

DES = MACHINES["des"]


def swaying(hz: float = 100.0, duration: float = 4.0) -> CommandTable:
    """Smooth, well inside all limits; it ends with all joints on the way."""
    return swaying_at(np.arange(round(duration * hz) + 1) / hz)


def swaying_at(t: np.ndarray) -> CommandTable:
    """The same at other times."""
    arm = 1.0 + 0.1 * np.sin(0.8 * t)
    return CommandTable(t, arm, np.column_stack([0.2 * np.sin(0.5 * t), 0.1 * np.cos(0.7 * t)]))


def resting(hz: float = 100.0, duration: float = 4.0) -> CommandTable:
    """Fork and cab come to rest at the last row, where the arm turns steadily."""
    t = np.arange(round(duration * hz) + 1) / hz
    u = t / duration
    fold = u**4 * (35.0 - 84.0 * u + 70.0 * u**2 - 20.0 * u**3)
    return CommandTable(t, np.full_like(t, 1.0), np.column_stack([0.2 * fold, -0.1 * fold]))


def riding(step: float = 0.04, phases: int = 12) -> CommandTable:
    """The fork's jerk is at its limit throughout, now to the one side and now to the other."""
    jerk = DES.limits[1].jerk
    signs = np.repeat(np.resize([1.0, -1.0, -1.0, 1.0], phases), 10)
    position = np.cumsum(np.cumsum(np.cumsum(signs * jerk * step) * step) * step)
    t = step * np.arange(len(signs))
    return CommandTable(t, np.full_like(t, 1.0), np.column_stack([position, np.zeros_like(t)]))


def uneven(table: CommandTable, seed: int = 0) -> CommandTable:
    """The rows of a table without some of them."""
    kept = np.random.default_rng(seed).random(len(table.t)) < 0.6
    kept[[0, -1]] = True
    return CommandTable(table.t[kept], table.arm_rate[kept], table.position[kept])


def csv_of(table: CommandTable) -> bytes:
    """The bytes of a table, as the tool writes them."""
    rpm, deg = 30.0 / np.pi, 180.0 / np.pi
    rows = np.column_stack([table.t, table.arm_rate * rpm, table.position * deg]).tolist()
    lines = "".join(",".join(map(repr, row)) + "\n" for row in rows)
    return ("t_s,arm_rpm,fork_deg,cab_deg\n" + lines).encode()
