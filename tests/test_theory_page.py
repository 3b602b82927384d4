"""docs/theory.md and docs/nomenclature.md name what there is."""

import ast
import importlib
import re
from pathlib import Path

import pytest

from des_cli.kinematics.chain import Chain
from des_cli.model.machine import DHRow, JointLimits, Seat
from des_cli.model.motion import Motion
from des_cli.model.response import Response
from des_cli.study.state import StateReport

ROOT = Path(__file__).parents[1]
THEORY = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
NOMENCLATURE = (ROOT / "docs" / "nomenclature.md").read_text(encoding="utf-8")
CITED = sorted(set(re.findall(r"(tests/[\w/]+\.py)::(\w+)", THEORY)))
CLASSES = {each.__name__: each for each in (Chain, DHRow, JointLimits, Motion, Response, Seat)}


@pytest.mark.parametrize(("path", "name"), CITED, ids="::".join)
def test_cited_tests_exist(path: str, name: str) -> None:
    tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
    assert name in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}


def test_every_correction_is_cited() -> None:
    tree = ast.parse((ROOT / "tests" / "test_errata.py").read_text(encoding="utf-8"))
    tests = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    tests = {name for name in tests if name.startswith("test_")}
    assert tests == {name for path, name in CITED if path == "tests/test_errata.py"}


def test_equations_are_numbered_once_and_without_a_gap() -> None:
    blocks = re.findall(r"```text\n(.*?)```", THEORY, re.S)
    marked = [
        int(number) for block in blocks for number in re.findall(r"\(T(\d+)\)\s*$", block, re.M)
    ]
    assert sorted(marked) == list(range(1, len(marked) + 1))


def test_cited_equations_exist() -> None:
    last = max(int(number) for number in re.findall(r"\(T(\d+)\)", THEORY))
    texts = [NOMENCLATURE, *(path.read_text() for path in ROOT.glob("tests/test_errata.py"))]
    cited = {int(number) for text in texts for number in re.findall(r"\(T(\d+)\)", text)}
    assert cited
    assert max(cited) <= last


def test_names_in_code_exist() -> None:
    """``module.function`` and ``Class.field`` of the tables."""
    modules = {
        path.stem: ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for folder in ("study", "model", "kinematics")  # whose coriolis is meant
        for path in (ROOT / "des_cli" / folder).glob("*.py")
    } | {"units": "des_cli.units"}
    fields = set(StateReport.__dataclass_fields__)
    assert {f"StateReport.{name}" for name in fields} & set(
        re.findall(r"StateReport\.\w+", NOMENCLATURE)
    )
    checked = 0
    for owner, name in re.findall(r"`(\w+)\.(\w+)", NOMENCLATURE):
        if owner in modules:
            module = importlib.import_module(modules[owner])
            found = hasattr(module, name) or any(
                hasattr(each, name) for each in vars(module).values() if isinstance(each, type)
            )
            assert found or name in Chain.__dict__, f"{owner}.{name}"
            checked += 1
        elif owner in CLASSES:
            each = CLASSES[owner]
            assert name in each.__dataclass_fields__ or hasattr(each, name), f"{owner}.{name}"
            checked += 1
    assert checked > 20
