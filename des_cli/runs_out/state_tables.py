"""The kinematics of states as columns, as JSON objects, and in the bytes of each format.

``QUANTITIES`` says once how each quantity is called, what it is in words, and
what its rows and columns are. A template such as ``coriolis_{}_rad_s2`` gives
the columns ``coriolis_ab3_rad_s2`` ... of a table, and the key
``coriolis_rad_s2`` of an object that holds the whole vector.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product

from des_cli.model.arrays import Floats
from des_cli.model.coriolis import COMPONENTS
from des_cli.model.machine import JOINTS
from des_cli.runs_out.tables import SEAT_PARTS, TableFormat, encode_table
from des_cli.study.state import StateReport

GROUND, SEAT, FIRST = ("i0", "j0", "k0"), ("x", "y", "z"), ("1", "2", "3")
PARTS = (*SEAT_PARTS, "total")


@dataclass(frozen=True, slots=True)
class Quantity:
    """How one field of a ``StateReport`` is written.

    Parameters
    ----------
    field : str
    template : str
        Of a column's name: a ``{}`` for each axis.
    title, unit : str
        In words.
    rows, columns : tuple of str
        Names along the first and the second axis of a value; empty where it
        has none.
    whole : str
        The key of the whole in an object, where the template does not tell it.
    """

    field: str
    template: str
    title: str
    unit: str = ""
    rows: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    whole: str = ""

    @property
    def key(self) -> str:
        """The key of the whole quantity in an object."""
        return self.whole or self.template.replace("_{}", "")

    @property
    def names(self) -> tuple[str, ...]:
        """A name for each component, the last axis running fastest."""
        axes = [axis for axis in (self.rows, self.columns) if axis]
        return tuple(self.template.format(*labels) for labels in product(*axes))


def _vector(
    field: str, template: str, title: str, unit: str, rows: tuple[str, ...] = GROUND
) -> Quantity:
    return Quantity(field, template, title, unit, rows)


def _jacobian(
    field: str, template: str, title: str, rows: tuple[str, ...], unit: str = ""
) -> Quantity:
    return Quantity(field, template, title, unit, rows, JOINTS)


QUANTITIES: tuple[Quantity, ...] = (
    Quantity("angle", "{}_rad", "Joint angle", "rad", JOINTS, whole="angle_rad"),
    Quantity("rate", "{}_rad_s", "Joint rate", "rad/s", JOINTS, whole="rate_rad_s"),
    Quantity(
        "acceleration",
        "{}_rad_s2",
        "Joint acceleration",
        "rad/s^2",
        JOINTS,
        whole="acceleration_rad_s2",
    ),
    Quantity(
        "t_0_17",
        "t_0_17_{}_{}",
        "T_0_17 (9): seat axes and seat origin, in the ground frame",
        "origin in m",
        (*GROUND, "0"),
        (*SEAT, "origin_m"),
    ),
    _jacobian("j1", "j1_{}_{}_m", "J1 (12): seat velocity along ground axes", GROUND, "m/rad"),
    Quantity("j1_determinant", "j1_determinant_m3", "Determinant of J1", "m^3"),
    _jacobian("j2", "j2_{}_{}", "J2 (32): M(seat) times the ground Jacobian", FIRST),
    _jacobian(
        "ground_jacobian",
        "ground_jacobian_{}_{}",
        "Ground Jacobian: angular velocity along ground axes",
        GROUND,
    ),
    _jacobian(
        "body_jacobian",
        "body_jacobian_{}_{}",
        "Body Jacobian: angular velocity along seat axes",
        SEAT,
    ),
    Quantity(
        "orientation_determinant",
        "orientation_determinant",
        "Determinant of J2, ground and body Jacobian",
    ),
    _vector("singular_values", "singular_value_{}", "Singular values of the same three", "", FIRST),
    _vector("w_ground", "w_ground_{}_rad_s", "Angular velocity, ground axes", "rad/s"),
    _vector("w_eq32", "w_eq32_{}_rad_s", "Angular velocity, axes of (32)", "rad/s", FIRST),
    _vector("w_seat", "w_seat_{}_rad_s", "Angular velocity p, q, r, seat axes", "rad/s", SEAT),
    _vector(
        "angular_ground",
        "angular_acceleration_{}_rad_s2",
        "Angular acceleration (16)-(18), ground axes",
        "rad/s^2",
    ),
    _vector(
        "coriolis_ground",
        "coriolis_{}_rad_s2",
        "Its Coriolis part (22)-(24), ground axes",
        "rad/s^2",
        tuple(each.key for each in COMPONENTS if each.axes == "report"),
    ),
    _vector(
        "angular_seat",
        "angular_acceleration_seat_{}_rad_s2",
        "Angular acceleration, seat axes",
        "rad/s^2",
        SEAT,
    ),
    _vector(
        "coriolis_seat",
        "coriolis_seat_{}_rad_s2",
        "Its Coriolis part, seat axes",
        "rad/s^2",
        SEAT,
    ),
    _vector("position", "seat_position_{}_m", "Seat position, ground axes", "m"),
    _vector("velocity", "seat_velocity_{}_m_s", "Seat velocity, ground axes", "m/s"),
    Quantity(
        "parts_ground",
        "seat_acceleration_{}_{}_m_s2",
        "Seat acceleration, ground axes",
        "m/s^2",
        PARTS,
        GROUND,
    ),
    Quantity(
        "parts_seat",
        "seat_acceleration_{}_{}_g",
        "Seat acceleration, seat axes, gravity left out",
        "g",
        PARTS,
        SEAT,
    ),
    _vector(
        "specific_force",
        "specific_force_{}_g",
        "Specific force, seat axes, gravity included",
        "g",
        SEAT,
    ),
    _vector("g_vector", "seat_{}_g", "G-vector: eyeballs in, left, down", "g", ("gx", "gy", "gz")),
)


def state_columns(report: StateReport, t: Floats | None = None) -> dict[str, Floats]:
    """Return a column of n doubles for each component of each quantity.

    Parameters
    ----------
    report : StateReport
    t : (n,) array, optional
        Times, for a first column ``t_s``.
    """
    columns = {} if t is None else {"t_s": t}
    for quantity in QUANTITIES:
        values: Floats = getattr(report, quantity.field)
        flat = values.reshape(len(values), -1)
        columns |= {name: flat[:, i] for i, name in enumerate(quantity.names)}
    return columns


def state_objects(report: StateReport, t: Floats | None = None) -> Iterator[dict[str, object]]:
    """Yield an object for each state; vectors and matrices are arrays, row by row.

    Joint vectors are in the order arm, fork, cab; the parts of the seat
    acceleration are objects by their names.
    """
    for index in range(len(report.angle)):
        found: dict[str, object] = {} if t is None else {"t_s": float(t[index])}
        for quantity in QUANTITIES:
            value = getattr(report, quantity.field)[index].tolist()
            named = quantity.rows == PARTS
            found[quantity.key] = dict(zip(PARTS, value, strict=True)) if named else value
        yield found


def encode_states(report: StateReport, format: TableFormat, t: Floats | None = None) -> bytes:
    """Return states in the bytes of a format; the doubles read back exactly.

    ``csv`` and ``parquet`` have a row a state and a column a component,
    ``ndjson`` an object a line, ``json`` an array of those objects.

    Raises
    ------
    NotReleasedError
        If a value is not a finite number.
    """
    if format in ("csv", "parquet"):
        return encode_table(state_columns(report, t), format)
    lines = [json.dumps(each, allow_nan=False) for each in state_objects(report, t)]
    if format == "json":
        return ("[\n" + ",\n".join(lines) + "\n]\n").encode()
    return "".join(line + "\n" for line in lines).encode()


def encode_state(report: StateReport, format: TableFormat, about: Mapping[str, object]) -> bytes:
    """Return a single state; as ``json`` one object, indented, that starts with ``about``."""
    if format == "json":
        [found] = state_objects(report)
        return (_indented({**about, **found}) + "\n").encode()
    return encode_states(report, format)


def _indented(content: Mapping[str, object]) -> str:
    """Write an object with a line for each key, and one for each row of a matrix."""
    lines = []
    for key, value in content.items():
        rows: list[str] | None = None
        if isinstance(value, list) and value and isinstance(value[0], list):
            rows, ends = [json.dumps(row, allow_nan=False) for row in value], "[]"
        elif isinstance(value, dict):
            rows = [f"{json.dumps(k)}: {json.dumps(v, allow_nan=False)}" for k, v in value.items()]
            ends = "{}"
        if rows is None:
            text = json.dumps(value, allow_nan=False)
        else:
            text = ends[0] + "\n    " + ",\n    ".join(rows) + "\n  " + ends[1]
        lines.append(f"  {json.dumps(key)}: {text}")
    return "{\n" + ",\n".join(lines) + "\n}"
