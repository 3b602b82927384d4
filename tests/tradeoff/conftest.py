"""A curve over weights, for the tests of its points."""

import pytest

from tests.support.points import COARSE, STUDY, Rows, rows_of


@pytest.fixture(scope="session")
def by_weight() -> Rows:
    from click.testing import CliRunner

    from des_cli.cli.main import program

    args = ["sweep", "cobra", *STUDY, *COARSE, "--limits", "warn", "--r2s", "8,1,0.2", "-f", "csv"]
    result = CliRunner().invoke(program, args)
    assert result.exit_code == 0, result.stderr
    return rows_of(result.stdout)
