"""How much is read of what a profile comes from: enough for a record, not for a flood."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Caps:
    """The most that is read, unless the user raises it.

    No key of a profile raises it: a stranger's profile would.

    Parameters
    ----------
    rows : int
        Of a table, and samples of a profile: 1 kHz for a quarter of an hour.
    mib : int
        Of a file or of standard input, in 2^20 bytes. Reading takes more: at the caps 0.4 GiB
        for joints or rates, 0.8 GiB with each cell in quotes, 1.9 GiB for an attitude.
    """

    rows: int = 1_000_000
    mib: int = 96

    @property
    def size(self) -> int:
        """The most bytes."""
        return self.mib << 20


DEFAULT_CAPS = Caps()
