"""Nothing that others named moves a terminal or makes a line of its own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from des_cli.cli.terminal import printable
from des_cli.runs_out.run_folder import write_run

FORGED = "x\n  written        safe\x1b[2K\u202e"


@pytest.mark.parametrize("text", ["", "plain, 5 µm → rad/s²", "日本"])
def test_what_can_be_seen_stays(text: str) -> None:
    assert printable(text) == text


def test_what_cannot_be_seen_is_written_out() -> None:
    assert printable(FORGED) == "x\\n  written        safe\\x1b[2K\\u202e"
    assert printable("\udcff\x9b") == "\\udcff\\x9b"


@pytest.mark.parametrize(
    "args",
    [
        ["reduce", "small.yaml", "--no-plots", "-o", FORGED],
        ["reduce", "small.yaml", "--no-plots", "-o", f"{FORGED}/x.csv"],
        ["reduce", FORGED],
        ["reduce", "small.yaml", "--machine", FORGED],
        ["reduce", "small.yaml", "--set", f"{FORGED}=1"],
        ["reduce", "small.yaml", f"--{FORGED}"],
        ["reduce", "small.yaml", "--jobs", FORGED],
        ["reduce", "small.yaml", "--dry-run", "-o", FORGED],
        ["reduce", "small.yaml", "-o", f"{FORGED}.csv", "-f", "json"],
        ["report", FORGED],
        ["report", "run", "-o", FORGED],
        ["validate", FORGED, f"{FORGED}.yaml"],
        ["sweep", "small.yaml", "--plot", f"{FORGED}/x.png"],
        ["machines", FORGED],
        ["profiles", FORGED],
        ["kinematics", FORGED],
        [FORGED],
    ],
    ids=lambda args: f"{args[0]} {len(args)}".split("\n")[0],
)
def test_no_command_prints_a_control_character(
    invoke, small: str, tmp_path: Path, synthetic_run, args: list[str]
) -> None:
    good = (tmp_path / small).read_text()
    (tmp_path / f"{FORGED}.yaml").write_text(good)
    write_run(synthetic_run(11), tmp_path / "run", plots=False)
    result = invoke("--color", "always", *args)
    words = result.stderr.replace("\x1b[0m", "")
    for code in ("1", "2", "31", "32", "33"):  # the styles of the console
        words = words.replace(f"\x1b[{code}m", "")
    for text in (words, result.stdout):
        assert all(line.isprintable() for line in text.split("\n"))
        assert "  written        safe" not in text.splitlines()
    assert "\\u202e" in words + result.stdout


def run_with_words_to(
    folder: Path, env: dict[str, str], name: str, *args: str
) -> subprocess.CompletedProcess[bytes]:
    if name == "closed":
        line = ["sh", "-c", 'exec "$0" -m des_cli "$@" 2>&-', sys.executable, *args]
        return subprocess.run(line, stdout=subprocess.PIPE, cwd=folder, env=env, check=False)
    line = [sys.executable, "-m", "des_cli", *args]
    if name == "full":
        with open("/dev/full", "wb") as full:
            return subprocess.run(
                line, stdout=subprocess.PIPE, stderr=full, cwd=folder, env=env, check=False
            )
    read, write = os.pipe()
    os.close(read)
    try:
        return subprocess.run(
            line, stdout=subprocess.PIPE, stderr=write, cwd=folder, env=env, check=False
        )
    finally:
        os.close(write)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
@pytest.mark.parametrize("words", ["full", "closed", "unread"])
@pytest.mark.parametrize(
    ("args", "code"),
    [
        (["reduce", "small.yaml", "-o", "-"], 0),
        (["validate", "absent.yaml"], 1),
        (["reduce", "--absent"], 2),
        (["reduce", "small.yaml", "--set", "machine=absent"], 3),
    ],
    ids=["0", "1", "2", "3"],
)
def test_words_that_cannot_be_told_change_no_exit_code(
    small: str,
    tmp_path: Path,
    python_environment: dict[str, str],
    words: str,
    args: list[str],
    code: int,
) -> None:
    done = run_with_words_to(tmp_path, python_environment, words, *args)
    assert done.returncode == code
    assert done.stdout.startswith(b"t_s,") is (code == 0)


LOOKING = """
import os
from des_cli.__main__ import main
from des_cli.batch import worker
from des_cli.cli import main as command

def note(name):
    with open(name, "w") as file:
        file.write(" ".join(os.path.realpath(f"/proc/self/fd/{number}") for number in range(3)))

class Workers(command.Program):
    def _dispatch(self, args, name, console):
        note("here.txt")
        from des_cli.batch.pool import local_executor
        with local_executor(2) as pool:
            pool.submit(os.system, "readlink /proc/$$/fd/0 /proc/$$/fd/1 /proc/$$/fd/2 > there.txt")
        return super()._dispatch(args, name, console)

if __name__ == "__main__":
    command.program.__class__ = Workers
    main()
"""


@pytest.mark.skipif(not os.path.exists("/proc/self/fd"), reason="needs Linux's /proc")
@pytest.mark.parametrize("closed", ["<&-", ">&-", "2>&-", "<&- >&- 2>&-"])
def test_no_file_takes_the_place_of_a_stream_that_is_closed(
    small: str, tmp_path: Path, python_environment: dict[str, str], closed: str
) -> None:
    (tmp_path / "look.py").write_text(LOOKING)
    line = f'exec "$0" look.py reduce {small} -o o.csv </dev/null >/dev/null 2>&1 {closed}'
    done = subprocess.run(
        ["sh", "-c", line, sys.executable], cwd=tmp_path, env=python_environment, check=False
    )
    assert done.returncode == 0
    assert (tmp_path / "here.txt").read_text().split() == ["/dev/null"] * 3
    assert (tmp_path / "there.txt").read_text().split()[::2] == ["/dev/null"] * 2
    assert (tmp_path / "o.csv").read_bytes().startswith(b"t_s,")
