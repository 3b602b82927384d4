"""A state on the command line, and what ``kinematics`` says of it."""

from __future__ import annotations

import json
from typing import Any

SPIN = ["--arm-rad-s", "2", "--fork-deg", "40", "--fork-rad-s", "-0.5", "--cab-rad-s", "1"]


def of(invoke: Any, *args: str) -> dict[str, Any]:
    result = invoke("kinematics", *args, "--format", "json")
    assert (result.exit_code, result.stderr) == (0, "")
    return json.loads(result.stdout)
