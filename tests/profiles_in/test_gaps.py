"""Gaps of a record: found, named, and refused, bridged or split."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from des_cli.errors import ProfileError
from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.gaps import find_gaps
from des_cli.model.profile import BodyRates, Profile
from des_cli.profiles_in.load import count_parts, load_profile

RATES = "t_s,p_rad_s,q_rad_s,r_rad_s\n"
GAP = RATES + "0,0,0,0\n0.01,0,0,0\n0.02,0,0,0.02\n5.02,0,0,0.02\n5.03,0,0,0\n5.04,0,0,0\n"


def record(times: list[float]) -> str:
    return RATES + "".join(f"{t!r},0,0,{0.01 * (row % 3)}\n" for row, t in enumerate(times))


def load(text: str, *settings: str, part: int | None = None) -> Profile:
    return load_profile("-", stdin=text.encode(), settings=settings, part=part)


def problems_of(text: str, *settings: str) -> list[str]:
    with pytest.raises(ProfileError) as caught:
        load(text, *settings)
    return [str(problem) for problem in caught.value.complaints]


def test_a_gap_is_a_step_that_is_long_among_the_others() -> None:
    assert find_gaps(np.array([0.0, 0.1, 0.2, 1.1, 1.2, 2.3, 2.4])) == [4]
    # In a fast record a step below a tenth of a second loses nothing.
    assert find_gaps(np.array([0.0, 0.001, 0.002, 0.1, 0.101, 0.202])) == [4]
    assert find_gaps(np.array([0.0, 10.0, 20.0, 30.0])) == []


def test_a_long_gap_is_refused_in_one_sentence_with_line_and_times() -> None:
    (line,) = problems_of(GAP)
    assert line.startswith("<stdin>:5: a gap of 5 s, from t = 0.02 to 5.02 s, where 0.01 s")
    assert "--gap bridge" in line
    assert "split" in line


def test_a_bridged_gap_turns_no_further_than_its_ends_say() -> None:
    profile = load(GAP, "gap=bridge")
    assert [remark[:40] for remark in profile.remarks] == [
        "line 5: a gap of 5 s, from t = 0.02 to 5"
    ]
    assert abs(make_desired(profile).motion.angle[-1, 0]) == pytest.approx(0.1002, abs=1e-12)


def test_a_short_gap_is_bridged_and_named_unless_it_is_refused() -> None:
    text = record([0.0, 0.01, 0.02, 0.03, 0.33, 0.34, 0.35])
    assert "line 6: a gap of 0.3 s, from t = 0.03 to 0.33 s" in load(text).remarks[0]
    assert problems_of(text, "gap=refuse")[0].startswith("<stdin>:6: a gap of 0.3 s")


def test_many_gaps_are_counted() -> None:
    times = [10.0 * (row // 3) + 0.01 * (row % 3) for row in range(99)]
    lines = problems_of(record(times))
    assert len(lines) == 21
    assert lines[-1] == "<stdin>: … and 12 more steps like these"


def test_split_makes_a_profile_of_each_stretch() -> None:
    assert count_parts("-", settings=["gap=split"], stdin=GAP.encode()) == 2
    first, second = (load(GAP, "gap=split", part=part) for part in (1, 2))
    assert (first.name, second.name) == ("stdin-1", "stdin-2")
    assert first.t.tolist() == [0.0, 0.01, 0.02]
    assert second.t.tolist() == [5.02, 5.03, 5.04]
    assert isinstance(second.command, BodyRates)
    assert second.command.start[:, 2].tolist() == [0.02, 0.0]
    assert first.sha256 != second.sha256
    assert second.remarks[0] == "part 2 of 2 between gaps: lines 5 to 7, t = 5.02 to 5.04 s"


def test_a_later_stretch_tells_from_where_it_starts() -> None:
    settings = ("gap=split", "initial={fork_deg: 10, cab_deg: 55}")
    first, second = (load(GAP, *settings, part=part) for part in (1, 2))
    assert not any("starts from" in remark for remark in first.remarks)
    assert second.remarks[1].startswith(
        "part 2 starts from the profile's initial angles, arm 0, fork 10, cab 55 deg, as every part"
    )
    assert "--trim 5.02:5.04 (or trim) with initial angles of its own" in second.remarks[1]
    alone = load(GAP, "trim={from_s: 5.02, to_s: 5.04}", "initial.cab_deg=40")
    np.testing.assert_array_equal(alone.t, second.t)
    # Positions tell it by themselves.
    table = GAP.replace("p_rad_s,q_rad_s,r_rad_s", "arm_rad_s,fork_rad,cab_rad")
    assert len(load(table, "gap=split", part=2).remarks) == 1


def test_one_profile_of_a_split_record_has_to_be_chosen() -> None:
    assert "gaps split it into 2 motions" in problems_of(GAP, "gap=split")[0]


def test_a_row_alone_between_gaps_is_left_out_with_a_remark() -> None:
    text = record([0.0, 0.01, 0.02, 5.0, 10.0, 10.01])
    assert count_parts("-", settings=["gap=split"], stdin=text.encode()) == 2
    assert load(text, "gap=split", part=1).remarks[1] == (
        "line 5: the row at t = 5 s stands alone between gaps and was left out"
    )
    assert load(text, "gap=split", part=2).t.tolist() == [10.0, 10.01]


def test_a_record_without_gaps_is_one_part_under_its_name() -> None:
    text = record([0.0, 0.1, 0.2])
    assert count_parts("-", settings=["gap=split"], stdin=text.encode()) == 1
    profile = load(text, "gap=split")
    assert (profile.name, profile.remarks) == ("stdin", ())
    assert count_parts("-", stdin=b"t_s,this is not read\n") == 1


def test_the_key_stands_in_a_profile_with_samples_alone(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text(GAP)
    path = tmp_path / "p.yaml"
    path.write_text("format: des-coriolis/1\nsamples: {file: log.csv}\ngap: split\n")
    assert count_parts(path) == 2
    assert load_profile(path, part=2).name == "p-2"
    path.write_text(
        "format: des-coriolis/1\ntime: {start_s: 0, stop_s: 1, step_s: 0.1}\ngap: bridge\n"
        "joints: {arm_rpm: 1, fork_deg: 0, cab_deg: 0}\n"
    )
    with pytest.raises(ProfileError, match="gap: is for samples; the commands below joints say"):
        load_profile(path)


def test_a_step_of_next_to_nothing_is_refused_by_its_line_and_length() -> None:
    text = RATES + "0,0,0,0\n0.02,0,1,1\n0.04,1,1,2\n0.040000001,2,1,3\n0.06,2,1,3\n"
    (line,) = problems_of(text)
    assert line.startswith("<stdin>:5: follows the row before it within 1e-09 s, from t = 0.04 to")
    assert "remove one of the two rows" in line
    # A recorder's jitter is none.
    assert len(load(record([0.0, 0.02, 0.04, 0.0401, 0.06])).t) == 5
