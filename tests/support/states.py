"""Independent kinematics for the tests: plain products of the table's matrices."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from des_cli.kinematics.chain import Chain, chain_of
from des_cli.model.machine import DHRow, JointLimits, Machine, Seat
from des_cli.model.machines import DES

STEP = 1e-30
"""Complex step: the derivative is exact to rounding for any step this small."""

LIMITS = (JointLimits(np.inf, 1.0, 1.0),) * 3


def dh_frames(machine: Machine, seat: Seat, angles: np.ndarray) -> tuple[list[Any], np.ndarray]:
    """Return the frames that the joints turn about, and T_0^17, row by row."""
    values = {"arm": angles[0], "fork": angles[1], "cab": angles[2], None: 0.0}
    values |= {"seat_yaw": seat.yaw, "seat_pitch": seat.pitch}
    frames, total = [], np.eye(4, dtype=complex)
    for row in machine.rows:
        ca, sa = np.cos(row.alpha), np.sin(row.alpha)
        theta = row.offset + row.sign * values[row.variable]
        ct, st = np.cos(theta), np.sin(theta)
        step = np.array(
            [
                [ct, -st, 0, row.a],
                [st * ca, ct * ca, -sa, -sa * row.d],
                [st * sa, ct * sa, ca, ca * row.d],
                [0, 0, 0, 1],
            ]
        )
        total = total @ step
        if row.variable in ("arm", "fork", "cab"):
            frames.append((row.sign, total[:3, 2], total[:3, 3]))
    return frames, total


@dataclass(frozen=True)
class Case:
    """A machine with its seat, its chain, and the independent forms of it."""

    machine: Machine
    seat: Seat

    @property
    def chain(self) -> Chain:
        return chain_of(self.machine, self.seat)

    def transform(self, angles: np.ndarray) -> np.ndarray:
        return dh_frames(self.machine, self.seat, angles)[1]

    def axes(self, angles: np.ndarray, frame: str) -> np.ndarray:
        """Signed joint axes, (3 joint, 3), in ground or seat components."""
        frames, total = dh_frames(self.machine, self.seat, angles)
        axes = np.array([sign * axis for sign, axis, _ in frames])
        return axes if frame in ("ground", "report") else axes @ total[:3, :3]

    def pairs(self, angles: np.ndarray, axes: str) -> np.ndarray:
        """Cross products w_j x w_k, (3 pair, 3)."""
        w = self.axes(angles, axes)
        return np.array([np.cross(w[0], w[1]), np.cross(w[0], w[2]), np.cross(w[1], w[2])])

    def coriolis(self, angles: np.ndarray, rates: np.ndarray, axes: str) -> np.ndarray:
        products = [rates[0] * rates[1], rates[0] * rates[2], rates[1] * rates[2]]
        return np.array(products) @ self.pairs(angles, axes)


def complex_step(function: Callable[[np.ndarray], np.ndarray], at: np.ndarray) -> np.ndarray:
    """Return the derivatives of a function of a vector, (3, ...)."""
    return np.stack([function(at + 1j * STEP * unit).imag / STEP for unit in np.eye(3)])


def _arbitrary_machine() -> Machine:
    rng = np.random.default_rng(20240)
    variables = [None, "arm", None, "fork", "seat_yaw", None, "cab", None, "seat_pitch"]
    signs = [1, -1, 1, 1, -1, 1, -1, 1, 1]
    rows = tuple(
        DHRow(*rng.uniform(-2.0, 2.0, 4), variable=variable, sign=sign)
        for variable, sign in zip(variables, signs, strict=True)
    )
    return Machine("arbitrary", rows, LIMITS)


CASES = {
    "des": Case(DES, Seat()),
    "des-turned-seat": Case(DES, Seat(yaw=0.8, pitch=0.3)),
    "arbitrary": Case(_arbitrary_machine(), Seat(yaw=-0.7, pitch=1.1)),
}


@pytest.fixture(params=list(CASES))
def case(request: pytest.FixtureRequest) -> Case:
    return CASES[request.param]


@pytest.fixture
def step() -> Callable[..., np.ndarray]:
    return complex_step


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(5)


_DATA = Path(__file__).parents[1] / "data" / "kinematics_reference.json"
_STATES = json.loads(_DATA.read_text())["states"]


@dataclass(frozen=True)
class State:
    """A state of the reference, with its seat and a comparison in feet."""

    values: dict[str, Any]

    @property
    def seat(self) -> Seat:
        return Seat(self.values["theta_sy"], self.values["theta_st"])

    @property
    def chain(self) -> Chain:
        return chain_of(DES, self.seat)

    def __getitem__(self, name: str) -> Any:
        value = self.values[name]
        return (
            {k: np.array(v) for k, v in value.items()}
            if isinstance(value, dict)
            else np.array(value)
        )


@pytest.fixture(params=_STATES, ids=lambda state: state["name"])
def state(request: pytest.FixtureRequest) -> State:
    return State(request.param)


@pytest.fixture
def same() -> Callable[[Any, Any], None]:
    """Compare with a reference value: 1e-9, and the rounding of its ten decimals."""

    def compare(value: Any, expected: Any) -> None:
        np.testing.assert_allclose(value, expected, rtol=1e-9, atol=5.1e-11)

    return compare
