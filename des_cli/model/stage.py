"""What a computation is at, in a few words to whoever wants to know."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

OnStage: TypeAlias = Callable[[str], None]
"""Called with a few words for what is done next, before anything that may take long."""


def untold(stage: str) -> None:
    """Tell nobody."""
