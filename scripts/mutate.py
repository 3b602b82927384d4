"""Whether the tests of ``verify`` see what goes wrong in it: one fault at a time, none in a file.

    python scripts/mutate.py --count 300 --seed 1
    python scripts/mutate.py --module budgets --count 0      # all of one module

A mutant is a module of ``des_cli.verify`` with one small fault: a comparison turned, a
constant a thousand times as large, a sign or an operator changed, a call or a statement left
out, another value returned. It exists in the memory of a process of its own, in which the
tests of ``verify`` run until one fails, the module's own first. A mutant with which all of
them pass has survived: a fault that nobody would see. The score is the share that did not.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import importlib.abc
import importlib.machinery
import importlib.util
import os
import pkgutil
import random
import resource
import signal
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
SOURCE, TESTS = ROOT / "des_cli" / "verify", ROOT / "tests" / "verify"
PRELOADED = ("des_cli.kinematics", "des_cli.reduction", "des_cli.results", "des_cli.study")
"""Imported once, before the mutants' processes part: all that no mutant is of."""

CPU_S = 120
"""Of one mutant. The tests take a tenth of it: more is a loop without an end."""

LEAST_SCORE = 0.95
PASSED, NO_TESTS = 0, 5

COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.GtE,
    ast.LtE: ast.Gt,
    ast.Gt: ast.LtE,
    ast.GtE: ast.Lt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
}
CONVERSIONS = {
    *("np.asarray", "np.array", "MappingProxyType"),
    *("float", "int", "bool", "str", "tuple", "list"),
}
"""Calls that change a type and no value: without them the tests see the same."""

TINY = 1e-200
"""Constants below keep a quotient finite, whatever their size."""

OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
}


@dataclass(frozen=True)
class Mutant:
    """A module with one fault.

    Parameters
    ----------
    module : str
        Without the package.
    line : int
    fault : str
        What is wrong there.
    node, number : int
        The node of the tree, in the order of a walk, and which of its faults.
    """

    module: str
    line: int
    fault: str
    node: int
    number: int

    def __str__(self) -> str:
        return f"{self.module}.py:{self.line}: {self.fault}"

    @property
    def path(self) -> Path:
        """Where the module is without a fault."""
        return SOURCE / f"{self.module}.py"

    def tree(self) -> ast.Module:
        """Return the module with its fault."""
        tree = ast.parse(self.path.read_text(encoding="utf-8"))
        node = next(node for i, node in enumerate(ast.walk(tree)) if i == self.node)
        new = list(_faults(node))[self.number][1](node)
        _Put(node, new).visit(tree)
        return ast.fix_missing_locations(tree)


def mutants_of(path: Path) -> list[Mutant]:
    """Return all mutants of a module, in the order of its lines."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    unread = _unread(tree)
    found = [
        Mutant(path.stem, node.lineno, fault, index, number)
        for index, node in enumerate(ast.walk(tree))
        if hasattr(node, "lineno") and id(node) not in unread
        for number, (fault, _) in enumerate(_faults(node))
    ]
    return sorted(found, key=lambda mutant: mutant.line)


class _Put(ast.NodeTransformer):
    """Put a node in another's place."""

    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self.old, self.new = old, new

    def visit(self, node: ast.AST) -> ast.AST:
        return self.new if node is self.old else self.generic_visit(node)


def _unread(tree: ast.Module) -> set[int]:
    """Return the nodes that change no result: types, documentation, errors, strict zips."""
    unread: set[int] = set()
    for node in ast.walk(tree):
        parts: list[ast.AST | None] = []
        match node:
            case ast.FunctionDef():
                arguments = node.args
                every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
                parts = [node.returns, *(a.annotation for a in every), *node.decorator_list]
            case ast.ClassDef():
                parts = list(node.decorator_list)
            case ast.AnnAssign(annotation=ast.Name(id="TypeAlias")):
                parts = [node]
            case ast.AnnAssign():
                parts = [node.annotation]
            case ast.keyword(arg="strict"):
                parts = [node.value]  # lengths that differ are a fault of another place
            case ast.Expr(value=ast.Constant()) | ast.Raise():
                parts = [node]
        unread |= {id(inner) for part in parts if part for inner in ast.walk(part)}
    return unread


Make = Callable[[Any], ast.AST]


def _faults(node: ast.AST) -> Iterator[tuple[str, Make]]:
    """Yield what can be wrong at a node, and what makes it so."""
    text = ast.unparse(node).split("\n", 1)[0]
    match node:
        case ast.Compare(ops=[op, *_]) if type(op) in COMPARISONS:
            turned = COMPARISONS[type(op)]()
            yield f"comparison turned: {text}", lambda n: _with(n, ops=[turned, *n.ops[1:]])
        case ast.BinOp(op=op) | ast.AugAssign(op=op) if type(op) in OPERATORS:
            other = OPERATORS[type(op)]()
            yield f"operator changed: {text}", lambda n: _with(n, op=other)
        case ast.BoolOp(op=op):
            swapped = ast.Or() if isinstance(op, ast.And) else ast.And()
            yield f"and, or swapped: {text}", lambda n: _with(n, op=swapped)
        case ast.UnaryOp():
            yield f"sign or negation left out: {text}", lambda n: n.operand
        case ast.Constant(value=bool(value)):
            yield f"turned: {text}", lambda n: ast.Constant(not value)
        case ast.Constant(value=int(value)) if abs(value) < 10:
            yield f"one more: {text}", lambda n: ast.Constant(value + 1)
        case ast.Constant(value=float(value)) if value == 0.0:
            yield f"one: {text}", lambda n: ast.Constant(1.0)
        case ast.Constant(value=int(value) | float(value)) if value > TINY:
            yield f"times 1000: {text}", lambda n: ast.Constant(1000 * value)
        case ast.Call(func=called, args=[first, *_]) if (
            not isinstance(first, ast.Starred) and ast.unparse(called) not in CONVERSIONS
        ):
            yield f"call left out: {text}", lambda n: n.args[0]
        case ast.Return(value=ast.expr()):
            yield f"nothing returned: {text}", lambda n: ast.Return(ast.Constant(None))
    match node:
        case ast.Expr() | ast.AugAssign():
            yield f"left out: {text}", lambda n: ast.Pass()
        case ast.If():
            yield f"never: {text}", lambda n: _with(n, test=ast.Constant(False))
            yield f"always: {text}", lambda n: _with(n, test=ast.Constant(True))
        case ast.IfExp():
            yield f"never: {text}", lambda n: n.orelse
            yield f"always: {text}", lambda n: n.body


def _with(node: ast.AST, **fields: object) -> ast.AST:
    for name, value in fields.items():
        setattr(node, name, value)
    return node


class _Instead(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Import a mutant where its module is asked for."""

    def __init__(self, mutant: Mutant) -> None:
        self.name, self.mutant = f"des_cli.verify.{mutant.module}", mutant

    def find_spec(
        self, name: str, path: object = None, target: object = None
    ) -> importlib.machinery.ModuleSpec | None:
        if name != self.name:
            return None
        return importlib.util.spec_from_file_location(name, self.mutant.path, loader=self)

    def exec_module(self, module: ModuleType) -> None:
        exec(compile(self.mutant.tree(), str(self.mutant.path), "exec"), module.__dict__)


def preload() -> None:
    """Import what all mutants share."""
    for package in PRELOADED:
        folder = importlib.import_module(package)
        for module in pkgutil.walk_packages(folder.__path__, f"{package}."):
            importlib.import_module(module.name)
    for name in ("pytest", "scipy.optimize", "scipy.linalg", "scipy.integrate"):
        importlib.import_module(name)
    early = [name for name in sys.modules if name.startswith("des_cli.verify.")]
    assert not early, f"imported before it is changed: {early}"


def tests_of(module: str) -> list[str]:
    """Return the files of tests, the module's own first."""
    own = TESTS / f"test_{module}.py"
    return [str(p) for p in sorted(TESTS.glob("test_*.py"), key=lambda p: (p != own, p.name))]


def start(mutant: Mutant | None) -> int:
    """Start the tests on a mutant, or on the modules as they are; return the process."""
    process = os.fork()
    if process:
        return process
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S))
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    code = 70
    try:
        import pytest

        if mutant:
            sys.meta_path.insert(0, _Instead(mutant))
        quiet = ["-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "--no-header"]
        code = int(pytest.main([*quiet, *tests_of(mutant.module if mutant else "verify")]))
    finally:
        os._exit(code)


def survived(status: int) -> bool:
    """Return whether all tests passed in a process that ended."""
    code = os.waitstatus_to_exitcode(status)
    assert code != NO_TESTS, "no tests were found"
    return code == PASSED


def run(mutants: list[Mutant], jobs: int) -> tuple[int, list[Mutant]]:
    """Return how many mutants were tried and those that survive, and say them as they do.

    An interrupt ends it early: the first of a random sample are one too.
    """
    _, status = os.waitpid(start(None), 0)
    assert survived(status), "the tests fail without any fault"
    running: dict[int, Mutant] = {}
    waiting, alive = list(reversed(mutants)), []
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                mutant = waiting.pop()
                running[start(mutant)] = mutant
            process, status = os.wait()
            mutant = running.pop(process)
            if survived(status):
                alive.append(mutant)
                print(f"survived: {mutant}", flush=True)
    except KeyboardInterrupt:
        for process in running:
            os.kill(process, signal.SIGKILL)
    return len(mutants) - len(waiting) - len(running), alive


def main() -> int:
    """Draw mutants, run the tests on each, and return 1 where too many survive."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--module", action="append", help="only of this one; repeatable")
    parser.add_argument("--count", type=int, default=300, help="how many are drawn; 0: all")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    os.chdir(ROOT)
    sys.path.insert(0, str(ROOT))
    preload()
    names = options.module or sorted(p.stem for p in SOURCE.glob("[!_]*.py"))
    mutants = [mutant for name in names for mutant in mutants_of(SOURCE / f"{name}.py")]
    total = len(mutants)
    if options.count and options.count < total:
        mutants = random.Random(options.seed).sample(mutants, options.count)
    tried, alive = run(mutants, options.jobs)
    score = 1.0 - len(alive) / max(tried, 1)
    print(f"{tried} of {total} mutants, {len(alive)} survived: {100.0 * score:.1f} %")
    return int(score < LEAST_SCORE)


if __name__ == "__main__":
    sys.exit(main())
