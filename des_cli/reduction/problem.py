"""The reduction problem as data: what is minimised, over what, within what.

A desired motion Theta, factors u on its rates, and the adapted motion theta that
they make (section 6 of ``docs/theory.md``)::

    theta' = u * phi,   phi = J^-1 W,   theta(t0) = Theta(t0)
    J = 1/2 int  c' R1 c + sum_i r2_i (1 - u_i)^2 + (Theta - theta)' Q (Theta - theta)  dt

How it is solved stands elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from des_cli.kinematics.chain import Chain, chain_of
from des_cli.model.arrays import Flags, Floats, freeze
from des_cli.model.machine import JOINTS, Machine
from des_cli.model.motion import Motion, Record, Shortfall
from des_cli.model.profile import Axes, Control, Ends, JacobianAt, Profile
from des_cli.units import STANDARD_GRAVITY_M_S2

FAINT = 1e-9
"""Mean square of the weighted cross-coupling [rad^2/s^4] below which there is none: at the
default weights 2e-5 rad/s^2, a hundredth of what a person can feel at the very least. The way
to reduce it would be told by the rounding of the rest."""


@dataclass(frozen=True)
class Problem:
    """Minimum Coriolis along a desired motion.

    Parameters
    ----------
    desired : Motion
        Theta and its rates on the sample grid.
    chain : Chain
        The machine's kinematics, from the ground to the seat.
    axes : {"report", "seat"}
        Axes in which the Coriolis vector is weighted.
    r1 : (3, 3) array
        Weight on the Coriolis components.
    r2 : (m,) array
        Weight on ``(1 - u_i)^2``; m = 1 for a scalar control, 3 per joint.
    tracking : (3,) array
        Diagonal of Q.
    jacobian : {"desired", "adapted"}
        The angles at which phi is taken.
    held : (3,) array of bool
        Joints whose factor stays one (per joint only).
    ends : {"free", "match-start", "match-both"}
        Whether factors (and angles) equal the desired ones at the ends.
    machine : Machine, optional
        Its limits hold for the adapted motion; None for no limits.
    gravity : float
        [m/s^2]
    requested : Motion, optional
        What the profile asks for, on the same samples, where ``desired`` is its
        executable replacement.
    shortfall : Shortfall, optional
        What the profile asks for beyond that.
    """

    desired: Motion
    chain: Chain
    axes: Axes
    r1: Floats
    r2: Floats
    tracking: Floats
    jacobian: JacobianAt = "desired"
    held: Flags = field(default_factory=lambda: np.zeros(3, dtype=bool))
    ends: Ends = "free"
    machine: Machine | None = None
    gravity: float = STANDARD_GRAVITY_M_S2
    requested: Motion | None = None
    shortfall: Shortfall | None = None

    def __post_init__(self) -> None:
        freeze(self, "r1", (3, 3))
        freeze(self, "r2", (None,))
        freeze(self, "tracking", (3,))

    @property
    def reference(self) -> Motion:
        """The motion that budgets are measured against."""
        return self.desired if self.requested is None else self.requested

    @property
    def controls(self) -> int:
        """Number of factors m: 1 (scalar p) or 3 (one per joint)."""
        return len(self.r2)


def control_weight(control: Control, r2: Floats) -> Floats:
    """Return the weight of each factor, (m,).

    Per joint, each factor has a third of its joint's weight, and the scalar has
    the mean: three equal factors cost what the scalar costs, so that the optimum
    per joint is never above the scalar one.
    """
    return np.array([r2.mean()]) if control == "scalar" else r2 / 3.0


def pose_problem(profile: Profile, desired: Motion, requested: Record | None = None) -> Problem:
    """Make the problem that a profile asks for along a desired motion.

    Parameters
    ----------
    profile : Profile
    desired : Motion
    requested : Record, optional
        What budgets are measured against, where it is not ``desired``.
    """
    reduction = profile.reduction
    # A weight on the whole vector is a weight on its length, whatever the axes: seat
    # axes then keep the arm's azimuth out of the arithmetic too.
    isotropic = np.array_equal(reduction.r1, reduction.r1[0, 0] * np.eye(3))
    return Problem(
        desired=desired,
        chain=chain_of(profile.machine, profile.seat),
        axes="seat" if isotropic else reduction.axes,
        r1=reduction.r1,
        r2=control_weight(reduction.control, reduction.r2),
        tracking=reduction.tracking,
        jacobian=reduction.jacobian,
        held=np.array([joint in reduction.hold for joint in JOINTS]),
        ends=reduction.ends,
        machine=profile.machine if reduction.limits == "enforce" else None,
        gravity=profile.machine.gravity,
        requested=None if requested is None else requested.motion,
        shortfall=None if requested is None else requested.shortfall,
    )
