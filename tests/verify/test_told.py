"""No number that a user is told can be another than what the motion does."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli import load_profile, pipeline
from des_cli.results.reading import read_metrics
from des_cli.verify import told as told_module
from des_cli.verify.claim import Claim
from des_cli.verify.told import check_told
from des_cli.verify.verify import verify

# Of a factor, of free joints, of body rates with a requested part that the joints lack.
CASES = {
    "scalar": ("cobra", ["time.step_s=0.05"]),
    "free": ("cobra_felt", ["time.step_s=0.05"]),
    "G": ("g_flight", []),
}
UNTOLD = {
    "objective",  # by the cost, which has a check of its own
    "acceleration_sign_changes",
    "ok",
}
SECTIONS = ("solver", "fidelity", "coriolis", "felt", "limits")


@pytest.fixture(scope="module", params=CASES)
def claim(request: pytest.FixtureRequest) -> Claim:
    """A claim with the metrics that were told of it."""
    claims: list[Claim] = []
    name, settings = CASES[request.param]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pipeline, "verify", lambda each: (claims.append(each), verify(each))[1])
        pipeline.reduce_profile(load_profile(name, settings=settings))
    (found,) = claims
    return found


def leaves(content: dict[str, Any], *path: str) -> Iterator[tuple[str, ...]]:
    """Yield the path of every number."""
    for key, value in content.items():
        if key in UNTOLD:
            continue
        if isinstance(value, dict):
            yield from leaves(value, *path, key)
        elif isinstance(value, int | float):
            yield (*path, key)


def told(claim: Claim, path: tuple[str, ...], change: Any) -> set[str]:
    """Change a number of the metrics, and return the keys of the checks that fail."""
    assert claim.told is not None
    content = copy.deepcopy(claim.told.mapping())
    inner = content
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = change(inner[path[-1]])
    return {check.key for check in check_told(claim, read_metrics(content)) if not check.ok}


def off(value: float) -> float:
    """A ten-millionth more, of what is felt."""
    return value + 1e-7 * max(abs(value), 1e-3)


def test_what_is_told_of_a_long_motion_is_found_in_pieces(
    claim: Claim, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert claim.told is not None
    whole = [check.value for check in check_told(claim, claim.told)]
    for module in ("model.motion.PIECE", "verify.integrals.CHUNK", "verify.occupant.TOGETHER"):
        monkeypatch.setattr(f"des_cli.{module}", 7)
    found = [check.value for check in check_told(claim, claim.told)]
    assert found == pytest.approx(whole, abs=1e-11)


def test_what_is_told_is_what_the_motion_does(claim: Claim) -> None:
    assert claim.told is not None
    checks = check_told(claim, claim.told)
    assert [check.key for check in checks] == [
        *("told.profile", "told.solver", "told.fidelity", "told.coriolis", "told.felt"),
        *("told.limits", "told.singularity"),
    ]
    assert all(check.value < 1e-9 for check in checks), checks
    assert all(check.value < 1e-11 for check in checks[:-1]), checks


def test_what_is_told_is_verified_where_something_is(claim: Claim) -> None:
    assert claim.told is not None
    keys = {check.key for check in check_told(claim, claim.told)}
    assert keys <= {check.key for check in verify(claim)}
    assert not keys & {check.key for check in verify(replace(claim, told=None))}


def test_every_number_that_is_off_is_found(claim: Claim, monkeypatch: pytest.MonkeyPatch) -> None:
    # how near the singularity it comes has tests of its own
    monkeypatch.setattr(told_module, "singularity_numbers", lambda *_: iter([("", 0.0, 0.0)]))
    assert claim.told is not None
    content = claim.told.mapping()
    missed = []
    count = 0
    for section in SECTIONS:
        for path in leaves(content[section], section):
            count += 1
            expected = {f"told.{section}"}
            if told(claim, path, off) != expected:
                missed.append(path)
    assert missed == []
    assert count > 150


@pytest.mark.parametrize("value", [None, float("nan"), float("inf"), "0.1", True])
def test_what_is_no_number_is_found(claim: Claim, value: object) -> None:
    path = ("felt", "seat_angular_acceleration", "magnitude", "peak_after_rad_s2")
    assert told(claim, path, lambda _: value) == {"told.felt"}


@pytest.mark.parametrize(
    "key",
    [
        *("method", "algorithm", "control", "axes", "jacobian", "limits", "ends", "objective"),
        *("optimise", "r1", "r2", "tracking", "budget", "status", "message"),
    ],
)
def test_other_words_and_weights_are_found(claim: Claim, key: str) -> None:
    def other(value: object) -> object:
        match value:
            case [[first, *rest], *rows]:
                return [[first + 1e-6, *rest], *rows]
            case [float() as first, *rest]:
                return [first + 1e-6, *rest]
            case dict():
                return dict.fromkeys(value, 0.9)
            case str():
                return "rising" if value != "rising" else "free"
        return [] if value else ["seat_yaw"]

    assert claim.told is not None
    if claim.told.mapping()["solver"].get(key) is not None:
        assert told(claim, ("solver", key), other) == {"told.solver"}


def test_another_duration_is_found(claim: Claim) -> None:
    assert told(claim, ("profile", "duration_s"), lambda value: 2 * value) == {"told.profile"}


def test_the_worst_number_is_named(claim: Claim) -> None:
    assert claim.told is not None
    content = copy.deepcopy(claim.told.mapping())
    content["felt"]["seat_g"]["gy"]["peak_after_g"] *= 1.01
    content["felt"]["seat_g"]["gz"]["peak_after_g"] *= 1.001
    (check,) = [each for each in check_told(claim, read_metrics(content)) if not each.ok]
    assert "largest of seat_g.gy.peak_after" in str(check)


def test_a_tilt_is_the_angle_between_two_directions_up_to_half_a_turn() -> None:
    """Of G-vectors of any length, where neither is shorter than a tenth of g."""
    rng = np.random.default_rng(9)
    g = rng.normal(size=(3, 400))
    size = np.linalg.norm(g, axis=0)
    axis = np.cross(g.T, rng.normal(size=(400, 3))).T
    axis /= np.linalg.norm(axis, axis=0)
    angle = np.radians(np.concatenate([rng.uniform(0.0, 180.0, 200), np.full(200, 180.0)]))
    # turned about an axis at right angles to it
    other = np.cos(angle) * g + np.sin(angle) * np.cross(axis.T, g.T).T
    other[:, 200:] = -g[:, 200:]
    tilt, clear = told_module._tilt(g, 0.7 * other)
    np.testing.assert_array_equal(clear, 0.7 * size >= 0.1)
    np.testing.assert_allclose(tilt[clear], np.degrees(angle[clear]), atol=1e-5)
    short = np.array([[0.0999], [0.0], [0.0]])
    for pair in ((short, g[:, :1]), (g[:, :1], short)):
        tilt, clear = told_module._tilt(*pair)
        assert (tilt[0], clear[0]) == (0.0, False)
    assert told_module._tilt(np.array([[0.1001], [0.0], [0.0]]), g[:, :1])[1][0]
