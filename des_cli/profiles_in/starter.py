"""A commented profile to start from."""

from __future__ import annotations

import json
import re
from pathlib import Path

_TEXT = Path(__file__).with_name("starter.yaml")
_PLAIN = re.compile(r"[A-Za-z][\w-]*", re.ASCII)
_WORDS_OF_YAML = {"true", "false", "null"}


def starter_text(name: str) -> str:
    """Return the YAML of a profile that is valid, keeps every limit, and says what its keys do.

    Parameters
    ----------
    name : str
        Of the profile.

    Raises
    ------
    ValueError
        Where no profile can be called so, in words for the user.

    Examples
    --------
    >>> "name: turn" in starter_text("turn").splitlines()
    True
    """
    from pydantic_core import PydanticCustomError

    from des_cli.profiles_in.schema import check_name

    try:
        check_name(name)
    except PydanticCustomError as error:
        raise ValueError(error.message()) from None
    plain = _PLAIN.fullmatch(name) and name.lower() not in _WORDS_OF_YAML
    shown = name if plain else json.dumps(name, ensure_ascii=False)
    text = _TEXT.read_text(encoding="utf-8")
    return text.replace("runs/{name}", f"runs/{name}").replace("name: {name}", f"name: {shown}")
