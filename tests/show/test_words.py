"""Numbers are written in one way, whoever reads them."""

import re
from pathlib import Path

import pytest

import des_cli
from des_cli.show.words import CONSOLE, PAGE
from des_cli.units import percent

ROOT = Path(des_cli.__file__).parent


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (0.5, "50.0 %"),
        (0.0163, "1.6 %"),
        (0.0016, "0.16 %"),
        (0.00994, "0.99 %"),
        (0.00996, "1.0 %"),
        (0.9994, "99.9 %"),
        (0.99996, "100 %"),
        (12.0, "1200 %"),
        (-0.28, "-28.0 %"),
        (None, "not known"),
        (float("inf"), "not known"),
    ],
)
def test_a_share_is_the_same_percentage_everywhere(share: float | None, text: str) -> None:
    assert CONSOLE.percent(share) == text
    page = PAGE.percent(share).replace(PAGE.space, " ").replace(PAGE.minus, "-")
    assert page == ("–" if text == "not known" else text)
    if text != "not known":
        assert share is not None
        assert percent(share) == text


def test_what_is_nothing_has_no_sign() -> None:
    assert CONSOLE.percent(-1e-9) == "0.00 %"
    assert PAGE.fixed(-1e-9, 2) == "0.00"


def test_what_is_no_number_is_not_known() -> None:
    assert CONSOLE.less(float("nan")) == CONSOLE.number(None) == CONSOLE.fixed(None) == "not known"


def test_nobody_else_makes_a_percentage() -> None:
    """A number before a percent sign is written by ``units.percent`` alone."""
    own = re.compile(r"\} ?%|%\}")
    texts = {path: path.read_text("utf-8") for path in ROOT.rglob("*.py")}
    found = {path.relative_to(ROOT).as_posix() for path, text in texts.items() if own.search(text)}
    # words.py exchanges the space before the sign
    assert found == {"units.py", "show/words.py"}
