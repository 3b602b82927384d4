"""Data on stdout, whole or not at all."""

from __future__ import annotations

import io
import sys
from types import SimpleNamespace

import pytest

from des_cli.cli.stdout import write_data
from des_cli.errors import FileAccessError


class Sipping(io.RawIOBase):
    """A raw stream that takes a few bytes at a time, as an unbuffered pipe may."""

    def __init__(self) -> None:
        super().__init__()
        self.taken = b""

    def writable(self) -> bool:
        return True

    def write(self, data: object) -> int:
        part = bytes(memoryview(data)[:7])  # type: ignore[arg-type]
        self.taken += part
        return len(part)


@pytest.mark.parametrize("data", [b"t_s,arm_rpm\n" * 50, "t_s,fork_deg\n" * 50, b""])
def test_a_stream_that_takes_a_part_gets_all(
    monkeypatch: pytest.MonkeyPatch, data: bytes | str
) -> None:
    stream = Sipping()
    monkeypatch.setattr(sys, "stdout", SimpleNamespace(buffer=stream))
    write_data(data)
    assert stream.taken == (data.encode() if isinstance(data, str) else data)


def test_a_closed_stdout_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdout", None)
    with pytest.raises(FileAccessError):
        write_data(b"t_s\n")
