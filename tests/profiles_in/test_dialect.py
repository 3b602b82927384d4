"""Separators and decimal signs: recognised where they are clear, kept where they are not."""

import pytest

from des_cli.profiles_in.dialect import (
    SEPARATORS,
    Dialect,
    how_to_ask,
    parse_decimal,
    parse_separator,
    recognise,
)

TABLE = "t_s,p_rad_s,q_rad_s,r_rad_s\n0.0,0.5,1,2\n0.1,0.25,1,2\n"


def written(separator: str, decimal: str) -> str:
    return TABLE.replace(",", "\0").replace(".", decimal).replace("\0", separator)


@pytest.mark.parametrize("decimal", [".", ","])
@pytest.mark.parametrize("separator", SEPARATORS)
@pytest.mark.parametrize("expected", SEPARATORS)
def test_a_table_is_told_whatever_was_expected(separator: str, decimal: str, expected: str) -> None:
    if separator == decimal:
        return  # needs quotes: below
    found = recognise(written(separator, decimal), expected, None)
    tab_is_blank = (expected, separator) == (" ", "\t")
    assert found == Dialect(" " if tab_is_blank else separator, decimal)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        # a header with a comma inside of a name, and numbers without any decimals
        ("t_s;p (x, rad/s);q_rad_s;r_rad_s\n0;1;2;3\n1;1;2;3\n", Dialect(";", ".")),
        # a broken row does not make another separator likely
        ("t_s,p rad/s,q rad/s\n0,1\n0,1,2\n0,1,2\n", Dialect(",", ".")),
        # no header at all
        ("0,25;0,5;1,5\n0,25;0,5;1,5\n", Dialect(";", ",")),
        # the one with more numbers has it; a text is no number
        ("a;b;c\n0,5;1,5;v1.2\n0,6;1,5;0.1\n", Dialect(";", ",")),
        ("a;b;c\n0.5;1.5;1,2,3\n0.6;1.5;0,1\n", Dialect(";", ".")),
        # between commas a decimal comma needs quotes
        ('a,b\n"0,5","1,5"\n', Dialect(",", ",")),
        ("a,b\n0,5\n", Dialect(",", ".")),
    ],
)
def test_what_speaks_for_a_dialect(text: str, expected: Dialect) -> None:
    assert recognise(text, ",", None) == expected


def test_a_decimal_sign_that_was_asked_for_gives_way_only_where_no_number_has_it() -> None:
    assert recognise("a;b\n0.5;1\n", ";", ",") == Dialect(";", ".")
    assert recognise("a;b\n0.5;1,5\n0.5;2\n", ";", ",") == Dialect(";", ",")
    assert recognise("a;b\n5;1\n", ";", ",") == Dialect(";", ",")


def test_the_sentence_names_what_differs_and_nothing_else() -> None:
    assert "semicolons and the numbers have a decimal comma: give --separator ';' --decimal ," in (
        how_to_ask(Dialect(";", ","), Dialect())
    )
    assert how_to_ask(Dialect("\t"), Dialect()) == (
        "the columns are separated by tabs: give --separator tab (in YAML: separator: tab)"
    )
    assert how_to_ask(Dialect(), Dialect(";", ".")) == (
        "the columns are separated by commas: give --separator , (in YAML: separator: ',')"
    )
    assert how_to_ask(Dialect(";"), Dialect(";", ",")).startswith(
        "the numbers have a decimal point: give --decimal ."
    )


@pytest.mark.parametrize("separator", SEPARATORS)
def test_what_the_sentence_says_to_type_is_understood(separator: str) -> None:
    asked = Dialect("," if separator != "," else ";")
    typed = how_to_ask(Dialect(separator), asked).split("--separator ")[1].split(" (in")[0]
    assert parse_separator(typed.strip("'")) == separator


def test_other_signs_are_refused() -> None:
    for text in ("", "x", ";;", "comma,", ":"):
        with pytest.raises(ValueError, match="must be ',', ';'"):
            parse_separator(text)
    with pytest.raises(ValueError, match=r"must be '\.' or ','"):
        parse_decimal("'")
