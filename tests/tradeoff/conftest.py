"""The points of two sweeps over the Cobra, computed once for all tests of the folder."""

from __future__ import annotations

import pytest
from click.testing import CliRunner

from des_cli.cli.main import program
from tests.support.points import COARSE, STUDY, Rows, rows_of


def swept(*args: str) -> Rows:
    result = CliRunner().invoke(program, ["sweep", "cobra", *args])
    assert result.exit_code == 0, result.stderr
    return rows_of(result.stdout)


@pytest.fixture(scope="package")
def by_weight() -> Rows:
    """The study's problem without limits, over three weights."""
    return swept(*STUDY, *COARSE, "--limits", "warn", "--r2s", "8,1,0.2", "-f", "csv")


@pytest.fixture(scope="package")
def by_budget() -> Rows:
    """All of the cross-coupling within the limits, over two budgets."""
    coarse = ("--set", "time.step_s=0.1")
    return swept("--axes", "seat", "--r1", "2,2,2", *coarse, "--budgets", "0.02,0.05")
