"""Nothing of the tool asks for a network, unless it is told of a scheduler."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

# Ends the process at the first name that is looked up, and at the first socket that is made:
# the interpreter tells of both, whoever does it.
OFFLINE = """
import os
import sys

def refuse(event, arguments):
    if event.startswith(("socket.", "urllib.", "http.", "ftplib.", "smtplib.", "webbrowser.")):
        os.write(2, f"asked for a network: {event} {arguments}".encode())
        os._exit(99)

sys.addaudithook(refuse)
"""

COMMANDS = """
from des_cli.cli.main import program

for line in (
    "reduce cobra_felt -o run --set time.step_s=0.1",
    "report run -o page.html",
    "reduce cobra cobra_table3 -o runs --set time.step_s=0.1 --no-plots --store store",
    "report --store store --where iterations>0",
    "verify run",
    "feed run --dry-run",
    "export run --preset ros2 -o run.yaml",
    "validate cobra",
    "sweep cobra -o curve.csv --set time.step_s=0.1 --budgets 0.02,0.05 --controls scalar",
    "kinematics cobra --format csv",
    "schema",
    "machines",
    "profiles",
    "new",
):
    try:
        program.main(line.split())
    except SystemExit as end:
        assert end.code == 0, (line, end.code)
"""


def run(script: str, tmp_path: Path, env: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env=env,
        check=False,
    )


@pytest.mark.slow
def test_no_command_asks_for_a_network(tmp_path: Path, python_environment: dict[str, str]) -> None:
    done = run(OFFLINE + COMMANDS, tmp_path, python_environment)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "page.html").exists()


def test_who_asked_would_be_seen(tmp_path: Path, python_environment: dict[str, str]) -> None:
    asking = "import socket\nsocket.socket()\n"
    assert run(OFFLINE + asking, tmp_path, python_environment).returncode == 99
