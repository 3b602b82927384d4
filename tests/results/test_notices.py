"""What a user is told beside the numbers, and what not."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.model.coriolis import COMPONENTS
from des_cli.model.machines import DES
from des_cli.model.motion import DesiredMotion, Motion
from des_cli.model.profile import JointCommands, Profile
from des_cli.results import notices
from des_cli.results.reading import read_metrics

PROFILE = Profile(
    "p",
    np.linspace(0.0, 1.0, 6),
    JointCommands(np.zeros(6), np.zeros((6, 2)), np.zeros((5, 2)), np.zeros((5, 2))),
    DES,
)


def find_notices(profile: Profile, asked: DesiredMotion, metrics: dict[str, Any]) -> list[str]:
    found = notices.find_notices(profile, asked, read_metrics(metrics))
    return [notice.text for notice in found]


def asked(*, damped: tuple[int, ...] = ()) -> DesiredMotion:
    t = np.linspace(0.0, 1.0, 6)
    flags = np.isin(np.arange(6), damped)
    residual = flags[:, None] * np.array([0.3, 0.0, 0.4])
    motion = Motion(t, np.zeros((6, 3)), np.zeros((5, 3)), np.zeros((5, 3)))
    return DesiredMotion(motion, np.ones(6), flags, residual)


def metrics(
    *,
    status: str = "converged",
    change: float = 0.0,
    objective: float | None = 0.5,
    vector: float | None = 0.4,
    felt: float = 0.1,
    turning: float = 0.4,
    broken: bool = True,
    solver: dict[str, Any] | None = None,
    **reductions: float | None,
) -> dict[str, Any]:
    coriolis: dict[str, Any] = {each.key: {"reduction": None} for each in COMPONENTS}
    coriolis |= {name: {"reduction": value} for name, value in reductions.items()}
    coriolis["vector"] = {"reduction": vector}
    quiet = {"at_acceleration_limit": 0.0, "acceleration_sign_changes": 2}
    return {
        "solver": {"status": status, "axes": "report", "message": "off by 1e-7"} | (solver or {}),
        "coriolis": {**coriolis, "objective": {"reduction": objective}},
        "executable": {
            "breaks_limits": broken,
            "joint_change_max_rad": {"arm": 0.0, "fork": 0.5 * change, "cab": change},
        },
        "fidelity": {
            "joint_deviation_relative": 0.05,
            "seat_rate_deviation_relative": felt,
            "seat_g_deviation_relative": 0.5 * felt,
        },
        "felt": {
            "seat_angular_acceleration": {
                "magnitude": {"rms_before_rad_s2": 0.4, "rms_after_rad_s2": turning}
            }
        },
        "limits": {
            "modified": {
                "arm": {"at_acceleration_limit": 0.97, "acceleration_sign_changes": 13},
                "fork": quiet,
                "cab": quiet,
            }
        },
    }


def test_nothing_to_say_of_a_clean_run() -> None:
    assert find_notices(PROFILE, asked(), metrics(bb3=0.7, ab3=-0.04, cb3=None, vector=0.4)) == []


def test_a_damped_inverse_is_told_with_its_times_and_its_residual() -> None:
    (notice,) = find_notices(PROFILE, asked(damped=(1, 2, 3)), metrics())
    assert "at 3 samples between t = 0.2 and 0.6 s" in notice
    assert "off by up to 0.5 rad/s" in notice


def test_a_replaced_motion_is_told_by_joint_where_it_can_be_noticed() -> None:
    (notice,) = find_notices(PROFILE, asked(), metrics(change=0.0015))
    assert "changed by up to cab 0.0015 rad" in notice
    assert "breaks limits" in notice
    assert "fork" not in notice
    (kept,) = find_notices(PROFILE, asked(), metrics(change=0.0015, broken=False))
    assert "limits" not in kept
    assert "made consistent" in kept
    assert find_notices(PROFILE, asked(), metrics(change=0.0005)) == []


@pytest.mark.parametrize("status", ["converged", "acceptable"])
def test_a_bought_component_is_told(status: str) -> None:
    notice = find_notices(PROFILE, asked(), metrics(status=status, bb3=0.7, ab3=-0.28, cb3=-7.0))[0]
    assert notice == "one component was bought with another: AB3 grew by 28.0 %, CB3 grew by 700 %"


def test_a_solution_that_is_none_has_bought_nothing() -> None:
    assert find_notices(PROFILE, asked(), metrics(status="diverged", bb3=0.7, ab3=-0.28)) == []


def test_a_worse_motion_is_not_called_bought() -> None:
    (notice,) = find_notices(PROFILE, asked(), metrics(objective=-0.079, bb3=-0.079, ab3=-0.3))
    assert "grew by 7.9 %: nothing was gained" in notice


def test_a_motion_that_feels_different_is_told() -> None:
    (notice,) = find_notices(PROFILE, asked(), metrics(felt=0.51))
    assert "seat rate is off by 51.0 %, G is off by 25.5 %, at 5.0 % in the joints" in notice
    assert "a budget on seat_rate_deviation_relative or seat_g_deviation_relative" in notice
    assert find_notices(PROFILE, asked(), metrics(felt=0.2)) == []
    assert find_notices(PROFILE, asked(), metrics(felt=0.51, status="infeasible")) == []
    rate = {"budget": {"seat_rate_deviation_relative": 0.51}}
    (notice,) = find_notices(PROFILE, asked(), metrics(felt=0.51, solver=rate))
    assert "changed: G is off by 25.5 %" in notice


def test_a_ride_that_got_worse_is_told_first_with_its_numbers_and_a_cure() -> None:
    found = find_notices(PROFILE, asked(), metrics(turning=2.2, felt=0.51))
    assert found[0] == (
        "worse to sit in than the profile: total angular acceleration 0.4 -> 2.2 rad/s² rms; "
        "a budget on seat_angular_acceleration_rms_ratio bounds that"
    )
    assert find_notices(PROFILE, asked(), metrics(turning=2.2, status="diverged")) == []


@pytest.mark.parametrize(
    ("budget", "labels"),
    [
        ({"joint_deviation_relative": 0.05}, "joints"),
        ({"seat_g_rms_error_g": 0.1}, "G error"),
        ({"joint_deviation_relative": 0.05, "seat_g_rms_error_g": 0.1}, "joints and G error"),
    ],
)
@pytest.mark.parametrize("control", ["free", "per-joint"])
def test_a_budget_that_leaves_the_rates_free_is_told(
    control: str, budget: dict[str, float], labels: str
) -> None:
    solver = {"budget": budget, "control": control, "objective": "coriolis"}
    (notice,) = find_notices(PROFILE, asked(), metrics(solver=solver))
    assert notice == (
        f"a budget on {labels} alone is ill-posed: the commands chatter (the arm's acceleration "
        "changes sign 13 times); add a budget on seat_rate_deviation_relative, or objective: blend"
    )
    restrained = budget | {"seat_rate_deviation_relative": 0.1}
    for change in (
        {"budget": restrained},
        {"objective": "blend"},
        {"control": "scalar"},
        {"budget": None},
    ):
        assert find_notices(PROFILE, asked(), metrics(solver=solver | change)) == []


def test_commands_that_do_not_chatter_are_not_said_to() -> None:
    quiet = metrics(solver={"budget": {"joint_deviation_relative": 0.05}, "control": "free"})
    quiet["limits"]["modified"]["arm"]["acceleration_sign_changes"] = 4
    (notice,) = find_notices(PROFILE, asked(), quiet)
    assert "ill-posed: nothing in it holds the joints' rates back; add a budget on" in notice
    assert "chatter" not in notice


def test_no_coriolis_is_told() -> None:
    (notice,) = find_notices(PROFILE, asked(), metrics(vector=None, objective=None))
    assert "nothing to reduce" in notice


def test_acceptable_is_told() -> None:
    (notice,) = find_notices(PROFILE, asked(), metrics(status="acceptable"))
    assert notice == "acceptable, not converged: off by 1e-7"


def test_what_reading_changed_is_told_first() -> None:
    profile = replace(PROFILE, remarks=("a gap was bridged",))
    found = find_notices(profile, asked(), metrics(status="acceptable"))
    assert found[0] == "a gap was bridged"
    assert len(found) == 2
