"""The desired motion of a profile, whatever it commands."""

from __future__ import annotations

from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.motion import DesiredMotion
from des_cli.model.profile import GCommand, Profile


def find_desired(profile: Profile, *, divide: bool = True) -> DesiredMotion:
    """Return the motion that a profile asks for.

    Joint commands and body rates say what the joints do, inside their limits or not. An
    requested G says what the pilot feels: the motion that comes nearest to it is looked for
    inside the limits, whatever the profile's policy on them.

    Parameters
    ----------
    profile : Profile
    divide : bool
        Whether body rates may be put on more rows than the profile has.

    Raises
    ------
    UsageError
        If the profile asks for G of a machine whose arm does not turn about the vertical.
    """
    if isinstance(profile.command, GCommand):
        # imported by the few profiles that need it
        from des_cli.reduction.g_profile import follow_g

        return follow_g(profile, profile.command)
    return make_desired(profile, divide=divide)


def require_makeable(profile: Profile) -> None:
    """Refuse a requested G that no centrifuge makes; see ``g_profile.require_makeable_g``."""
    if isinstance(profile.command, GCommand):
        from des_cli.reduction.g_profile import require_makeable_g

        require_makeable_g(profile, profile.command)
