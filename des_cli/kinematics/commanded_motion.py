"""The desired motion of the joints: what a profile asks of a machine.

Joint commands are the motion already: ``W = J theta'`` of them, solved about the
commanded rates, gives these back even on the singularity, so that nothing is solved.
Body rates are integrated through the body-axis inverse, damped near the singularity
and held inside the machine's rate limits.
"""

from __future__ import annotations

import numpy as np

from des_cli.kinematics.attitude import (
    geodesic_angle,
    integrate_attitude,
    rotation_of_quaternion,
    rotation_vector,
)
from des_cli.kinematics.chain import Chain, chain_of, joint_axes, seat_rotation
from des_cli.kinematics.coriolis import angular_acceleration_split
from des_cli.kinematics.orientation import body_jacobian, least_singular_value
from des_cli.kinematics.rate_field import RateField
from des_cli.kinematics.refinement import as_they_are, resolve
from des_cli.model.arrays import Flags, Floats, frozen
from des_cli.model.motion import DesiredMotion, Motion, Shortfall, mean_of_sides
from des_cli.model.profile import BodyRates, JointCommands, Profile


def make_desired(profile: Profile, *, divide: bool = True) -> DesiredMotion:
    """Return the desired motion of a profile's joints.

    Parameters
    ----------
    profile : Profile
        Of joint commands or body rates.
    divide : bool
        Whether body rates may be put on more rows than the profile has.

    Returns
    -------
    DesiredMotion
        For joint commands the commands themselves, with the arm's angle
        integrated from its velocity by the trapezoidal rule, as a velocity that
        is linear between samples moves it. For body rates on more rows than the
        profile has, where these are too far apart to hold the turning.
    """
    chain = chain_of(profile.machine, profile.seat)
    if isinstance(profile.command, JointCommands):
        return _from_joints(chain, profile, profile.command)
    if isinstance(profile.command, BodyRates):
        return _from_body_rates(chain, profile, profile.command, divide=divide)
    raise TypeError("a requested G takes the machine's limits: reduction.desired.find_desired")


def _from_joints(chain: Chain, profile: Profile, command: JointCommands) -> DesiredMotion:
    step = np.diff(profile.t)
    arm = command.arm_rate
    turned = np.cumsum(0.5 * step * (arm[:-1] + arm[1:]))
    arm_angle = profile.initial_angle[0] + np.concatenate([[0.0], turned])
    angle = np.column_stack([arm_angle, command.position])
    # Zero is added for a negative zero would be a sign in the command table.
    start = np.column_stack([arm[:-1], command.rate_start]) + 0.0
    end = np.column_stack([arm[1:], command.rate_end]) + 0.0
    return DesiredMotion(
        motion=Motion(profile.t, frozen(angle), frozen(start), frozen(end)),
        least_singular_value=least_singular_value(chain, angle),
        damped=np.zeros(len(profile.t), dtype=bool),
        residual=np.zeros((len(profile.t), 3)),
    )


def _from_body_rates(
    chain: Chain, profile: Profile, command: BodyRates, *, divide: bool
) -> DesiredMotion:
    field = RateField.of(chain, profile.machine)
    grid = resolve if divide else as_they_are
    demand = grid(field, profile.t, command, profile.initial_angle)
    command, angle = demand.command, demand.angle
    sides = np.stack([angle[:-1], angle[1:]], axis=1)
    demanded = np.stack([command.start, command.end], axis=1)
    rate, held, residual = field.rates(body_jacobian(chain, sides), demanded)
    flown = seat_rotation(chain, angle)
    demanded_attitude = flown[0] @ integrate_attitude(demand.step, command)
    motion = Motion(demand.t, angle, rate[:, 0], rate[:, 1])
    return DesiredMotion(
        motion=motion,
        least_singular_value=least_singular_value(chain, angle),
        damped=_at_samples(held),
        residual=mean_of_sides(residual),
        attitude_error=float(np.max(geodesic_angle(flown, demanded_attitude))),
        recorded_attitude_error=_against_record(command, demanded_attitude),
        shortfall=_shortfall(chain, motion, command, held, (flown, demanded_attitude)),
        rates=command,
        remarks=(demand.remark,) if demand.remark else (),
    )


def _shortfall(
    chain: Chain, motion: Motion, command: BodyRates, held: Flags, attitudes: tuple[Floats, Floats]
) -> Shortfall | None:
    """Return what of the rates the joints do not make; None where nothing was held or damped."""
    if not np.any(held):
        return None
    sides = motion.rate_sides
    accelerations = np.broadcast_to(motion.acceleration[:, None, :], sides.shape)
    spin = (sides[..., None, :] @ joint_axes(chain, motion.angle_sides, "seat"))[..., 0, :]
    euler, cross = angular_acceleration_split(
        chain, motion.angle_sides, sides, accelerations, "seat"
    )
    short = np.any(held, axis=1)[:, None, None]
    slope = ((command.end - command.start) / motion.step[:, None])[:, None, :]
    return Shortfall(
        seat_rate=np.where(short, np.stack([command.start, command.end], axis=1) - spin, 0.0),
        seat_angular_acceleration=np.where(short, slope - (euler + cross), 0.0),
        seat_g=np.zeros_like(spin),
        attitude=rotation_vector(*attitudes),
    )


def _at_samples(sides: Flags) -> Flags:
    """Return where either interval at a sample has the flag, (n,)."""
    flags = np.zeros(len(sides) + 1, dtype=bool)
    flags[:-1] |= sides[:, 0]
    flags[1:] |= sides[:, 1]
    return flags


def _against_record(command: BodyRates, demanded_attitude: Floats) -> float | None:
    """Return the largest angle between recorded and integrated attitude [rad]."""
    if command.attitude is None:
        return None
    known = np.all(np.isfinite(command.attitude), axis=1)
    if not known[0]:
        return None
    recorded = rotation_of_quaternion(command.attitude[known])
    relative = np.swapaxes(recorded[0], 0, 1) @ recorded
    integrated = np.swapaxes(demanded_attitude[0], 0, 1) @ demanded_attitude[known]
    return float(np.max(geodesic_angle(relative, integrated)))
