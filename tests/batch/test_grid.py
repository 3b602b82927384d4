"""A grid is every combination of its values, each a job with a name of its own."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from des_cli.batch.grid import Axis, grid_jobs, point_names, spelled
from des_cli.batch.job import Job, Output
from des_cli.batch.source import Source, load_source
from des_cli.profiles_in.schema import check_name

SECONDS = Axis("time.step_s", (0.25, 0.5))
WEIGHTS = Axis("reduction.r2", (1, 2.5))


def test_each_profile_takes_every_combination_and_the_last_axis_varies_fastest() -> None:
    jobs = grid_jobs([Job(Source("cobra")), Job(Source("cobra_felt"))], [SECONDS, WEIGHTS])
    assert [job.source.name for job in jobs] == ["cobra"] * 4 + ["cobra_felt"] * 4
    profiles = [load_source(job.source) for job in jobs[:4]]
    assert [profile.name for profile in profiles] == [
        "cobra__step_s_0.25__r2_1",
        "cobra__step_s_0.25__r2_2.5",
        "cobra__step_s_0.5__r2_1",
        "cobra__step_s_0.5__r2_2.5",
    ]
    assert [profile.t[1] for profile in profiles] == [0.25, 0.25, 0.5, 0.5]
    assert [profile.reduction.r2[0] for profile in profiles] == [1, 2.5, 1, 2.5]
    assert len({profile.sha256 for profile in profiles}) == 4


def test_no_axis_leaves_the_jobs_as_they_are() -> None:
    job = Job(Source("cobra"), Output("x", out_is_parent=False))
    assert grid_jobs([job], []) == [job]
    assert grid_jobs([job], [WEIGHTS])[0].output.out_is_parent


def test_a_machine_comes_before_what_is_changed_of_it() -> None:
    axes = [Axis("machine.limits.fork.jerk_rad_s3", (3,)), Axis("machine", ("des",))]
    (job,) = grid_jobs([Job(Source("cobra"))], axes)
    assert load_source(job.source).machine.limits[1].jerk == 3


def test_keys_of_one_name_are_told_apart_by_their_paths() -> None:
    axes = [Axis("joints.arm_rpm[0].to_s", (1,)), Axis("joints.arm_rpm[1].to_s", (2,))]
    (job,) = grid_jobs([Job(Source("cobra"))], axes)
    assert str(job.source.settings[-1]) == (
        'name="cobra__joints.arm_rpm_0_.to_s_1__joints.arm_rpm_1_.to_s_2"'
    )


def test_a_profile_that_cannot_be_read_stays_in_every_point(tmp_path: Path) -> None:
    jobs = grid_jobs([Job(Source(str(tmp_path / "none.yaml")))], [WEIGHTS])
    assert [str(job.source.settings[-1]) for job in jobs] == ["reduction.r2=1", "reduction.r2=2.5"]


def test_names_that_would_be_cut_or_the_same_end_in_a_digest() -> None:
    long = "x" * 90
    names = point_names(long, ["k_" + "y" * 30 + end for end in "ab"], ["a", "b"])
    assert len(set(names)) == 2
    assert all(name.startswith(long) and len(name) == 100 for name in names)
    # whatever else is in the grid
    both = point_names("p", ["k_a_b", "k_a_b", "k_c"], ["k=a/b", "k=a b", "k=c"])
    other = point_names("p", ["k_c", "k_a_b", "k_a_b"], ["k=c", "k=a b", "k=a/b"])
    assert sorted(both) == sorted(other)
    assert len(set(both)) == 3


VALUES = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False),
    st.integers(),
    st.booleans(),
    st.text(max_size=150),
    st.lists(st.integers(), min_size=1, max_size=4),
)


@given(own=st.sampled_from(["cobra", "ä" * 90, "a b(1)"]), values=st.lists(VALUES, min_size=1))
def test_every_name_is_one_that_a_profile_may_have(own: str, values: list[object]) -> None:
    exact = [repr(value) for value in values]
    names = point_names(own, [f"key_{spelled(value)}" for value in values], exact)
    for name in names:
        assert check_name(name) == name
    assert len(set(names)) == len(set(exact))


@pytest.mark.parametrize(
    ("value", "text"), [("../x", "_x"), ("-", "_"), ("", "_"), (1e-5, "1e-05")]
)
def test_a_value_leads_nowhere(value: object, text: str) -> None:
    assert spelled(value) == text
