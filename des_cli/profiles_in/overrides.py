"""Values that replace those of a profile, by ``--set reduction.r2=0.2`` or by an option."""

from __future__ import annotations

import re
from collections.abc import Sequence

from des_cli.errors import Complaint, ProfileError
from des_cli.model.metric import STUDY_METRIC
from des_cli.profiles_in.machine_schema import DEFAULT_MACHINE
from des_cli.profiles_in.machine_yaml import is_machine_file
from des_cli.profiles_in.setting import AnySetting
from des_cli.profiles_in.wording import plain, shown
from des_cli.profiles_in.yaml_nodes import MAX_DEPTH, Node, Step, node_of, parse_yaml, path_text
from des_cli.units import split_unit

OPTION = "--"
"""How places begin that are options and not lines of a file."""

_BUDGET, _WEIGHTS = "budget", ("r2", "tracking")
"""Keys of the reduction of which the first stands instead of the others."""

_STEP = re.compile(r"([A-Za-z_]\w*)((?:\[\d{1,6}\])*)")
_ALTERNATIVES = ("joints", "body_rates", "samples")
"""Sections of which a profile has one."""


def apply_settings(root: Node, settings: Sequence[AnySetting]) -> list[Complaint]:
    """Change a document by settings, in their order.

    A key replaces the one that gives the same quantity in another unit, or without
    one, so ``initial.arm_deg=3`` also works where the profile says ``arm_rad``. A budget
    takes the weights away, and they take it away; ``reduction.budget.METRIC=0.1`` joins
    the budgets that the profile has on other metrics, and ``machine.limits...`` changes
    the built-in machine that the profile names.
    Whether the keys exist is for the schema to say, which names the setting
    as the place.

    Parameters
    ----------
    root : Node
        A mapping; changed in place.
    settings : sequence of Setting or str
        A text is one of ``--set``, ``path=value``; the value is YAML: ``0.2``,
        ``[0, 2, 0]``, ``seat``.

    Returns
    -------
    list of Complaint
        One for each setting that cannot be understood or applied.
    """
    complaints: list[Complaint] = []
    for setting in settings:
        try:
            _apply(root, setting)
        except ProfileError as error:
            complaints += error.complaints
    return complaints


def _apply(root: Node, setting: AnySetting) -> None:
    if isinstance(setting, str):
        label = f"--set {plain(setting)}"
        name, equals, text = setting.partition("=")
        if not equals:
            raise _rejected(label, "must be path=value, such as reduction.r2=0.2")
        path = parse_path(name.strip(), label)
        value = _value(text, label)
    else:
        label = plain(setting.option)
        path = parse_path(setting.path, label)
        value = node_of(setting.value, label)
    node = root
    for depth, step in enumerate(path[:-1]):
        node = _descend(node, step, path[: depth + 1], label)
    _put(node, path, value, label)


def parse_path(name: str, label: str) -> list[Step]:
    """Split ``joints.arm_rpm[1].to_s`` into its steps.

    Raises
    ------
    ProfileError
        If it is not a path of names and indices, or deeper than any key.
    """
    path: list[Step] = []
    if name.count(".") + name.count("[") >= MAX_DEPTH:
        raise _rejected(label, f"is a path of more than {MAX_DEPTH} levels")
    for part in name.split("."):
        match = _STEP.fullmatch(part)
        if not match:
            raise _rejected(label, f"{shown(name)} is not a path such as joints.arm_rpm[1].to_s")
        path.append(match[1])
        path += [int(index) for index in re.findall(r"\d+", match[2])]
    return path


def _value(text: str, label: str) -> Node:
    if not text.strip():
        raise _rejected(label, "has no value after =")
    try:
        return _relabel(parse_yaml(text, label), label)
    except ProfileError as error:
        words = "; ".join(complaint.what for complaint in error.complaints)
        of_it = "the value " if words.startswith(("is ", "holds ")) else "in the value "
        raise _rejected(label, f"{of_it}{words}") from None


def _relabel(node: Node, label: str) -> Node:
    """Give a tree the setting as its place: lines and columns mean nothing there."""
    node.place = label
    node.key_places = dict.fromkeys(node.key_places, label)
    for _, child in node.children():
        _relabel(child, label)
    return node


def _descend(node: Node, step: Step, path: Sequence[Step], label: str) -> Node:
    _check_container(node, step, path, label)
    if isinstance(node.value, dict) and list(path) == ["reduction", _BUDGET]:
        _make_budgets_a_mapping(node.value)
    if isinstance(node.value, dict) and list(path) == ["machine"]:
        _make_machine_a_mapping(node.value, label)
    if isinstance(node.value, dict) and step not in node.value:
        # The schema, not this function, knows which keys exist.
        node.value[str(step)] = Node(label, {})
        node.key_places[str(step)] = label
    if isinstance(node.value, dict) and node.value[str(step)].value is None:
        node.value[str(step)] = Node(label, {})
    return dict(node.children())[step]


def _make_budgets_a_mapping(reduction: dict[str, Node]) -> None:
    """Name the metric of a bare budget, and take the weights away that a budget replaces."""
    for other in _same_quantity(_BUDGET, reduction, top=False):
        del reduction[other]
    bare = reduction.get(_BUDGET)
    if bare is not None and type(bare.value) in (int, float):
        reduction[_BUDGET] = Node(bare.place, {STUDY_METRIC: bare}, {STUDY_METRIC: bare.place})


def _make_machine_a_mapping(document: dict[str, Node], label: str) -> None:
    """Make a built-in machine, or the default one, the base of what is changed in it."""
    named = document.get("machine", Node(label, DEFAULT_MACHINE))
    if not isinstance(named.value, str):
        return
    if is_machine_file(named.value):
        raise _rejected(label, f"the machine is a file: change it in {plain(named.value)}")
    document["machine"] = Node(named.place, {"base": named}, {"base": named.place})


def _put(node: Node, path: Sequence[Step], value: Node, label: str) -> None:
    step = path[-1]
    _check_container(node, step, path, label)
    if isinstance(node.value, list) and isinstance(step, int):
        node.value[step] = value
    elif isinstance(node.value, dict):
        for other in _same_quantity(str(step), node.value, top=len(path) == 1):
            del node.value[other]
        node.value[str(step)] = value
        node.key_places[str(step)] = label


def _same_quantity(key: str, present: Sequence[str] | dict[str, Node], *, top: bool) -> list[str]:
    """Return the other keys that give the same as ``key``."""
    if key == _BUDGET:
        return [other for other in present if other in _WEIGHTS]
    if key in _WEIGHTS:
        return [other for other in present if other == _BUDGET]
    if top:
        return [o for o in present if o != key and {key, o} <= set(_ALTERNATIVES)]
    stem = split_unit(key)[0]
    return [other for other in present if other != key and split_unit(other)[0] == stem]


def _check_container(node: Node, step: Step, path: Sequence[Step], label: str) -> None:
    parent = path_text(path[:-1])
    if isinstance(step, int):
        if not isinstance(node.value, list):
            raise _rejected(label, f"{parent} is not a list")
        if step >= len(node.value):
            raise _rejected(label, f"{parent} has {len(node.value)} items, counted from 0")
    elif not isinstance(node.value, dict):
        kind = "a list: say which item, [0]" if isinstance(node.value, list) else "a single value"
        value = "" if isinstance(node.value, list) else f" ({shown(node.value)})"
        raise _rejected(label, f"{parent} is {kind}{value}, so it has no {step}")


def _rejected(label: str, what: str) -> ProfileError:
    return ProfileError([Complaint(label, what)])
