"""The one component that a run weighs, from its metrics."""

import numpy as np
import pytest

from des_cli.results.reading import read_metrics
from des_cli.show.weighted import weighted_component


@pytest.mark.parametrize(
    ("solver", "expected"),
    [
        ({"axes": "report", "r1": np.diag([0, 2, 0]).tolist()}, "bb3"),
        ({"axes": "report", "r1": np.diag([1, 0, 0]).tolist()}, "ab3"),
        ({"axes": "seat", "r1": np.diag([0, 0, 3]).tolist()}, "seat_z"),
        ({"axes": "seat", "r1": np.diag([2, 2, 2]).tolist()}, None),
        ({"axes": "seat"}, None),
        ({"axes": "report"}, "bb3"),
        ({}, None),
    ],
)
def test_the_weighted_component_is_known(solver: dict[str, object], expected: str | None) -> None:
    assert weighted_component(read_metrics({"solver": solver}).solver) == expected
