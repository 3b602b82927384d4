"""A profile ends alike whatever kernel the linear algebra runs on: its sums round otherwise."""

from __future__ import annotations

import os

import pytest

from des_cli.profiles_in.builtin import builtin_profiles
from tests.support.kernels import KERNELS, Ended, available, on_kernel

FEW = ("cobra_felt", "rapid_onset", "rolling_spin")
NAMES = (
    tuple(profile.name for profile in builtin_profiles())
    if os.environ.get("DES_CORIOLIS_KERNELS") == "all"
    else FEW
)
"""With ``DES_CORIOLIS_KERNELS=all`` every maneuver that comes with the tool."""

SAME = 1e-3
"""Largest difference of a reduction, relative."""


@pytest.fixture(scope="module")
def reference() -> dict[str, Ended]:
    if not available(KERNELS[0]):
        pytest.skip(f"this processor lacks the instructions of {KERNELS[0]}")
    return on_kernel(KERNELS[0], NAMES)


@pytest.mark.slow
@pytest.mark.parametrize("kernel", KERNELS[1:])
def test_status_and_reduction_are_those_of_another_kernel(
    kernel: str, reference: dict[str, Ended]
) -> None:
    if not available(kernel):
        pytest.skip(f"this processor lacks the instructions of {kernel}")
    found = on_kernel(kernel, NAMES)
    assert set(found) == set(reference) == set(NAMES)
    for name, ended in found.items():
        expected = reference[name]
        assert (ended.exit_code, ended.status) == (expected.exit_code, expected.status), ended.said
        assert ended.reduction == pytest.approx(expected.reduction, rel=SAME)
