"""The registry of options agrees with what it stands for."""

import json
from typing import Any, get_args

import click
import pytest

from des_cli.batch.job import TableFormat
from des_cli.cli.options import _REDUCTION, TABLE_FORMATS, plain_setting, reduction_settings
from des_cli.cli.reduce import reduce
from des_cli.model import profile
from des_cli.profiles_in.setting import Setting
from des_cli.runs_out import tables


def test_table_formats_are_those_that_can_be_written() -> None:
    assert TABLE_FORMATS == tables.TABLE_FORMATS == get_args(TableFormat)


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("method", profile.Method),
        ("algorithm", profile.Algorithm),
        ("control", profile.Control),
        ("axes", profile.Axes),
        ("jacobian", profile.JacobianAt),
        ("limits", profile.LimitsPolicy),
        ("objective", profile.Objective),
        ("ends", profile.Ends),
        ("optimise", profile.FreeParameter),
    ],
)
def test_choices_are_those_of_the_model(key: str, words: object) -> None:
    option = next(p for p in reduce.params if p.name == key)
    assert isinstance(option.type, click.Choice)
    assert tuple(option.type.choices) == get_args(words)


def test_every_option_of_reduction_is_a_field_of_the_model() -> None:
    fields = set(profile.Reduction.__dataclass_fields__)
    assert {key for key, _, _ in _REDUCTION} <= fields


def settings_of(values: dict[str, Any]) -> list[tuple[str, Any]]:
    return [(setting.path, setting.value) for setting in reduction_settings(values)]


def test_reduction_options_become_typed_settings_in_order() -> None:
    values = {"r2": "1", "method": "zero", "r1": "0, 2, 0", "axes": None, "iterations": 3}
    assert reduction_settings(values) == (
        Setting("reduction.method", "zero", "--method zero"),
        Setting("reduction.r1", [0, 2, 0], "--r1 0, 2, 0"),
        Setting("reduction.r2", 1, "--r2 1"),
        Setting("reduction.iterations", 3, "--iterations 3"),
        # without limits the zero method jumps
        Setting("reduction.limits", "enforce", "--method zero"),
    )


def test_a_budget_becomes_a_setting_inside_the_limits() -> None:
    assert settings_of({"budget": ("0.05",)}) == [
        ("reduction.budget", {"joint_deviation_relative": 0.05}),
        ("reduction.limits", "enforce"),
    ]
    both = ("seat_g_rms_error_g = 0.1", "seat_rate_deviation_relative=10%")
    assert settings_of({"budget": both, "limits": "warn"}) == [
        ("reduction.limits", "warn"),
        ("reduction.budget", {"seat_g_rms_error_g": 0.1, "seat_rate_deviation_relative": 0.1}),
    ]
    assert reduction_settings({"budget": (), "optimise": ()}) == ()


@pytest.mark.parametrize(
    ("budgets", "words"),
    [
        (("5%", "joint_deviation_relative=0.1"), "twice for joint_deviation_relative"),
        (
            ("seat_g_rms_error_g=5%",),
            "seat_g_rms_error_g=5% is .* no share: give it in g",
        ),
        (("attitude_error_max_deg=5 %",), "give it in deg"),
    ],
)
def test_a_metric_twice_and_a_percentage_of_what_is_no_share(
    budgets: tuple[str, ...], words: str
) -> None:
    with pytest.raises(click.UsageError, match=words):
        reduction_settings({"budget": budgets})


def test_free_parameters_and_leads_become_settings() -> None:
    values = {"optimise": ("seat_yaw", "cab_start"), "lead_in": "1.5", "lead_out": "2"}
    assert settings_of(values) == [
        ("reduction.optimise", ["seat_yaw", "cab_start"]),
        ("reduction.lead_in_s", 1.5),
        ("reduction.lead_out_s", 2),
    ]


def test_options_of_free_joints_are_understood(invoke, small: str) -> None:
    options = (
        "--control free --budget 5% --budget seat_g_rms_error_g=0.1 --objective blend "
        "--optimise seat_yaw --optimise fork_start --ends match-rates --lead-in 1.5 --lead-out 2"
    )
    result = invoke("validate", small, "--format", "json", *options.split())
    facts = json.loads(result.stdout)
    assert facts["budget"] == {"joint_deviation_relative": 0.05, "seat_g_rms_error_g": 0.1}
    assert (facts["control"], facts["objective"], facts["ends"]) == ("free", "blend", "match-rates")
    assert facts["optimise"] == ["seat_yaw", "fork_start"]
    assert (facts["lead_in_s"], facts["lead_out_s"]) == (1.5, 2.0)


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ("--budget half", 3, "joint_deviation_relative: must be a number, is 'half'"),
        ("--budget half%", 3, "must be a number, is 'half%'"),
        ("--budget 100%", 3, "must be below 1"),
        ("--budget seat_g=1", 3, "seat_g"),
        ("--lead-in -1", 3, "reduction.lead_in_s: must be at least 0"),
        ("--lead-in soon", 3, "must be a number"),
        ("--optimise seat_roll", 2, "seat_roll"),
        ("--budget 5% --r2 1", 2, "instead of --r2"),
    ],
)
def test_what_is_no_value(invoke, small: str, options: str, code: int, words: str) -> None:
    result = invoke("validate", small, *options.split())
    assert (result.exit_code, result.stdout) == (code, "")
    assert words in result.stderr


@pytest.mark.parametrize("weights", [{"r2": "1"}, {"tracking": "1"}])
def test_a_budget_beside_weights_is_wrong_use(weights: dict[str, str]) -> None:
    with pytest.raises(click.UsageError, match=f"instead of --{next(iter(weights))}"):
        reduction_settings({"budget": ("0.05",), **weights})


def test_a_matrix_is_written_in_brackets() -> None:
    matrix = "[[2, 0, 0], [0, 2, 0], [0, 0, 2]]"
    rows = [[2, 0, 0], [0, 2, 0], [0, 0, 2]]
    assert settings_of({"r1": matrix}) == [("reduction.r1", rows)]


@pytest.mark.parametrize(
    ("options", "line"),
    [
        (("--r2", "-1"), "--r2 -1: reduction.r2: must be greater than 0, is -1"),
        (("--r1", "1,2"), "--r1 1,2: reduction.r1: must have at least 3 items, has 2"),
        (("--trim", "2:1"), "--trim 2:1: trim: is for samples"),
        (("--budget", "half"), "--budget half: reduction.budget.joint_deviation_relative: must be"),
    ],
)
def test_a_message_names_the_option_and_not_what_stands_for_it(
    invoke, small: str, options: tuple[str, str], line: str
) -> None:
    result = invoke("validate", small, *options)
    assert result.exit_code == 3
    assert any(each.startswith(line) for each in result.stderr.splitlines()), result.stderr


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ("reduction.budget=5%", "reduction.budget=0.05"),
        ("reduction.budget.seat_rate_deviation_relative = 12.3 %", "=0.123"),
        ("reduction.allow_change=30%", "=0.3"),
        ("reduction.budget=1_0%", "=1_0%"),
        ("reduction.budget=%", "=%"),
        ("reduction.budget=0.05", "=0.05"),
        ("joints.fork_deg=t%", "joints.fork_deg=t%"),
    ],
)
def test_a_share_may_be_set_as_a_percentage(text: str, plain: str) -> None:
    assert plain_setting(text).endswith(plain)


@pytest.mark.parametrize(
    "args",
    [
        ("--set", "reduction.budget.seat_g_rms_error_g=5%"),
        ("--budget", "seat_g_rms_error_g=5%"),
        ("--grid", "budget.seat_g_rms_error_g=5%"),
    ],
)
def test_what_is_no_share_has_no_percentage(invoke, small: str, args: tuple[str, str]) -> None:
    result = invoke("reduce", small, *args)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "seat_g_rms_error_g=5% is a percentage of what is no share" in result.stderr
    assert "give it in g." in result.stderr


def test_a_percentage_is_the_share_that_it_means(invoke, write_profile) -> None:
    name = write_profile("felt", r2="1").name
    said = {}
    for most in ("5%", "0.05"):
        options = ("--set", f"reduction.budget={most}", "--allow-change", "30%")
        result = invoke("validate", name, *options, "--format", "json")
        assert result.exit_code == 0, result.stderr
        said[most] = json.loads(result.stdout)
    assert said["5%"]["budget"] == {"joint_deviation_relative": 0.05}


def test_a_file_says_how_it_wants_a_share(invoke, write_profile) -> None:
    result = invoke("validate", write_profile("felt", r2="1\n  budget: 5%").name)
    assert result.exit_code == 3
    assert "reduction.budget: must be a number, is '5%'; a share of 5 % is written 0.05" in (
        result.stderr
    )
