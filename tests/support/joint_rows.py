"""Rows of joints of closed forms."""

from __future__ import annotations

import numpy as np

from des_cli.model.joint_rows import JointRows


def rows(count: int = 25, hz: float = 100.0, start: float = -0.5) -> JointRows:
    """Sines of different frequencies, with their derivatives, from a time before 0 on."""
    t = start + np.arange(count) / hz
    frequency, size = np.array([0.7, 1.1, 1.9]), np.array([2.0, 0.6, 0.4])
    phase = frequency * t[:, None]
    return JointRows(
        t,
        size * np.sin(phase),
        size * frequency * np.cos(phase),
        -size * frequency**2 * np.sin(phase),
    )
