"""Which plots a run has, within which limits, and what is said of each."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from des_cli.model.run import Run
from des_cli.results.reading import read_metrics
from des_cli.runs_out.tables import trajectory_columns
from des_cli.show.page.curves import Family, families_of
from des_cli.show.page.panels import Panel, panels_of
from tests.support.page import set_at


@pytest.fixture
def panels(synthetic_run: Callable[..., Run]) -> Callable[..., dict[str, Panel]]:
    """A function that returns the panels of a run whose cab has a jerk of some shape."""

    def make(jerk: np.ndarray | None = None, **limits: float) -> dict[str, Panel]:
        run = synthetic_run(101)
        families = families_of(trajectory_columns(run))
        if jerk is not None:
            values = dict(families["jerk"].values) | {"cab_after": jerk}
            families["jerk"] = Family(families["jerk"].t, values)
        content = dict(run.metrics)
        for key, value in limits.items():
            set_at(content, f"limits.modified.cab.{key}", value)
        found = panels_of(families, read_metrics(content), {"fork": 2.0, "arm": np.inf})
        return {panel.key: panel for panel in found}

    return make


def test_every_curve_is_a_column_of_its_family(
    panels: Callable[..., dict[str, Panel]], synthetic_run: Callable[..., Run]
) -> None:
    families = families_of(trajectory_columns(synthetic_run(101)))
    for panel in panels().values():
        assert {each.column for each in panel.curves} <= set(families[panel.family].values)
        assert panel.span[0] < panel.span[1]
        assert panel.finding.endswith(".")
        assert len({each.pen for each in panel.curves}) == len(panel.curves)


def test_where_a_motion_is_at_its_limit_is_marked(
    panels: Callable[..., dict[str, Panel]],
) -> None:
    t = np.linspace(0.0, 10.0, 101)
    jerk = np.where((t > 2.05) & (t < 3.05), -8.0, 1.0)
    jerk[80] = 8.0
    panel = panels(jerk, jerk_limit_rad_s3=8.0)["cab-jerk"]
    assert panel.limit == 8.0
    np.testing.assert_allclose(panel.at_limit, [(2.1, 3.0), (8.0, 8.0)])
    assert "of the limit of 8; at it for 0.9 s." in panel.finding
    assert panel.span[1] > 8.0


def test_a_far_limit_does_not_flatten_the_curve(panels: Callable[..., dict[str, Panel]]) -> None:
    panel = panels(np.linspace(-1.0, 1.0, 101), jerk_limit_rad_s3=1000.0)["cab-jerk"]
    assert panel.limit == 1000.0
    assert panel.span[1] < 2000.0 / 3.0
    assert panel.at_limit == ()


def test_a_limit_of_an_angle_is_in_degrees_and_an_endless_joint_has_none(
    panels: Callable[..., dict[str, Panel]],
) -> None:
    found = panels()
    assert found["fork-angle"].limit == pytest.approx(np.degrees(2.0))
    assert found["arm-angle"].limit is None
    assert found["arm-angle"].finding.endswith("no limit.")


def test_before_is_what_the_profile_asks_for(synthetic_run: Callable[..., Run]) -> None:
    columns = trajectory_columns(synthetic_run(101))
    families = families_of(columns)
    np.testing.assert_array_equal(
        families["angle"].values["cab_before"], np.degrees(columns["asked_cab_rad"])
    )
    size = np.linalg.norm([columns[f"coriolis_seat_{axis}_after_rad_s2"] for axis in "xyz"], axis=0)
    np.testing.assert_allclose(families["turning"].values["c_n_after"], size)
