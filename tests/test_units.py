"""Units against scipy's constants, and suffixes that could be taken for each other."""

import math

import pytest
from scipy import constants

from des_cli.units import UNITS, percent, split_unit, suffixes, unit_named

DEGREE, RPM = constants.degree, 2.0 * constants.pi / constants.minute
TO_SI = {
    **{"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": constants.minute},
    **{"rad": 1.0, "deg": DEGREE, "rad_s": 1.0, "deg_s": DEGREE, "rpm": RPM},
    **{"rad_s2": 1.0, "deg_s2": DEGREE, "rad_s3": 1.0, "deg_s3": DEGREE},
    **{"m": 1.0, "ft": constants.foot, "m_s2": 1.0, "ft_s2": constants.foot},
    "g": 32.2 * constants.foot,  # as the study takes it
}


def test_every_unit_is_what_it_is_elsewhere() -> None:
    assert {unit.suffix: unit.to_si for unit in UNITS} == pytest.approx(TO_SI, rel=1e-15)
    assert len(UNITS) == len(TO_SI)


@pytest.mark.parametrize("unit", UNITS, ids=lambda unit: unit.suffix)
def test_the_longest_suffix_is_the_unit(unit) -> None:
    assert split_unit(f"seat_yaw_{unit.suffix}") == ("seat_yaw", unit)
    assert unit_named(unit.suffix) is unit
    assert unit.suffix in suffixes(unit.quantity)


@pytest.mark.parametrize("name", ["arm", "rpm", "arm_rpms", "", "arm_RPM"])
def test_a_name_without_a_unit_stays_whole(name: str) -> None:
    assert split_unit(name) == (name, None)


def test_suffixes_stand_in_the_order_of_the_table() -> None:
    assert suffixes("rate") == ("rad_s", "deg_s", "rpm")
    assert suffixes("specific_force") == ("m_s2", "ft_s2", "g")
    assert suffixes("mass") == ()


@pytest.mark.parametrize(
    ("share", "decimals"),
    [(9.94e-3, 2), (9.96e-3, 1), (0.01, 1), (0.9994, 1), (0.9996, 0), (1.0, 0), (12.345, 0)],
)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_percent_has_the_decimals_of_the_number_as_it_is_rounded(
    share: float, decimals: int, sign: float
) -> None:
    number, _, mark = percent(sign * share).partition(" ")
    assert (len(number.partition(".")[2]), mark) == (decimals, "%")
    assert math.isclose(float(number), 100 * sign * share, abs_tol=0.501 * 10**-decimals)
