"""The tables of a run: what got worse or breaks a limit is marked, what is not known a dash."""

from __future__ import annotations

from des_cli.model.felt import Felt, GSizes, TurningSizes
from des_cli.model.metrics import Metrics
from des_cli.results.reading import read_metrics
from des_cli.show.page.tables import (
    coriolis_rows,
    joint_rows,
    limit_rows,
    seat_rows,
    turning_rows,
)
from des_cli.show.words import PAGE

UNKNOWN = PAGE.unknown


def marked(rows: list) -> list[str]:
    """The texts of the cells that stand out."""
    return [cell.text for row in rows for cell in row if cell.mark]


def test_a_component_that_grew_is_marked() -> None:
    metrics = read_metrics(
        {
            "coriolis": {
                "vector": {"reduction": 0.5, "rms_before_rad_s2": 0.4, "rms_after_rad_s2": 0.28},
                "seat_x": {"reduction": -0.25},
            }
        }
    )
    rows = {row[0].text: row for row in coriolis_rows(metrics)}
    assert len(rows) == 7
    assert marked(list(rows.values())) == [PAGE.change(-0.25)]
    [vector] = [row for row in rows.values() if row[2].text == "0.4000"]
    assert [cell.text for cell in vector[1:]] == [
        PAGE.change(0.5),
        "0.4000",
        "0.2800",
        UNKNOWN,
        UNKNOWN,
    ]


def loaded(peak: float, limit: float, ok: bool) -> Metrics:
    load = {"rate_peak_rad_s": peak, "rate_limit_rad_s": limit, "ok": ok}
    return read_metrics({"limits": {"modified": {"fork": load}}})


def test_a_peak_over_its_limit_is_marked_and_rounding_is_not() -> None:
    assert marked(limit_rows(loaded(1.01, 1.0, False))) == ["1.0100 exceeds", "broken"]
    assert marked(limit_rows(loaded(1.0 + 1e-12, 1.0, True))) == []
    labels = [row[0].text for row in limit_rows(loaded(1.0, 1.0, True))]
    assert labels[:4] == [
        "arm rate [rad/s]",
        "arm acceleration [rad/s²]",
        "arm jerk [rad/s³]",
        "arm, all limits",
    ]


def test_joints_are_off_in_degrees() -> None:
    fidelity = {
        "joint_rms_rad": {"arm": 0.1, "fork": 0.0, "cab": None},
        "end_error_rad": {"arm": -1.0},
    }
    arm, fork, cab = joint_rows(read_metrics({"fidelity": fidelity}))
    assert [cell.text for cell in arm] == ["arm", "5.730", UNKNOWN, UNKNOWN, "−57.296", UNKNOWN]
    assert [cell.text for cell in fork[:2]] == ["fork", "0.000"]
    assert {cell.text for cell in cab[1:]} == {UNKNOWN}


def test_a_total_angular_acceleration_that_grew_is_marked() -> None:
    sizes = TurningSizes(0.4, 0.5, 0.6, 0.6)
    metrics = Metrics(felt=Felt(seat_angular_acceleration={"magnitude": sizes}))
    rows = turning_rows(metrics)
    assert [row[0].text for row in rows] == ["|α| [rad/s²]"]
    assert marked(rows) == ["0.5000"]


def test_rows_without_a_number_are_left_out() -> None:
    empty = Metrics()
    assert turning_rows(empty) == []
    assert seat_rows(empty) == []
    assert len(joint_rows(empty)) == 3


def test_the_onset_that_grew_is_marked_on_its_axis() -> None:
    quiet = GSizes(onset_before_g_s=0.5, onset_after_g_s=0.5)
    hard = GSizes(onset_before_g_s=0.5, onset_after_g_s=0.9)
    rows = seat_rows(Metrics(felt=Felt(seat_g={"gx": quiet, "gy": hard, "gz": quiet})))
    assert [row[0].text for row in rows] == ["Gx", "Gy", "Gz"]
    assert marked(rows) == [f"0.500 {PAGE.arrow} 0.900"]
