"""Each layer imports only from its left, and the core touches nothing outside itself."""

import ast
import re
from pathlib import Path

import pytest

import des_cli

ROOT = Path(des_cli.__file__).parent
LAYERS = (
    ("errors", "units"),
    ("model",),
    ("kinematics",),
    ("solver", "study"),
    ("reduction",),
    ("verify", "results"),
    ("pipeline",),
    ("signals",),
    ("profiles_in", "runs_out", "show"),
    ("release",),
    ("batch", "tradeoff", "feed", "api"),
    ("cli", "__main__"),
)
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names}
CORE = LEVEL["pipeline"]
OUTSIDE = {"io", "logging", "os", "pathlib", "shutil", "subprocess", "sys", "tempfile"}
TOUCHING = {"open", "print", "input"}
MODULES = sorted(ROOT.rglob("*.py"))


def part(path: Path) -> str:
    return path.relative_to(ROOT).with_suffix("").parts[0]


def imports(tree: ast.AST) -> list[str]:
    names = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            names += [f"{node.module}.{alias.name}" for alias in node.names]
    return names


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_imports_only_from_the_left(path: Path) -> None:
    own = part(path)
    if own == "__init__":  # the public names, each imported on first use
        return
    assert own in LEVEL, f"{own} has no layer: add it to LAYERS and docs/architecture.md"
    for name in imports(ast.parse(path.read_text())):
        package, _, rest = name.partition(".")
        if package == "des_cli" and rest not in ("", "__version__"):
            assert LEVEL[rest.partition(".")[0]] <= LEVEL[own], f"{own} must not import {name}"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_core_opens_no_file_prints_nothing_and_reads_no_environment(path: Path) -> None:
    if part(path) == "__init__" or LEVEL[part(path)] > CORE:
        return
    tree = ast.parse(path.read_text())
    assert not {name.partition(".")[0] for name in imports(tree)} & OUTSIDE
    called = {
        node.func.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
    }
    assert not called & TOUCHING


def test_every_layer_exists() -> None:
    assert {part(path) for path in MODULES} - {"__init__"} == set(LEVEL)


def test_every_module_that_solves_is_in_the_architecture() -> None:
    page = (Path(__file__).parents[1] / "docs" / "architecture.md").read_text("utf-8")
    table = page.partition("## How a problem is solved")[2].partition("\n\n**")[0]
    rows = re.findall(r"^\| (`.+?) \|", table, re.M)
    named = [name for row in rows for name in re.findall(r"`(\w+)`", row)]
    rooms = ("solver", "study", "reduction")
    modules = {path.stem for room in rooms for path in (ROOT / room).rglob("*.py")} - {"__init__"}
    assert set(named) - set(rooms) == modules


@pytest.mark.parametrize("path", sorted((ROOT / "solver").glob("*.py")), ids=lambda p: p.name)
def test_the_solver_knows_no_centrifuge(path: Path) -> None:
    allowed = ("des_cli.model.arrays", "des_cli.model.solution", "des_cli.solver")
    inside = [n for n in imports(ast.parse(path.read_text())) if n.startswith("des_cli")]
    assert [name for name in inside if not name.startswith(allowed)] == []
