"""Which columns of a file are read, and as what."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from des_cli.errors import Complaint
from des_cli.profiles_in.clock import is_clock
from des_cli.profiles_in.column_complaints import (
    check_missing,
    misspelt,
    nothing_to_fly,
    repeated,
    several_kinds,
    some,
    stands_often,
    unusable,
)
from des_cli.profiles_in.column_kinds import (
    ALIASES,
    ASKED_G,
    ATTITUDES,
    BODY_RATES,
    COMMANDS,
    EULER,
    IGNORED,
    JOINT_COMMANDS,
    KINDS,
    QUANTITIES,
    Column,
    Kind,
    Said,
    first_said,
)
from des_cli.profiles_in.csv_header import Header
from des_cli.profiles_in.unit_spelling import HeaderName, read_name, unit_of
from des_cli.profiles_in.wording import did_you_mean, plain
from des_cli.units import split_unit


def choose_columns(
    header: Header,
    named: Mapping[str, str],
    complaints: list[Complaint],
    remarks: list[str],
    *,
    euler: bool = False,
) -> list[Column]:
    """Match the columns of a file with what a profile needs.

    Parameters
    ----------
    header : Header
    named : mapping of str to str
        Our name to the name in the file, as asked for. They go before names of
        the contract (``p_rad_s``), and these before other spellings (``P (deg/s)``).
    complaints, remarks : list
        Take what is wrong, and what was done.
    euler : bool
        Whether the order of roll, pitch and yaw is known; without it they are not
        read beside body rates.

    Returns
    -------
    list of Column
        Times, one kind of commands, and what is complete beside them, in the order
        of the file; incomplete where there are complaints.
    """
    found = [*_named(header, named, complaints, remarks), *_recognised(header, named)]
    if complaints:
        return []
    kinds = _kinds(header, found)
    if len(kinds) != 1:
        what = several_kinds(kinds, found) if kinds else nothing_to_fly(header)
        complaints.append(Complaint(header.where, what))
        return []
    kind = kinds[0]
    chosen = []
    for stem in ("t", *kind.stems):
        same = first_said(found, stem)
        chosen += same[:1]
        if len(same) > 1:
            complaints.append(Complaint(header.where, repeated(stem, same)))
    check_missing(header, kind, found, complaints)
    chosen += _beside(kind, found, euler=euler)
    for column in chosen:
        _check_units(header, column, complaints, remarks)
    if not set(kind.stems) <= {read_name(name).stem for name in named}:
        _tell_unread(header, chosen, remarks)
    return sorted(chosen, key=lambda column: column.place)


def _beside(kind: Kind, found: Sequence[Column], *, euler: bool) -> list[Column]:
    """Return what is read beside a kind of commands; of attitudes one is enough."""
    chosen: list[Column] = []
    for group in kind.beside:
        if group == EULER and (chosen or not euler):
            continue
        parts = [first_said(found, stem) for stem in group]
        if all(len(part) == 1 for part in parts):
            chosen += [part[0] for part in parts]
    return chosen


def _named(
    header: Header, named: Mapping[str, str], complaints: list[Complaint], remarks: list[str]
) -> list[Column]:
    """Return the columns that the user names."""
    found = []
    for name, in_file in named.items():
        where = f"{header.label}: column {plain(name)}={plain(in_file)}"
        own, theirs = read_name(name), read_name(in_file)
        count = header.names.count(in_file)
        if not count:
            same_unit = [other for other in header.names if _units_agree(other, in_file)]
            hint = did_you_mean(in_file, same_unit) or f"; there are {some(header.names)}"
            complaints.append(Complaint(where, f"the file has no column {plain(in_file)}{hint}"))
            continue
        if count > 1:
            complaints.append(Complaint(where, stands_often(in_file, count)))
        elif list(named.values()).count(in_file) > 1:
            complaints.append(Complaint(where, f"the column {plain(in_file)} is named twice"))
        if own.stem not in QUANTITIES:
            known = [stem + name[len(own.stem) :] for stem in QUANTITIES]
            hint = did_you_mean(name, known)
            complaints.append(Complaint(where, f"the name {plain(name)} is not known{hint}"))
            continue
        column = _column(header, header.names.index(in_file), own, Said.BY_USER, name)
        if not own.unit_text and theirs.unit_text and column.unit is None:
            column = _column(header, column.place, _with_unit_of(own, theirs), Said.BY_USER, name)
        if own.unit and theirs.unit and own.unit != theirs.unit:
            words = f"{plain(in_file)} is read in {own.unit.suffix}, as {plain(name)} says"
            remarks.append(f"{words}, and not in {theirs.unit.suffix}")
        if not column.usable:
            complaints.append(Complaint(where, unusable(column)))
        found.append(column)
    return found


def _recognised(header: Header, named: Mapping[str, str]) -> list[Column]:
    """Return the columns whose names in the file say what they are."""
    found = []
    for place, name in enumerate(header.names):
        if not name or name in named.values():
            continue
        own = read_name(name)
        if own.stem in QUANTITIES:
            by_contract = split_unit(name)[0] == own.stem or name in ALIASES
            said = Said.BY_CONTRACT if by_contract else Said.BY_SPELLING
            found.append(_column(header, place, own, said, name))
    return found


def _column(header: Header, place: int, own: HeaderName, said: Said, name: str) -> Column:
    """Make a column with its own unit, or else with that of the row of units."""
    unit, text = own.unit, own.unit_text
    if not text and header.units:
        text = header.units[place]
        unit = unit_of(text)
    clock = place < len(header.first) and is_clock(header.first[place])
    return Column(own.stem, name, header.names[place], place, unit, text, said, clock)


def _with_unit_of(own: HeaderName, theirs: HeaderName) -> HeaderName:
    return HeaderName(own.stem, theirs.unit, theirs.unit_text)


def _units_agree(name: str, other: str) -> bool:
    """Whether two names do not differ by their units: a hint must not cost a factor."""
    units = read_name(name).unit, read_name(other).unit
    return None in units or units[0] == units[1]


def _kinds(header: Header, found: Sequence[Column]) -> list[Kind]:
    """Return the kinds of commands that the file gives; it should be one.

    Those that the user names, else those that are complete, else those of which
    there is more.
    """
    by_user = {column.stem for column in found if column.said is Said.BY_USER}
    usable = {column.stem for column in found if column.usable}
    if named := [kind for kind in KINDS if by_user & {*kind.stems}]:
        return _preferred(named, by_user, usable)
    # What has no known unit may still be meant; what has that of another quantity is not.
    meant = usable | {column.stem for column in found if column.unit is None}
    complete = [kind for kind in COMMANDS if kind.complete(usable)]
    if complete == [ASKED_G]:
        other = [JOINT_COMMANDS] if meant & {*JOINT_COMMANDS.stems} else []
        return [*other, *([BODY_RATES] if "r" in meant else []), ASKED_G]
    if complete:
        return complete
    others = {*JOINT_COMMANDS.stems, *BODY_RATES.stems}
    if not meant & others:
        complete = [kind for kind in ATTITUDES if kind.complete(usable)]
    return complete[:1] or _begun(header, found, meant)


def _preferred(named: list[Kind], by_user: set[str], usable: set[str]) -> list[Kind]:
    """Return which of the kinds that the user names in part are meant."""
    commands = [kind for kind in named if kind in COMMANDS]
    if not commands:
        return named[:1]
    if BODY_RATES not in commands or "r" in by_user or JOINT_COMMANDS in commands:
        return commands
    # p and q are rates beside a G too
    if ASKED_G in commands or (ASKED_G.complete(usable) and not BODY_RATES.complete(usable)):
        return [ASKED_G]
    return commands


def _begun(header: Header, found: Sequence[Column], meant: set[str]) -> list[Kind]:
    """Return the kinds of commands of which there is most, where none is complete."""
    present = {column.stem for column in found}
    for group in (COMMANDS, ATTITUDES):
        weights = [
            sum(
                2 if stem in (meant if kind.any_of else present) else bool(misspelt(header, stem))
                for stem in kind.stems
            )
            for kind in group
        ]
        if most := max(weights):
            return [kind for kind, weight in zip(group, weights, strict=True) if weight == most]
    return []


def _check_units(
    header: Header, column: Column, complaints: list[Complaint], remarks: list[str]
) -> None:
    """Say where the row of units contradicts the name of a column."""
    below = unit_of(header.units[column.place]) if header.units else None
    if below is None or column.unit is None or below == column.unit:
        return
    says = f"the row of units says {below.suffix}"
    if column.said is Said.BY_USER:
        own = (
            f"{plain(column.in_file)} is read in {column.unit.suffix}, as {plain(column.name)} says"
        )
        remarks.append(f"{own}, and {says}")
    else:
        what = f"the column {plain(column.in_file)} is in {column.unit.suffix}, but {says}"
        complaints.append(Complaint(header.where, f"{what}; correct one of them"))


def _tell_unread(header: Header, chosen: Sequence[Column], remarks: list[str]) -> None:
    read = {column.place for column in chosen}
    unread = [
        name
        for place, name in enumerate(header.names)
        if name and place not in read and name not in IGNORED
    ]
    if unread:
        are = "column is" if len(unread) == 1 else "columns are"
        remarks.append(f"{len(unread)} {are} not read: {some(unread, 5)}")
