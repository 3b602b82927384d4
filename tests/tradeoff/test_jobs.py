"""The jobs of a curve: one reading and one desired motion for all of its points."""

from __future__ import annotations

import pickle
from collections import Counter
from collections.abc import Callable

import pytest

from des_cli import pipeline
from des_cli.batch.source import Source
from des_cli.errors import ProfileError, UsageError
from des_cli.model.profile import Profile
from des_cli.profiles_in import variants
from des_cli.tradeoff.jobs import PointJob, PointPlan, load_points, make_jobs, run_point

BUDGET = "reduction.budget.joint_deviation_relative"
PLANS = [
    *(
        PointPlan((f"reduction.control={control}", f"{BUDGET}={most}"), control, BUDGET, most)
        for control in ("scalar", "per-joint")
        for most in (0.02, 0.05)
    ),
    PointPlan(("reduction.r2=1",)),
]
COARSE = ("time.step_s=0.25",)
SMOOTH = Source("flight_log", ("smooth={cutoff_hz: 2}", "resample={step_s: 0.2}"))


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often a profile is read, and how often its desired motion is made."""
    counted: Counter[str] = Counter()

    def count(place: object, name: str) -> None:
        original: Callable[..., object] = getattr(place, name)

        def counting(*args: object, **options: object) -> object:
            counted[name] += 1
            return original(*args, **options)

        monkeypatch.setattr(place, name, counting)

    count(variants, "parse_file")
    count(pipeline, "find_desired")
    return counted


def jobs_of(source: Source, plans: list[PointPlan] = PLANS) -> list[PointJob]:
    return make_jobs(source.name, plans, load_points(source, plans))


def test_a_curve_reads_its_profile_once_and_makes_its_motion_once(calls: Counter[str]) -> None:
    results = [run_point(job) for job in jobs_of(Source("cobra", COARSE))]
    assert [result.failure for result in results] == [None] * len(PLANS)
    assert calls == {"parse_file": 1, "find_desired": 1}


@pytest.mark.slow
def test_a_record_is_smoothed_once(calls: Counter[str]) -> None:
    for job in jobs_of(SMOOTH):
        run_point(job)
    assert calls == {"parse_file": 1, "find_desired": 2}  # as recorded, and smoothed


@pytest.mark.slow
@pytest.mark.parametrize("source", [Source("cobra", COARSE), SMOOTH], ids=lambda s: s.name)
def test_a_point_is_the_same_with_a_motion_of_its_own_and_elsewhere(source: Source) -> None:
    for job in jobs_of(source, PLANS[::2]):  # of each control one, and the one of a weight
        alone = PointJob(job.label, job.plan, job.profile, None)
        found = run_point(job)
        assert found.ok
        assert run_point(pickle.loads(pickle.dumps(job))) == found == run_point(alone)


def test_a_motion_that_cannot_be_made_is_the_failure_of_each_point(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refuse(profile: Profile, **options: object) -> None:
        raise UsageError.of("no such motion")

    monkeypatch.setattr(pipeline, "find_desired", refuse)
    results = [run_point(job) for job in jobs_of(Source("cobra", COARSE))]
    assert [result.failure and result.failure.lines for result in results] == [
        ("no such motion",)
    ] * len(PLANS)
    points = [point for result in results for point in result.points]
    assert [point.status for point in points] == ["failed"] * (len(PLANS) - 1)


def test_all_that_is_wrong_of_the_first_kind_is_told_once() -> None:
    plans = [PointPlan((f"{BUDGET}={most}",), "free", BUDGET, most) for most in (1.5, 2.5)]
    with pytest.raises(ProfileError) as caught:
        load_points(Source("cobra", ("seat.yaw_deg=x",)), plans)
    wheres = [complaint.where for complaint in caught.value.complaints]
    assert len(wheres) == len(set(wheres)) == 3
    odd = PointPlan(("reduction.control=free", "reduction.r2=1"), "free", "r2", 1.0)
    with pytest.raises(UsageError, match="control: free"):
        load_points(Source("cobra"), [odd, *plans])
    assert load_points(Source("cobra"), [PointPlan(odd.settings)])  # as baselines
