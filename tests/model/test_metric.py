"""Every metric is declared once, and named by its constant everywhere else."""

import re
from pathlib import Path
from typing import get_args

import pytest

import des_cli
from des_cli.model.metric import METRICS, MetricKey

SOURCES = {path: path.read_text("utf-8") for path in Path(des_cli.__file__).parent.rglob("*.py")}


def test_every_key_has_its_metric() -> None:
    assert tuple(METRICS) == get_args(MetricKey)
    assert all(metric.key == key for key, metric in METRICS.items())


@pytest.mark.parametrize("key", get_args(MetricKey))
def test_a_key_is_spelled_where_it_is_declared(key: str) -> None:
    """Elsewhere only what is called after it has its name: a field, a column, an example."""
    spelled = [path.name for path, text in SOURCES.items() if re.search(rf"[\"']{key}[\"']", text)]
    assert spelled == ["metric.py"]
