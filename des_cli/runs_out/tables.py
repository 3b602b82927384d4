"""Tables of a run: their columns, and the bytes of each format.

A table is a mapping from a column's name, which ends with its unit, to a
one-dimensional array of doubles. Every format reads back the same doubles, bit
for bit: the text formats write the shortest decimal that does. They need neither pandas
nor, but for a long CSV, pyarrow.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, TypeAlias, get_args

import numpy as np

from des_cli.errors import Complaint, NotReleasedError
from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.response import acceleration_parts
from des_cli.model.arrays import Floats
from des_cli.model.coriolis import COMPONENTS
from des_cli.model.machine import JOINTS
from des_cli.model.motion import Motion, mean_of_sides
from des_cli.model.run import Run
from des_cli.reduction.limits import jerk_at_samples
from des_cli.units import split_unit

TableFormat: TypeAlias = Literal["csv", "ndjson", "json", "parquet"]
TABLE_FORMATS: tuple[TableFormat, ...] = get_args(TableFormat)

SEAT_PARTS = ("tangential", "centripetal", "coriolis")
"""Of the seat's linear acceleration; see ``kinematics.response.acceleration_parts``."""

LONG_TABLE = 50_000
"""Rows from which on a CSV goes through Arrow, which is as long to import as it then saves."""

# Rows turned into text at a time: keeps the Python floats of a long table from
# being alive all at once.
_ROWS_AT_ONCE = 65_536


def command_columns(run: Run) -> dict[str, Floats]:
    """Return the command table: the modified motion, with its leads if it has any.

    Parameters
    ----------
    run : Run

    Returns
    -------
    dict of str to (n,) array
        ``t_s``, ``arm_rpm`` (a velocity command; at a step of the rate the mean
        of both sides), ``fork_deg``, ``cab_deg`` (position commands).
    """
    motion = run.commands
    return {
        "t_s": motion.t,
        "arm_rpm": _in_unit("arm_rpm", motion.rate[:, 0]),
        "fork_deg": _in_unit("fork_deg", motion.angle[:, 1]),
        "cab_deg": _in_unit("cab_deg", motion.angle[:, 2]),
    }


def trajectory_columns(run: Run) -> dict[str, Floats]:
    """Return everything that is known at each sample.

    A quantity that steps at a sample is given as the mean of both sides.

    Parameters
    ----------
    run : Run

    Returns
    -------
    dict of str to (n,) array
        Desired and modified joint motion, the factor ``p`` (or ``p_arm``,
        ``p_fork``, ``p_cab``, or none), the adjoint, the Coriolis vector in report
        and in seat axes, the G-vector at the seat, the seat's rate and total angular
        acceleration, and the split of the seat's linear acceleration; ``before``
        belongs to the motion that the profile asks for and ``after`` to the modified
        one. At the end the motion that the profile asks for: the desired one is the
        nearest to it inside the limits, where these are enforced. ``docs/formats.md``
        lists the columns.
    """
    before, after = run.before, run.after
    machine = run.profile.machine
    parts = [
        acceleration_parts(chain_of(machine, seat), motion)
        for seat, motion in (
            (run.profile.seat, run.asked.motion),
            (run.seat, run.solution.modified),
        )
    ]
    blocks = [
        run.solution.modified.t[:, None],
        *_motion_blocks(run.desired),
        *_motion_blocks(run.solution.modified),
        run.solution.control,
        run.solution.adjoint,
        _interleaved(before.coriolis_report, after.coriolis_report),
        _interleaved(before.coriolis_seat, after.coriolis_seat),
        _interleaved(before.seat_g, after.seat_g),
        _interleaved(before.seat_rate, after.seat_rate),
        _interleaved(before.seat_angular_acceleration, after.seat_angular_acceleration),
        *(
            _interleaved(*(of_motion[:, :, part] for of_motion in parts))
            for part in range(len(SEAT_PARTS))
        ),
        *_motion_blocks(run.asked.motion),
    ]
    names = trajectory_names(
        run.solution.control.shape[1], adjoint=run.solution.adjoint.shape[1] > 0
    )
    vectors = (block[:, i] for block in blocks for i in range(block.shape[1]))
    return dict(zip(names, vectors, strict=True))


def trajectory_names(joints_of_p: int, *, adjoint: bool = True) -> tuple[str, ...]:
    """Return the names of ``trajectory_columns``, in their order.

    Parameters
    ----------
    joints_of_p : int
        1 for a factor p that all joints share, 3 for one per joint, 0 for a motion
        that is no multiple of the desired rates.
    adjoint : bool
        Whether there is one: a motion whose dynamics were eliminated has none.
    """
    vectors = [
        *((f"coriolis_{each.key}", "rad_s2") for each in COMPONENTS if each.axes == "report"),
        *((f"coriolis_{each.key}", "rad_s2") for each in COMPONENTS if each.axes == "seat"),
        *((f"seat_g{axis}", "g") for axis in "xyz"),
        *((f"seat_{axis}", "rad_s") for axis in "pqr"),
        *((f"seat_angular_acceleration_{axis}", "rad_s2") for axis in "xyz"),
        *((f"seat_{part}_{axis}", "g") for part in SEAT_PARTS for axis in "xyz"),
    ]
    return (
        "t_s",
        *_motion_names("desired"),
        *_motion_names("modified"),
        *(["p"] if joints_of_p == 1 else [f"p_{joint}" for joint in JOINTS[:joints_of_p]]),
        *(f"adjoint_{joint}" for joint in JOINTS if adjoint),
        *(f"{stem}_{when}_{unit}" for stem, unit in vectors for when in ("before", "after")),
        *_motion_names("asked"),
    )


def _motion_names(which: str) -> list[str]:
    units = ("rad", "rad_s", "rad_s2", "rad_s3")
    return [f"{which}_{joint}_{unit}" for joint in JOINTS for unit in units]


def encode_table(columns: Mapping[str, Floats], format: TableFormat) -> bytes:
    """Return a table in the bytes of a format.

    Parameters
    ----------
    columns : mapping of str to (n,) array
    format : {"csv", "ndjson", "json", "parquet"}
        ``csv`` starts with the header row and has no comment lines; ``ndjson``
        is an object a line; ``json`` an array of those objects, a line each.

    Raises
    ------
    NotReleasedError
        If a value is not a finite number: such a table must not be played.
    ValueError
        If the columns are not equally long vectors, or the format is none of
        the above.
    """
    if len({np.shape(values) for values in columns.values()}) != 1 or any(
        np.ndim(values) != 1 for values in columns.values()
    ):
        raise ValueError("columns of a table must be vectors of one length")
    _require_finite(columns)
    match format:
        case "csv":
            return _csv(columns)
        case "ndjson":
            return "".join(line + "\n" for line in _objects(columns)).encode()
        case "json":
            return ("[\n" + ",\n".join(_objects(columns)) + "\n]\n").encode()
        case "parquet":
            return _parquet(columns)
    raise ValueError(f"unknown table format {format!r}: one of {', '.join(TABLE_FORMATS)}")


def _in_unit(name: str, si: Floats) -> Floats:
    """Turn SI values into the unit that the column's name ends with."""
    unit = split_unit(name)[1]
    assert unit is not None, name
    return si / unit.to_si


def _motion_blocks(motion: Motion) -> list[Floats]:
    """Return angle, rate, acceleration and jerk at samples, an (n, 4) array a joint."""
    interval = motion.acceleration
    acceleration = mean_of_sides(np.stack([interval, interval], axis=1))
    course = np.stack([motion.angle, motion.rate, acceleration, jerk_at_samples(motion)], axis=2)
    return [course[:, joint] for joint in range(len(JOINTS))]


def _interleaved(before: Floats, after: Floats) -> Floats:
    """Turn two (n - 1, 2, 3) arrays into (n, 6): each component before and after."""
    pairs = np.stack([mean_of_sides(before), mean_of_sides(after)], axis=2)
    return pairs.reshape(len(pairs), -1)


def _require_finite(columns: Mapping[str, Floats]) -> None:
    complaints = []
    for name, values in columns.items():
        bad = np.flatnonzero(~np.isfinite(values))
        if bad.size:
            what = (
                f"{bad.size} of {len(values)} values are not finite numbers, the first "
                f"({values[bad[0]]}) in row {bad[0] + 1}; no table is written"
            )
            complaints.append(Complaint(name, what))
    if complaints:
        raise NotReleasedError(complaints)


def _text_columns(columns: Mapping[str, Floats]) -> Iterator[Sequence[list[str]]]:
    """Yield blocks of rows: for each column the shortest exact text of its values."""
    arrays = [np.asarray(values, dtype=np.float64) for values in columns.values()]
    for start in range(0, len(arrays[0]), _ROWS_AT_ONCE):
        block = slice(start, start + _ROWS_AT_ONCE)
        yield [[float.__repr__(value) for value in array[block].tolist()] for array in arrays]


def _csv(columns: Mapping[str, Floats]) -> bytes:
    if len(next(iter(columns.values()))) >= LONG_TABLE:
        return _long_csv(columns)
    blocks = [",".join(columns).encode() + b"\n"]
    for texts in _text_columns(columns):
        rows = "\n".join(map(",".join, zip(*texts, strict=True)))
        blocks.append(rows.encode("ascii") + b"\n")
    return b"".join(blocks)


def _objects(columns: Mapping[str, Floats]) -> Iterator[str]:
    """Yield a row at a time as a JSON object on one line."""
    keys = [json.dumps(name).replace("%", "%%") for name in columns]
    template = "{" + ", ".join(f"{key}: %s" for key in keys) + "}"
    for texts in _text_columns(columns):
        yield from (template % row for row in zip(*texts, strict=True))


def _long_csv(columns: Mapping[str, Floats]) -> bytes:
    """Return the same by Arrow, which writes whole numbers without their ``.0``."""
    import pyarrow as pa
    import pyarrow.csv as pc

    sink = pa.BufferOutputStream()
    sink.write(",".join(columns).encode() + b"\n")
    pc.write_csv(_arrow_table(columns), sink, pc.WriteOptions(include_header=False))
    return bytes(sink.getvalue())


def _arrow_table(columns: Mapping[str, Floats]) -> Any:
    import pyarrow as pa

    # From buffers, because pa.array would import pandas to ask whether it was given any.
    arrays: list[Any] = [
        pa.Array.from_buffers(
            pa.float64(),
            len(values),
            [None, pa.py_buffer(np.ascontiguousarray(values, np.float64))],
        )
        for values in columns.values()
    ]
    return pa.Table.from_arrays(arrays, names=list(columns))


def _parquet(columns: Mapping[str, Floats]) -> bytes:
    # Imported here: it costs a tenth of a second that a CSV table does not need.
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = _arrow_table(columns)
    sink = pa.BufferOutputStream()
    # Snappy is what every reader knows; a dictionary of doubles that never
    # repeat only adds bytes.
    pq.write_table(table, sink, compression="snappy", use_dictionary=False, store_schema=False)
    return bytes(sink.getvalue())
