"""``--set``: paths, values, and what is said about those that lead nowhere."""

from __future__ import annotations

import pytest

from des_cli.errors import ProfileError
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.overrides import apply_settings
from des_cli.profiles_in.yaml_nodes import parse_yaml

TEXT = """\
seat: {yaw_deg: 90}
initial: {arm_rad: 1}
joints:
  arm_rpm:
    - {from_s: 0, to_s: 5, value: 1}
    - {from_s: 5, to_s: 10, value: 2}
machine: des
samples:
"""


def changed(*settings: str) -> dict:  # type: ignore[type-arg]
    root = parse_yaml(TEXT, "x")
    assert apply_settings(root, settings) == []
    return root.plain()  # type: ignore[no-any-return]


def problems_of(*settings: str) -> list[str]:
    return [str(problem) for problem in apply_settings(parse_yaml(TEXT, "x"), settings)]


def test_values_are_yaml() -> None:
    found = changed("reduction.r2=0.2", "reduction.r1=[0, 2, 0]", "reduction.axes=seat", "name='5'")
    assert found["reduction"] == {"r2": 0.2, "r1": [0, 2, 0], "axes": "seat"}
    assert found["name"] == "5"


def test_a_budget_and_weights_replace_each_other() -> None:
    weights = ("reduction.r2=0.2", "reduction.tracking=3")
    budget = "reduction.budget={seat_g_rms_error_g: 1e-1}"
    assert changed(*weights, budget)["reduction"] == {"budget": {"seat_g_rms_error_g": 0.1}}
    assert changed(budget, *weights)["reduction"] == {"r2": 0.2, "tracking": 3}


def test_a_budget_joins_those_on_other_metrics() -> None:
    one = "reduction.budget.seat_g_rms_error_g=0.1"
    other = "reduction.budget.seat_rate_deviation_relative=0.2"
    both = {"seat_g_rms_error_g": 0.1, "seat_rate_deviation_relative": 0.2}
    assert changed(one, other)["reduction"] == {"budget": both}
    assert changed(one, other, f"{one}5")["reduction"]["budget"]["seat_g_rms_error_g"] == 0.15
    assert changed("reduction.r2=1", one)["reduction"] == {"budget": {"seat_g_rms_error_g": 0.1}}
    bare = {"joint_deviation_relative": 0.05, "seat_g_rms_error_g": 0.1}
    assert changed("reduction.budget=0.05", one)["reduction"] == {"budget": bare}


def test_a_setting_changes_the_built_in_machine_that_the_profile_names() -> None:
    setting = "machine.limits.fork.jerk_rad_s3=3"
    assert changed(setting)["machine"] == {"base": "des", "limits": {"fork": {"jerk_rad_s3": 3}}}
    named = changed("machine=johnsville", setting, "machine.occupant.gy_g=[-1, 1]")["machine"]
    assert (named["base"], named["occupant"]) == ("johnsville", {"gy_g": [-1, 1]})
    machine = load_profile("rolling_spin", settings=[setting]).machine
    assert [limit.jerk for limit in machine.limits] == [1.26, 3.0, 10.0]
    with pytest.raises(ProfileError, match=r"a file: change it in own.yaml"):
        load_profile("rolling_spin", settings=["machine=own.yaml", setting])


def test_a_limit_replaces_the_word_that_lifts_it_and_the_other_way_round() -> None:
    base, fork = "machine={base: des, limits: {fork: {}}}", "machine.limits.fork"
    number, word = f"{fork}.jerk_rad_s3=3", f"{fork}.jerk=unlimited"
    assert changed(base, number, word)["machine"]["limits"]["fork"] == {"jerk": "unlimited"}
    assert changed(base, word, number)["machine"]["limits"]["fork"] == {"jerk_rad_s3": 3}
    machine = load_profile("rolling_spin", settings=[base, number, "machine.occupant.gy_g=[-1, 1]"])
    assert machine.machine.limits[1].jerk == 3.0
    assert machine.machine.occupant.gy == (-1.0, 1.0)


def test_lists_are_indexed_and_other_members_stay() -> None:
    found = changed("joints.arm_rpm[1].to_s=4", "joints.arm_rpm[0]={value: 7}")
    assert found["joints"]["arm_rpm"] == [{"value": 7}, {"from_s": 5, "to_s": 4, "value": 2}]


def test_another_unit_replaces_and_does_not_repeat() -> None:
    assert changed("initial.arm_deg=3")["initial"] == {"arm_deg": 3}
    assert changed("joints.arm_rad_s=3")["joints"] == {"arm_rad_s": 3}
    assert changed("seat.pitch_deg=3")["seat"] == {"yaw_deg": 90, "pitch_deg": 3}


def test_other_commands_replace_those_of_the_profile() -> None:
    found = changed("body_rates={p_rpm: 1}")
    assert found["body_rates"] == {"p_rpm": 1}
    assert "joints" not in found
    assert "samples" not in found


def test_an_empty_section_is_filled() -> None:
    assert changed("samples.file=x.csv")["samples"] == {"file": "x.csv"}


def test_the_last_setting_wins() -> None:
    assert changed("name=a", "name=b")["name"] == "b"


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("reduction.r2", "must be path=value"),
        ("=3", "is not a path"),
        ("a..b=3", "is not a path"),
        ("a[x]=3", "is not a path"),
        ("a[-1]=3", "is not a path"),
        ("name=", "has no value"),
        ("name=[1", ": the value is not valid YAML"),
        ("name=!!str 3", ": in the value the tag"),
        ("name=&a 1", ": in the value the anchor &a is not accepted; write the value out"),
        ("joints.arm_rpm[2].to_s=3", "joints.arm_rpm has 2 items, counted from 0"),
        ("joints.arm_rpm.to_s=3", "joints.arm_rpm is a list: say which item, [0], so it has no"),
        ("initial.arm_rad.x=3", "initial.arm_rad is a single value (1), so it has no x"),
        ("seat[0]=3", "seat is not a list"),
        ("seat.\x1b[1m=3", "is not a path"),
    ],
)
def test_a_setting_that_leads_nowhere_is_refused(setting: str, words: str) -> None:
    (line,) = problems_of(setting)
    assert line.startswith("--set ")
    assert words in line
    assert line.isprintable()


@pytest.mark.parametrize("path", ["a" + ".a" * 1000, "a" + ".a" * 50_000, "a" + "[1]" * 30])
def test_a_path_deeper_than_any_key_is_refused(path: str) -> None:
    with pytest.raises(ProfileError, match="is a path of more than 20 levels"):
        load_profile("cobra", settings=[f"{path}=1"])


def test_unknown_keys_and_bad_values_name_the_setting_as_their_place() -> None:
    with pytest.raises(ProfileError) as caught:
        load_profile("cobra", settings=["redction.r2=1", "reduction.r2=-1", "joints.arm_rpm[7]=2"])
    assert sorted(str(problem) for problem in caught.value.complaints) == [
        "--set joints.arm_rpm[7]=2: joints.arm_rpm has 2 items, counted from 0",
        "--set redction.r2=1: redction: is not a key here (did you mean reduction?)",
        "--set reduction.r2=-1: reduction.r2: must be greater than 0, is -1",
    ]
