"""The machines that the project knows by name."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Literal, TypeAlias

from des_cli.model.machine import ASSUMED_JERK_PER_ACCELERATION, DHRow, JointLimits, Machine
from des_cli.units import FOOT_M, STANDARD_GRAVITY_M_S2

_QUARTER = math.pi / 2

ForkAxis: TypeAlias = Literal["radial", "tangential"]
FORK_AXES: tuple[ForkAxis, ForkAxis] = ("radial", "tangential")

CHAIN_LENGTHS = ("L2", "Lx", "Ly", "Lz", "Lt")
"""The lengths that Table 2 of the study is made of."""


def gimballed_centrifuge_rows(
    lengths: Mapping[str, float], *, fork_axis: ForkAxis = "radial"
) -> tuple[DHRow, ...]:
    """Return the rows of Table 2 for a centrifuge with own lengths.

    Parameters
    ----------
    lengths : mapping of str to float
        L2 (arm axis to the gimbals' centre), Lx, Ly, Lz (seat frame's offset
        in the cab) and Lt (seat to the pilot's head) [m].
    fork_axis : {"radial", "tangential"}
        Whether the fork turns about the arm's own direction, as on the DES, or
        about the direction of travel. With a tangential fork and the seat yaw
        0 the pilot faces the travel of a positive arm rate, the fork angle is
        the roll to the right and the cab angle the pitch up.

    Raises
    ------
    KeyError
        If a length is missing.
    """
    heading = [DHRow(offset=-_QUARTER)] if fork_axis == "tangential" else []
    return (
        DHRow(variable="arm", sign=-1),
        DHRow(a=lengths["L2"]),
        *heading,
        DHRow(offset=_QUARTER),
        DHRow(alpha=_QUARTER),
        DHRow(variable="fork"),
        DHRow(offset=_QUARTER),
        DHRow(alpha=-_QUARTER),
        DHRow(variable="cab"),
        DHRow(a=-lengths["Lx"], d=lengths["Lz"]),
        DHRow(offset=-_QUARTER),
        DHRow(a=lengths["Ly"]),
        DHRow(alpha=_QUARTER),
        DHRow(variable="seat_yaw", sign=-1),
        DHRow(alpha=-_QUARTER),
        DHRow(variable="seat_pitch", sign=-1),
        DHRow(alpha=_QUARTER),
        DHRow(d=-lengths["Lt"]),
    )


def read_chain(rows: Sequence[DHRow]) -> tuple[dict[str, float], ForkAxis] | None:
    """Tell the lengths and the fork's axis that rows were made of.

    Parameters
    ----------
    rows : sequence of DHRow

    Returns
    -------
    lengths : dict of str to float
        Each of ``CHAIN_LENGTHS`` [m].
    fork_axis : {"radial", "tangential"}
        None for both where `gimballed_centrifuge_rows` does not make these rows.
    """
    # a chain whose lengths are 1, 2, ... tells by its rows which one stands where
    marks = {float(mark): name for mark, name in enumerate(CHAIN_LENGTHS, start=1)}
    for axis in FORK_AXES:
        marked = gimballed_centrifuge_rows({v: k for k, v in marks.items()}, fork_axis=axis)
        lengths = {
            marks[abs(mark)]: math.copysign(1.0, mark) * length + 0.0
            for there, row in zip(marked, rows, strict=False)
            for mark, length in ((there.a, row.a), (there.d, row.d))
            if mark
        }
        complete = len(lengths) == len(marks)
        if complete and tuple(rows) == gimballed_centrifuge_rows(lengths, fork_axis=axis):
            return lengths, axis
    return None


def limits_with_assumed_jerk(angle: float, rate: float, acceleration: float) -> JointLimits:
    """Return the limits of a joint whose jerk limit nobody published.

    Parameters
    ----------
    angle, rate, acceleration : float
        [rad], [rad/s], [rad/s^2]
    """
    return JointLimits(angle, rate, acceleration, ASSUMED_JERK_PER_ACCELERATION * acceleration)


_DES_LENGTHS = {
    name: feet * FOOT_M
    for name, feet in {
        "L1": 12.27,
        "L2": 19.0,
        "Lx": 3.90,
        "Ly": 0.012,
        "Lz": 0.012,
        "Lt": 2.76,
    }.items()
}

DES = Machine(
    name="des",
    rows=gimballed_centrifuge_rows(_DES_LENGTHS),
    limits=(
        limits_with_assumed_jerk(angle=math.inf, rate=5.86, acceleration=0.63),
        limits_with_assumed_jerk(angle=2 * math.pi, rate=3.14, acceleration=2.5),
        limits_with_assumed_jerk(angle=2 * math.pi, rate=3.14, acceleration=5.0),
    ),
    lengths=_DES_LENGTHS,
    source=(
        "Coriolis study of the Dynamic Environment Simulator, Tables 1 and 2. The table "
        "bounds the arm's angle by 2 pi, but the arm turns endlessly; L1 is not part of the "
        "chain; the length printed as a second L_1 is Lt. Assumed, because the tables have none: "
        "jerk limits of 2 1/s times the acceleration limits."
    ),
)

_JOHNSVILLE_RADIUS = 50.0 * FOOT_M
_JOHNSVILLE_RATE = math.sqrt(40.0 * STANDARD_GRAVITY_M_S2 / _JOHNSVILLE_RADIUS)
_AT_CENTRE = {"Lx": 0.0, "Ly": 0.0, "Lz": 0.0, "Lt": 0.0}
_JOHNSVILLE_LENGTHS = {"L2": _JOHNSVILLE_RADIUS, **_AT_CENTRE}

JOHNSVILLE = Machine(
    name="johnsville",
    rows=gimballed_centrifuge_rows(_JOHNSVILLE_LENGTHS, fork_axis="tangential"),
    limits=(
        limits_with_assumed_jerk(
            angle=math.inf,
            rate=_JOHNSVILLE_RATE,
            acceleration=10.0 * STANDARD_GRAVITY_M_S2 / (2 * _JOHNSVILLE_RATE * _JOHNSVILLE_RADIUS),
        ),
        DES.limits[1],
        DES.limits[2],
    ),
    lengths=_JOHNSVILLE_LENGTHS,
    source=(
        "Johnsville (Warminster) human centrifuge, later the Dynamic Flight Simulator. Published: "
        "a 50 ft arm, a dual-gimballed gondola (The G Machine, Air & Space Magazine), 40 g and "
        "10 g/s (D. Darling, Internet Encyclopedia of Science, Johnsville Centrifuge). Derived: "
        "the arm's rate gives 40 g at 50 ft, its acceleration 10 g/s at that rate. Assumed, "
        "because not found published: the outer gimbal turns about the direction of travel, the "
        "head sits at the gimbals' centre, the gimbals have the DES's fork and cab limits, and the "
        "jerk limits are 2 1/s times the acceleration limits."
    ),
)

_COVISART_LENGTHS = {"L2": 0.0, **_AT_CENTRE}

COVISART = Machine(
    name="covisart",
    rows=gimballed_centrifuge_rows(_COVISART_LENGTHS, fork_axis="tangential"),
    limits=(
        limits_with_assumed_jerk(angle=math.inf, rate=math.radians(225.0), acceleration=2.5),
        limits_with_assumed_jerk(angle=2 * math.pi, rate=math.radians(225.0), acceleration=2.5),
        limits_with_assumed_jerk(angle=2 * math.pi, rate=math.radians(210.0), acceleration=5.0),
    ),
    lengths=_COVISART_LENGTHS,
    source=(
        "Covisart three-axis motion simulator, a gyroscope without an arm. Published (Covisart "
        "simulator user guide): rotation without end in three axes, tabulated as +-360 deg; "
        "largest rates yaw 225, roll 225, pitch 210 deg/s. Here the arm is the yaw axis and turns "
        "endlessly, the fork the roll, the cab the pitch. Assumed, because not found published: "
        "this order of the axes, the head at their common centre, the accelerations (those of the "
        "DES's fork, fork and cab), and jerk limits of 2 1/s times the accelerations."
    ),
)

MACHINES: Mapping[str, Machine] = MappingProxyType(
    {machine.name: machine for machine in (DES, JOHNSVILLE, COVISART)}
)
"""Built-in machines by name."""
