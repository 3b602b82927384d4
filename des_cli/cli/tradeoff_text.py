"""The points of a trade-off curve as aligned text, for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from des_cli.cli.lines import wrapped
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_ERROR,
    ATTITUDE_ERROR,
    JOINT_DEVIATION,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
)
from des_cli.model.tradeoff import TradePoint
from des_cli.show.words import CONSOLE, steps_taken

# Columns: head, field, how a value is written.
_COLUMNS = (
    ("objective", "objective_reduction", CONSOLE.percent),
    ("vector", "vector_reduction", CONSOLE.percent),
    ("BB3", "bb3_reduction", CONSOLE.percent),
    ("seat x", "seat_x_reduction", CONSOLE.percent),
    ("seat y", "seat_y_reduction", CONSOLE.percent),
    ("seat z", "seat_z_reduction", CONSOLE.percent),
    ("joints", JOINT_DEVIATION, CONSOLE.percent),
    ("rate", SEAT_RATE_DEVIATION, CONSOLE.percent),
    ("G rms [g]", SEAT_G_ERROR, CONSOLE.number),
    ("α error", ANGULAR_ACCELERATION_ERROR, CONSOLE.number),
    ("α rms", "seat_angular_acceleration_rms_rad_s2", CONSOLE.number),
    ("α peak", "seat_angular_acceleration_peak_rad_s2", CONSOLE.number),
    ("turn [deg]", ATTITUDE_ERROR, CONSOLE.number),
)
_WIDTH = 11
_ENDING = "  limits  status"
_ENDING_WIDTH = len("  limits  not executable")
_TITLES = {
    "report-sweep": "study's single sweep",
    "constant-p": "constant p",
    "free": "optimum, the joints moving freely",
    "scalar": "optimum, one factor for all joints",
    "per-joint": "optimum, one factor for each joint",
}


def points_text(points: Sequence[TradePoint], about: str, columns: int | None = None) -> str:
    """Write a table for each curve: reductions, then what they cost.

    A minus before a reduction is a growth.

    Parameters
    ----------
    points : sequence of TradePoint
    about : str
    columns : int, optional
        Of the terminal: a table that is wider goes on below, with its first column again.
    """
    what = (
        "reduction of the cross-coupling; deviation of joints, seat rate, seat G; total angular "
        f"acceleration α at the seat [rad/s²]{_before(points)}; attitude"
    )
    lines = [about, *wrapped(what, columns, 0)]
    for title, curve in groupby(points, key=_title):
        lines += ["", *_curve(title, list(curve), columns)]
    return "\n".join(line.rstrip() for line in lines) + "\n"


def point_line(point: TradePoint) -> str:
    """Say how one point ended."""
    name = f"{point.control}, {point.swept} {point.value:g}"
    if point.objective_reduction is None:
        return f"{name}: {point.status}: {point.message}"
    steps = steps_taken(point.iterations)
    turning = CONSOLE.number(point.seat_angular_acceleration_rms_rad_s2)
    gained = (
        f"{CONSOLE.less(point.objective_reduction)} at joints {_joints(point)}, "
        f"seat rate {CONSOLE.percent(point.fidelity(SEAT_RATE_DEVIATION))}, α {turning} rad/s² rms"
    )
    why = f" ({point.message})" if point.status == "unverified" else ""
    return f"{name}: {point.status} in {steps}, {gained}{why}"


def _before(points: Sequence[TradePoint]) -> str:
    """Say what the total angular acceleration is before any reduction, the same for all."""
    for point in points:
        rms = point.seat_angular_acceleration_rms_before_rad_s2
        peak = point.seat_angular_acceleration_peak_before_rad_s2
        if rms is not None and peak is not None:
            return f", before {CONSOLE.number(rms)} rms and {CONSOLE.number(peak)} peak"
    return ""


def _joints(point: TradePoint) -> str:
    return CONSOLE.percent(point.fidelity(JOINT_DEVIATION))


def _title(point: TradePoint) -> str:
    return _TITLES[point.control if point.algorithm == "optimum" else point.algorithm]


def _curve(title: str, points: Sequence[TradePoint], columns: int | None) -> Iterator[str]:
    yield title
    swept = _head(points[0].swept)
    first = max(len(swept), 10)
    for at, (begin, end, ending) in enumerate(_parts(first + 2, columns)):
        shown = _COLUMNS[begin:end]
        heads = "".join(f"{head:>{_WIDTH}}" for head, _, _ in shown)
        yield f"  {swept:>{first}}{heads}{_ENDING if ending else ''}"
        for point in points:
            value = f"  {point.value:>{first}g}"
            if point.objective_reduction is None and point.limits_ok is None:
                if at == 0:
                    yield f"{value}  {point.status}: {point.message}"
                continue
            cells = "".join(f"{write(getattr(point, key)):>{_WIDTH}}" for _, key, write in shown)
            limits = "kept" if point.limits_ok else "broken"
            yield f"{value}{cells}" + (f"  {limits:<6}  {point.status}" if ending else "")


def _parts(first: int, columns: int | None) -> Iterator[tuple[int, int, bool]]:
    """Yield which columns stand beside each other, and whether limits and status do too."""
    count = len(_COLUMNS)
    if columns is None or first + count * _WIDTH + _ENDING_WIDTH <= columns:
        yield 0, count, True
        return
    most = max(1, (columns - first) // _WIDTH)
    with_ending = max(0, (columns - first - _ENDING_WIDTH) // _WIDTH)
    begin = 0
    while count - begin > with_ending:
        end = min(begin + most, count)
        yield begin, end, False
        begin = end
    yield begin, count, True


def _head(swept: str) -> str:
    """Call the usual budget by a short name; any other by its own."""
    return "budget" if swept == JOINT_DEVIATION else swept
