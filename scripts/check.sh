#!/bin/sh
# Check everything, stopping at the first check that fails.
#
#   sh scripts/check.sh            from a clean clone or a working tree
#
# Needs Python 3.11 or newer and a package index; makes .venv by itself.
set -eu
cd "$(dirname "$0")/.."

say() { printf '\n== %s\n' "$*"; }

say "environment"
if [ ! -x .venv/bin/python ]; then
    if command -v python3.11 >/dev/null 2>&1 && python3.11 -c '' >/dev/null 2>&1; then
        python=python3.11
    else
        python=python3
    fi
    "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || {
        echo "Python 3.11 or newer is needed, and $python is older" >&2
        exit 1
    }
    "$python" -m venv .venv
fi
.venv/bin/python -m pip install --quiet --require-hashes -r requirements-test.lock
.venv/bin/python -m pip install --quiet --no-deps --no-build-isolation --editable .
.venv/bin/des-coriolis --version

say "lint"
.venv/bin/ruff check .

say "format"
.venv/bin/ruff format --check .

say "types"
.venv/bin/mypy

say "docs"
.venv/bin/python scripts/check_docs.py

say "tests"
.venv/bin/python -m pytest
