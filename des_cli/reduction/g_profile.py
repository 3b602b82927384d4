"""The machine's motion for a profile that asks for G.

First a guess: the arm's rate that would hold each requested G, no faster than the arm can
change it, and the directions of the force which that makes. Then, in turns until neither
changes the G, `reduction.g_fit` finds the fork and cab that turn the force which is really
there, tangential and relative parts included, into the requested direction, and the arm that
comes nearest to the requested magnitude. Where the arm lags, only the magnitude is off.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from des_cli.errors import Complaint, NotReleasedError, UsageError
from des_cli.kinematics.chain import Chain, chain_of
from des_cli.kinematics.g_motion import (
    NO_G,
    PILOT,
    force_of_arm,
    gimbal_angles,
    requested_directions,
    steady_joints,
)
from des_cli.kinematics.onset import largest_onset
from des_cli.kinematics.orientation import least_singular_value
from des_cli.kinematics.response import respond
from des_cli.kinematics.twist import SeatForms, seat_forms
from des_cli.kinematics.washout import seen_turned, washed_rotation
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, Joint, JointLimits, Machine
from des_cli.model.metric import SEAT_G_DEVIATION
from des_cli.model.motion import DesiredMotion, GOffset, Motion, Shortfall, integrate_sides
from des_cli.model.profile import GCommand, Profile
from des_cli.model.response import Response
from des_cli.reduction.change import allowed_change
from des_cli.reduction.executable import (
    CLEAR,
    ExecutableSpline,
    fit_executable,
    sample_spline,
)
from des_cli.reduction.free.unknowns import SEAT_VARIABLES
from des_cli.reduction.free.windows import Windows
from des_cli.reduction.g_fit import G_TOLERANCE, Direction, Magnitude, fit_g
from des_cli.solver.spline import FEWEST_INTERVALS, Ends, SplineGrid
from des_cli.units import STANDARD_GRAVITY_M_S2

KNOT_STEP = 0.05
"""Time between knots [s]: a tenth of what a joint takes to its full acceleration under the
assumed jerk limits."""

GRIDS = 2
"""Grids of knots, each twice as fine as the one before it: most turns are taken on the
coarsest."""

TURNS = 8
"""Turns of arm and gimbals at most; a turn leaves of the error about the share that the
seat's offset from the gimbals has of the arm's length."""


@dataclass(frozen=True)
class _Task:
    """What is the same in every fit of a profile."""

    profile: Profile
    chain: Chain
    forms: SeatForms
    limits: tuple[JointLimits, ...]

    @property
    def machine(self) -> Machine:
        return self.profile.machine

    @property
    def t(self) -> Floats:
        return self.profile.t


def follow_g(profile: Profile, command: GCommand) -> DesiredMotion:
    """Return the motion inside the machine's limits whose G is nearest to the requested one.

    Parameters
    ----------
    profile : Profile
    command : GCommand
        Of the profile.

    Returns
    -------
    DesiredMotion
        With ``shortfall`` and ``g_offset``, what of the requested G is not made.

    Raises
    ------
    UsageError
        If the machine's arm does not turn about the vertical.
    """
    chain = chain_of(profile.machine, profile.seat)
    forms = seat_forms(chain, profile.machine.gravity)
    if not forms.vertical:
        what = "asks for G, and the machine's arm does not turn about the vertical; command joints"
        raise UsageError([Complaint(profile.name, what)])
    task = _Task(profile, chain, forms, _eased(profile.machine))
    motion = sample_spline(_fit(task, _with_rates(profile.t, command)), profile.t)
    response = respond(profile.machine, profile.seat, motion)
    return DesiredMotion(
        motion=motion,
        least_singular_value=least_singular_value(chain, motion.angle),
        damped=np.zeros(len(profile.t), dtype=bool),
        residual=np.zeros((len(profile.t), 3)),
        shortfall=_shortfall(command, response),
        g_offset=measure_offset(profile.t, command, response),
    )


def require_makeable_g(profile: Profile, command: GCommand) -> None:
    """Refuse a G that is nowhere as large as gravity, which no centrifuge takes away.

    Its nearest is a machine that stands still: nothing to reduce, and to tell a share of it
    that is changed says little where next to nothing is asked.

    Raises
    ------
    NotReleasedError
        If more of the requested G would be changed than the profile allows.
    """
    size = np.linalg.norm(command.sides, axis=-1)
    gravity, most = profile.machine.gravity / STANDARD_GRAVITY_M_S2, float(np.max(size))
    if most >= gravity:
        return
    nothing = most <= NO_G
    allowed = allowed_change(profile.reduction, SEAT_G_DEVIATION)
    # The nearest that can be made is gravity itself, in the requested direction.
    if not nothing and _rms(profile.t, gravity - size) <= allowed * _rms(profile.t, size):
        return
    asks = "asks for no G at all" if nothing else f"asks for {most:.3g} g at most"
    what = (
        f"{asks}, and no centrifuge makes less than {gravity:.3g} g for long: standing still it "
        f"makes that; ask for {gravity:.3g} g or more"
    )
    raise NotReleasedError([Complaint(profile.name, what)])


def _shortfall(command: GCommand, response: Response) -> Shortfall:
    none = np.zeros_like(response.seat_g)
    return Shortfall(
        seat_rate=none,
        seat_angular_acceleration=none,
        seat_g=command.sides - response.seat_g,
        attitude=np.zeros((len(none) + 1, 3)),
    )


def measure_offset(t: Floats, command: GCommand, response: Response) -> GOffset:
    """Return how far a response is from a requested G.

    Parameters
    ----------
    t : (n,) array
        [s]
    command : GCommand
    response : Response
    """
    off = np.linalg.norm(response.seat_g - command.sides, axis=-1)
    k, side = np.unravel_index(int(np.argmax(off)), off.shape)
    onset = [
        float(largest_onset(t, np.linalg.norm(g, axis=-1, keepdims=True))[0])
        for g in (command.sides, response.seat_g)
    ]
    rates: list[float | None] = [None, None]
    if command.rates is not None:
        commanded = np.stack([command.rates.start, command.rates.end], axis=1)
        rates = [_rms(t, (response.seat_rate - commanded)[..., axis]) for axis in (0, 1)]
    return GOffset(_rms(t, off), float(off[k, side]), float(t[k + side]), *onset, *rates)


def _rms(t: Floats, sides: Floats) -> float:
    return float(np.sqrt(integrate_sides(np.diff(t), sides**2) / (t[-1] - t[0])))


def _fit(task: _Task, requested: Floats) -> ExecutableSpline:
    """Return the spline nearest to a requested G, (n - 1, 2, 3) [g]."""
    duration = float(task.t[-1] - task.t[0])
    coarsest = KNOT_STEP * 2 ** (GRIDS - 1)
    count = max(FEWEST_INTERVALS, int(np.ceil(duration / coarsest - 1e-9)))
    grid = SplineGrid(float(task.t[0]), duration / count, count)
    control = _first_guess(task, grid, requested)
    for halving in range(GRIDS):
        if halving:
            grid, control = grid.refined(control)
        control = _in_turns(task, grid, control, requested)
    return ExecutableSpline(grid, control)


def _in_turns(task: _Task, grid: SplineGrid, control: Floats, requested: Floats) -> Floats:
    """Return the control points at which arm and gimbals suit each other."""
    at_points = _requested_at(task.t, requested, Windows(grid, SEAT_VARIABLES).times())
    direction = Direction(requested_directions(at_points).T)
    arm, gimbals = _holding("fork", "cab"), _holding("arm")
    before = np.zeros((3, len(at_points)))
    for _ in range(TURNS):
        found = fit_g(grid, control, task.forms, direction, task.limits, gimbals)
        if np.max(np.abs(found.force - before)) < G_TOLERANCE:
            break
        before = found.force
        magnitude = _magnitude_along(found.force, (at_points * PILOT).T, task.machine.gravity)
        control = fit_g(grid, found.control, task.forms, magnitude, task.limits, arm).control
    return found.control


def _magnitude_along(force: Floats, requested: Floats, gravity: float) -> Magnitude:
    """Return what the arm is to make of forces (3, points) beside the requested ones [g].

    Of a force whose direction is given, the length nearest to the requested force is that
    of the latter's projection: the requested magnitude where the direction is as requested,
    less where the gimbals cannot reach it. Less than gravity [m/s^2] is made by no arm, and
    to ask for it would only make the search wander.
    """
    length = np.maximum(np.linalg.norm(force, axis=0), NO_G)
    along = np.sum(force * requested, axis=0) / length
    return Magnitude(np.maximum(along, gravity / STANDARD_GRAVITY_M_S2))


def _first_guess(task: _Task, grid: SplineGrid, requested: Floats) -> Floats:
    """Return control points inside the limits, arm first, then the direction of its force."""
    t = grid.knots
    at_knots = _requested_at(task.t, requested, t)
    steady = steady_joints(task.machine, task.chain, at_knots)
    rate = _slewed(steady.arm_rate, grid.step, task.limits[0].acceleration)
    arm = fit_executable(
        grid, _through(task, t, rate, steady.gimbal), task.limits, _holding()
    ).control
    rate, acceleration = (grid.values(arm, t, order)[:, 0] for order in (1, 2))
    gravity = task.machine.gravity
    force = force_of_arm(task.chain, gravity, steady.gimbal, rate, acceleration)
    gimbal = gimbal_angles(task.chain, force, requested_directions(at_knots))
    return fit_executable(grid, _through(task, t, rate, gimbal), task.limits, _holding()).control


def _slewed(rate: Floats, step: float, acceleration: float) -> Floats:
    """Return the largest rates below given ones that change no faster than a limit.

    So the arm is early on the way down and late on the way up: never faster than commanded.
    """
    most = acceleration * step * np.arange(len(rate))
    slower = np.minimum.accumulate(rate - most) + most
    return np.asarray((np.minimum.accumulate((slower + most)[::-1])[::-1]) - most)


def _through(task: _Task, t: Floats, arm_rate: Floats, gimbal: Floats) -> Motion:
    """Return the motion with an arm rate and gimbal angles at times."""
    turned = np.cumsum(0.5 * np.diff(t) * (arm_rate[:-1] + arm_rate[1:]))
    arm = task.profile.initial_angle[0] + np.concatenate([[0.0], turned])
    rate = np.column_stack([arm_rate, np.gradient(gimbal, t, axis=0)])
    return Motion(t, np.column_stack([arm, gimbal]), rate[:-1], rate[1:])


def _requested_at(t: Floats, sides: Floats, times: Floats) -> Floats:
    """Return values that are linear over each interval at any times, (q, 3)."""
    k = np.clip(np.searchsorted(t, times, side="right") - 1, 0, len(t) - 2)
    u = ((times - t[k]) / (t[k + 1] - t[k]))[:, None]
    return np.asarray((1.0 - u) * sides[k, 0] + u * sides[k, 1])


def _with_rates(t: Floats, command: GCommand) -> Floats:
    """Return the requested G along the axes that the rates beside it turn, (n - 1, 2, 3) [g]."""
    if command.rates is None:
        return command.sides
    commanded = np.stack([command.rates.start, command.rates.end], axis=1)
    rotation = washed_rotation(np.diff(t), commanded, command.washout)
    force = command.sides * PILOT
    sides = (seen_turned(rotation[:-1], force[:, 0]), seen_turned(rotation[1:], force[:, 1]))
    return np.asarray(np.stack(sides, axis=1) * PILOT)


def _eased(machine: Machine) -> tuple[JointLimits, ...]:
    """Return limits from whose inside a reduction can start."""
    return tuple(
        replace(
            limit,
            angle=limit.angle * (1.0 - CLEAR),
            rate=limit.rate * (1.0 - CLEAR),
            acceleration=limit.acceleration * (1.0 - CLEAR),
            jerk=limit.jerk * (1.0 - CLEAR),
        )
        for limit in machine.limits
    )


def _holding(*joints: Joint) -> Ends:
    """Return ends that keep the arm's angle at the start, with some joints held."""
    no = np.zeros(3, dtype=bool)
    held = np.array([joint in joints for joint in JOINTS])
    return Ends(np.array([True, False, False]), no, no, no, held)
