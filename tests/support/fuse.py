"""A call of the operating system that fails once."""

from __future__ import annotations

import os
from typing import Any

import pytest


class Fuse:
    """Makes the n-th call of a function of ``os`` fail."""

    def __init__(
        self,
        monkeypatch: pytest.MonkeyPatch,
        name: str,
        blow_at: int,
        error: BaseException | type[BaseException] = KeyboardInterrupt,
    ) -> None:
        self.calls, self.blow_at, self.error = 0, blow_at, error
        self.really = getattr(os, name)
        monkeypatch.setattr(os, name, self)

    def __call__(self, *args: Any, **options: Any) -> Any:
        self.calls += 1
        if self.calls == self.blow_at:
            raise self.error
        return self.really(*args, **options)
