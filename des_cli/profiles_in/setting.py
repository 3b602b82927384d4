"""A value that replaces one of a profile, from an option or from ``--set``."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, TypeAlias

from des_cli.errors import ProfileError


@dataclass(frozen=True)
class Setting:
    """A value that an option gives to a key of a profile.

    Parameters
    ----------
    path : str
        Of the key, as ``--set`` has it: ``reduction.r2``.
    value : number, text, list or mapping
        What the key is to hold; whether it may is for the schema to say.
    option : str
        The option as messages name it: ``--r2 0.2``.
    """

    path: str
    value: Any
    option: str

    def __str__(self) -> str:
        """Return what counts in a digest: the key and its value, however it was said."""
        return f"{self.path}={json.dumps(self.value, ensure_ascii=False)}"


AnySetting: TypeAlias = str | Setting
"""A setting, or the text of a ``--set``: ``reduction.r2=0.2``."""


def value_of_option(text: str) -> Any:
    """Return the number, list or text that an option's text means.

    Text that is nothing else stays text, so that the schema can say what it should be.

    >>> [value_of_option(text) for text in ("1e-3", "0,2,0", "[[1, 0], [0, 1]]", "half%")]
    [0.001, [0, 2, 0], [[1, 0], [0, 1]], 'half%']
    """
    # ruamel, which --help must not wait for
    from des_cli.profiles_in.yaml_nodes import parse_yaml

    text = text.strip()
    listed = f"[{text}]" if "," in text and not text.startswith("[") else text
    try:
        return parse_yaml(listed, text).plain()
    except ProfileError:
        return text
