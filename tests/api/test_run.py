"""The Python interface: what goes in, what a run shows of itself, and what it writes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from des_cli import Run, load_profile, reduce_profile
from des_cli.errors import FileAccessError, NotReleasedError, ProfileError, UsageError
from des_cli.runs_out.stored_run import read_run
from des_cli.runs_out.table_reading import parse_command_table
from tests.support.runs import make_run

SMALL = """\
format: des-coriolis/1
name: small
time: {start_s: 0, stop_s: 2, step_s: 0.02}
joints: {arm_rpm: "8 + 0.3*sin(t)", fork_deg: "-5*(1 - cos(t))", cab_deg: "4*sin(t)"}
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("api") / "small.yaml"
    path.write_text(SMALL)
    return path


@pytest.fixture(scope="module")
def run(path: Path) -> Run:
    return reduce_profile(path)


def test_a_name_a_path_and_a_profile_are_the_same(run: Run, path: Path) -> None:
    for given in (str(path), load_profile(path)):
        again = reduce_profile(given)
        assert again.metrics == run.metrics
    assert run.released
    assert run.refusal == ()


def test_the_budget_of_a_file_and_of_a_profile(path: Path) -> None:
    budget = {"seat_rate_deviation_relative": 0.05}
    one, other = (reduce_profile(given, budget=budget) for given in (path, load_profile(path)))
    assert one.metrics["fidelity"] == other.metrics["fidelity"]
    assert one.metrics["solver"]["budget"] == budget
    deviation = one.metrics["fidelity"]["seat_rate_deviation_relative"]
    assert 0.049 < deviation <= 0.05


def test_a_number_alone_is_the_studys_measure(path: Path) -> None:
    for given in (path, load_profile(path)):
        run = reduce_profile(given, budget=0.01)
        assert run.metrics["solver"]["budget"] == {"joint_deviation_relative": 0.01}


def test_settings(path: Path) -> None:
    run = reduce_profile(path, settings={"reduction.ends": "match-both", "name": "other"})
    assert (run.name, run.metrics["solver"]["ends"]) == ("other", "match-both")
    with pytest.raises(UsageError, match="small: is read already: give its name or its file"):
        reduce_profile(load_profile(path), settings={"name": "other"})


@pytest.mark.parametrize(
    ("budget", "said"),
    [
        ({"nothing": 0.1}, r"budget: nothing is no metric: .*seat_g_rms_error_g"),
        ({"seat_g_rms_error_g": 0.0}, r"budget\['seat_g_rms_error_g'\]: must be positive"),
        ({"seat_g_rms_error_g": float("nan")}, "must be positive, is nan"),
    ],
)
def test_a_wrong_budget_is_named(path: Path, budget: dict[str, float], said: str) -> None:
    with pytest.raises(UsageError, match=said):
        reduce_profile(load_profile(path), budget=budget)
    with pytest.raises(ProfileError, match="budget"):
        reduce_profile(path, budget=budget)


def test_an_unknown_name_is_a_sentence() -> None:
    with pytest.raises(FileAccessError, match="cobrra"):
        reduce_profile("cobrra")


def test_tables_are_frames(run: Run) -> None:
    assert list(run.commands) == ["t_s", "arm_rpm", "fork_deg", "cab_deg"]
    assert len(run.commands) == 101
    frame = run.to_pandas()
    assert isinstance(frame, pd.DataFrame)
    assert frame.index.name == "t_s"
    assert set(frame) == set(run.trajectory) - {"t_s"}
    modified = np.degrees(frame["modified_fork_rad"].to_numpy())
    np.testing.assert_allclose(modified, run.commands["fork_deg"], rtol=0, atol=1e-12)


def test_its_repr_is_a_line(run: Run) -> None:
    assert len(repr(run)) < 250
    assert repr(run).startswith("<Run small: converged, cross-coupling ")
    assert len(repr(run.details)) < 100
    assert "seat rate off by 10.0 %" in repr(run)


def test_a_notebook_shows_a_table_that_a_stranger_cannot_write_into() -> None:
    run = Run(make_run(11, name="<script>"))
    shown = run._repr_html_()
    assert "<script>" not in shown
    assert "&lt;script&gt;" in shown
    assert "<table>" in shown


def test_a_figure_is_shown_and_saved(run: Run, tmp_path: Path) -> None:
    picture = run.plot("limits")
    assert repr(picture) == "<Picture limits of small>"
    assert picture._repr_png_().startswith(b"\x89PNG")
    assert picture.save(tmp_path / "x.svg").read_bytes().startswith(b"<?xml")
    with pytest.raises(FileAccessError, match=r"x\.svg"):
        picture.save(tmp_path / "x.svg")
    with pytest.raises(UsageError, match="ends in"):
        picture.save(tmp_path / "x.gif")
    with pytest.raises(UsageError, match="small: 'joints' is no figure: felt, "):
        run.plot("joints")
    with pytest.raises(UsageError, match="small: has no figure 9: the run has no factor p"):
        run.plot("9")


def test_a_folder_is_a_run_and_a_file_its_table(run: Run, tmp_path: Path) -> None:
    folder = run.save(tmp_path / "run", plots=False)
    stored = read_run(folder)
    assert stored.metrics == json.loads(json.dumps(run.metrics))
    table = run.save(tmp_path / "table.parquet")
    one = parse_command_table(table.read_bytes(), "table")
    other = parse_command_table(stored.commands, "commands")
    np.testing.assert_array_equal(one.t, other.t)
    with pytest.raises(FileAccessError):
        run.save(folder)
    run.save(folder, plots=False, overwrite=True)
    with pytest.raises(UsageError, match=r"\.txt is no format of a table: \.csv"):
        run.save(tmp_path / "table.txt")


def test_nothing_is_written_that_is_not_released(path: Path, tmp_path: Path) -> None:
    settings = {"reduction.limits": "check", "reduction.control": "scalar", "reduction.r2": 1e-3}
    fast = {"joints.arm_rpm": "8 + 3*sin(6*t)"}
    run = reduce_profile(path, settings=settings | fast)
    assert not run.released
    assert run.refusal
    with pytest.raises(NotReleasedError):
        run.save(tmp_path / "run")
    assert not list(tmp_path.iterdir())
    assert "not released: " in run._repr_html_()
