"""The checks of the project, one session each.

``nox`` runs what a change has to pass; ``nox -s NAME -- ARGUMENTS`` one session, its
tool called with these arguments. ``nox --list`` says what there is.

Every session runs in the environment that nox itself is installed in, made from
``requirements-test.lock`` (see README.md): what is locked is what checks, and no session
spends time on an environment of its own.
"""

from __future__ import annotations

import sys

import nox

nox.needs_version = ">=2024.10.9"
nox.options.default_venv_backend = "none"
nox.options.sessions = ["lint", "types", "docs", "full"]

# Numerical libraries with a thread for each core, in a test process for each core, would
# stand in each other's way.
ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}


def _module(session: nox.Session, *command: str, env: dict[str, str] | None = None) -> None:
    """Run a module with the interpreter of this environment, activated or not."""
    session.run(sys.executable, "-m", *command, env=env)


@nox.session
def lint(session: nox.Session) -> None:
    """Rules of style and the format, of code and tests."""
    _module(session, "ruff", "check", ".")
    _module(session, "ruff", "format", "--check", ".")


@nox.session
def types(session: nox.Session) -> None:
    """Types: strict in the core, see pyproject.toml."""
    _module(session, "mypy", *session.posargs)


@nox.session
def docs(session: nox.Session) -> None:
    """Links, commands, options, keys and columns of the pages."""
    session.run(sys.executable, "scripts/check_docs.py")


@nox.session
def site(session: nox.Session) -> None:
    """Build the documentation as a site, in build/site; a warning fails."""
    # Anew: pages that did not change would keep the navigation of the last time.
    how = ["--fresh-env", "--write-all", "--fail-on-warning", "--keep-going", "--quiet"]
    _module(session, "sphinx", *how, "-c", "docs", "-d", "build/doctrees", ".", "build/site")


@nox.session
def tests(session: nox.Session) -> None:
    """The fast loop: every test that is not marked slow."""
    _pytest(session, "-m", "not slow")


@nox.session
def full(session: nox.Session) -> None:
    """All tests."""
    _pytest(session)


@nox.session
def browser(session: nox.Session) -> None:
    """Try the page in Chromium, with ``pip install -e '.[browser]'``; without, all is skipped."""
    _module(session, "pytest", "-m", "browser", "tests/show/browser", *session.posargs)


@nox.session
def coverage(session: nox.Session) -> None:
    """All tests, with the branches of des_cli that they take."""
    _pytest(session, "--cov", "--cov-branch", "--cov-report=term:skip-covered")


@nox.session
def mutation(session: nox.Session) -> None:
    """Whether the tests of verify see faults in it; arguments go to scripts/mutate.py."""
    session.run(sys.executable, "scripts/mutate.py", *session.posargs, env=ONE_THREAD)


def _pytest(session: nox.Session, *options: str) -> None:
    """Run tests on all cores, a file on one of them; arguments after ``--`` go to pytest."""
    # A file's fixtures and cached solutions are computed once, by the one worker that has it.
    parallel = ["--numprocesses=auto", "--dist=loadfile"]
    _module(session, "pytest", *parallel, *options, *session.posargs, env=ONE_THREAD)
