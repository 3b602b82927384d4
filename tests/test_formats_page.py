"""docs/formats.md names what the tool writes, and nothing that it does not."""

import itertools
import json
import math
import re
from dataclasses import fields
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
from ruamel.yaml import YAML

from des_cli.errors import ExitCode
from des_cli.model.machines import DES
from des_cli.model.metric import Budget, MetricKey
from des_cli.model.metrics import Added, AskedG
from des_cli.model.motion import Motion
from des_cli.model.notice import HARMS, NoticeName
from des_cli.model.profile import Reduction
from des_cli.pipeline import reduce_profile
from des_cli.profiles_in.expression import FUNCTIONS
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.machine_schema import JointLimits, MachineSection, Occupant
from des_cli.profiles_in.machine_yaml import parse_machine
from des_cli.runs_out.tables import trajectory_names
from des_cli.units import UNITS, split_unit, suffixes

PAGE = Path(__file__).parents[1] / "docs" / "formats.md"
TEXT = PAGE.read_text(encoding="utf-8")


def section(title: str) -> str:
    match = re.search(rf"^(#+) {re.escape(title)}\n", TEXT, re.M)
    assert match, title
    same_or_higher = rf"^#{{1,{len(match[1])}}} "
    return re.split(same_or_higher, TEXT[match.end() :], maxsplit=1, flags=re.M)[0]


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


def test_notices_and_which_of_them_warn_of_harm() -> None:
    rows = re.findall(r"^\| `([\w-]+)` \| (yes)? ?\|", section("Notices"), re.M)
    # What becomes of an earlier output is no word on the run.
    assert {name for name, _ in rows} == {*get_args(NoticeName)} - {"earlier"}
    assert [name for name, harm in rows if harm] == list(HARMS)


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
    rows = [(split_unit(key)[0], value.strip("`")) for key, value in rows]
    assert {key for key, _ in rows} == set(Reduction.__dataclass_fields__)
    for key, value in rows:
        own = getattr(default, key)
        if isinstance(own, (str, int, float)):
            assert type(own)(value) == own
    budgets = YAML(typ="safe").load(dict(rows)["budget"])
    assert default.budget == tuple(Budget(metric, most) for metric, most in budgets.items())
    assert [key for key, value in rows if value == "none"] == ["optimise", "hold"]
    assert not default.optimise
    assert not default.hold
    weights = {"r1": default.r1.diagonal(), "r2": default.r2[0], "tracking": default.tracking[0]}
    for key, weight in weights.items():
        np.testing.assert_array_equal(json.loads(dict(rows)[key]), weight)


def test_metrics_of_a_budget() -> None:
    text = section("Reduction").partition("Budgets are on any metrics")[2].partition(". ")[0]
    assert named(text.partition(":")[2]) == set(get_args(MetricKey))


def test_the_machine_of_the_page_is_read_and_its_keys_are_those_of_the_schema() -> None:
    text = section("Machines")
    shown = re.search(r"```yaml\n(.*?)```", text, re.S)
    assert shown
    machine = parse_machine(shown[1], "formats.md")
    assert [limit.jerk for limit in machine.limits] == [1.0, DES.limits[1].jerk, math.inf]
    assert machine.occupant.bounded
    rows = re.findall(r"^\| (.+?) \| (.+) \|$", text, re.M)
    keys = {split_unit(key)[0] for cell, _ in rows for key in named(cell)}
    known = {split_unit(key)[0] for key in MachineSection.known_keys()}
    assert keys == known
    bounds = named(next(words for cell, words in rows if cell == "`occupant`"))
    assert {key for key in Occupant.known_keys() if not key.endswith("deg_s2")} <= bounds
    limits = named(next(words for cell, words in rows if cell == "`limits`"))
    assert {f"{m.stem}_{suffixes(m.quantity)[0]}" for m in JointLimits.measures} <= limits


def test_the_jerk_of_a_rounded_table_is_at_most_what_the_page_says() -> None:
    # errors of half a digit with the signs that add up in the estimate
    digit, step = 1e-3, 0.01
    position = 0.5 * digit * np.array([0, -1, 1, 0, -1, 1, 0, 0, 0, 0])
    rate = np.gradient(position, step)
    table = np.stack([0 * rate, rate, 0 * rate], axis=1)
    motion = Motion(step * np.arange(10), 0 * table, table[:-1], table[1:])
    assert np.max(np.abs(motion.jerk)) == pytest.approx(1.5 * digit / step**3)


@pytest.fixture(scope="module")
def metrics() -> dict:
    settings = [
        "time.step_s=0.25",
        "reduction.control=free",
        "reduction.budget={seat_g_rms_error_g: 0.05, seat_rate_deviation_relative: 0.1}",
        "reduction.optimise=[seat_yaw, seat_pitch, fork_start, cab_start]",
    ]
    return reduce_profile(load_profile("cobra", settings=settings)).metrics


def test_metrics(metrics: dict) -> None:
    def keys(value: object) -> set[str]:
        if not isinstance(value, dict):
            return set()
        return set(value).union(*map(keys, value.values()))

    rows = re.findall(r"^\| `(\w+)` \| (.+) \|$", section("metrics.json"), re.M)
    assert {name for name, _ in rows} == set(metrics)
    metrics["solver"]["budget"] = None  # a mapping of metrics, or null
    assert metrics["asked_g"] is None
    metrics["asked_g"] = dict.fromkeys(each.name for each in fields(AskedG))
    assert metrics["added"] is None
    metrics["added"] = dict.fromkeys(each.name for each in fields(Added))
    optional = {"recorded_attitude_error_max_deg", "r1"}
    for name, cell in rows:
        words = {part for word in named(cell) for part in word.split(".")}
        assert words - optional == keys(metrics[name]) - optional, name
