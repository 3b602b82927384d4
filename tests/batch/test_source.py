"""Where a profile comes from: read once or in parts, and never two of one name."""

import numpy as np
import pytest

from des_cli.batch.source import (
    Source,
    load_source,
    load_source_variants,
    require_distinct_names,
    split_source,
)
from des_cli.errors import DesError, UsageError
from des_cli.model.profile import Profile
from tests.support.profiles import SMALL

COBRA = Source("cobra", settings=("time.step_s=0.25",))

# Two stretches of a record with four seconds between them.
LOG = "t_s,p_rad_s,q_rad_s,r_rad_s\n" + "".join(
    f"{t:g},0,0,0.05\n" for t in (0, 0.1, 0.2, 0.3, 4.3, 4.4, 4.5)
)


def log(gap: str) -> Source:
    return Source("-", (f"gap={gap}",), stdin=LOG.encode())


def test_a_profile_is_read_as_its_source_says() -> None:
    profile = load_source(Source("-", ("time.step_s=0.25",), stdin=SMALL.encode()))
    assert profile.name == "small"
    np.testing.assert_array_equal(profile.t, np.arange(9) / 4)
    table = "time;arm_rpm;fork_deg;cab_deg\n0;30,5;0;0\n0,5;30,5;2;0\n1;30,5;3;0\n"
    source = Source("-", columns={"t_s": "time"}, separator=";", decimal=",", stdin=table.encode())
    np.testing.assert_array_equal(load_source(source).t, [0.0, 0.5, 1.0])


def test_each_stretch_of_a_record_that_is_split_is_a_source_of_its_own() -> None:
    parts = split_source(log("split"))
    assert [part.part for part in parts] == [1, 2]
    loaded = [load_source(part).t for part in parts]
    assert [len(t) for t in loaded] == [4, 3]
    assert [t[-1] - t[0] for t in loaded] == pytest.approx([0.3, 0.2])


@pytest.mark.parametrize("source", [log("bridge"), log("refuse"), Source("nowhere.yaml"), COBRA])
def test_whatever_is_not_split_stays_as_it_is(source: Source) -> None:
    assert split_source(source) == [source]


def test_variants_are_profiles_or_what_is_wrong_with_them() -> None:
    finer, wrong = load_source_variants(COBRA, [("reduction.r2=4",), ("reduction.r2=-4",)])
    assert isinstance(finer, Profile)
    assert finer.reduction.r2.tolist() == [4.0] * 3
    assert len(finer.t) == 41
    assert isinstance(wrong, DesError)


def test_names_that_occur_twice_are_refused_together() -> None:
    with pytest.raises(UsageError) as caught:
        require_distinct_names([Source("cobra"), Source("nowhere.yaml"), COBRA])
    assert [problem.where for problem in caught.value.complaints] == ["cobra"]
    require_distinct_names([Source("cobra"), Source("nowhere.yaml")])
