"""Reduce the Coriolis that a pilot feels in a three-axis human centrifuge.

The Python interface is two verbs::

    from des_cli import load_profile, reduce_profile

    run = reduce_profile("cobra_felt")
    run.metrics["coriolis"]["vector"]["reduction"]
    run.commands, run.trajectory                # pandas
    run.plot("felt")
    run.save("runs/cobra_felt")

All names are imported on first use, so that ``import des_cli`` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from des_cli.api.reduce import reduce_profile
    from des_cli.api.run import Run
    from des_cli.profiles_in.load import load_profile

__version__ = "0.1.0"

__all__ = ["Run", "__version__", "load_profile", "reduce_profile"]

_HOME = {
    "Run": "des_cli.api.run",
    "load_profile": "des_cli.profiles_in.load",
    "reduce_profile": "des_cli.api.reduce",
}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """List the public names, imported or not."""
    return sorted({*globals(), *__all__})
