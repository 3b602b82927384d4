"""How late lines were sent."""

from __future__ import annotations

from array import array


class Lateness:
    """Of each line that was sent, in the order of sending."""

    def __init__(self) -> None:
        self._late = array("q")

    def __len__(self) -> int:
        return len(self._late)

    def add(self, late: int) -> None:
        """Take how late a line was sent [ns]."""
        self._late.append(late)

    def quantile(self, share: float) -> float:
        """Return what a share of the lines is not later than [s]; 0 without lines.

        >>> lateness = Lateness()
        >>> for late in (1_000_000, 3_000_000, 2_000_000):
        ...     lateness.add(late)
        >>> lateness.quantile(0.5), lateness.quantile(1.0)
        (0.002, 0.003)
        """
        if not self._late:
            return 0.0
        rank = max(-int(-share * len(self._late) // 1), 1)
        return sorted(self._late)[rank - 1] / 1e9

    def __str__(self) -> str:
        """Say how many lines there were, and how late."""
        parts = ((0.5, "median"), (0.99, "99 %"), (1.0, "most"))
        late = ", ".join(f"{1e3 * self.quantile(share):.3f} ms ({name})" for share, name in parts)
        rows = f"{len(self)} row{'' if len(self) == 1 else 's'}"
        return f"{rows}, late by {late}" if self._late else rows
