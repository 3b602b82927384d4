"""The script computes what the package does: numbers unpacked, and where the machine is."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of, joint_origins, transform
from des_cli.model.machine import Seat
from des_cli.model.machines import MACHINES
from des_cli.show.page.assets import script_part
from des_cli.show.page.machine_view import MachineView
from des_cli.show.page.packing import pack

pytestmark = pytest.mark.browser


@pytest.fixture
def blank(chromium: Any) -> Any:
    """An empty page with the functions of two scripts."""
    page = chromium.new_page()
    page.add_script_tag(content=script_part("data.js") + script_part("drawing.js"))
    yield page
    page.close()


def test_numbers_are_unpacked_as_they_were_packed(blank: Any) -> None:
    values = np.array([0.0, -1.5, 3.14159274, 1e-30, 6.5e7])
    assert blank.evaluate("(text) => [...unpack(text)]", pack(values)) == pytest.approx(
        values.tolist(), rel=1e-7
    )


def test_the_seat_is_where_the_chain_puts_it(blank: Any) -> None:
    machine, seat = MACHINES["des"], Seat(1.2, -0.3)
    view = MachineView(machine, seat, seat)
    chain = chain_of(machine, seat)
    for angles in np.random.default_rng(1).uniform(-3.0, 3.0, (20, 3)):
        frames = blank.evaluate(
            "([chain, angles]) => framesOf(chain, angles)",
            [view.chains()["after"], angles.tolist()],
        )
        np.testing.assert_allclose(frames["seat"], transform(chain, angles), atol=1e-12)
        origins = joint_origins(chain, angles)
        for joint, frame in enumerate(("arm", "fork", "cab")):
            position = np.array(frames[frame])[:3, 3]
            np.testing.assert_allclose(position, origins[joint], atol=1e-12)


def test_ticks_are_round_and_inside(blank: Any) -> None:
    blank.add_script_tag(content=script_part("paper.js"))
    assert blank.evaluate("ticks(-0.33, 1.02, 4)") == pytest.approx([0.0, 0.5, 1.0])
