"""Integrals and sizes of what is felt, by plain sums over all states at once."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.verify.felt import Felt
from des_cli.verify.integrals import integral, sizes, state_blocks
from tests.reduction.conftest import make_wave
from tests.support.claims import claim_of

CLAIM = claim_of(make_wave([[0.6, 0.1], [0.1, 0.3], [0.1, -0.2]]))


@pytest.fixture(params=[1, 7, 100_000], autouse=True)
def length(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("des_cli.verify.integrals.CHUNK", request.param)


def test_blocks_are_all_states_and_neither_is_starts_and_ends() -> None:
    m = len(CLAIM.weight)
    blocks = list(state_blocks(m))
    np.testing.assert_array_equal(np.concatenate([np.arange(m)[b] for b in blocks]), np.arange(m))
    assert all((b.start < m // 2) == (b.stop <= m // 2) for b in blocks)


def test_an_integral_of_what_is_felt_and_what_was() -> None:
    felt, before = CLAIM.after, CLAIM.chain.at(*np.ones((3, len(CLAIM.weight), 3)))

    def running(here: Felt, there: Felt) -> Floats:
        return np.asarray(here.cross_ground[0] * there.g[2] + here.angle[1])

    expected = float(CLAIM.weight @ running(felt, before))
    assert integral(CLAIM, running, felt, before) == pytest.approx(expected, rel=1e-12)


def test_sizes_of_components_and_of_the_length() -> None:
    g, other = CLAIM.after.g, CLAIM.after.turning
    for found, vectors in ((sizes(CLAIM, g), g), (sizes(CLAIM, g, other), g - other)):
        each = [*vectors, np.linalg.norm(vectors, axis=0)]
        rms = [np.sqrt(CLAIM.weight @ v**2 / CLAIM.duration) for v in each]
        assert found.rms == pytest.approx(rms, rel=1e-12)
        assert found.peak == pytest.approx([np.max(np.abs(v)) for v in each], rel=1e-15)


def test_one_value_that_is_no_number_is_no_size() -> None:
    g = CLAIM.after.g.copy()
    g[1, 3] = np.nan
    found = sizes(CLAIM, g)
    assert np.isnan([found.rms[1], found.peak[1], found.rms[-1], found.peak[-1]]).all()
