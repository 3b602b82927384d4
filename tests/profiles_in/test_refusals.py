"""Every refusal of a profile, in words and with its place."""

from __future__ import annotations

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from des_cli.errors import FileAccessError, ProfileError
from tests.support.profiles import SMALL, load, problems_of


@pytest.mark.parametrize(
    ("old", "new", "place", "words"),
    [
        ("format: des-coriolis/1\n", "", "1:1: format", "is missing"),
        ("coriolis/1", "coriolis/9", "1:9: format", "must be des-coriolis/1"),
        ("name: small", "nam: small", "2:1: nam", "did you mean name?"),
        ("name: small", "name: a/b", "2:7: name", "a folder is named after it"),
        ("name: small", "name: ..", "2:7: name", "a folder is named after it"),
        ("name: small", "name: 5", "2:7: name", "must be text, is 5"),
        ("stop_s: 2", "stop: 2", "3:20: time.stop", "needs its unit in the key: stop_s"),
        ("stop_s: 2", "stop_s: 0", "3:28: time.stop_s", "must be greater than start_s (0)"),
        ("stop_s: 2", "stop_s: yes", "3:28: time.stop_s", "must be a number, is 'yes'"),
        ("stop_s: 2", "stop_s: true", "3:28: time.stop_s", "must be a number, is True"),
        ("stop_s: 2", "stop_s: '2'", "3:28: time.stop_s", "must be a number, is '2'"),
        ("stop_s: 2", "stop_s: .nan", "3:28: time.stop_s", "must be a finite number"),
        ("stop_s: 2", "stop_s: null", "3:28: time.stop_s", "must be a number"),
        ("step_s: 0.5", "step_s: 0", "3:39: time.step_s", "must be greater than 0"),
        ("step_s: 0.5", "step_s: 1e-9", "3:39: time.step_s", "more than 1000000 samples"),
        ("step_s: 0.5", "step_s: 1, step_ms: 2", "3:7: time", "is given twice"),
        ("time: {start_s: 0, stop_s: 2, step_s: 0.5}\n", "", "1:1", "time is missing"),
        ("fork_deg", "fork", "6:3: joints.fork", "fork_rad or fork_deg"),
        ("fork_deg", "fork_rpm", "6:3: joints.fork_rpm", "fork_rad or fork_deg"),
        ("fork_deg", "frok_deg", "6:3: joints.frok_deg", "did you mean fork_deg?"),
        ("  cab_deg: 5\n", "", "5:3: joints", "the cab's angle is missing"),
        ('"10*t"', "2^t", "6:13: joints.fork_deg", "a power is written **"),
        ('"10*t"', "[]", "6:13: joints.fork_deg", "at least one segment"),
        ('"10*t"', "true", "6:13: joints.fork_deg", "must be a number, an expression in t"),
        ('"10*t"', "1/(t-1)", "6:13: joints.fork_deg", "no finite value at t = 1 s"),
        ('"10*t"', "sign(t-1)", "6:13: joints.fork_deg", "jumps at t = 1 s from -1 to 1 deg"),
        ('"10*t"', "[{from_s: 0, to_s: 2}]", "6:14: joints.fork_deg[0].value", "is missing"),
        ("cab_deg: 5", "cab_deg: 5\nbody_rates: {p_rpm: 0, q_rpm: 0, r_rpm: 0}", "8:1: body_rates",
         "stands beside joints"),
        ("name: small", "initial: {cab_deg: 3}", "2:11: initial.cab_deg", "leave this out"),
        ("name: small", "reduction: {r1: [1, 2]}", "2:17: reduction.r1", "at least 3 items"),
        ("name: small", "reduction: {r1: [[1, 2, 0], [0, 1, 0], [0, 0, 1]]}",
         "2:17: reduction.r1", "must be symmetric: [0][1] is 2, [1][0] is 0"),
        ("name: small", "reduction: {r1: [[1, 2, 0], [2, 1, 0], [0, 0, 1]]}",
         "2:17: reduction.r1", "must be positive semidefinite"),
        ("name: small", "reduction: {r1: [1, -1, 0]}", "2:21: reduction.r1[1]", "at least 0"),
        ("name: small", "reduction: {r2: 0}", "2:17: reduction.r2", "must be greater than 0"),
        ("name: small", "reduction: {r2: [1, 2]}", "2:17: reduction.r2", "at least 3 items"),
        ("name: small", "reduction: {tracking: -1}", "2:23: reduction.tracking", "at least 0"),
        ("name: small", "reduction: {budget: 0}", "2:21: reduction.budget", "at least 1e-09"),
        ("name: small", "reduction: {budget: 1e-308}", "2:21: reduction.budget", "at least 1e-09"),
        ("name: small", "seat: {yaw_deg: 1e308}", "2:17: seat.yaw_deg", "at most 1e+06"),
        ("name: small", "initial: {arm_deg: -1e308}", "2:20: initial.arm_deg", "at least -1e+06"),
        ("name: small", "reduction: {budget: {g: 1}}", "2:22: reduction.budget.g", "must be joint"),
        ("name: small", "reduction: {budget: {}}", "2:21: reduction.budget", "at least 1 items"),
        ("name: small", "reduction: {budget: [1]}", "2:21: reduction.budget", "or metrics with"),
        ("name: small", "reduction: {budget: {seat_g_rms_error_g: 1, joint_deviation_relative: 1}}",
         "2:71: reduction.budget.joint_deviation_relative", "must be below 1"),
        ("name: small", "reduction: {budget: 1}", "2:21: reduction.budget", "must be below 1"),
        ("name: small", "reduction: {objective: feel}", "2:24: reduction.objective",
         "must be coriolis, blend or felt"),
        ("name: small", "reduction: {optimise: [seat_roll]}", "2:24: reduction.optimise[0]",
         "must be seat_yaw, seat_pitch, fork_start or cab_start"),
        ("name: small", "reduction: {optimise: [seat_yaw, seat_yaw]}",
         "2:34: reduction.optimise[1]", "names seat_yaw twice"),
        ("name: small", "reduction: {ends: match-end}", "2:19: reduction.ends",
         "must be free, match-start, match-rates or match-both"),
        ("name: small", "reduction: {lead_in: 2}", "2:13: reduction.lead_in", "needs its unit"),
        ("name: small", "reduction: {lead_in_s: 2, lead_in_ms: 2}", "2:12: reduction",
         "is given twice"),
        ("name: small", "reduction: {lead_out_s: -2}", "2:25: reduction.lead_out_s", "at least 0"),
        ("name: small", "reduction: {budget: 1, r2: 1, tracking: 1}", "2:21: reduction.budget",
         "stands instead of r2 and tracking"),
        ("name: small", "reduction: {tolerance: 0}", "2:24: reduction.tolerance", "greater than 0"),
        ("name: small", "reduction: {iterations: 1.5}", "2:25: reduction.iterations", "whole"),
        ("name: small", "reduction: {hold: [leg]}", "2:20: reduction.hold[0]", "arm, fork or cab"),
        ("name: small", "reduction: {method: minimun}", "2:21: reduction.method",
         "did you mean minimum?"),
        ("name: small", "reduction: 3", "2:12: reduction", "must be a mapping"),
        ("name: small", "machine: dse", "2:10: machine", "did you mean des?"),
        ("name: small", "machine: 3", "2:10: machine", "a machine's name"),
    ],
)  # fmt: skip
def test_a_mistake_is_named_where_it_stands(old: str, new: str, place: str, words: str) -> None:
    assert old in SMALL
    lines = problems_of(SMALL.replace(old, new))
    assert any(f"<stdin>:{place}: " in line and words in line for line in lines), lines
    assert all(line.isprintable() for line in lines)


@pytest.mark.parametrize(
    ("second", "place", "words"),
    [
        ("{from_s: 1, to_s: 1, value: 3}", "[1].to_s", "must be greater than from_s (1)"),
        ("{from_s: 1.5, to_s: 2, value: 3}", "[1].from_s", "leaves a gap"),
        ("{from_s: 0.5, to_s: 2, value: 3}", "[1].from_s", "leaves an overlap"),
        ("{from_s: 1, to_s: 1.5, value: 3}", "[1]", "leaves the time to 2 s uncovered"),
        ("{from_s: 1, to_s: 2, value: 4}", "[1].value", "jumps at t = 1 s from 3 to 4 deg"),
        ("{from_s: 1, to_s: 2, valeu: 3}", "[1].valeu", "did you mean value?"),
        ("{from: 1, to_s: 2, value: 3}", "[1].from", "needs its unit in the key: from_s"),
        ("{to_s: 2, value: 3}", "[1]", "the start of a segment is missing"),
        ("7", "[1]", "must be a mapping"),
    ],
)
def test_segments_must_join(second: str, place: str, words: str) -> None:
    segments = f"\n    - {{from_s: 0, to_s: 1, value: 3}}\n    - {second}\n"
    lines = problems_of(SMALL.replace('"10*t"', segments))
    assert len(lines) in (1, 2)
    assert any(f": joints.fork_deg{place}: " in line and words in line for line in lines), lines


def test_all_mistakes_come_at_once_in_the_order_of_the_file() -> None:
    text = """\
format: des-coriolis/1
nmae: x
machine: {base: dse}
initial: {fork_deg: 1}
time: {start_s: 0, stop_s: 2, step_s: 0.5}
joints: {arm_rpm: 1, fork_deg: "2 +", cab_deg: "log(t)"}
reduction: {r2: -1, r1: [[1, 2, 0], [0, 1, 0], [0, 0, 1]]}
"""
    lines = problems_of(text)
    assert [line.split(":")[1] for line in lines] == ["2", "3", "6", "6", "7"]
    # What the schema refuses hides nothing that can be checked without it.
    lines = problems_of(text.replace('"2 +"', "2").replace("-1", "1"))
    assert [line.split(":")[1] for line in lines] == ["2", "3", "6", "7"]
    assert "symmetric" in lines[-1]


@pytest.mark.parametrize(
    ("commands", "wrong"),
    [
        (
            'joints: {arm: 1, fork_deg: "1/(t - 1)", cab_deg: [{from_s: 0, to_s: 1, value: 2}]}',
            ["joints.arm", "joints.fork_deg", "joints.cab_deg[0]"],
        ),
        (
            'body_rates: {p_deg_s: "sqrt(-1)", q: 1, r_deg_s: [{from_s: 1, to_s: 2, value: 1}]}',
            ["body_rates.p_deg_s", "body_rates.q", "body_rates.r_deg_s[0]"],
        ),
        (
            "joints: {arm_rpm: 1, fork_deg: [{from_s: 0, to_s: 1, value: 1}], cab_deg: log(t)}",
            ["joints.fork_deg[0]", "joints.cab_deg"],
        ),
    ],
)
def test_a_wrong_command_hides_no_other(commands: str, wrong: list[str]) -> None:
    text = f"format: des-coriolis/1\ntime: {{start_s: 0, stop_s: 2, step_s: 0.5}}\n{commands}\n"
    assert [line.split(": ")[1] for line in problems_of(text)] == wrong


def test_a_flood_of_mistakes_is_counted() -> None:
    lines = problems_of(SMALL + "".join(f"key{k}: 1\n" for k in range(500)))
    assert len(lines) == 51
    assert lines[-1] == "… and 450 more problems"


@pytest.mark.parametrize("text", ["- 1\n- 2\n", "{}", "{a: 1}", "[]", "--- 5", "a: &a [*a]"])
def test_yaml_that_is_no_profile_is_refused(text: str) -> None:
    assert problems_of(text)


SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(10**20), 10**20),
    st.floats(),
    st.sampled_from(["t", "1/t", "des", "..", "a/b", "*", "\x1b[0m", "é", "{", "2^t", "9**9**9"]),
)
KEYS = st.sampled_from(
    [
        "format",
        "name",
        "machine",
        "seat",
        "initial",
        "time",
        "joints",
        "body_rates",
        "samples",
        "reduction",
        "arm_rpm",
        "fork_deg",
        "cab_deg",
        "cab",
        "start_s",
        "stop_s",
        "step_s",
        "from_s",
        "to_s",
        "value",
        "p_deg_s",
        "file",
        "columns",
        "base",
        "rows",
        "limits",
        "r1",
        "r2",
        "yaw_deg",
        "lengths_ft",
    ]
)
TREES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(KEYS, inner, max_size=4)),
    max_leaves=8,
)


@settings(max_examples=200)
@given(st.dictionaries(KEYS, TREES, max_size=4))
def test_any_tree_of_values_is_a_profile_or_refused(tree: dict[str, object]) -> None:
    overrides = [f"{key}={json.dumps(value)}" for key, value in tree.items()]
    lines = ["read"]
    try:
        load(SMALL, *overrides)
    except (ProfileError, FileAccessError) as error:
        lines = [str(problem) for problem in error.complaints]
    assert lines
    assert all(line.isprintable() for line in lines)
