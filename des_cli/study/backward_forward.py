"""The study's own law, as printed: adjoint backward, factor, angles forward.

The adjoint equations (42)-(44) are integrated backward from (45) on the desired
motion, the factor follows from (47),

    L' = -1/2 d/dtheta (c' R1 c),   L(tf) = 0,   p = 1 - L' J2^-1 W / r2,

and the angles are integrated forward once from (46). The law leaves out the
derivative of c with respect to p: it is not the optimum, and iterating it need
not converge.
"""

from __future__ import annotations

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.kinematics.coriolis_along import coriolis_slope
from des_cli.model.arrays import Floats, frozen
from des_cli.model.motion import Motion
from des_cli.model.profile import Axes
from des_cli.model.sides import in_pieces


def adjoint_along(motion: Motion, chain: Chain, axes: Axes, r1: Floats) -> Floats:
    """Integrate (42)-(45) backward along a motion.

    Parameters
    ----------
    motion : Motion
    chain : Chain
    axes : {"report", "seat"}
        Axes in which the Coriolis vector is weighted.
    r1 : (3, 3) array
        Weight on its components.

    Returns
    -------
    (n, 3) array
        The costate L of the joint angles at each sample; zero at the last.
    """
    fall = 0.5 * motion.step[:, None] * coriolis_slope(chain, motion, axes, r1)
    return np.vstack([np.cumsum(fall[::-1], axis=0)[::-1], np.zeros(3)])


def factors_of(desired: Motion, adjoint: Floats, r2: Floats) -> Floats:
    """Return the factors of (47) on the rates of a desired motion.

    Parameters
    ----------
    desired : Motion
    adjoint : (n, 3) array
    r2 : (m,) array
        One weight for a factor of all rates, or three for one a joint.

    Returns
    -------
    (n, m) array
    """
    power = adjoint * desired.rate
    if len(r2) == 1:
        power = power.sum(axis=1, keepdims=True)
    return np.asarray(1.0 - power / r2)


def follow(desired: Motion, factors: Floats) -> Motion:
    """Integrate (46) forward: the motion of factors on the rates of a desired one.

    Parameters
    ----------
    desired : Motion
    factors : (n, m) array
        Linear between samples; m = 1 for one factor of all rates, or 3.

    Returns
    -------
    Motion
        Ones return the desired motion, but for the arm's angle where that is not what
        its rates integrate to: the arm is commanded by its velocity.
    """
    start, end = factors[:-1] * desired.rate_start, factors[1:] * desired.rate_end
    angle = np.empty_like(desired.angle)
    angle[0] = 0.0
    for part in in_pieces(len(desired.step)):
        samples = slice(part.start, part.stop + 1)
        half = 0.5 * desired.step[part, None]
        straight = half * (desired.rate_start[part] + desired.rate_end[part])
        missed = np.diff(desired.angle[samples], axis=0) - straight
        missed[:, 0] = 0.0
        both = factors[samples][:-1] + factors[samples][1:]
        moved = half * (start[part] + end[part])
        moved += 0.5 * both * missed
        angle[part.start + 1 : part.stop + 1] = moved
    np.cumsum(angle, axis=0, out=angle)
    angle += desired.angle[0]
    return Motion(desired.t, frozen(angle), frozen(start), frozen(end))
