"""Steps of a record that are no sampling: gaps, and rows that hardly differ in time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, TypeAlias, get_args

import numpy as np

from des_cli.errors import Complaint, ProfileError
from des_cli.model.arrays import Floats
from des_cli.model.gaps import find_gaps

GapPolicy: TypeAlias = Literal["refuse", "bridge", "split"]
GAP_POLICIES: tuple[str, ...] = get_args(GapPolicy)

LONGEST_BRIDGED = 0.5
"""Longest gap [s] that is bridged without a word from the user: longer than that, nobody
knows what the body did in between."""

SHORTEST_PER_MEDIAN = 1e-3
"""Steps over the median step below which a row is no sample of its own: a rate that
changes by its noise in a thousandth of a step is an acceleration that nobody recorded."""

LEAST_ROWS = 2
"""Rows that make a motion."""

_TOLD = 20
"""Steps described before the rest is only counted."""

Place: TypeAlias = Callable[[int], int]
"""From a row of the record to its line in the file."""


@dataclass
class GapHandling:
    """What is done about the gaps of a record.

    Parameters
    ----------
    policy : {"refuse", "bridge", "split"}, optional
        Without it short gaps are bridged and long ones refused.
    part : int, optional
        Which of the stretches that ``split`` makes is read, counted from 1.
    parts : int
        How many there are, once the record is read.
    """

    policy: GapPolicy | None = None
    part: int | None = None
    parts: int = 1


def find_short_steps(
    t: Floats, label: str, line: Place, *, drawn_every: float = np.inf
) -> list[Complaint]:
    """Say which rows follow another one within hardly any time.

    Parameters
    ----------
    t : (n,) array
        Increasing times, n >= 2 [s].
    label : str
        What messages call the file.
    line : callable
        From a row to its line.
    drawn_every : float
        Longest step of what is drawn between the rows [s], where these are corners of
        straight lines and no sampling; infinite where they are.
    """
    step = np.diff(t)
    usual = min(float(np.median(step)), drawn_every)
    rows = np.flatnonzero(step < SHORTEST_PER_MEDIAN * usual).tolist()

    def cure(row: int) -> str:
        held = t[row] + usual
        if usual < drawn_every or (row + 2 < len(t) and t[row + 2] <= held):
            return "remove one of the two rows"
        return f"for a step there, move this row to t = {held:.12g} s; else remove one of the two"

    return _bounded(
        [
            Complaint(
                f"{label}:{line(row + 1)}",
                f"follows the row before it within {step[row]:.3g} s, from t = {t[row]:.12g} to "
                f"{t[row + 1]:.12g} s, where {usual:.4g} s are usual; {cure(row)}",
            )
            for row in rows
        ],
        label,
    )


def select_rows(
    t: Floats,
    label: str,
    line: Place,
    handling: GapHandling,
    remarks: list[str],
    *,
    straight: bool = False,
) -> slice:
    """Return the rows that are read as one motion: all, or a stretch between gaps.

    Parameters
    ----------
    t : (n,) array
        Increasing times, n >= 2 [s].
    label, line
        As of `find_short_steps`.
    handling : GapHandling
        Its ``parts`` are set.
    remarks : list of str
        Takes a sentence for every gap that was bridged and every stretch left out.
    straight : bool
        Whether the rows are corners of straight lines: then a long step is a long line,
        and a gap only where the user asks for gaps.

    Raises
    ------
    ProfileError
        Naming each gap that is refused, or where no such part exists.
    """
    gaps = [] if straight and handling.policy is None else find_gaps(t)
    if handling.policy == "split":
        return _part(t, label, line, gaps, handling, remarks)
    bridged = handling.policy == "bridge"
    limit = np.inf if bridged else 0.0 if handling.policy == "refuse" else LONGEST_BRIDGED
    refused = [row for row in gaps if t[row + 1] - t[row] > limit]
    if refused:
        cure = (
            "--gap bridge (or gap: bridge) moves on across it, split makes a motion of each stretch"
        )
        found = [Complaint(f"{label}:{line(r + 1)}", f"{_gap(t, r)}; {cure}") for r in refused]
        raise ProfileError(_bounded(found, label))
    told = [
        f"line {line(row + 1)}: {_gap(t, row)}; it was bridged by a motion between its two ends"
        for row in gaps
    ]
    remarks += told[:_TOLD]
    if len(told) > _TOLD:
        remarks.append(f"{len(told) - _TOLD} more gaps like these were bridged")
    return slice(0, len(t))


def _part(
    t: Floats,
    label: str,
    line: Place,
    gaps: Sequence[int],
    handling: GapHandling,
    remarks: list[str],
) -> slice:
    """Return the rows of the stretch that is asked for."""
    bounds = [0, *(row + 1 for row in gaps), len(t)]
    every = [slice(a, b) for a, b in pairwise(bounds)]
    kept = [rows for rows in every if rows.stop - rows.start >= LEAST_ROWS]
    if not kept:
        what = f"has gaps on either side of every row; a motion needs {LEAST_ROWS} rows without one"
        raise ProfileError([Complaint(label, what)])
    handling.parts = len(kept)
    part = handling.part or (1 if len(kept) == 1 else None)
    if part is None or not 1 <= part <= len(kept):
        what = f"gaps split it into {len(kept)} motions, and one is expected here: reduce takes all"
        raise ProfileError([Complaint(label, what)])
    rows = kept[part - 1]
    if len(every) > 1:
        remarks.append(
            f"part {part} of {len(kept)} between gaps: lines {line(rows.start)} to "
            f"{line(rows.stop - 1)}, t = {t[rows.start]:.12g} to {t[rows.stop - 1]:.12g} s"
        )
    if part == 1:
        remarks += [
            f"line {line(rows.start)}: the row at t = {t[rows.start]:.12g} s stands alone "
            "between gaps and was left out"
            for rows in every
            if rows.stop - rows.start < LEAST_ROWS
        ][:_TOLD]
    return rows


def _gap(t: Floats, row: int) -> str:
    step = np.diff(t)
    return (
        f"a gap of {step[row]:.4g} s, from t = {t[row]:.12g} to {t[row + 1]:.12g} s, "
        f"where {np.median(step):.4g} s are usual"
    )


def _bounded(complaints: list[Complaint], label: str) -> list[Complaint]:
    if len(complaints) <= _TOLD:
        return complaints
    rest = Complaint(label, f"… and {len(complaints) - _TOLD} more steps like these")
    return [*complaints[:_TOLD], rest]
