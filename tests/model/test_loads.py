"""What drives a joint, by its name, beside the limit of the same."""

from typing import get_args

from des_cli.model.loads import Driven, JointLoad, Loads
from des_cli.model.machine import JOINTS

LOAD = JointLoad(
    rate_peak_rad_s=1.0,
    rate_limit_rad_s=2.0,
    acceleration_peak_rad_s2=3.0,
    acceleration_limit_rad_s2=4.0,
    jerk_peak_rad_s3=5.0,
)


def test_peak_and_limit_are_those_of_what_is_driven() -> None:
    assert [LOAD.peak(driven) for driven in get_args(Driven)] == [1.0, 3.0, 5.0]
    assert [LOAD.limit(driven) for driven in get_args(Driven)] == [2.0, 4.0, None]


def test_of_a_joint_that_was_not_measured_nothing_is_known() -> None:
    loads = Loads()
    for by_joint in (loads.desired, loads.modified):
        assert tuple(by_joint) == JOINTS
        assert {load.peak("rate") for load in by_joint.values()} == {None}
        assert {load.ok for load in by_joint.values()} == {None}
