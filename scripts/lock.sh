#!/bin/sh
# Write both lock files anew from pyproject.toml; needs uv on the path.
#
#   sh scripts/lock.sh             keep what is locked, add what is new
#   sh scripts/lock.sh --upgrade   take the newest of everything
set -eu
cd "$(dirname "$0")/.."

lock() {
    out=$1
    shift
    # The build backend is locked too: the project installs without isolation. Extras stay in the names:
    # where a package needs coverage[toml], pip does not take a pinned `coverage` for it.
    printf 'hatchling\neditables\n' |
        uv pip compile --quiet --universal --python-version 3.11 --generate-hashes \
            --no-header --no-annotate --no-strip-extras --no-emit-index-url --output-file "$out" "$@" \
            pyproject.toml - >/dev/null
}

lock requirements.lock "$@"
lock requirements-test.lock --extra test --extra docs --extra cluster --extra mcap --extra xlsx "$@"
