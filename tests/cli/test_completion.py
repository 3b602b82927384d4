"""Shells complete what the tool knows: through click's own classes, as a shell would ask."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import click
import pytest
from click.shell_completion import CompletionItem, ShellComplete, get_completion_class

from des_cli.cli import completion
from des_cli.cli.completion_shells import register_shells
from des_cli.cli.main import COMMANDS, PROGRAM, program
from des_cli.model.machines import MACHINES
from des_cli.model.metric import METRICS
from des_cli.profiles_in.builtin import builtin_profiles
from des_cli.runs_out import manifest

VARIABLE = "_DES_CORIOLIS_COMPLETE"


def completed(*words: str) -> list[CompletionItem[str]]:
    *args, incomplete = words
    shell = ShellComplete(program, {}, PROGRAM, VARIABLE)
    return shell.get_completions(list(args), incomplete)


def values(*words: str) -> list[str]:
    return [item.value for item in completed(*words)]


def test_commands_without_importing_any(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("des_cli.cli.main.import_module", None)
    assert values("") == list(COMMANDS)
    assert values("re") == ["reduce", "report"]
    assert {"--log-format", "--version", "-V"} <= set(values("-"))
    assert [item.help for item in completed("schema")] == [COMMANDS["schema"]]


def test_built_in_profiles_and_the_files_beside_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("coil.yaml", "log.csv", "notes.txt"):
        (tmp_path / name).touch()
    known = [profile.name for profile in builtin_profiles()]
    assert values("reduce", "") == ["coil.yaml", "log.csv", *known]
    assert values("reduce", "cob") == ["cobra", "cobra_felt", "cobra_table3"]
    assert values("profiles", "") == known
    for command in ("reduce", "validate", "sweep", "kinematics"):
        assert "coil.yaml" in values(command, "co")
        (other,) = completed(command, "elsewhere/c")
        assert (other.type, other.value) == ("file", "elsewhere/c")


@pytest.mark.parametrize("command", ["reduce", "verify", "sweep"])
def test_machines(command: str) -> None:
    assert values(command, "--machine", "") == list(MACHINES)
    assert values(command, "--machine", "jo") == ["johnsville"]
    assert values("machines", "d") == [name for name in MACHINES if name.startswith("d")]


def test_metrics_of_budgets_with_their_units() -> None:
    assert values("reduce", "x", "--budget", "") == [f"{metric}=" for metric in METRICS]
    (item,) = completed("reduce", "x", "--budget", "seat_g_r")
    assert (item.value, item.help) == ("seat_g_rms_error_g=", "G error [g]")
    assert values("reduce", "x", "--budget", "seat_g_rms_error_g=0") == []
    assert values("sweep", "x", "--budgets", "attitude") == ["attitude_error_max_deg="]


def test_keys_and_their_words() -> None:
    assert values("reduce", "x", "--set", "reduction.me") == ["reduction.method="]
    assert values("reduce", "x", "--set", "reduction.axes=") == [
        *("reduction.axes=report", "reduction.axes=seat")
    ]
    assert "reduction.lead_in_s=" in values("reduce", "x", "--set", "reduction.")
    assert values("reduce", "x", "--set", "reduction.budget.attitude") == [
        "reduction.budget.attitude_error_max_deg="
    ]
    assert values("reduce", "x", "--grid", "budget.seat_r") == [
        "budget.seat_rate_deviation_relative="
    ]
    assert values("reduce", "x", "--grid", "control=free,") == [
        *("control=free,scalar", "control=free,per-joint")
    ]
    assert values("reduce", "x", "--axes", "") == ["report", "seat"]
    assert values("reduce", "x", "--grid", "r2=") == []


@pytest.mark.parametrize("key", completion._OTHER_KEYS)
def test_keys_that_are_offered_are_keys_of_a_profile(invoke, small: str, key: str) -> None:
    value = "1" if key == "time.stop_s" else "0.05" if key == "time.step_s" else "0"
    result = invoke("validate", small, "--set", f"{key}={value}")
    assert result.exit_code == 0, result.stderr


def test_figures_columns_conditions_and_lists() -> None:
    found = {item.value: item.help for item in completed("plot", "x", "--figure", "co")}
    assert list(found) == ["coriolis", "coriolis_components", "commands"]
    assert all(found.values())
    assert "t_s,arm_rad_s" in values("export", "x", "--columns", "t_s,arm")
    assert values("report", "--store", "s", "--where", "bb3") == ["bb3.reduction"]
    assert values("sweep", "x", "--controls", "free,p") == ["free,per-joint"]
    assert values("reduce", "x", "--euler", "x") == ["xyz", "xzy"]
    assert [item.type for item in completed("reduce", "x", "--store", "s")] == ["dir"]
    assert [item.type for item in completed("reduce", "x", "-o", "s")] == ["file"]


def test_run_folders_and_tables(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for folder in ("runs/a", "runs/b", "runs/none", "mine"):
        (tmp_path / folder).mkdir(parents=True)
    for folder in ("runs/a", "runs/b", "mine"):
        (tmp_path / folder / completion.MANIFEST).touch()
    (tmp_path / "commands.csv").touch()
    assert values("plot", "") == values("report", "") == ["mine", "runs/a", "runs/b"]
    assert values("plot", "runs/b") == ["runs/b"]
    assert values("plot", "./m") == ["./mine"]
    assert values("verify", "") == ["mine", "runs/a", "runs/b", "commands.csv"]
    assert [item.type for item in completed("feed", "elsewhere")] == ["file"]


def test_a_run_is_told_by_its_manifest() -> None:
    assert completion.MANIFEST == manifest.MANIFEST


Asked = Callable[[str, str, int], list[str]]


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> Asked:
    """Ask as the script of a shell does."""
    register_shells()

    def ask(shell: str, words: str, at: int) -> list[str]:
        monkeypatch.setenv("COMP_WORDS", words)
        monkeypatch.setenv("COMP_CWORD", str(at))
        found = get_completion_class(shell)
        assert found is not None
        return found(program, {}, PROGRAM, VARIABLE).complete().splitlines()

    return ask


@pytest.mark.parametrize(
    ("words", "at", "told"),
    [
        ("x reduce y --set reduction.axes =", 5, ["report", "seat"]),
        ("x reduce y --set reduction.axes = se", 6, ["seat"]),
        ("x reduce y --axes = se", 5, ["seat"]),
        ("x reduce y --grid = control = free,p", 7, ["free,per-joint"]),
        ("x reduce y --budget seat_g_r", 4, ["seat_g_rms_error_g="]),
    ],
)
def test_bash_cuts_words_at_equals(asked: Asked, words: str, at: int, told: list[str]) -> None:
    assert asked("bash", words, at) == [f"plain,{value}" for value in told]


@pytest.mark.parametrize(
    ("shell", "added"),
    [
        ("bash", "compopt -o nospace"),
        ("zsh", "compadd -U -S '' --"),
        ("fish", 'string split -m 1 ","'),
    ],
)
def test_the_scripts_set_no_space_after_a_key_and_keep_lists_whole(
    shell: str, added: str, python_environment: dict[str, str]
) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "des_cli"],
        env=python_environment | {VARIABLE: f"{shell}_source"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert added in done.stdout
    assert f"{VARIABLE}={shell}_complete" in done.stdout


@pytest.mark.parametrize("line", ["reduce co", "reduce x --budget s", "plot r", "sweep x --grid "])
def test_completing_imports_nothing_heavy(
    line: str, tmp_path: Path, python_environment: dict[str, str]
) -> None:
    code = (
        "import sys\nfrom des_cli.cli.main import main\n"
        "try:\n    main()\nfinally:\n"
        "    heavy = {'numpy', 'pydantic', 'ruamel.yaml', 'matplotlib', 'pyarrow'}\n"
        "    print(*heavy & set(sys.modules), file=sys.stderr)\n"
    )
    words = f"x {line}"
    asking = {VARIABLE: "zsh_complete", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=python_environment | asking | {"PATH": os.environ["PATH"]},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr.strip()) == (0, "")


def test_what_is_offered_is_taken(invoke) -> None:
    """An option that completes a word takes it."""
    for name in COMMANDS:
        command = program.get_command(click.Context(program), name)
        assert command is not None
        for parameter in command.params:
            if isinstance(parameter.type, click.Choice) and isinstance(parameter, click.Option):
                offered = values(name, parameter.opts[0], "")
                assert set(offered) <= {str(each) for each in parameter.type.choices}
