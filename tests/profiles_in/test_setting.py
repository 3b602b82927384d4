"""Values that options give: what their text means, and what counts of them in a digest."""

from __future__ import annotations

from typing import Any

import pytest

from des_cli.profiles_in.overrides import apply_settings
from des_cli.profiles_in.setting import AnySetting, Setting, value_of_option
from des_cli.profiles_in.yaml_nodes import parse_yaml


@pytest.mark.parametrize(
    ("text", "value"),
    [
        (" 3 ", 3),
        ("0x10", 16),
        ("-.5", -0.5),
        ("0, 2 ,0", [0, 2, 0]),
        (" [0,2,0]", [0, 2, 0]),
        ("fork,cab", ["fork", "cab"]),
        ("unlimited", "unlimited"),
        ("no", "no"),
        ("'5'", "5"),
    ],
)
def test_a_text_is_the_number_list_or_text_that_it_means(text: str, value: Any) -> None:
    found = value_of_option(text)
    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize("text", ["", "[1, 2", "1,]", "[1],[2]", "a: b: c", "!!str 5", "*a"])
def test_what_means_nothing_stays_the_text_that_it_is(text: str) -> None:
    assert value_of_option(text) == text


def test_a_setting_counts_by_its_key_and_value_however_it_was_said() -> None:
    by_option = Setting("reduction.r1", [0, 0.001, 0], "--r1 0,1e-3,0")
    assert str(by_option) == "reduction.r1=[0, 0.001, 0]"
    assert str(by_option) == str(Setting("reduction.r1", [0, 1e-3, 0], "--preset calm"))
    assert str(Setting("name", "Überschlag", "--name Überschlag")) == 'name="Überschlag"'
    # Text and number of the same look are two settings.
    assert str(Setting("name", "5", "")) != str(Setting("name", 5, ""))


@pytest.mark.parametrize("value", [0.1, 3, "sea: t", "5", "é", [1, [2.5, "a"]], {"from_s": 2}])
def test_the_text_of_a_setting_sets_the_same_value(value: Any) -> None:
    setting = Setting("reduction.r1", value, "--r1")
    either: tuple[AnySetting, ...] = (setting, str(setting))
    for given in either:
        root = parse_yaml("name: x\n", "x")
        assert apply_settings(root, [given]) == []
        assert root.plain()["reduction"]["r1"] == value
