"""The registry of options agrees with what it stands for."""

from typing import get_args

import click
import pytest

from des_cli.cli.options import _REDUCTION, TABLE_FORMATS, reduction_settings
from des_cli.cli.reduce import reduce
from des_cli.files import tables
from des_cli.job import TableFormat
from des_cli.model import profile


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
    ],
)
def test_choices_are_those_of_the_model(key: str, words: object) -> None:
    option = next(p for p in reduce.params if p.name == key)
    assert isinstance(option.type, click.Choice)
    assert tuple(option.type.choices) == get_args(words)


def test_every_option_of_reduction_is_a_field_of_the_model() -> None:
    fields = set(profile.Reduction.__dataclass_fields__)
    assert {key for key, _, _ in _REDUCTION} <= fields


def test_reduction_options_become_settings_in_order() -> None:
    values = {"r2": "1", "method": "zero", "r1": "0, 2, 0", "axes": None, "iterations": 3}
    assert reduction_settings(values) == (
        "reduction.method=zero",
        "reduction.r1=[0, 2, 0]",
        "reduction.r2=1",
        "reduction.iterations=3",
        "reduction.limits=enforce",  # without limits the zero method jumps
    )


def test_a_budget_becomes_a_setting_inside_the_limits() -> None:
    assert reduction_settings({"budget": "0.05"}) == (
        "reduction.budget=0.05",
        "reduction.limits=enforce",
    )
    assert reduction_settings({"budget": "seat_g_rms_error_g = 0.1", "limits": "warn"}) == (
        "reduction.limits=warn",
        "reduction.budget={seat_g_rms_error_g: 0.1}",
    )


@pytest.mark.parametrize("weights", [{"r2": "1"}, {"tracking": "1"}])
def test_a_budget_beside_weights_is_wrong_use(weights: dict[str, str]) -> None:
    with pytest.raises(click.UsageError, match=f"instead of --{next(iter(weights))}"):
        reduction_settings({"budget": "0.05", **weights})


def test_a_matrix_in_brackets_stays_as_it_is() -> None:
    matrix = "[[2, 0, 0], [0, 2, 0], [0, 0, 2]]"
    assert reduction_settings({"r1": matrix}) == (f"reduction.r1={matrix}",)
