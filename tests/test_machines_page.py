"""docs/machines.md: its files are read, and do what the page says."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from des_cli.cli.main import program
from des_cli.kinematics.chain import chain_of, seat_position, seat_rotation
from des_cli.model.machine import Seat
from des_cli.model.machines import DES, gimballed_centrifuge_rows
from des_cli.profiles_in.machine_text import machine_text
from des_cli.profiles_in.machine_yaml import parse_machine

PAGE = Path(__file__).parents[1] / "docs" / "machines.md"
FILES = re.findall(r"```yaml\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)
MY, OWN, TURN = FILES


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    """Run a command line beside the page's files."""
    monkeypatch.chdir(tmp_path)
    for name, text in (("my.yaml", MY), ("own.yaml", OWN), ("turn.yaml", TURN)):
        Path(name).write_text(text)

    def invoke(*args: str) -> Result:
        return CliRunner().invoke(program, list(args))

    return invoke


def test_the_first_machine_is_the_printed_one_with_other_numbers() -> None:
    keys = [line for line in machine_text(DES).splitlines() if not line.startswith("#")]
    shown = [line for line in MY.splitlines() if "name" not in line and "occupant" not in line]
    assert [line.split(":")[0] for line in keys] == [
        line.split(":")[0] for line in shown if "gy_g" not in line
    ]
    machine = parse_machine(MY, "my.yaml")
    assert machine.rows == gimballed_centrifuge_rows(dict(DES.lengths) | {"L2": 25 * 0.3048})
    assert machine.limits[1:] == DES.limits[1:]


def test_the_machine_of_rows_has_its_cab_above_the_fork(run) -> None:
    result = run("kinematics", "--machine", "own.yaml", "--format", "text")
    assert result.exit_code == 0, result.stderr
    machine = parse_machine(OWN, "own.yaml")
    chain = chain_of(machine, Seat())
    lengths = machine.lengths
    np.testing.assert_allclose(
        seat_position(chain, np.zeros(3)), [lengths["R"], 0.0, lengths["H"] - lengths["S"]]
    )
    # the seat hangs below the cab's axis and turns about it, on a circle of its own length
    turned = seat_position(chain, np.array([0.0, 0.0, np.pi / 2]))
    np.testing.assert_allclose(turned, [lengths["R"] + lengths["S"], 0.0, lengths["H"]])
    np.testing.assert_allclose(seat_rotation(chain, np.zeros(3))[:, 2], [0, 0, -1], atol=1e-15)


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ((), 0),
        (("--control", "per-joint"), 0),
        (("--method", "zero"), 0),
        (("--control", "scalar"), 2),
        (("--algorithm", "report-sweep", "--limits", "warn"), 2),
    ],
)
def test_two_axes_work_with_hold_where_the_page_says_so(run, options, code) -> None:
    coarse = ("--set", "time.step_s=0.1", "--no-plots", "-o", "table.csv")
    result = run("reduce", "turn.yaml", *coarse, *options)
    assert result.exit_code == code, result.stderr
    if code == 0:
        table = np.loadtxt("table.csv", delimiter=",", skiprows=1)
        np.testing.assert_array_equal(table[:, 2], 0.0)
        assert np.ptp(table[:, 1]) > 1.0
    else:
        assert "hold" in result.stderr


def test_a_factor_needs_no_hold(run) -> None:
    Path("turn.yaml").write_text(TURN.replace("hold: [fork]", "control: scalar"))
    coarse = ("--set", "time.step_s=0.1", "-o", "table.csv", "--budget", "5%")
    assert run("reduce", "turn.yaml", *coarse).exit_code == 0
    np.testing.assert_array_equal(np.loadtxt("table.csv", delimiter=",", skiprows=1)[:, 2], 0.0)
