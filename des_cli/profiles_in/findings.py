"""Everything that is wrong with a profile, collected before anything is said."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from pydantic import ValidationError

from des_cli.errors import Complaint, ProfileError
from des_cli.profiles_in.wording import did_you_mean, one_of, shown
from des_cli.profiles_in.yaml_nodes import Node, Step, path_text

MAX_COMPLAINTS = 50
"""Lines printed of one profile; the rest is counted."""


class Findings:
    """Problems of one document, each with its place in the file.

    Parameters
    ----------
    root : Node
        The document; paths start there.
    """

    def __init__(self, root: Node) -> None:
        self.root = root
        self.complaints: list[Complaint] = []

    def add(self, path: Sequence[Step], words: str, *, of_key: bool = False) -> None:
        """Add what is wrong with the value (or the key) at a path."""
        place = self.root.place_of(path, of_key=of_key)
        name = path_text(path)
        self.complaints.append(Complaint(f"{place}: {name}" if name else place, words))

    def add_validation(self, error: ValidationError, prefix: Sequence[Step] = ()) -> set[Step]:
        """Add what the schema found.

        Parameters
        ----------
        error : ValidationError
        prefix : sequence of str or int
            Where the validated value stands in the document.

        Returns
        -------
        set of str or int
            The members of the validated value that have a complaint.
        """
        failed: set[Step] = set()
        for details in error.errors(include_url=False):
            context = details.get("ctx", {})
            # Tags of a union's branches stand in the location, in angle brackets.
            found = [step for step in details["loc"] if not str(step).startswith("<")]
            of_key = found[-1:] == ["[key]"]  # how pydantic names a mapping's key itself
            if of_key:
                found.pop()
            found += context.get("at", ())
            found = [step for step in found if step != ""]
            failed.add(found[0] if found else "")
            of_key = of_key or context.get("of_key", False)
            self.add([*prefix, *found], _words(details, found), of_key=of_key)
        return failed

    def raise_if_any(self) -> None:
        """Raise a ProfileError with every complaint, if there is one."""
        if self.complaints:
            raise ProfileError(sorted(dict.fromkeys(self.complaints), key=_line_and_column))


def _line_and_column(complaint: Complaint) -> tuple[int, int]:
    """Order complaints as they stand in the file; options come last."""
    match = re.search(r":(\d+):(\d+)(: |$)", complaint.where)
    return (int(match[1]), int(match[2])) if match else (1 << 30, 0)


def bounded(complaints: Sequence[Complaint]) -> list[Complaint]:
    """Return the complaints once each, no more than a person would read."""
    once = list(dict.fromkeys(complaints))
    if len(once) <= MAX_COMPLAINTS:
        return once
    rest = len(once) - MAX_COMPLAINTS
    return [*once[:MAX_COMPLAINTS], Complaint("", f"… and {rest} more problems")]


def _words(details: Any, path: Sequence[Step]) -> str:
    """Say in a person's words what pydantic found."""
    context, value = details.get("ctx", {}), details["input"]
    is_now = f", is {shown(value)}" if not isinstance(value, dict | list) else ""
    match details["type"]:
        case "profile":
            return str(context["words"])
        case "missing":
            return "is missing"
        case "float_type" | "float_parsing":
            return f"must be a number{is_now}"
        case "int_type" | "int_from_float":
            return f"must be a whole number{is_now}"
        case "string_type":
            return f"must be text{is_now}"
        case "list_type":
            return f"must be a list{is_now}"
        case "dict_type":
            return f"must be a mapping{is_now}"
        case "finite_number":
            return f"must be a finite number{is_now}"
        case "literal_error":
            choices = [choice.strip(" '") for choice in _choices(context["expected"])]
            hint = did_you_mean(value, choices) if isinstance(value, str) else ""
            return f"must be {one_of(choices)}{is_now}{hint}"
        case "greater_than":
            return f"must be greater than {context['gt']:g}{is_now}"
        case "greater_than_equal":
            return f"must be at least {context['ge']:g}{is_now}"
        case "less_than_equal":
            return f"must be at most {context['le']:g}{is_now}"
        case "too_short":
            return f"must have at least {context['min_length']} items, has {len(value)}"
        case "too_long":
            return f"must have at most {context['max_length']} items, has {len(value)}"
        case "string_too_short":
            return "must not be empty"
        case "string_too_long":
            return f"must have at most {context['max_length']} characters"
    return str(details["msg"])


def _choices(expected: str) -> list[str]:
    return expected.replace(" or ", ", ").split(", ")
