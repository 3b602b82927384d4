"""Values as YAML on one line, which reads back as it was."""

from __future__ import annotations

import json
import re
from typing import Any

_PLAIN_KEY = re.compile(r"[^\W\d]\w*")


def yaml_text(value: Any) -> str:
    r"""Write plain values as JSON, which is YAML, but for what YAML does not take as it stands.

    >>> print(yaml_text({"name": "é\x7f", "at": [0.1, None]}))
    {"name": "é\U0000007f", "at": [0.1, null]}
    """
    text = json.dumps(value, ensure_ascii=False)
    return "".join(each if each.isprintable() else f"\\U{ord(each):08x}" for each in text)


def yaml_key(name: str) -> str:
    """Write a key, in quotes where it is more than a plain name.

    >>> yaml_key("Lx"), yaml_key("L, x")
    ('Lx', '"L, x"')
    """
    return name if _PLAIN_KEY.fullmatch(name) else yaml_text(name)
