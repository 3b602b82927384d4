"""Whether a record is noisy: beyond the machine's limits only by what is faster than a maneuver."""

from __future__ import annotations

import numpy as np

from des_cli.kinematics.smoothing import smooth_samples, why_not_smooth
from des_cli.model.arrays import Flags, Floats
from des_cli.model.machine import JOINTS, Machine
from des_cli.model.motion import DesiredMotion
from des_cli.model.profile import Profile
from des_cli.units import percent

CUTOFF_HZ = 2.0
"""What is suggested [Hz]: joints of tonnes follow no maneuver that is faster."""

OFTEN = 0.05
"""Share of the time beyond a limit from which it is no single corner of a maneuver."""

CURED = 1.0 / 3.0
"""Share of that time which may remain after smoothing: else it is the maneuver that is too fast."""

SMALL = 0.5
"""Root mean square of what smoothing takes from the rates, relative to them, up to which it is
noise upon a motion and not the motion itself."""


def suggest_smoothing(profile: Profile, requested: DesiredMotion) -> str:
    """Return a sentence that suggests to smooth a noisy record, or nothing.

    A joint is driven by noise if its acceleration or jerk is often beyond a
    limit, seldom so without what is faster than `CUTOFF_HZ`, and most of its rates
    is left without it. A corner of a maneuver is beyond limits once,
    and a maneuver that is too fast stays so.

    Parameters
    ----------
    profile : Profile
    requested : DesiredMotion
        What the profile asks of the joints.
    """
    motion = requested.motion
    if profile.smooth_cutoff_hz <= CUTOFF_HZ or why_not_smooth(motion.t, CUTOFF_HZ):
        return ""
    rate, step = motion.rate, motion.step / (motion.t[-1] - motion.t[0])
    often = step[1:] @ beyond_limits(motion.t, rate, profile.machine)
    if not np.any(often > OFTEN):
        return ""
    smooth, _, _ = smooth_samples(motion.t, rate, CUTOFF_HZ)
    still = step[1:] @ beyond_limits(motion.t, smooth, profile.machine)
    change, size = (np.sqrt(np.mean(x**2, axis=0)) for x in (rate - smooth, rate))
    noisy = (often > OFTEN) & (still <= CURED * often) & (change <= SMALL * size)
    if not np.any(noisy):
        return ""
    worst = int(np.argmax(np.where(noisy, often - still, -1.0)))
    return (
        f"the record is noisy: the {JOINTS[worst]}'s acceleration or jerk is beyond a limit "
        f"{percent(often[worst])} of the time, and {percent(still[worst])} without what is "
        f"faster than {CUTOFF_HZ:g} Hz, which is {percent(change[worst] / size[worst])} of its "
        f"rate; smooth: {{cutoff_hz: {CUTOFF_HZ:g}}} (--smooth {CUTOFF_HZ:g}) takes that out "
        "before the reduction"
    )


def beyond_limits(t: Floats, rate: Floats, machine: Machine) -> Flags:
    """Tell where the acceleration or the jerk of rates at samples is beyond a limit.

    Parameters
    ----------
    t : (n,) array
        [s]
    rate : (n, 3) array
        [rad/s]
    machine : Machine

    Returns
    -------
    (n - 2, 3) array of bool
        At each sample but the ends, for each joint.
    """
    step = np.diff(t)[:, None]
    acceleration = np.diff(rate, axis=0) / step
    jerk = np.diff(acceleration, axis=0) / (0.5 * (step[1:] + step[:-1]))
    most = np.array([[limit.acceleration, limit.jerk] for limit in machine.limits])
    fast = np.abs(acceleration) > most[:, 0]
    return np.asarray(fast[1:] | fast[:-1] | (np.abs(jerk) > most[:, 1]))
