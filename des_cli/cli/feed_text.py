"""What ``feed`` says of the rows that it sends, and of those that it does not."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from des_cli.model.machine import JOINTS
from des_cli.release.clocked import Clock, Clocked
from des_cli.release.playback import SAME_VALUE, Playback

COMMANDED = ((30.0 / math.pi, "rpm"), (180.0 / math.pi, "deg"), (180.0 / math.pi, "deg"))
"""Units of the commands of arm, fork and cab, over those of SI."""


def plan_line(target: str, clock: Clock, clocked: Clocked, hold_s: float | None) -> str:
    """Say what is to be sent."""
    seconds = (clocked.table_rows - 1) / clock.hz
    text = f"{target}: {clocked.table_rows} rows at {clock.hz:g} Hz, {seconds:g} s"
    if clock.end == "ramp":
        text += f", then {(len(clocked.rows.t) - clocked.table_rows) / clock.hz:.3g} s to rest"
    elif clock.end == "hold":
        text += ", then held" + ("" if hold_s is None else f" for {hold_s:g} s")
    beside = [
        f"{joint} {off * factor:.2g} {unit}"
        for joint, off, (factor, unit) in zip(JOINTS, clocked.off.tolist(), COMMANDED, strict=True)
        if off > SAME_VALUE
    ]
    if beside:
        text += f"; beside the rows of the table by at most {', '.join(beside)}"
    return text


def broken_lines(target: str, played: Playback, clock: Clock, clocked: Clocked) -> Iterator[str]:
    """Say which limits the rows break, and what keeps them."""
    what = f"{target}: at {clock.hz:g} Hz and --rate {clock.rate:g}"
    for check in clocked.failed:
        yield f"{what}: {check.key}: {check}"
    if clock.end != "stop" and not played.on(replace(clock, end="stop")).failed:
        other = "--at-end ramp" if clock.end == "hold" else "--at-end stop"
        yield f"{target}: only what follows the last row breaks them: give {other}"
    elif largest := played.largest_rate(clock):
        yield f"{target}: the largest rate that keeps them is {largest:g}: give --rate {largest:g}"
