"""Derivatives by finite differences."""

from __future__ import annotations

from collections.abc import Callable

from des_cli.model.arrays import Floats


def along(function: Callable[[Floats], Floats], x: Floats, move: Floats, h: float = 1e-3) -> Floats:
    """Sixth-order difference of a function along a direction."""
    weights = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
    parts = [
        w * (function(x + k * h * move) - function(x - k * h * move)) / h
        for k, w in weights.items()
    ]
    return parts[0] + parts[1] + parts[2]
