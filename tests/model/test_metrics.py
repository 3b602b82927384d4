"""The typed metrics and the file that is made of them."""

import json

from des_cli.model.felt import Felt, TurningSizes
from des_cli.model.machine import JOINTS
from des_cli.model.metric import JOINT_DEVIATION, SEAT_G_ERROR
from des_cli.model.metrics import (
    Added,
    BaselineFacts,
    Change,
    ConstantBaseline,
    CrossCoupling,
    Executable,
    Fidelity,
    Metrics,
    Part,
    Singularity,
)


def test_the_sections_of_the_file_stand_in_their_order() -> None:
    mapping = Metrics().mapping()
    assert list(mapping) == [
        *("profile", "solver", "parameters", "asked_g", "coriolis", "fidelity", "added"),
        *("felt", "changes", "executable", "baseline", "limits", "singularity"),
        *("violations", "notices", "notice_names"),
    ]
    assert json.loads(json.dumps(mapping)) == mapping
    mapping["notices"].append("mine")
    assert Metrics().mapping()["notices"] == []


def test_keys_of_inner_sections_stand_where_the_contract_has_them() -> None:
    metrics = Metrics(
        coriolis=CrossCoupling({"bb3": Part(0.689, TurningSizes(rms_after_rad_s2=0.2))}),
        fidelity=Fidelity({SEAT_G_ERROR: 0.04}),
        executable=Executable(True, False, Change(0.1, metrics={SEAT_G_ERROR: 0.01})),
        baseline=BaselineFacts(constant_p=ConstantBaseline(0.8, 0.2)),
    )
    mapping = metrics.mapping()
    assert mapping["coriolis"]["bb3"]["reduction"] == 0.689
    assert mapping["coriolis"]["bb3"]["rms_after_rad_s2"] == 0.2
    assert mapping["coriolis"]["objective"] == {"reduction": None}
    assert mapping["fidelity"][SEAT_G_ERROR] == 0.04
    assert mapping["executable"]["joint_change_relative"] == 0.1
    assert mapping["executable"][SEAT_G_ERROR] == 0.01
    assert mapping["baseline"]["constant_p"] == {"p": 0.8, JOINT_DEVIATION: 0.2}
    assert metrics.coriolis.reduction("bb3") == 0.689
    assert metrics.executable.change.value(SEAT_G_ERROR) == 0.01


def test_a_recorded_attitude_has_a_key_only_where_there_is_one() -> None:
    key = "recorded_attitude_error_max_deg"
    assert key not in Metrics().mapping()["singularity"]
    assert Metrics(singularity=Singularity(**{key: 0.5})).mapping()["singularity"][key] == 0.5


def test_the_offset_of_an_end_has_angles_and_rates_by_joint() -> None:
    start = {f"{joint}_rad": 0.1 * i for i, joint in enumerate(JOINTS)}
    start |= {f"{joint}_rad_s": 1.0 + i for i, joint in enumerate(JOINTS)}
    fidelity = Fidelity(start_error=start, end_error_rad={"arm": 7.0}, end_error_rad_s={"arm": 8.0})
    assert fidelity.offset("start").angle == {"arm": 0.0, "fork": 0.1, "cab": 0.2}
    assert fidelity.offset("start").rate == {"arm": 1.0, "fork": 2.0, "cab": 3.0}
    assert fidelity.offset("end") == ({"arm": 7.0}, {"arm": 8.0})
    assert set(Fidelity().offset("start").rate.values()) == {None}


def test_the_ride_is_what_the_reduction_adds_where_that_is_measured() -> None:
    felt, added = Felt(), Felt()
    assert Metrics(felt=felt).ride is felt
    assert Metrics(felt=felt, added=Added(felt=added)).ride is added
