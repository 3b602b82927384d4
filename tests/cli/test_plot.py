"""``plot``: one figure of a run."""

from pathlib import Path

import pytest

from des_cli.cli.plot import FIGURES


@pytest.fixture
def run_folder(invoke, write_profile) -> str:
    assert invoke("-q", "reduce", write_profile("one").name, "--no-plots").exit_code == 0
    return "runs/one"


def test_the_names_of_the_help_are_those_that_can_be_drawn() -> None:
    from des_cli.show.plots import figures

    assert set(FIGURES) == set(figures.FIGURES)


@pytest.mark.parametrize(
    ("suffix", "start"), [("svg", b"<?xml"), ("pdf", b"%PDF"), ("png", b"\x89PNG")]
)
def test_the_ending_is_the_format(
    invoke, run_folder: str, tmp_path: Path, suffix: str, start: bytes
) -> None:
    target = tmp_path / f"fig.{suffix}"
    target.write_text("old")
    result = invoke("plot", run_folder, "--figure", "10", "-o", target.name)
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr == f"fig.{suffix}: exists; --overwrite replaces it\n"
    assert target.read_text() == "old"
    result = invoke("plot", run_folder, "--figure", "10", "-o", target.name, "--overwrite")
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr == f"figure 10 in fig.{suffix}\n"
    assert target.read_bytes().startswith(start)


def test_without_a_file_it_has_the_figures_name(invoke, run_folder: str, tmp_path: Path) -> None:
    assert invoke("plot", run_folder, "--figure", "limits").exit_code == 0
    assert (tmp_path / "limits.svg").read_bytes().startswith(b"<?xml")


def test_standard_output(invoke, run_folder: str) -> None:
    result = invoke("plot", run_folder, "--figure", "7", "-o", "-", "-f", "pdf")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout_bytes.startswith(b"%PDF")
    assert invoke("plot", run_folder, "-o", "-").stdout_bytes.startswith(b"\x89PNG")


def test_what_cannot_be_drawn_is_wrong_use(invoke, run_folder: str, tmp_path: Path) -> None:
    for out, said in (
        ("x.gif", "a figure's file ends in .svg, .pdf or .png"),
        ("x", "a figure's file ends in .svg, .pdf or .png"),
    ):
        result = invoke("plot", run_folder, "-o", out)
        assert result.exit_code == 2
        assert said in result.stderr
    result = invoke("plot", run_folder, "-o", "x.svg", "-f", "png")
    assert result.exit_code == 2
    assert "x.svg is no png" in result.stderr
    assert not list(tmp_path.glob("x*"))


def test_a_free_motion_has_no_factor(invoke, write_profile) -> None:
    arguments = ("--control", "free", "--axes", "seat", "--limits", "enforce", "--no-plots")
    budget = ("--budget", "seat_g_rms_error_g=0.05", "--budget", "seat_rate_deviation_relative=0.1")
    profile = write_profile("free").name
    assert invoke("-q", "reduce", profile, *arguments, *budget).exit_code == 0
    result = invoke("plot", "runs/free", "--figure", "9")
    assert result.exit_code == 2
    assert result.stderr.startswith("runs/free: has no figure 9: the run has no factor p, ")


def test_no_run_is_1(invoke) -> None:
    result = invoke("plot", "nowhere")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr.startswith("nowhere")
