"""What is read of any metrics is typed, and of our own it is all of them."""

from __future__ import annotations

import json
from dataclasses import FrozenInstanceError

import pytest

from des_cli.model.metric import JOINT_DEVIATION, SEAT_RATE_DEVIATION
from des_cli.model.metrics import Metrics
from des_cli.pipeline import reduce_profile
from des_cli.profiles_in.load import load_profile
from des_cli.results.reading import read_metrics
from tests.support.sway import reduced_sway


@pytest.mark.parametrize("optimise", ["[]", "[seat_yaw, cab_start]"])
def test_our_own_file_reads_back_whole(optimise: str) -> None:
    settings = ["time.step_s=0.25", "reduction.control=free", f"reduction.optimise={optimise}"]
    settings.append(
        "reduction.budget={seat_g_rms_error_g: 0.05, seat_rate_deviation_relative: 0.1}"
    )
    run = reduce_profile(load_profile("cobra", settings=settings))
    found = read_metrics(json.loads(json.dumps(run.metrics)))
    assert found == run.results
    assert found.mapping() == run.metrics


def test_nothing_is_changed_once_it_is_measured() -> None:
    run = reduced_sway()
    with pytest.raises(FrozenInstanceError):
        run.results.notices = ()  # type: ignore[misc]
    assert run.metrics["notices"] == [notice.text for notice in run.notices]


@pytest.mark.parametrize("content", [None, [], "text", {}, {"solver": 3, "felt": {"seat_g": []}}])
def test_of_a_stranger_nothing_is_known(content: object) -> None:
    assert read_metrics(content) == Metrics()


def test_what_is_not_what_it_should_be_is_not_known() -> None:
    content = {
        "solver": {"iterations": 6.5, "converged": "yes", "cost": 10**400, "status": ["converged"]},
        "profile": {"samples": 11.0, "name": "cobra"},
        "fidelity": {SEAT_RATE_DEVIATION: float("nan"), JOINT_DEVIATION: 1, "of_later": 0.5},
        "baseline": {"report_sweep": {}, "constant_p": {"p": 0.7}},
        "notices": ["one", 2, None],
        "unheard_of": {},
    }
    found = read_metrics(content)
    solver = found.solver
    assert (solver.iterations, solver.converged, solver.cost, solver.status) == (None,) * 4
    assert (found.profile.samples, found.profile.name) == (11, "cobra")
    assert found.fidelity.value(SEAT_RATE_DEVIATION) is None
    assert found.fidelity.value(JOINT_DEVIATION) == 1.0
    assert found.fidelity.metrics["of_later"] == 0.5
    assert found.baseline.report_sweep is None
    assert found.baseline.constant_p is not None
    assert found.baseline.constant_p.joint_deviation is None
    assert found.notices == ("one",)


def test_the_ride_is_the_one_that_was_reduced() -> None:
    felt = {"seat_g": {"gy": {"peak_before_g": 0.5, "peak_after_g": 0.6}}}
    other = {"seat_g": {"gy": {"peak_before_g": 0.7, "peak_after_g": 0.6}}}
    assert read_metrics({"felt": felt}).ride.seat_g["gy"].peak == (0.5, 0.6)
    added = {"budgets": {JOINT_DEVIATION: 0.02}, "felt": other}
    found = read_metrics({"felt": felt, "added": added})
    assert found.ride.seat_g["gy"].peak == (0.7, 0.6)
    assert found.added is not None
    assert found.added.budgets == {JOINT_DEVIATION: 0.02}
    assert read_metrics({"felt": felt, "added": None}).added is None
