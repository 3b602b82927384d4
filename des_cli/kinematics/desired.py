"""The desired motion of the joints: what a profile asks of a machine.

Joint commands go through ``W = J theta'`` and back through the inverse about the
commanded rates; body rates are integrated through the body-axis inverse, damped
near the singularity and held inside the machine's rate limits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from des_cli.kinematics.attitude import (
    geodesic_angle,
    integrate_attitude,
    rotation_of_quaternion,
    rotation_vector,
)
from des_cli.kinematics.chain import Chain, chain_of, joint_axes, seat_rotation
from des_cli.kinematics.coriolis import angular_acceleration_split
from des_cli.kinematics.orientation import (
    SINGULAR_VALUE_THRESHOLD,
    body_jacobian,
    damped_inverse_rates,
    smallest_singular_value,
)
from des_cli.model.arrays import Flags, Floats
from des_cli.model.machine import Machine
from des_cli.model.motion import DesiredMotion, Motion, Shortfall, mean_of_sides
from des_cli.model.profile import BodyRates, JointCommands, Profile

LONGEST_TURN = 0.1
"""Joint angle per Runge-Kutta step [rad], times the smallest singular value: with
it one step's error stays below 1e-8 rad away from the singularity."""

MOST_SUBSTEPS = 64
"""Runge-Kutta steps in one interval, at the most."""

SURELY_REGULAR = 1.5 * SINGULAR_VALUE_THRESHOLD
"""Determinant above which nothing is damped: the axes are unit vectors, so the two
larger singular values have a product of at most 1.5."""


def make_desired(profile: Profile) -> DesiredMotion:
    """Return the desired motion of a profile's joints.

    Parameters
    ----------
    profile : Profile
        Of joint commands or body rates.

    Returns
    -------
    DesiredMotion
        For joint commands the commands themselves, with the arm's angle
        integrated from its velocity by the trapezoidal rule, as a velocity that
        is linear between samples moves it.
    """
    chain = chain_of(profile.machine, profile.seat)
    if isinstance(profile.command, JointCommands):
        return _from_joints(chain, profile, profile.command)
    if isinstance(profile.command, BodyRates):
        return _from_body_rates(chain, profile, profile.command)
    raise TypeError("an asked G takes the machine's limits: reduction.desired.find_desired")


def _from_joints(chain: Chain, profile: Profile, command: JointCommands) -> DesiredMotion:
    step = np.diff(profile.t)
    arm = command.arm_rate
    turned = np.cumsum(0.5 * step * (arm[:-1] + arm[1:]))
    arm_angle = profile.initial_angle[0] + np.concatenate([[0.0], turned])
    angle = np.column_stack([arm_angle, command.position])
    commanded = np.stack(
        [
            np.column_stack([arm[:-1], command.rate_start]),
            np.column_stack([arm[1:], command.rate_end]),
        ],
        axis=1,
    )
    sides = np.stack([angle[:-1], angle[1:]], axis=1)
    jacobian = body_jacobian(chain, sides)
    wanted = np.asarray((jacobian @ commanded[..., None])[..., 0])
    # About the commanded rates the crossing of the singularity is removable: the
    # demand that remains is zero, and so is what the damping could take from it.
    rate, damped, residual = damped_inverse_rates(jacobian, wanted, reference=commanded)
    lost = damped & (np.abs(residual).max(axis=-1) > np.finfo(float).eps * 16)
    return DesiredMotion(
        motion=Motion(profile.t, angle, rate[:, 0], rate[:, 1]),
        singular_value=smallest_singular_value(body_jacobian(chain, angle)),
        damped=_at_samples(lost),
        residual=mean_of_sides(residual),
    )


def _from_body_rates(chain: Chain, profile: Profile, command: BodyRates) -> DesiredMotion:
    step = np.diff(profile.t)
    field = RateField.of(chain, profile.machine)
    angle = _integrate(field, step, command, profile.initial_angle)
    sides = np.stack([angle[:-1], angle[1:]], axis=1)
    wanted = np.stack([command.start, command.end], axis=1)
    rate, held, residual = field.rates(body_jacobian(chain, sides), wanted)
    flown = seat_rotation(chain, angle)
    wished = flown[0] @ integrate_attitude(step, command)
    motion = Motion(profile.t, angle, rate[:, 0], rate[:, 1])
    return DesiredMotion(
        motion=motion,
        singular_value=smallest_singular_value(body_jacobian(chain, angle)),
        damped=_at_samples(held),
        residual=mean_of_sides(residual),
        attitude_error=float(np.max(geodesic_angle(flown, wished))),
        recorded_attitude_error=_against_record(command, wished),
        shortfall=_shortfall(chain, motion, command, held, (flown, wished)),
    )


def _shortfall(
    chain: Chain, motion: Motion, command: BodyRates, held: Flags, attitudes: tuple[Floats, Floats]
) -> Shortfall | None:
    """Return what of the rates the joints do not make; None where nothing was held or damped."""
    if not np.any(held):
        return None
    sides = motion.rate_sides
    accelerations = np.broadcast_to(motion.acceleration[:, None, :], sides.shape)
    made = (sides[..., None, :] @ joint_axes(chain, motion.angle_sides, "seat"))[..., 0, :]
    euler, cross = angular_acceleration_split(
        chain, motion.angle_sides, sides, accelerations, "seat"
    )
    short = np.any(held, axis=1)[:, None, None]
    slope = ((command.end - command.start) / motion.step[:, None])[:, None, :]
    return Shortfall(
        seat_rate=np.where(short, np.stack([command.start, command.end], axis=1) - made, 0.0),
        seat_angular_acceleration=np.where(short, slope - (euler + cross), 0.0),
        seat_g=np.zeros_like(made),
        attitude=rotation_vector(*attitudes),
    )


@dataclass(frozen=True)
class RateField:
    """Joint rates that make a seat rate, damped and inside the rate limits.

    Parameters
    ----------
    chain : Chain
    limit : (3,) array
        [rad/s]
    """

    chain: Chain
    limit: Floats

    @classmethod
    def of(cls, chain: Chain, machine: Machine) -> RateField:
        """Take the rate limits of a machine."""
        return cls(chain, np.array([joint.rate for joint in machine.limits]))

    def rates(self, jacobian: Floats, wanted: Floats) -> tuple[Floats, Flags, Floats]:
        """Solve ``J theta' = W`` within the limits, vectorised.

        A joint that would pass its limit is held there, and the others are
        solved for what is left of the demand.

        Returns
        -------
        rates : (..., 3) array
        held : (...) array of bool
            Where anything was damped or held.
        residual : (..., 3) array
            ``W - J theta'`` [rad/s].
        """
        rates, damped, residual = damped_inverse_rates(jacobian, wanted)
        at_limit = np.zeros(rates.shape, dtype=bool)
        for _ in range(3):  # each round holds at least one joint more
            over = ~at_limit & (np.abs(rates) > self.limit)
            if not np.any(over):
                break
            at_limit |= over
            fixed = np.where(at_limit, np.clip(rates, -self.limit, self.limit), 0.0)
            left = wanted - np.asarray((jacobian @ fixed[..., None])[..., 0])
            movable = np.where(at_limit[..., None, :], 0.0, jacobian)
            rates = fixed + np.where(at_limit, 0.0, damped_inverse_rates(movable, left)[0])
        residual = wanted - np.asarray((jacobian @ rates[..., None])[..., 0])
        return rates, damped | np.any(at_limit, axis=-1), residual

    def at(self, angle: Floats, wanted: Floats) -> tuple[Floats, float]:
        """Return the rates at one state, (3,), and the Jacobian's |determinant|."""
        jacobian = body_jacobian(self.chain, angle)
        determinant = abs(_determinant(jacobian))
        if determinant > SURELY_REGULAR:
            rates = np.asarray(np.linalg.solve(jacobian, wanted), dtype=np.float64)
            if np.all(np.abs(rates) <= self.limit):
                return rates, determinant
        return self.rates(jacobian, wanted)[0], determinant


def _integrate(field: RateField, step: Floats, command: BodyRates, initial: Floats) -> Floats:
    """Integrate the joint angles by Runge-Kutta of order four, refined where it turns fast."""
    angle = np.empty((len(step) + 1, 3))
    angle[0] = initial
    for k, h in enumerate(step):
        rates = (command.start[k], command.middle[k], command.end[k])
        first, determinant = field.at(angle[k], rates[0])
        fastest = max(float(np.max(np.abs(first))), float(np.max(np.abs(rates))))
        turn = LONGEST_TURN * max(determinant, SINGULAR_VALUE_THRESHOLD)
        count = min(MOST_SUBSTEPS, max(1, int(np.ceil(h * fastest / turn))))
        state = angle[k]
        for part in range(count):
            a, b = part / count, (part + 1) / count
            middle = _parabola(rates, 0.5 * (a + b))
            dt = h / count
            k1 = first if part == 0 else field.at(state, _parabola(rates, a))[0]
            k2 = field.at(state + 0.5 * dt * k1, middle)[0]
            k3 = field.at(state + 0.5 * dt * k2, middle)[0]
            k4 = field.at(state + dt * k3, _parabola(rates, b))[0]
            state = state + dt / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        angle[k + 1] = state
    return angle


def _parabola(rates: tuple[Floats, Floats, Floats], s: float) -> Floats:
    """Interpolate between start (s = 0), middle and end (s = 1) of an interval."""
    start, middle, end = rates
    return np.asarray(
        (1.0 - s) * (1.0 - 2.0 * s) * start
        + 4.0 * s * (1.0 - s) * middle
        + s * (2.0 * s - 1.0) * end
    )


def _determinant(jacobian: Floats) -> float:
    (a, b, c), (d, e, f), (g, h, i) = jacobian.tolist()
    return float(a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g))


def _at_samples(sides: Flags) -> Flags:
    """Return where either interval at a sample has the flag, (n,)."""
    flags = np.zeros(len(sides) + 1, dtype=bool)
    flags[:-1] |= sides[:, 0]
    flags[1:] |= sides[:, 1]
    return flags


def _against_record(command: BodyRates, wished: Floats) -> float | None:
    """Return the largest angle between recorded and integrated attitude [rad]."""
    if command.attitude is None:
        return None
    known = np.all(np.isfinite(command.attitude), axis=1)
    if not known[0]:
        return None
    recorded = rotation_of_quaternion(command.attitude[known])
    relative = np.swapaxes(recorded[0], 0, 1) @ recorded
    integrated = np.swapaxes(wished[0], 0, 1) @ wished[known]
    return float(np.max(geodesic_angle(relative, integrated)))
