"""What the moving picture of a run needs to know of its machine."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from des_cli.errors import DesError
from des_cli.kinematics.chain import Chain, chain_of
from des_cli.model.machine import JOINTS, Joint, Machine, Seat
from des_cli.model.metrics import Metrics
from des_cli.profiles_in.machine_yaml import parse_machine


@dataclass(frozen=True, slots=True)
class MachineView:
    """A machine as a run has it.

    Parameters
    ----------
    machine : Machine
    before, after : Seat
        As the profile has the seat, and as the run has it.
    """

    machine: Machine
    before: Seat
    after: Seat

    @property
    def angle_limits(self) -> dict[Joint, float]:
        """Of each joint [rad]."""
        limits = zip(JOINTS, self.machine.limits, strict=True)
        return {joint: limit.angle for joint, limit in limits}

    def chains(self) -> dict[str, Any]:
        """Return the constant transforms and the signs of both chains, as plain lists [m]."""
        return {
            "before": _plain(chain_of(self.machine, self.before)),
            "after": _plain(chain_of(self.machine, self.after)),
        }


def machine_view(manifest: Mapping[str, Any], metrics: Metrics) -> MachineView | None:
    """Return the machine of a run, None where its manifest does not say it.

    Parameters
    ----------
    manifest : mapping
        The content of ``manifest.json``; those of earlier versions have no machine.
    metrics : Metrics
    """
    rows, seat = manifest.get("machine"), manifest.get("seat")
    if not isinstance(rows, dict) or not isinstance(seat, dict):
        return None
    yaw, pitch = seat.get("yaw_rad"), seat.get("pitch_rad")
    if not isinstance(yaw, float | int) or not isinstance(pitch, float | int):
        return None
    after = Seat(yaw, pitch)
    try:
        # JSON is YAML: the manifest's machine is read as that of a profile.
        machine = parse_machine(json.dumps(rows), "manifest.json")
        return MachineView(machine, _seat_before(metrics, after), after)
    except (DesError, ValueError, TypeError):
        return None


def _seat_before(metrics: Metrics, after: Seat) -> Seat:
    """Return the seat as the profile has it, where its angles were among what was found."""
    found = {}
    for key in ("yaw", "pitch"):
        constant = (metrics.parameters or {}).get(f"seat_{key}")
        before = constant.before_deg if constant else None
        found[key] = getattr(after, key) if before is None else math.radians(before)
    return Seat(**found)


def _plain(chain: Chain) -> dict[str, Any]:
    return {
        "constants": [constant.tolist() for constant in chain.constants],
        "signs": list(chain.signs),
    }
