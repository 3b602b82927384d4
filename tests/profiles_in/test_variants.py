"""A profile that is read once is the one that would be read each time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from des_cli.errors import DesError, FileAccessError
from des_cli.model.profile import Profile, Reduction
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.variants import load_variants
from tests.support.profiles import SMALL

VARIANTS = (
    ("reduction.r2=4",),
    ("reduction.budget.seat_g_rms_error_g=0.1",),
    ("reduction.budget.seat_g_rms_error_g=0.2", "reduction.control=scalar"),
    ("reduction.method=zero", "reduction.r1=[0, 2, 0]"),
    (),
)
WRONG = (
    ("reduction.budget.seat_rate_deviation_relative=1.5",),
    ("reduction.r1=[[1, 2, 0], [0, 1, 0], [0, 0, 1]]", "reduction.rr2=1"),
    ("reduction.r2=1",),
    ("reduction.r2.arm=1",),
)
CSV = "t_s,arm_rpm,fork_deg,cab_deg\n0,1,0,0\n1,2,1,1\n2,3,2,1\n"


@pytest.fixture(params=["yaml", "csv"])
def path(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    path = tmp_path / f"small.{request.param}"
    path.write_text(SMALL if request.param == "yaml" else CSV)
    return path


def plain(reduction: Reduction) -> dict[str, object]:
    return {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in vars(reduction).items()}


def one_by_one(path: Path, settings: tuple[str, ...], further: tuple[str, ...]) -> object:
    try:
        return load_profile(path, settings=[*settings, *further])
    except DesError as error:
        return error


def outcome(found: object) -> object:
    """What can be compared of a profile, or of what is wrong with it."""
    if isinstance(found, Profile):
        return found.name, found.t.tolist(), found.remarks, plain(found.reduction)
    assert isinstance(found, DesError)
    return type(found), found.complaints


@pytest.mark.parametrize("variants", [VARIANTS, VARIANTS[::-1], VARIANTS + WRONG], ids=len)
def test_each_variant_is_what_it_would_be_alone(path: Path, variants) -> None:
    settings = ("reduction.tracking=2", "reduction.ends=match-both")
    found = load_variants(path, variants, settings=settings)
    alone = [one_by_one(path, settings, each) for each in variants]
    assert [outcome(each) for each in found] == [outcome(each) for each in alone]


def test_the_motion_is_shared_and_only_what_was_read_has_a_digest(path: Path) -> None:
    first, *others = load_variants(path, VARIANTS)
    assert isinstance(first, Profile)
    assert first.sha256 == load_profile(path, settings=VARIANTS[0]).sha256
    for other in others:
        assert isinstance(other, Profile)
        assert (other.command, other.machine) == (first.command, first.machine)
        assert other.sha256 == ""


def told(found: list[object]) -> set[object]:
    return {c for error in found if isinstance(error, DesError) for c in error.complaints}


@pytest.mark.parametrize("variants", [WRONG, VARIANTS], ids=["wrong", "right"])
def test_a_faulty_profile_is_told_as_often_as_it_would_be(path: Path, variants) -> None:
    for settings in (("machine=dess",), ("seat.yaw_deg=x", "smooth={cutoff_hz: 1}")):
        found = load_variants(path, variants, settings=settings)
        assert all(isinstance(each, DesError) for each in found)
        alone = [one_by_one(path, settings, each) for each in variants]
        assert told(found) == told(alone)


def test_a_file_that_is_not_there_is_told_at_once(tmp_path: Path) -> None:
    with pytest.raises(FileAccessError, match="there is no such file"):
        load_variants(tmp_path / "nowhere.yaml", VARIANTS)
