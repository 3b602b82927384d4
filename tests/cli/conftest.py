"""A small profile, and the command line without a process of its own."""

from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from des_cli.cli.main import program

# The Cobra's first second, coarsely sampled: it keeps every limit and solves at once.
SMALL = """\
format: des-coriolis/1
name: {name}
machine: des
initial: {{arm_deg: 0}}
time: {{start_s: 0, stop_s: 1, step_s: 0.05}}
joints:
  arm_rpm: "8.8 - 0.66*t"
  fork_deg: "-60*(1 - cos(pi*t/5))"
  cab_deg: "30 - 2.5*t"
reduction:
  axes: report
  control: scalar
  r1: [0, 2, 0]
  r2: 1
  limits: warn
"""

Invoke = Callable[..., Result]


@pytest.fixture
def invoke(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Invoke:
    """Run a command line in the test's folder; stdout and stderr stay apart."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DES_CORIOLIS_DEBUG", raising=False)

    def run(*args: str, **options: object) -> Result:
        return CliRunner().invoke(program, list(args), **options)  # type: ignore[arg-type]

    return run


@pytest.fixture
def write_profile(tmp_path: Path) -> Callable[..., Path]:
    """Write a small profile into the test's folder, with lines replaced as asked."""

    def write(name: str = "small", **lines: str) -> Path:
        text = SMALL.format(name=name)
        for key, value in lines.items():
            old = next(line for line in text.splitlines() if line.strip().startswith(f"{key}:"))
            text = text.replace(old, f"{old[: len(old) - len(old.lstrip())]}{key}: {value}")
        path = tmp_path / f"{name}.yaml"
        path.write_text(text)
        return path

    return write


@pytest.fixture
def small(write_profile: Callable[..., Path]) -> str:
    """The name of a profile file in the test's folder."""
    return write_profile().name
