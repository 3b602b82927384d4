"""A small profile as text, read with settings, or refused."""

from __future__ import annotations

import pytest

from des_cli.errors import ProfileError
from des_cli.model.profile import Profile
from des_cli.profiles_in.load import load_profile

SMALL = """\
format: des-coriolis/1
name: small
time: {start_s: 0, stop_s: 2, step_s: 0.5}
joints:
  arm_rad_s: 1
  fork_deg: "10*t"
  cab_deg: 5
"""


def load(text: str, *settings: str) -> Profile:
    """The profile that a text describes."""
    return load_profile("-", stdin=text.encode(), settings=settings)


def problems_of(text: str, *settings: str) -> list[str]:
    """Everything that is said against a text."""
    with pytest.raises(ProfileError) as caught:
        load(text, *settings)
    return [str(problem) for problem in caught.value.complaints]
