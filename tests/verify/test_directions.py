"""Test directions are motions of a table, and keep clear of what holds the solution."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machine import JointLimits, OccupantBounds
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion
from des_cli.verify.directions import FEWEST, SHORTEST, Direction, coarseness, find_directions
from des_cli.verify.occupant import largest_onsets
from tests.reduction.conftest import make_cobra, make_wave
from tests.support.claims import claim_of

WAVE = make_wave(
    [[0.6, 0.1, 0.05], [0.0, 0.3, -0.1], [0.1, -0.2, 0.15]], intervals=240, duration=8.0
)


@pytest.mark.parametrize("ends", ["free", "match-start", "match-rates", "match-both"])
@pytest.mark.parametrize("starts", [(), ("fork_start",)])
def test_directions_keep_the_ends_and_integrate(ends, starts):
    t = WAVE.t
    directions = find_directions(claim_of(WAVE, ends=ends, limits="warn", optimise=starts))
    assert {d.joint for d in directions} == {0, 1, 2}
    for d in directions:
        time = t[d.first : d.first + len(d.rate)]
        assert len(time) > FEWEST
        assert np.ptp(time) >= 0.99 * SHORTEST
        rise = np.cumsum(0.5 * np.diff(time) * (d.rate[:-1] + d.rate[1:]))
        np.testing.assert_allclose(d.angle - d.angle[0], [0.0, *rise], atol=1e-15)
        begins, stops = time[0] == t[0], time[-1] == t[-1]
        starts_free = begins and starts and d.joint == 1
        assert abs(d.angle[0]) < 1e-12 or starts_free
        assert abs(d.angle[-1]) < 1e-12 or (stops and ends != "match-both")
        assert abs(d.rate[0]) < 1e-12 or (begins and ends == "free")
        assert abs(d.rate[-1]) < 1e-12 or (stops and ends in ("free", "match-start"))
    moved = [
        (any(abs(d.rate[0]) > 0.1 for d in directions), ends == "free"),
        (any(abs(d.angle[0]) > 0.1 for d in directions), bool(starts)),
        (any(abs(d.rate[-1]) > 0.1 for d in directions), ends in ("free", "match-start")),
        (any(abs(d.angle[-1]) > 0.1 for d in directions), ends != "match-both"),
    ]
    assert [found for found, _ in moved] == [expected for _, expected in moved]


def test_directions_keep_clear_of_a_limit_and_of_held_joints():
    peak = float(np.max(np.abs(WAVE.acceleration[:, 1])))
    fork = replace(DES.limits[1], acceleration=peak, jerk=np.inf)
    machine = replace(DES, limits=(DES.limits[0], fork, DES.limits[2]))
    claim = claim_of(WAVE, machine=machine, hold=frozenset({"arm"}), limits="enforce")
    directions = find_directions(claim)
    assert {d.joint for d in directions} == {1, 2}
    tight = np.abs(WAVE.acceleration[:, 1]) > 0.99 * peak
    assert tight.any()
    for d in directions:
        if d.joint == 1:
            assert not tight[d.first : d.first + len(d.rate) - 1].any()


def test_directions_per_joint_keep_clear_of_standstill():
    motion = make_cobra(250)
    directions = find_directions(claim_of(motion, control="per-joint", limits="warn"))
    for d in directions:
        rate = motion.rate[d.first : d.first + len(d.rate), d.joint]
        assert np.all(np.sign(rate) == np.sign(rate[0]))
        assert np.all(np.abs(rate) > 1e-9)


FINE, COARSE = np.linspace(0.0, 8.0, 1601), np.linspace(0.0, 8.0, 161)
SHAPES = {
    "bump": lambda x: x**3 * (1.0 - x) ** 3,
    "leave": lambda x: x * (1.0 - x) ** 3,
    "arrive": lambda x: x**3,
    "rise": lambda x: x**3 * (10.0 - 15.0 * x + 6.0 * x**2),
    "fall": lambda x: 1.0 - x**3 * (10.0 - 15.0 * x + 6.0 * x**2),
}


def motion_of(t, rates):
    """Rates at samples as they are given, and angles by their integral."""
    rise = np.cumsum(0.5 * np.diff(t)[:, None] * (rates[:-1] + rates[1:]), axis=0)
    return Motion(t, np.vstack([np.zeros(3), rise]), rates[:-1], rates[1:])


def only(joint, t, rate):
    """One joint at rates, the others at rest."""
    rates = np.zeros((len(t), 3))
    rates[:, joint] = rate
    return motion_of(t, rates)


def machine_with(joint, **limits):
    """A machine with no limit but those of one joint."""
    endless = JointLimits(angle=np.inf, rate=np.inf, acceleration=np.inf, jerk=np.inf)
    found = [endless] * 3
    found[joint] = replace(endless, **limits)
    return replace(DES, limits=tuple(found), occupant=OccupantBounds())


def shape_of(t, direction):
    """The closed form that an angle is, to what the trapezoidal rule leaves."""
    time = t[direction.first : direction.first + len(direction.rate)]
    x = (time - time[0]) / (time[-1] - time[0])
    (found,) = (
        name
        for name, form in SHAPES.items()
        if np.allclose(
            direction.angle / np.max(np.abs(direction.angle)),
            form(x) / np.max(np.abs(form(x))),
            atol=2e-2,
        )
    )
    return found


def windows_of(t, claim):
    """Joint, shape, begin and end in seconds, of each direction."""
    return [
        (d.joint, shape_of(t, d), float(t[d.first]), float(t[d.first + len(d.rate) - 1]))
        for d in find_directions(claim)
    ]


def stretch(free, t):
    """First and last time of the one stretch that is free and long enough for a window."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], free.astype(int), [0]])))
    runs = [(first, last - 1) for first, last in zip(edges[::2], edges[1::2], strict=True)]
    ((first, last),) = [run for run in runs if t[run[1]] - t[run[0]] > SHORTEST]
    return t[first], t[last]


def guarded(t, tight):
    """What is farther than the guard from every sample that is tight, pair by pair."""
    guard = max(0.04, 2.0 * np.max(np.diff(t)))
    return ~np.any(np.abs(t[:, None] - t[None, tight]) <= guard * (1 + 1e-12), axis=1)


def reached(claim, joint):
    """First and last time of a joint's bumps."""
    t = claim.modified.t
    found = [w for w in windows_of(t, claim) if w[0] == joint and w[1] == "bump"]
    return min(w[2] for w in found), max(w[3] for w in found)


def test_a_motion_that_nothing_holds_has_these_directions():
    t = FINE
    options = {"limits": "warn", "hold": frozenset({"arm", "cab"}), "optimise": ("fork_start",)}
    claim = claim_of(only(1, t, np.sin(t)), ends="free", **options)
    found = windows_of(t, claim)
    assert all(joint == 1 for joint, *_ in found)
    long, short = [0.0, 6.4 / 3, 12.8 / 3, 6.4], np.linspace(0.0, 8.0 * 11 / 12, 4)
    bumps = [(at, at + 1.6) for at in long] + [(at, at + 8.0 / 12.0) for at in short]
    rest = [("leave", 0.0, 1.6), ("fall", 0.0, 1.6), ("arrive", 6.4, 8.0), ("rise", 6.4, 8.0)]
    expected = sorted([("bump", *each) for each in bumps] + rest)
    found = sorted((shape, begin, end) for _, shape, begin, end in found)
    assert [shape for shape, *_ in found] == [shape for shape, *_ in expected]
    np.testing.assert_allclose([w[1:] for w in found], [w[1:] for w in expected], atol=0.0051)
    for d in find_directions(claim):
        assert np.max(np.abs(d.rate)) == pytest.approx(1.0, abs=1e-15)
        assert d.most == 256
    for ends, shapes in (
        ("match-start", {"bump", "fall", "arrive", "rise"}),
        ("match-rates", {"bump", "fall", "rise"}),
        ("match-both", {"bump", "fall"}),
    ):
        found = windows_of(t, claim_of(claim.modified, ends=ends, **options))
        assert {shape for _, shape, *_ in found} == shapes


def test_on_uneven_steps_a_bump_still_ends_where_it_began():
    rng = np.random.default_rng(8)
    t = np.concatenate([[0.0], np.cumsum(rng.uniform(0.005, 0.08, 200))])
    directions = find_directions(claim_of(only(1, t, np.sin(t)), ends="free", limits="warn"))
    bumps = [d for d in directions if abs(d.angle[-1]) < 1e-3]
    assert len(bumps) >= 24
    for d in bumps:
        assert abs(d.angle[-1]) < 1e-15


def fork_within_rate(t, rate):
    """The fork alone moves, and is free where its rate is below its limit of 1 rad/s."""
    return claim_of(
        motion_of(t, np.outer(rate, [0.0, 1.0, 0.0])),
        machine=machine_with(1, rate=1.0),
        limits="enforce",
        ends="match-both",
        hold=frozenset({"arm", "cab"}),
    )


@pytest.mark.parametrize(
    ("free", "long", "short"),
    # of 12 s: lengths of a fifth and a twelfth, 2.4 s and 1 s
    [(0.9, 1, 1), (1.2, 1, 1), (1.5, 1, 2), (2.2, 1, 3), (3.1, 1, 4), (3.5, 2, 4), (5.2, 3, 4)],
)
def test_a_stretch_has_windows_by_its_length(free, long, short):
    t = np.linspace(0.0, 12.0, 1201)
    rate = np.where(t < free + 0.05, 0.5, 1.0)
    found = windows_of(t, fork_within_rate(t, rate))
    lengths = np.array([end - begin for *_, begin, end in found])
    assert len(found) == long + short
    for of, count, share in ((lengths[:long], long, 2.4), (lengths[long:], short, 1.0)):
        np.testing.assert_allclose(of, free if count == 1 else share, atol=0.0201)
    assert min(w[2] for w in found[long:]) == 0.0
    assert max(w[3] for w in found[long:]) == pytest.approx(free, abs=0.0101)


@pytest.mark.parametrize(("count", "step", "some"), [(14, 0.024, True), (13, 0.024, False)])
def test_a_window_has_at_least_fourteen_intervals(count, step, some):
    t = step * np.arange(count + 1)
    found = find_directions(claim_of(only(1, t, 0 * t + 1.0), limits="warn", ends="match-both"))
    assert bool(found) == some


@pytest.mark.parametrize(("span", "some"), [(0.3, True), (0.298, True), (0.296, False)])
def test_a_window_is_not_shorter_than_a_bump_must_be(span, some):
    t = np.linspace(0.0, span, 100)
    found = find_directions(claim_of(only(1, t, 0 * t + 1.0), limits="warn", ends="match-both"))
    assert bool(found) == some


def test_the_longest_windows_are_taken():
    """Of two stretches the first has 0.6 s, the other all that four windows need."""
    t = FINE
    rate = np.where((t >= 0.65) & (t <= 1.0), 1.0, 0.5)
    found = windows_of(t, fork_within_rate(t, rate))
    assert len(found) == 8
    assert min(w[2] for w in found) == pytest.approx(1.045, abs=1e-9)


@pytest.mark.parametrize("t", [FINE, COARSE])
@pytest.mark.parametrize("back", [False, True])
@pytest.mark.parametrize("quantity", ["angle", "rate", "acceleration", "jerk"])
def test_a_limit_holds_what_is_within_a_hundredth_of_it_and_beside(quantity, back, t):
    """Rates of t^4: all that they make grows, so that a limit holds from one sample on."""
    x = (8.0 - t if back else t) / 8.0
    motion = only(1, t, x**4)
    if back:  # the angle falls to nothing
        motion = replace(motion, angle=motion.angle - motion.angle[-1])
    h = float(t[1] - t[0])
    # At each sample the largest beside it: a constant slope over an interval is that of its
    # middle to h^2, a second difference that of the sample.
    later = np.abs(motion.rate[:, 1])
    slope = np.abs(np.diff(later)) / h
    curve = np.zeros_like(t)
    curve[1:-1] = np.abs(np.diff(slope)) / h
    values = {
        "angle": np.abs(motion.angle[:, 1]),
        "rate": later,
        "acceleration": np.maximum(np.append(slope, 0.0), np.insert(slope, 0, 0.0)),
        "jerk": curve,
    }[quantity]
    bound = float(np.interp(6.0, t, values if not back else values[::-1]))
    options = {"ends": "match-both", "machine": machine_with(1, **{quantity: bound})}
    claim = claim_of(motion, limits="enforce", **options)
    free = guarded(t, values >= 0.99 * bound)
    assert np.any(~free)
    assert reached(claim, 1) == pytest.approx(stretch(free, t), abs=1e-9)
    assert reached(claim, 2) == (0.0, 8.0)
    assert reached(claim_of(motion, limits="warn", **options), 1) == (0.0, 8.0)


@pytest.mark.parametrize(("step", "near"), [(0.005, 0.01), (0.02, 0.04), (0.05, 0.25), (0.08, 0.3)])
def test_a_bound_for_the_occupant_holds_farther_off_on_coarse_steps(step, near):
    """The arm alone: some L2 w^2 / g sideways, for a rate w that grows."""
    t = np.arange(0.0, 8.0 + 0.5 * step, step)
    motion = only(0, t, 0.3 * t)
    g = claim_of(motion).after.g[1]
    side, sideways = np.sign(g[-1]), np.abs(np.append(g[: len(t) - 1], g[-1]))
    pull = DES.lengths["L2"] * motion.rate[:, 0] ** 2 / 9.80665
    np.testing.assert_allclose(sideways, pull, atol=1e-3)
    bound = 3.0
    low, high = (-np.inf, bound) if side > 0 else (-bound, np.inf)
    machine = replace(machine_with(0), occupant=OccupantBounds(gy=(low, high)))
    claim = claim_of(motion, machine=machine, limits="enforce", ends="match-both")
    free = guarded(t, sideways >= (1.0 - near) * bound)
    for joint in range(3):
        assert reached(claim, joint) == pytest.approx(stretch(free, t), abs=1e-9)
    assert reached(replace(claim, profile=claim_of(motion).profile), 0)[1] > 7.9


@pytest.mark.parametrize("back", [False, True])
def test_an_interval_in_which_g_is_steep_holds_both_its_samples(back):
    """A ripple of the arm's rate as long as the onset's window: G is back after each."""
    t = FINE
    rate = 2.0 + 0.02 * np.clip((t - 5.0) / 3.0, 0.0, 1.0) * np.sin(20.0 * np.pi * t)
    motion = only(0, t, rate[::-1] if back else rate)
    felt = claim_of(motion).after
    ground = np.concatenate([felt.g[:, : len(t) - 1], felt.g[:, -1:]], axis=1)
    slope = np.max(np.abs(np.diff(ground, axis=1)), axis=0) / 0.005
    peaks = slope[1:-1][(slope[1:-1] > slope[2:]) & (slope[1:-1] > slope[:-2])]
    # a bound that a peak all but reaches
    bound = float(np.min(peaks[peaks > 2.0])) / 0.995
    assert np.max(largest_onsets(motion, felt)) < 0.5 * bound
    machine = replace(machine_with(0), occupant=OccupantBounds(g_onset=bound))
    claim = claim_of(motion, machine=machine, limits="enforce", ends="match-both")
    tight = np.zeros(len(t), dtype=bool)
    steep = (slope - bound) / bound >= -0.01
    tight[:-1] |= steep
    tight[1:] |= steep
    assert tight.any()
    free = guarded(t, tight)
    assert reached(claim, 1) == pytest.approx(stretch(free, t), abs=1e-9)


@pytest.mark.parametrize("back", [False, True])
def test_a_budget_on_a_peak_holds_what_is_within_a_hundredth_of_it(back):
    """The cab alone is off, by 2 degrees a second: so is the attitude."""
    t = FINE
    requested = only(2, t, 0 * t)
    off = np.radians(2.0) * (8.0 - t if back else t)
    motion = replace(requested, angle=np.outer(off, [0.0, 0.0, 1.0]))
    budget = (Budget("attitude_error_max_deg", 12.0),)
    claim = claim_of(motion, requested=requested, budget=budget, limits="warn", ends="match-both")
    free = guarded(t, np.degrees(off) >= 0.99 * 12.0)
    assert reached(claim, 0) == pytest.approx(stretch(free, t), abs=1e-9)
    looser = (Budget("joint_deviation_relative", 0.01),)
    other = claim_of(motion, requested=requested, budget=looser, limits="warn", ends="match-both")
    assert reached(other, 0) == (0.0, 8.0)


@pytest.mark.parametrize("turn", [7.75, 7.7525])
def test_a_factor_means_nothing_where_its_joint_stands_or_turns(turn):
    """The fork stands for a second, to a millionth of its largest rate, and turns later."""
    t = FINE
    rate = np.where(t < 1.0, -0.9e-6 * 10.0, 10.0 * np.sign(turn - t))
    desired = motion_of(t, np.stack([0 * t + 1.0, rate, 0 * t + 1.0], axis=1))
    claim = claim_of(desired, control="per-joint", limits="warn", ends="match-both")
    beside = (np.abs(t - turn) < 0.0051) if turn == 7.75 else (np.abs(t - turn) < 0.0026)
    free = guarded(t, (t <= 1.0) | beside)
    found = [w for w in windows_of(t, claim) if w[0] == 1]
    assert min(w[2] for w in found) == pytest.approx(stretch(free, t)[0], abs=1e-9)
    assert max(w[3] for w in found) == pytest.approx(stretch(free, t)[1], abs=1e-9)
    assert reached(claim, 0) == (0.0, 8.0)
    assert reached(claim_of(desired, limits="warn", ends="match-both"), 1) == (0.0, 8.0)


def test_a_rough_record_is_evaluated_at_all_of_a_window():
    t = np.linspace(0.0, 8.0, 4001)
    rng = np.random.default_rng(2)
    rough = only(1, t, np.sin(t) + 0.5 * rng.normal(size=len(t)))
    claim = claim_of(rough, limits="warn", control="free")
    assert claim.rough
    for d in find_directions(claim):
        np.testing.assert_array_equal(d.sampled, np.arange(len(d.rate) - 1))
    smooth = find_directions(claim_of(only(1, t, np.sin(t)), limits="warn"))
    assert max(len(d.rate) - 1 for d in smooth) > 256
    assert max(len(d.sampled) for d in smooth) <= 256


@pytest.mark.parametrize(
    ("intervals", "most", "sampled"),
    [(4, 2, [0, 2]), (5, 2, [0, 3]), (5, 5, [0, 1, 2, 3, 4]), (3, 9, [0, 1, 2]), (7, 3, [0, 3, 6])],
)
def test_of_a_long_window_every_so_many_intervals_are_evaluated(intervals, most, sampled):
    values = np.zeros(intervals + 1)
    np.testing.assert_array_equal(Direction(0, 3, values, values, most).sampled, sampled)


@pytest.mark.parametrize(("steps", "value"), [([0.004, 0.008], 1.0), ([0.01, 0.03], 4.0)])
def test_coarseness_is_by_the_mean_step(steps, value):
    t = np.concatenate([[0.0], np.cumsum(steps)])
    assert coarseness(claim_of(only(1, t, 0 * t))) == pytest.approx(value, rel=1e-12)
