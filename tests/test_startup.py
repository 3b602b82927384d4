"""Start-up is lean: what a command does not need, it does not import."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import click
import pytest

from des_cli.cli.main import COMMANDS, program
from des_cli.model.run import Run
from des_cli.runs_out.run_folder import write_run

# Runs the command line in a fresh interpreter and prints, as the last line of
# stderr, which of the watched modules it imported.
WATCH = """
import sys
from des_cli.cli.main import main
try:
    main()
finally:
    watched = {watched!r}
    print("imported:", *sorted(watched & set(sys.modules)), file=sys.stderr)
"""


def imported(watched: set[str], *args: str, cwd: Path, env: dict[str, str]) -> set[str]:
    done = subprocess.run(
        [sys.executable, "-c", WATCH.format(watched=watched), *args],
        capture_output=True,
        text=True,
        cwd=cwd,
        env=env,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    label, *names = done.stderr.splitlines()[-1].split()
    assert label == "imported:"
    return set(names)


@pytest.fixture
def one_run(tmp_path: Path, synthetic_run: Callable[..., Run]) -> None:
    """Write a run without figures into the folder ``run``."""
    write_run(synthetic_run(), tmp_path / "run", plots=False)


@pytest.mark.parametrize(
    "args",
    [
        ["--help"],
        ["--version"],
        ["reduce", "--help"],
        ["report", "--help"],
        ["sweep", "--help"],
        ["validate", "--help"],
        ["verify", "--help"],
        ["new", "--help"],
        ["profiles", "--help"],
        ["kinematics", "--help"],
        ["machines", "--help"],
        ["schema", "--help"],
        ["feed", "--help"],
        ["export", "--help"],
    ],
    ids=" ".join,
)
def test_help_leaves_numpy_unimported(
    args: list[str], tmp_path: Path, python_environment: dict[str, str]
) -> None:
    heavy = {"numpy", "scipy", "pandas", "pyarrow", "matplotlib", "pydantic", "ruamel.yaml"}
    heavy |= {"dask", "distributed", "openpyxl", "mcap", "bokeh", "jinja2"}
    assert imported(heavy, *args, cwd=tmp_path, env=python_environment) == set()


def test_help_says_of_each_command_what_that_says_of_itself_and_imports_none(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    modules = {f"des_cli.cli.{name}" for name in COMMANDS}
    assert imported(modules, "--help", cwd=tmp_path, env=python_environment) == set()
    for name, said in COMMANDS.items():
        command = program.get_command(click.Context(program), name)
        assert command is not None
        assert command.get_short_help_str(limit=200) == said


def test_factors_leave_the_free_motion_and_filters_unimported(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    watched = {"des_cli.reduction.free.method", "des_cli.reduction.g_profile"}
    watched |= {"scipy.signal", "scipy.interpolate", "dask", "distributed"}
    args = ["reduce", "cobra", "--set", "time.step_s=0.25", "-o", "x.csv"]
    assert imported(watched, *args, cwd=tmp_path, env=python_environment) == set()


@pytest.mark.usefixtures("one_run")
def test_a_page_leaves_matplotlib_and_the_python_of_bokeh_unimported(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    watched = {"matplotlib", "bokeh", "scipy.integrate", "jinja2"}
    args = ["report", "run", "-o", "page.html"]
    assert imported(watched, *args, cwd=tmp_path, env=python_environment) == {"jinja2"}


def test_package_leaves_numpy_unimported(python_environment: dict[str, str]) -> None:
    code = "import sys, des_cli; sys.exit('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], env=python_environment, check=False)
    assert done.returncode == 0


def test_a_csv_table_leaves_pandas_and_matplotlib_unimported(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    watched = {"numpy", "pandas", "matplotlib", "pyarrow", "scipy.integrate"}
    args = ["reduce", "cobra", "--set", "time.step_s=0.25", "-o", "x.csv"]
    assert imported(watched, *args, cwd=tmp_path, env=python_environment) == {"numpy"}
    assert (tmp_path / "x.csv").read_text().startswith("t_s,arm_rpm,fork_deg,cab_deg\n")
