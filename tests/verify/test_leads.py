"""A table with its leads: from rest, of the length asked for, round the very maneuver."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.verify.leads import check_leads
from tests.support.claims import claim_of, failing, values_of
from tests.support.free_case import Case, with_rates

LESS, MORE = 5e-10, 2e-9
"""On either side of what rounding alone may change, in s, rad and rad/s."""

IN, OUT = 0.5, 0.75
T = np.array([-0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75])
RATE = np.outer([0.0, 0.5, 1.0, 0.8, 0.7, 0.9, 1.0, 0.5, 0.2, 0.0], [1.0, -0.5, 0.3])
TABLE = with_rates(T, np.zeros(3), RATE)
MANEUVER = Motion(T[2:7], TABLE.angle[2:7], TABLE.rate_start[2:6], TABLE.rate_end[2:6])
KEYS = {"leads.length", "leads.rest", "leads.maneuver"}


def checks_of(table: Motion, maneuver: Motion = MANEUVER, **leads: float) -> list[Check]:
    leads = {"lead_in": IN, "lead_out": OUT, **leads}
    return check_leads(claim_of(maneuver, further={"commands": table}, **leads))


def shifted(name: str, index: Any, by: float) -> Motion:
    values = getattr(TABLE, name).copy()
    values[index] += by
    return replace(TABLE, **{name: values})


def test_a_table_with_its_leads_passes() -> None:
    checks = checks_of(TABLE)
    assert values_of(checks) == dict.fromkeys(KEYS, 0.0)
    assert all(check.ok for check in checks)


def test_where_the_table_is_the_maneuver_nothing_is_checked() -> None:
    assert check_leads(claim_of(MANEUVER, lead_in=IN)) == []
    assert check_leads(claim_of(MANEUVER, further={"commands": MANEUVER}, lead_in=IN)) == []


@pytest.mark.parametrize("lead", ["lead_in", "lead_out"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_each_lead_has_its_length(lead: str, sign: float) -> None:
    length = {"lead_in": IN, "lead_out": OUT}[lead]
    for by, broken in ((LESS, False), (MORE, True)):
        checks = checks_of(TABLE, **{lead: length + sign * by})
        assert failing(checks) == ({"leads.length"} if broken else set())
        assert values_of(checks)["leads.length"] == pytest.approx(by, rel=1e-6)


@pytest.mark.parametrize(("name", "at"), [("rate_start", 0), ("rate_end", -1)])
@pytest.mark.parametrize("joint", [0, 1, 2])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_every_joint_rests_at_both_ends(name: str, at: int, joint: int, sign: float) -> None:
    for by, broken in ((LESS, False), (MORE, True)):
        checks = checks_of(shifted(name, (at, joint), sign * by))
        assert failing(checks) == ({"leads.rest"} if broken else set())


@pytest.mark.parametrize(
    ("cut", "leads"),
    [
        (slice(2, None), {"lead_in": 0.0}),
        (slice(None, 7), {"lead_out": 0.0}),
    ],
)
def test_an_end_without_a_lead_need_not_rest(cut: slice, leads: dict[str, float]) -> None:
    t = T[cut]
    table = Motion(t, TABLE.angle[cut], RATE[cut][:-1], RATE[cut][1:])
    checks = checks_of(table, **leads)
    assert failing(checks) == set()
    assert failing(checks_of(table)) >= {"leads.length", "leads.rest"}


@pytest.mark.parametrize(
    ("name", "samples"), [("angle", 5), ("rate_start", 4), ("rate_end", 4), ("t", 5)]
)
@pytest.mark.parametrize("joint", [0, 1, 2])
def test_the_maneuver_in_the_table_is_the_modified_motion(
    name: str, samples: int, joint: int
) -> None:
    for at in range(len(getattr(TABLE, name))):
        within = 2 <= at < 2 + samples
        index = at if name == "t" else (at, joint)
        for by, broken in ((LESS, False), (MORE, within), (-MORE, within)):
            failed = failing(checks_of(shifted(name, index, by)))
            assert ("leads.maneuver" in failed) is broken


@pytest.mark.parametrize("end", [6, 2])
def test_a_table_that_stops_short_of_the_maneuvers_end_is_refused(end: int) -> None:
    short = Motion(T[:end], TABLE.angle[:end], RATE[: end - 1], RATE[1:end])
    checks = checks_of(short, lead_out=0.0)
    assert values_of(checks)["leads.maneuver"] == np.inf
    assert failing(checks) >= {"leads.length", "leads.maneuver"}


def led(motion: Motion, seconds: float, last: float = 0.0) -> Motion:
    """A motion that comes from rest in so many seconds, with the cosine's rates."""
    t = np.concatenate([motion.t[0] - seconds + np.arange(0.0, seconds, 0.04), motion.t])
    share = 0.5 - 0.5 * np.cos(np.pi * (t - t[0])[:, None] / seconds)
    count = len(t) - len(motion.t)
    rate = np.vstack([motion.rate_start[0] * share[:count] + last, motion.rate])
    found = with_rates(t, np.zeros(3), rate)
    angle = found.angle + (motion.angle[0] - found.angle[count])
    angle[count:] = motion.angle
    return replace(found, angle=angle)


def test_an_optimum_with_a_lead(case: Case) -> None:
    motion, lead = case.solution.modified, {"lead_in": 4.0, "limits": "warn"}
    assert case.failed(commands=led(motion, 4.0), **lead) == set()
    # faster than the machine may, though the maneuver itself is not
    failed = case.failed(commands=led(motion, 0.4), lead_in=0.4)
    assert {"limits.arm.acceleration", "limits.arm.jerk"} <= failed
    assert all(key.startswith("limits.") for key in failed)
    assert case.failed(commands=led(motion, 4.0), lead_in=5.0, limits="warn") == {"leads.length"}
    assert case.failed(commands=led(motion, 4.0, last=2e-9), **lead) == {"leads.rest"}
    table = led(motion, 4.0)
    angle = table.angle.copy()
    angle[150:, 0] += 1e-8
    failed = case.failed(commands=replace(table, angle=angle), **lead)
    assert failed == {"leads.maneuver", "dynamics.angles"}
    cut = Motion(motion.t[:-1], motion.angle[:-1], motion.rate_start[:-1], motion.rate_end[:-1])
    assert "leads.maneuver" in case.failed(commands=led(cut, 4.0), **lead)
    angle[3, 1] = np.nan
    assert case.failed(commands=replace(table, angle=angle), **lead) == {"finite"}
