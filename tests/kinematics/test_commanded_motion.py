"""The desired motion: joint commands there and back, body rates integrated."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from des_cli.kinematics.attitude import rotation
from des_cli.kinematics.chain import chain_of, joint_axes, seat_rotation
from des_cli.kinematics.commanded_motion import make_desired
from des_cli.kinematics.orientation import damped_inverse_rates
from des_cli.kinematics.response import respond, respond_as_requested
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.profile import BodyRates, JointCommands, Profile
from tests.support.cobra import cobra

RATE_LIMIT = np.array([limit.rate for limit in DES.limits])
RPM = 2.0 * np.pi / 60.0


def body_jacobian(angle):
    """The body-axis Jacobian in closed form at the study's seat, (3, 3)."""
    (_, s2, s3), (_, c2, c3) = np.sin(angle), np.cos(angle)
    return np.array([[-s2, 0.0, -1.0], [-c2 * s3, c3, 0.0], [c2 * c3, s3, 0.0]])


def smooth(t):
    """Angles and rates away from the singularity, all joints moving."""
    angle = [0.7 * t - 0.2 * np.cos(t) + 0.2, 0.6 * np.sin(0.8 * t), 0.4 + 0.5 * np.sin(1.1 * t)]
    rate = [0.7 + 0.2 * np.sin(t), 0.48 * np.cos(0.8 * t), 0.55 * np.cos(1.1 * t)]
    return np.array(angle), np.array(rate)


def demand(motion, t):
    """Body rates of joint expressions, exact at the ends and middle of every interval."""
    inside = 1e-12  # to the side of a joining of segments that the interval is on
    a, b = t[:-1], t[1:]
    sides = []
    for times in (a + inside, 0.5 * (a + b), b - inside):
        rows = [body_jacobian(angle) @ rate for angle, rate in map(motion, times)]
        sides.append(np.array(rows))
    return BodyRates(*sides)


def body_profile(t, rates, initial=(0.0, 0.0, 0.0), seat=None):
    return Profile(
        "p", t, rates, DES, seat=seat or Seat(), initial_angle=np.array(initial, dtype=float)
    )


def joint_profile(t, motion):
    angle = np.array([motion(at)[0] for at in t])
    start = np.array([motion(at + 1e-12)[1] for at in t[:-1]])
    end = np.array([motion(at - 1e-12)[1] for at in t[1:]])
    arm = np.append(start[:, 0], end[-1, 0])
    command = JointCommands(arm, angle[:, 1:], start[:, 1:], end[:, 1:])
    return Profile("p", t, command, DES, initial_angle=angle[0])


class TestJointCommands:
    def test_commands_are_the_motion_through_the_singularity(self):
        t = np.linspace(0.0, 10.0, 1201)  # with both crossings, 10/3 and 20/3 s, on samples
        profile = joint_profile(t, cobra)
        desired = make_desired(profile)
        command, motion = profile.command, desired.motion
        assert desired.least_singular_value < 1e-7
        np.testing.assert_array_equal(motion.rate_start[:, 1:], command.rate_start)
        np.testing.assert_array_equal(motion.rate_end[:, 1:], command.rate_end)
        np.testing.assert_array_equal(motion.rate[:, 0], command.arm_rate)
        np.testing.assert_array_equal(motion.angle[:, 1:], command.position)
        assert not np.signbit(motion.rate_sides[motion.rate_sides == 0.0]).any()
        assert not desired.damped.any()
        assert not desired.residual.any()

    def test_there_and_back_through_the_singularity(self):
        """What the motion makes of the seat's rates gives it back, about itself."""
        t = np.linspace(0.0, 10.0, 1201)
        profile = joint_profile(t, cobra)
        motion = make_desired(profile).motion
        axes = joint_axes(chain_of(DES, profile.seat), motion.angle_sides, "seat")
        jacobian = axes.swapaxes(-1, -2)
        demanded = (jacobian @ motion.rate_sides[..., None])[..., 0]
        rate, damped, residual = damped_inverse_rates(
            jacobian, demanded, reference=motion.rate_sides
        )
        assert damped.any()
        np.testing.assert_array_equal(rate, motion.rate_sides)
        assert not residual.any()

    def test_returned_rates_integrate_to_the_commanded_positions(self):
        t = np.linspace(0.0, 10.0, 1201)
        motion = make_desired(joint_profile(t, cobra)).motion
        # Trapezoids with the ends' accelerations corrected: Hermite, of fourth order.
        fork = np.radians(-60.0) * (np.pi / 5.0) ** 2 * np.cos(np.pi * t / 5.0)
        corrected = 0.5 * motion.step * (motion.rate_start[:, 1] + motion.rate_end[:, 1])
        corrected += motion.step**2 / 12.0 * (fork[:-1] - fork[1:])
        np.testing.assert_allclose(
            np.cumsum(corrected), motion.angle[1:, 1] - motion.angle[0, 1], atol=1e-9
        )
        np.testing.assert_allclose(
            np.cumsum(motion.step * motion.rate_start[:, 2]),
            motion.angle[1:, 2] - motion.angle[0, 2],
            atol=1e-9,
        )

    def test_the_arm_turns_by_the_trapezoids_of_its_velocity(self):
        t = np.cumsum(np.random.default_rng(1).uniform(0.01, 0.2, 50))
        arm = np.random.default_rng(2).normal(size=50)
        command = JointCommands(arm, np.zeros((50, 2)), np.zeros((49, 2)), np.zeros((49, 2)))
        profile = Profile("p", t, command, DES, initial_angle=np.array([0.7, 9.0, 9.0]))
        motion = make_desired(profile).motion
        assert motion.angle[0].tolist() == [0.7, 0.0, 0.0]
        expected = 0.7 + np.array([np.trapezoid(arm[: k + 1], t[: k + 1]) for k in range(50)])
        np.testing.assert_allclose(motion.angle[:, 0], expected, atol=1e-13)
        np.testing.assert_allclose(motion.rate_end[:, 0], arm[1:], atol=1e-12)

    def test_the_cabs_rate_steps_where_segments_join(self):
        t = np.linspace(0.0, 10.0, 101)
        motion = make_desired(joint_profile(t, cobra)).motion
        stepping = np.flatnonzero(np.abs(motion.rate_step[:, 2]) > 1e-6)
        assert t[1 + stepping].tolist() == [5.0]
        assert motion.rate_step[stepping[0], 2] == pytest.approx(2.0 * np.radians(2.5))


class TestBodyRates:
    def test_the_cobras_rates_give_its_joints_back(self):
        t = np.linspace(0.0, 10.0, 1001)

        def shallow(at):
            return cobra(at, reach_deg=25.0)[:2]  # 50 degrees at most: away from the singularity

        start = shallow(0.0)[0]
        desired = make_desired(body_profile(t, demand(shallow, t), start))
        expected = np.array([shallow(at)[0] for at in t])
        np.testing.assert_allclose(desired.motion.angle, expected, rtol=0, atol=1e-8)
        assert not desired.damped.any()
        assert desired.attitude_error < 1e-8

    def test_seat_rates_at_the_samples_are_the_demanded_ones(self):
        t = np.linspace(0.0, 8.0, 161)
        rates = demand(smooth, t)
        profile = body_profile(t, rates, smooth(0.0)[0])
        desired = make_desired(profile)
        flown = respond(DES, Seat(), desired.motion).seat_rate
        assert not desired.damped.any()
        np.testing.assert_allclose(flown[:, 0], rates.start, rtol=0, atol=1e-12)
        np.testing.assert_allclose(flown[:, 1], rates.end, rtol=0, atol=1e-12)
        assert np.abs(desired.residual).max() < 1e-14

    def test_fourth_order(self):
        errors = []
        for intervals in (160, 320, 640):  # fine enough for one step an interval
            t = np.linspace(0.0, 6.0, intervals + 1)
            motion = make_desired(body_profile(t, demand(smooth, t), smooth(0.0)[0])).motion
            expected = np.array([smooth(at)[0] for at in t])
            errors.append(np.abs(motion.angle - expected).max())
        assert errors[-1] < 1e-10
        assert np.log2(np.array(errors[:-1]) / errors[1:]).min() > 3.9

    def test_coarse_samples_are_refined_inside(self):
        # Half a second a sample: one Runge-Kutta step each would be off by 1e-3.
        t = np.linspace(0.0, 6.0, 13)
        motion = make_desired(body_profile(t, demand(smooth, t), smooth(0.0)[0])).motion
        expected = np.array([smooth(at)[0] for at in t])
        recorded = np.searchsorted(motion.t, t)
        np.testing.assert_allclose(motion.angle[recorded], expected, rtol=0, atol=3e-4)

    def test_against_an_integrator_with_another_seat(self):
        seat = Seat(yaw=0.4, pitch=0.3)
        t = np.linspace(0.0, 4.0, 201)

        def rates_at(times):
            times = np.asarray(times)
            rows = [0.3 * np.sin(times), 0.2 * np.cos(2.0 * times), 0.25 + 0.0 * times]
            return np.stack(rows, axis=-1)

        command = BodyRates(rates_at(t[:-1]), rates_at(0.5 * (t[:-1] + t[1:])), rates_at(t[1:]))
        desired = make_desired(body_profile(t, command, (0.1, 0.2, -0.3), seat))
        # What the pilot sees is the attitude, whatever the joints: integrate that.
        flown = seat_rotation(chain_of(DES, seat), desired.motion.angle)

        def derivative(at, flat):
            p, q, r = rates_at(at)
            cross = np.array([[0.0, -r, q], [r, 0.0, -p], [-q, p, 0.0]])
            return (flat.reshape(3, 3) @ cross).ravel()

        found = solve_ivp(
            derivative, (0.0, 4.0), flown[0].ravel(), "DOP853", t_eval=t, rtol=1e-12, atol=1e-13
        )
        np.testing.assert_allclose(flown, found.y.T.reshape(-1, 3, 3), rtol=0, atol=1e-7)

    @pytest.mark.parametrize(
        ("rate", "initial", "expected"),
        [
            # Along the closed-form columns: the fork at cab 0, the cab anywhere, the arm at rest.
            ((0.0, 0.3, 0.0), (0.0, 0.0, 0.0), (0.0, 0.3, 0.0)),
            ((0.25, 0.0, 0.0), (1.0, 0.6, 0.2), (0.0, 0.0, -0.25)),
            ((0.0, 0.0, 0.4), (-0.5, 0.0, 0.0), (0.4, 0.0, 0.0)),
        ],
        ids=["pitch-is-fork", "roll-is-cab", "yaw-is-arm"],
    )
    def test_constant_rates_about_one_joint(self, rate, initial, expected):
        t = np.linspace(0.0, 3.0, 31)
        command = BodyRates(*[np.tile(rate, (30, 1))] * 3)
        motion = make_desired(body_profile(t, command, initial)).motion
        wanted = np.array(initial) + t[:, None] * np.array(expected)
        np.testing.assert_allclose(motion.angle, wanted, rtol=0, atol=1e-12)

    def test_no_rates_no_motion(self):
        t = np.linspace(0.0, 1.0, 11)
        command = BodyRates(*[np.zeros((10, 3))] * 3)
        motion = make_desired(body_profile(t, command, (0.3, np.pi / 2, -0.4))).motion
        np.testing.assert_array_equal(motion.angle, np.tile([0.3, np.pi / 2, -0.4], (11, 1)))
        np.testing.assert_array_equal(motion.rate_sides, 0.0)

    def test_a_demand_through_the_singularity_finishes_and_is_flagged(self):
        # The fork pitches up to and past 90 degrees while the seat asks for a yaw that
        # arm and cab, one axis there, cannot make.
        t = np.linspace(0.0, 2.0, 401)
        command = BodyRates(*[np.tile([0.0, 0.5, 0.1], (400, 1))] * 3)
        desired = make_desired(body_profile(t, command, (0.0, 1.35, 0.0)))
        motion = desired.motion
        for values in (motion.angle, motion.rate_sides, desired.residual):
            assert np.isfinite(values).all()
        assert (np.abs(motion.rate_sides) <= RATE_LIMIT * (1.0 + 1e-12)).all()
        assert desired.least_singular_value < 1e-3
        assert desired.damped.any()
        assert not desired.damped.all()
        size = np.linalg.norm(desired.residual, axis=1)
        assert size[desired.damped].max() > 1e-2
        assert size[~desired.damped].max() < 1e-12
        assert desired.attitude_error > 1e-2
        seat_rate = respond(DES, Seat(), motion).seat_rate
        np.testing.assert_allclose(
            seat_rate[:, 0], command.start - desired_residual(desired)[:, 0], atol=1e-12
        )

    @pytest.mark.slow
    @settings(max_examples=12)
    @given(
        amplitude=st.lists(st.floats(-6.0, 6.0), min_size=6, max_size=6),
        fork=st.floats(-3.2, 3.2),
        cab=st.floats(-3.2, 3.2),
    )
    def test_any_demand_ends_finite_and_inside_the_rate_limits(self, amplitude, fork, cab):
        t = np.linspace(0.0, 2.0, 41)
        mix = np.reshape(amplitude, (2, 3))

        def at(times):
            return np.cos(times)[:, None] * mix[0] + np.sin(3.0 * times)[:, None] * mix[1]

        command = BodyRates(at(t[:-1]), at(0.5 * (t[:-1] + t[1:])), at(t[1:]))
        desired = make_desired(body_profile(t, command, (0.0, fork, cab)))
        motion = desired.motion
        assert np.isfinite(motion.angle).all()
        assert (np.abs(motion.rate_sides) <= RATE_LIMIT * (1.0 + 1e-12)).all()
        chord = np.abs(np.diff(motion.angle, axis=0)) / motion.step[:, None]
        assert (chord <= RATE_LIMIT * (1.0 + 1e-9)).all()
        size = np.linalg.norm(desired.residual, axis=1)
        assert (size[~desired.damped] < 1e-9).all()

    def test_what_is_held_back_is_the_shortfall(self):
        """The arm would turn at 6 rad/s for a second: half of that is more than it can."""
        t = np.linspace(0.0, 4.0, 401)

        def at(times):
            bump = np.where(np.abs(times - 2.0) < 0.5, np.cos(np.pi * (times - 2.0)) ** 2, 0.0)
            return np.outer(6.0 * bump, [0.0, 0.0, 1.0]) + np.array([0.1, 0.05, 0.3])

        command = BodyRates(at(t[:-1]), at(0.5 * (t[:-1] + t[1:])), at(t[1:]))
        profile = body_profile(t, command, (0.1, 0.2, -0.1))
        desired = make_desired(profile)
        assert desired.shortfall is not None
        requested = respond_as_requested(DES, Seat(), desired)
        recorded = np.stack([command.start, command.end], axis=1)
        np.testing.assert_allclose(requested.seat_rate, recorded, atol=1e-12)
        slope = (command.end - command.start) / 0.01
        made = respond(DES, Seat(), desired.motion)
        held = np.any(np.abs(desired.shortfall.seat_rate) > 1e-9, axis=(1, 2))
        assert 20 < held.sum() < 110
        np.testing.assert_allclose(
            requested.seat_angular_acceleration[held],
            np.broadcast_to(slope[held, None], (held.sum(), 2, 3)),
            atol=1e-10,
        )
        np.testing.assert_array_equal(
            requested.seat_angular_acceleration[~held][:, 0],
            made.seat_angular_acceleration[~held][:, 0],
        )
        flown = seat_rotation(chain_of(DES, Seat()), desired.motion.angle)
        solution = solve_ivp(
            lambda s, r: (r.reshape(3, 3) @ skew(at(np.array([s]))[0])).reshape(-1),
            (0.0, 4.0),
            flown[0].reshape(-1),
            t_eval=t,
            rtol=1e-10,
            atol=1e-12,
            max_step=0.01,
        )
        wished = solution.y.T.reshape(-1, 3, 3)
        off = flown @ rotation(desired.shortfall.attitude) - wished
        assert np.abs(off).max() < 2e-6
        quiet = BodyRates(*(0.1 * part for part in (command.start, command.middle, command.end)))
        assert make_desired(body_profile(t, quiet)).shortfall is None

    def test_against_a_recorded_attitude(self):
        t = np.linspace(0.0, 5.0, 101)
        command = demand(smooth, t)
        angle = np.array([smooth(at)[0] for at in t])
        turned = Rotation.from_matrix(seat_rotation(chain_of(DES, Seat()), angle))
        off = Rotation.from_rotvec(np.outer(t / 5.0, [0.0, 0.02, 0.0]))
        recorded = (Rotation.from_rotvec([1.0, 2.0, 0.5]) * turned * off).as_quat()[:, [3, 0, 1, 2]]
        recorded[40:60] = np.nan
        rates = BodyRates(command.start, command.middle, command.end, attitude=recorded)
        found = make_desired(body_profile(t, rates, angle[0]))
        assert found.recorded_attitude_error == pytest.approx(0.02, abs=1e-5)
        bare = make_desired(body_profile(t, command, angle[0]))
        assert bare.recorded_attitude_error is None


def skew(w):
    return np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])


def desired_residual(desired):
    """The residual at both ends of every interval; nothing steps here."""
    return np.stack([desired.residual[:-1], desired.residual[1:]], axis=1)
