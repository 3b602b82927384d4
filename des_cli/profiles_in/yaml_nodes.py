"""YAML text as a tree in which every value knows its place in the file.

Built from the parser's events rather than with a loader, so that the rules are
the project's own: YAML 1.2 scalars (``1e-3`` is a number; ``no`` and ``1:30``
are text), no repeated keys, no tags, anchors, aliases or merge keys, and one
document. What is read stands in the file where it counts, and is as large as the file.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.events import (
    AliasEvent,
    DocumentStartEvent,
    MappingStartEvent,
    NodeEvent,
    ScalarEvent,
    SequenceStartEvent,
)

from des_cli.errors import Complaint, ProfileError
from des_cli.profiles_in.wording import plain, shown

MAX_BYTES = 1 << 18
"""Longest YAML text read; recorded samples belong in a CSV file."""

MAX_NODES = 20_000
"""Values in a file."""

MAX_DEPTH = 20
"""Levels of nesting; a profile has five."""

Scalar: TypeAlias = str | int | float | bool | None
Step: TypeAlias = str | int

_INTEGER = re.compile(r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_WORDS: dict[str, Scalar] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), float("inf")),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}
_EXACT_DIGITS = 15
"""Longer whole numbers are read as doubles, as every other number is."""


@dataclass(slots=True)
class Node:
    """A value of a YAML file, with its place.

    Parameters
    ----------
    place : str
        ``cobra.yaml:12:14``, or the option that set the value.
    value : scalar, dict of str to Node, or list of Node
    key_places : dict of str to str
        Where each key of a mapping stands.
    """

    place: str
    value: Scalar | dict[str, Node] | list[Node]
    key_places: dict[str, str] = field(default_factory=dict)

    def children(self) -> Iterator[tuple[Step, Node]]:
        """Iterate over the members of a mapping or list with their key or index."""
        if isinstance(self.value, dict):
            yield from self.value.items()
        elif isinstance(self.value, list):
            yield from enumerate(self.value)

    def child(self, step: Step) -> Node | None:
        """Return a member of a mapping or list by its key or index, or None."""
        if isinstance(self.value, dict):
            return self.value.get(step) if isinstance(step, str) else None
        if isinstance(self.value, list) and isinstance(step, int) and step < len(self.value):
            return self.value[step]
        return None

    def plain(self) -> Any:
        """Return the value as plain dictionaries, lists and scalars."""
        if isinstance(self.value, dict):
            return {key: node.plain() for key, node in self.value.items()}
        if isinstance(self.value, list):
            return [node.plain() for node in self.value]
        return self.value

    def place_of(self, path: Iterable[Step], *, of_key: bool = False) -> str:
        """Return where the value at ``path`` stands, or the nearest one around it.

        Parameters
        ----------
        path : iterable of str or int
        of_key : bool
            Point at the last key rather than at its value.
        """
        node, key_place = self, self.place
        for step in path:
            following = node.child(step)
            if following is None:
                return node.place
            key_place = node.key_places.get(str(step), following.place)
            node = following
        return key_place if of_key else node.place


def node_of(value: Any, place: str) -> Node:
    """Return plain dictionaries, lists and scalars as a tree that all stands in one place.

    Parameters
    ----------
    value : scalar, list or mapping
    place : str
    """
    if isinstance(value, dict):
        members = {str(key): node_of(member, place) for key, member in value.items()}
        return Node(place, members, dict.fromkeys(members, place))
    if isinstance(value, list):
        return Node(place, [node_of(member, place) for member in value])
    return Node(place, value)


def path_text(path: Iterable[Step]) -> str:
    """Write a path as users do.

    >>> path_text(["joints", "arm_rpm", 1, "to_s"])
    'joints.arm_rpm[1].to_s'
    """
    text = ""
    for step in path:
        text += f"[{step}]" if isinstance(step, int) else f"{'.' if text else ''}{plain(step)}"
    return text


def parse_yaml(text: str, label: str) -> Node:
    """Read YAML text of one document.

    Parameters
    ----------
    text : str
    label : str
        What messages call the file.

    Raises
    ------
    ProfileError
        If the text is not YAML, or uses what is not accepted here; repeated
        keys are all named.
    """
    if len(text) > MAX_BYTES:
        raise _rejected(label, f"is larger than {MAX_BYTES >> 10} KiB; put samples in a CSV file")
    builder = _Builder(label)
    try:
        for event in YAML(typ="safe", pure=True).parse(text):
            builder.take(event)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"{label}:{mark.line + 1}:{mark.column + 1}" if mark else label
        words = " ".join(str(error.problem or error.context or "").split())
        raise _rejected(place, f"is not valid YAML: {words[:200]}") from None
    except YAMLError as error:
        words = " ".join(str(error).split())
        raise _rejected(label, f"is not valid YAML: {ascii(words[:200])[1:-1]}") from None
    except ProfileError:
        raise
    except Exception:
        # The parser lets ValueError, IndexError and others escape on malformed text.
        raise _rejected(label, "is not valid YAML") from None
    return builder.finish()


def parse_scalar_text(text: str) -> Scalar:
    """Resolve an unquoted scalar as YAML 1.2's core schema does.

    >>> [parse_scalar_text(text) for text in ("1e-3", "no", "1:30", "0x1F", "true", "~")]
    [0.001, 'no', '1:30', 31, True, None]
    """
    if text in _WORDS:
        return _WORDS[text]
    if len(text) <= _EXACT_DIGITS and _INTEGER.fullmatch(text):
        return int(text, 8 if text.startswith("0o") else 16 if text.startswith("0x") else 10)
    if _FLOAT.fullmatch(text):
        return float(text)
    return text


def _rejected(where: str, what: str) -> ProfileError:
    return ProfileError([Complaint(where, what)])


class _Builder:
    """Builds the tree from events, without recursion."""

    def __init__(self, label: str) -> None:
        self.label = label
        self.root: Node | None = None
        self.open: list[Node] = []
        self.key: tuple[str, str] | None = None
        self.documents = 0
        self.nodes = 0
        self.complaints: list[Complaint] = []

    def take(self, event: Any) -> None:
        """Take the next event of the parser."""
        mark = event.start_mark
        place = f"{self.label}:{mark.line + 1}:{mark.column + 1}" if mark else self.label
        if isinstance(event, DocumentStartEvent):
            self.documents += 1
            if self.documents > 1:
                raise _rejected(place, "a second document starts; keep one profile a file")
            if event.version not in (None, (1, 2)):
                version = ".".join(map(str, event.version))
                raise _rejected(place, f"is YAML {version}, which reads no as false; use 1.2")
        elif isinstance(event, NodeEvent):
            self._take_node(event, place)
        elif type(event).__name__ in ("MappingEndEvent", "SequenceEndEvent"):
            self.open.pop()

    def _take_node(self, event: Any, place: str) -> None:
        tag = getattr(event, "tag", None)
        if tag is not None and str(tag) != "!":
            raise _rejected(place, f"the tag {shown(str(tag))} is not accepted; give plain values")
        if event.anchor is not None:
            sign = "alias *" if isinstance(event, AliasEvent) else "anchor &"
            what = f"the {sign}{plain(str(event.anchor))} is not accepted; write the value out"
            raise _rejected(place, what)
        if isinstance(event, ScalarEvent):
            self._take_scalar(event, place, quoted=event.style is not None or tag is not None)
        else:
            empty: dict[str, Node] | list[Node]
            empty = {} if isinstance(event, MappingStartEvent) else []
            assert isinstance(event, MappingStartEvent | SequenceStartEvent)
            if len(self.open) >= MAX_DEPTH:
                raise _rejected(place, f"is nested more than {MAX_DEPTH} levels deep")
            node = Node(place, empty)
            self._place(node)
            self.open.append(node)

    def _take_scalar(self, event: Any, place: str, *, quoted: bool) -> None:
        if self.open and isinstance(self.open[-1].value, dict) and self.key is None:
            if event.value == "<<" and not quoted:
                raise _rejected(place, "the merge key << is not accepted; write the values out")
            self.key = (event.value, place)
            return
        self._place(Node(place, event.value if quoted else parse_scalar_text(event.value)))

    def _place(self, node: Node) -> None:
        """Put a value where the open mapping or list expects one."""
        if not self.open:
            self.root = node
            return
        self.nodes += 1
        if self.nodes > MAX_NODES:
            raise _rejected(node.place, f"holds more than {MAX_NODES} values")
        parent = self.open[-1]
        if isinstance(parent.value, list):
            parent.value.append(node)
        elif isinstance(parent.value, dict):
            if self.key is None:
                raise _rejected(node.place, "a key must be a name, not a list or a mapping")
            key, place = self.key
            self.key = None
            if key in parent.value:
                first = parent.key_places[key].removeprefix(f"{self.label}:").split(":")[0]
                self.complaints.append(
                    Complaint(place, f"{plain(key)} is given twice; the first is on line {first}")
                )
            parent.value.setdefault(key, node)
            parent.key_places.setdefault(key, place)

    def finish(self) -> Node:
        """Return the tree, or say that there is none."""
        if self.complaints:
            raise ProfileError(self.complaints)
        if self.root is None:
            raise _rejected(self.label, "is empty")
        return self.root
