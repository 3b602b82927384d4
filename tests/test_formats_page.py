"""docs/formats.md names what the tool writes, and nothing that it does not."""

import itertools
import json
import re
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from des_cli.errors import ExitCode
from des_cli.files.expression import FUNCTIONS
from des_cli.files.load import load_profile
from des_cli.files.tables import trajectory_names
from des_cli.model.metric import Budget, MetricKey
from des_cli.model.profile import Reduction
from des_cli.pipeline import reduce_profile
from des_cli.units import UNITS

PAGE = Path(__file__).parents[1] / "docs" / "formats.md"
TEXT = PAGE.read_text(encoding="utf-8")


def section(title: str) -> str:
    match = re.search(rf"^(#+) {re.escape(title)}\n(.*?)(?=^\1 |\Z)", TEXT, re.M | re.S)
    assert match, title
    return match[2]


def named(text: str) -> set[str]:
    return set(re.findall(r"`([^`\n]+)`", text))


def expanded(pattern: str) -> set[str]:
    parts = re.split(r"\{([^}]*)\}", pattern)
    choices = [part.split(",") if i % 2 else [part] for i, part in enumerate(parts)]
    return {"".join(words) for words in itertools.product(*choices)}


def test_units_are_those_of_the_table() -> None:
    assert named(section("Units")) - {"arm_rad_s2"} == {f"_{unit.suffix}" for unit in UNITS}


def test_exit_codes() -> None:
    codes = re.findall(r"^\| (\d+) \|", section("Exit codes"), re.M)
    assert [int(code) for code in codes] == [int(code) for code in ExitCode]


def test_functions_of_expressions() -> None:
    text = section("Profiles in YAML").partition("Expressions are arithmetic")[2].split(".")[0]
    assert named(text) - {"+ - * / **", "pi"} == set(FUNCTIONS)


def test_trajectory_columns() -> None:
    cells = re.findall(r"^\| (.+?) \|", section("trajectory.parquet"), re.M)[1:]
    names = {name for cell in cells for pattern in named(cell) for name in expanded(pattern)}
    assert names == {*trajectory_names(1), *trajectory_names(3)}


def test_keys_of_a_reduction() -> None:
    rows = re.findall(r"^\| `(\w+)` \| .+ \| (.+) \|$", section("Reduction"), re.M)
    default = Reduction()
    assert {key for key, _ in rows} == set(Reduction.__dataclass_fields__)
    for key, value in rows:
        if isinstance(getattr(default, key), (str, int, float)):
            assert value == f"`{getattr(default, key)}`"
    assert default.budget == (
        Budget("joint_deviation_relative", float(dict(rows)["budget"].strip("`"))),
    )
    weights = {"r1": default.r1.diagonal(), "r2": default.r2[0], "tracking": default.tracking[0]}
    for key, weight in weights.items():
        np.testing.assert_array_equal(json.loads(dict(rows)[key].strip("`")), weight)


def test_metrics_of_a_budget() -> None:
    text = section("Reduction").partition("A budget is on one metric")[2].partition(". ")[0]
    assert named(text.partition(":")[2]) == set(get_args(MetricKey))


@pytest.fixture(scope="module")
def metrics() -> dict:
    return reduce_profile(load_profile("cobra", settings=["time.step_s=0.25"])).metrics


def test_metrics(metrics: dict) -> None:
    def keys(value: object) -> set[str]:
        if not isinstance(value, dict):
            return set()
        return set(value).union(*map(keys, value.values()))

    rows = re.findall(r"^\| `(\w+)` \| (.+) \|$", section("metrics.json"), re.M)
    assert {name for name, _ in rows} == set(metrics)
    optional = {"recorded_attitude_error_max_deg", "r1"}
    for name, cell in rows:
        words = {part for word in named(cell) for part in word.split(".")}
        assert words - optional == keys(metrics[name]) - optional, name
