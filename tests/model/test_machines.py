from __future__ import annotations

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of, joint_axes, seat_position, seat_rotation
from des_cli.model.machine import Seat
from des_cli.model.machines import (
    DES,
    JOHNSVILLE,
    MACHINES,
    gimballed_centrifuge_rows,
    read_chain,
)
from des_cli.units import FOOT_M, STANDARD_GRAVITY_M_S2


def test_des_is_table_1():
    assert DES.lengths["L2"] == pytest.approx(5.7912, rel=1e-15)
    assert {name: round(value / FOOT_M, 9) for name, value in DES.lengths.items()} == {
        "L1": 12.27,
        "L2": 19.0,
        "Lx": 3.9,
        "Ly": 0.012,
        "Lz": 0.012,
        "Lt": 2.76,
    }
    assert [limit.rate for limit in DES.limits] == [5.86, 3.14, 3.14]
    assert [limit.acceleration for limit in DES.limits] == [0.63, 2.5, 5.0]
    assert [limit.angle for limit in DES.limits] == [math.inf, 2 * math.pi, 2 * math.pi]
    assert len(DES.rows) == 17


@pytest.mark.parametrize("name", list(MACHINES))
def test_every_machine_has_a_chain_limits_and_a_source(name):
    machine = MACHINES[name]
    assert machine.name == name
    chain = chain_of(machine, Seat())
    axes = joint_axes(chain, np.array([0.3, -0.4, 2.0]))
    np.testing.assert_allclose(np.linalg.norm(axes, axis=-1), 1.0, rtol=0, atol=1e-14)
    assert abs(axes[0, 2]) == 1.0  # the arm turns about the vertical
    assert all(limit.rate > 0 and limit.acceleration > 0 for limit in machine.limits)
    # no source has jerk limits: half a second from no acceleration to the limit
    assert [limit.acceleration / limit.jerk for limit in machine.limits] == [0.5] * 3
    assert "Assumed" in machine.source
    assert "jerk limits" in machine.source
    assert pickle.loads(pickle.dumps(machine)) == machine


def test_tangential_fork_is_roll_and_cab_is_pitch():
    """Seat yaw 0 faces the travel of a positive arm rate; roll right, pitch up."""
    chain = chain_of(JOHNSVILLE, Seat(yaw=0.0))
    home = np.zeros(3)
    travel = np.cross(joint_axes(chain, home)[0], seat_position(chain, home))
    forward, right, down = seat_rotation(chain, home).T
    np.testing.assert_allclose(forward, travel / np.linalg.norm(travel), rtol=0, atol=1e-14)
    np.testing.assert_allclose(down, [0, 0, -1], rtol=0, atol=1e-14)
    body = joint_axes(chain, home, "seat")
    np.testing.assert_allclose(body[1:], [[1, 0, 0], [0, 1, 0]], rtol=0, atol=1e-14)
    rolled = seat_rotation(chain, np.array([0.0, 0.1, 0.0]))
    assert rolled[2, 1] < 0  # the right wing goes down
    pitched = seat_rotation(chain, np.array([0.0, 0.0, 0.1]))
    assert pitched[2, 0] > 0  # the nose goes up
    assert right[2] == 0


def test_johnsville_arm_limits_are_its_published_performance():
    arm = JOHNSVILLE.limits[0]
    radius = JOHNSVILLE.lengths["L2"]
    assert arm.rate**2 * radius == pytest.approx(40 * STANDARD_GRAVITY_M_S2, rel=1e-12)
    onset = 2 * arm.rate * arm.acceleration * radius
    assert onset == pytest.approx(10 * STANDARD_GRAVITY_M_S2, rel=1e-12)


def test_missing_length_is_an_error():
    with pytest.raises(KeyError, match="Lt"):
        gimballed_centrifuge_rows({"L2": 1.0, "Lx": 0.0, "Ly": 0.0, "Lz": 0.0})


@pytest.mark.parametrize("axis", ["radial", "tangential"])
@pytest.mark.parametrize("values", [(5.5, 0.0, 0.1, 0.1, -2.0), (0.0, 0.0, 0.0, 0.0, 0.0)])
def test_a_chain_tells_what_it_was_made_of(axis, values):
    lengths = dict(zip(("L2", "Lx", "Ly", "Lz", "Lt"), values, strict=True))
    rows = gimballed_centrifuge_rows(lengths, fork_axis=axis)
    assert read_chain(rows) == (lengths, axis)


def test_another_chain_is_not_one_of_named_lengths():
    rows = list(DES.rows)
    assert read_chain(rows[:-1]) is None
    assert read_chain([*rows, rows[-1]]) is None
    for index in range(len(rows)):
        changed = [*rows]
        changed[index] = replace(rows[index], alpha=rows[index].alpha + 0.1)
        assert read_chain(changed) is None
