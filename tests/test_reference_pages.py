"""docs/reference is what scripts/reference.py writes from the code, and names all of it."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

from des_cli.errors import ExitCode
from des_cli.model.metric import METRICS

SCRIPT = Path(__file__).parents[1] / "scripts" / "reference.py"


@pytest.fixture(scope="module")
def reference() -> ModuleType:
    spec = importlib.util.spec_from_file_location("reference", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_no_page_is_missing_or_stale(reference: ModuleType) -> None:
    assert list(reference.stale(reference.pages())) == []


def test_a_page_that_is_stale_missing_or_of_nobody_is_named(
    reference: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reference, "FOLDER", tmp_path)
    (tmp_path / "one.md").write_text("old")
    (tmp_path / "other.md").write_text("of nobody")
    found = list(reference.stale({"one.md": "new", "two.md": "new"}))
    assert [line.partition(": ")[0].rpartition("/")[2] for line in found] == [
        "one.md",
        "two.md",
        "other.md",
    ]


def test_every_metric_has_a_meaning(reference: ModuleType) -> None:
    assert list(reference.MEANING) == list(METRICS)


def test_the_exit_codes_that_errors_have_are_named(reference: ModuleType) -> None:
    page = reference.exit_codes_page()
    assert all(f"| {int(code)} | `{code.name}` |" in page for code in ExitCode)


def test_equal_siblings_share_their_rows(reference: ModuleType) -> None:
    value = {"a": {"x_rad": 1.0, "y": 2}, "b": {"x_rad": 0.0, "y": 3}, "onset_g_s": 1.0}
    assert reference._leaves(value) == [
        ("{a,b}.x_rad", "rad"),
        ("{a,b}.y", ""),
        ("onset_g_s", "g/s"),
    ]
