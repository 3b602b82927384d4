"""The figures of a run: there, of the right data, and the same bytes every time."""

import io
import sys

import pytest
from PIL import Image

from des_cli.model.run import Run
from des_cli.results.reading import read_metrics
from des_cli.runs_out.tables import trajectory_columns
from des_cli.show.plots import CAPTIONS, draw_plots
from tests.support.pictures import BLUE, GREY, area, picture
from tests.support.runs import make_run


def figures_of(run: Run) -> dict[str, bytes]:
    return draw_plots(trajectory_columns(run), run.metrics)


@pytest.fixture(scope="module")
def plain() -> dict[str, bytes]:
    """The figures of the smallest run, drawn once."""
    return figures_of(make_run(11))


@pytest.mark.slow
@pytest.mark.parametrize("control", ["scalar", "per-joint"])
def test_every_figure_shows_its_curves(control: str) -> None:
    run = make_run(101, control=control)
    figures = figures_of(run)
    assert list(figures) == list(CAPTIONS)
    widths = set()
    for name, png in figures.items():
        image = picture(png)
        widths.add(image.width)
        assert area(image, BLUE) > 1000, name
        if name not in ("adjoint", "deviation"):
            assert area(image, GREY) > 300, name
    assert len(widths) == 1


@pytest.mark.slow
def test_equal_runs_give_equal_bytes() -> None:
    first, second = (figures_of(run) for run in (make_run(), make_run()))
    assert first == second


@pytest.mark.slow
def test_the_users_matplotlibrc_changes_nothing(plain: dict[str, bytes]) -> None:
    import matplotlib

    with matplotlib.rc_context(
        {"figure.facecolor": "red", "axes.grid": False, "font.size": 30, "savefig.dpi": 10}
    ):
        assert figures_of(make_run(11)) == plain
        assert matplotlib.rcParams["font.size"] == 30


@pytest.mark.slow
def test_a_figure_is_of_its_run(plain: dict[str, bytes]) -> None:
    other = figures_of(make_run(11, control="per-joint"))
    assert [name for name in plain if plain[name] == other[name]] == ["adjoint"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("section", "change", "figures"),
    [
        ("solver", {"status": "acceptable", "converged": False}, set(CAPTIONS)),
        ("solver", {"budget": {"joint_deviation_relative": 0.13}}, {"deviation"}),
        ("limits", {"modified": {"fork": {"jerk_limit_rad_s3": 5.0}}}, {"limits"}),
        ("felt", {"seat_angular_acceleration": {}}, {"felt"}),
        ("executable", {"joint_change_max_rad": {"cab": 0.0123}}, {"commands"}),
        ("executable", {"joint_change_max_rad": {"cab": 1e-6}}, set()),
    ],
)
def test_standing_budget_and_changes_are_on_the_figures_they_belong_to(
    plain: dict[str, bytes], section: str, change: dict[str, object], figures: set[str]
) -> None:
    run = make_run(11)
    metrics = run.metrics | {section: run.metrics[section] | change}
    changed = draw_plots(trajectory_columns(run), metrics)
    assert {name for name in plain if plain[name] != changed[name]} == figures


@pytest.mark.slow
def test_a_free_motion_has_no_figure_of_factors_and_adjoint() -> None:
    run = make_run(11, control="free")
    figures = figures_of(run)
    assert list(figures) == [name for name in CAPTIONS if name not in ("factor", "adjoint")]


@pytest.mark.slow
def test_pyplot_stays_out() -> None:
    run = make_run(11)
    figures_of(run)
    assert "matplotlib.pyplot" not in sys.modules


@pytest.mark.slow
def test_no_version_and_no_time_is_in_the_file(plain: dict[str, bytes]) -> None:
    for png in plain.values():
        facts = Image.open(io.BytesIO(png)).info
        assert set(facts) == {"dpi", "Title", "Software"}
        assert facts["Software"] == "des-coriolis"


@pytest.mark.slow
def test_metrics_of_a_stranger_do_not_stop_the_figures() -> None:
    columns = trajectory_columns(make_run(11))
    for metrics in (
        {},
        {"solver": 1, "coriolis": []},
        {"limits": {"modified": {"arm": {"jerk_limit_rad_s3": -1.0, "jerk_peak_rad_s3": "x"}}}},
        {"solver": {"axes": ["report"], "r1": "two"}, "coriolis": {"bb3": {"reduction": "much"}}},
        {
            "solver": {"status": "$x_$", "converged": False, "budget": {"$a_$": 1.0}},
            "fidelity": {"$a_$": 2.0},
            "executable": {"joint_change_max_rad": {"$\\q$": 2.0, "b": "c"}},
        },
    ):
        assert list(draw_plots(columns, metrics)) == list(CAPTIONS)


@pytest.mark.parametrize("reduction", [None, "0.5", float("nan"), 10**400, [0.5]])
def test_a_reduction_that_is_no_number_is_not_known(reduction: object) -> None:
    metrics = read_metrics({"coriolis": {"bb3": {"reduction": reduction}}})
    assert metrics.coriolis.reduction("bb3") is None
