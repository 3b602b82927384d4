"""Sections of a profile whose keys carry units, as pydantic models.

A quantity such as the fork's angle may be given by any key of the unit table
that measures it (``fork_deg``, ``fork_rad``): the model has a field for each,
and exactly one of them may be given.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    ValidationError,
    create_model,
    model_validator,
)
from pydantic_core import InitErrorDetails, PydanticCustomError

from des_cli.profiles_in.wording import did_you_mean, one_of, plain
from des_cli.units import Unit, split_unit, suffixes

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
"""A finite number; text and true/false are none."""


OMITTED: Any = None
"""Default of a key that may be left out; null in the file is refused all the same."""


@dataclass(frozen=True, slots=True)
class Measure:
    """A quantity that a section holds.

    Parameters
    ----------
    stem : str
        The key without its unit.
    quantity : str
        As the unit table names it.
    title : str
        In words, for messages and the schema.
    required : bool
    others : tuple of str
        Keys without a unit that may stand in its place.
    """

    stem: str
    quantity: str
    title: str
    required: bool = True
    others: tuple[str, ...] = ()

    @property
    def keys(self) -> tuple[str, ...]:
        """Every key that may give it."""
        return (*(f"{self.stem}_{suffix}" for suffix in suffixes(self.quantity)), *self.others)


def fault(
    words: str, at: Sequence[str | int | None] = (), *, of_key: bool = False
) -> PydanticCustomError:
    """Make an error with the project's own words.

    Parameters
    ----------
    words : str
    at : sequence of str or int
        The place below the value that is validated.
    of_key : bool
        Whether the key is wrong rather than its value.
    """
    context = {"words": words, "at": tuple(at), "of_key": of_key}
    return PydanticCustomError("profile", "{words}", context)


class Section(BaseModel):
    """A mapping of a profile: no key but its own, and none twice."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, arbitrary_types_allowed=True, protected_namespaces=()
    )
    measures: ClassVar[tuple[Measure, ...]] = ()
    elsewhere: ClassVar[Mapping[str, str]] = {}
    """Keys that belong to another place, with what is said of them here."""

    @classmethod
    def keys(cls) -> list[str]:
        """Return every key that the section knows."""
        return list(cls.model_fields)

    @classmethod
    def measure(cls, stem: str) -> Measure:
        """Return the quantity of that name."""
        return next(measure for measure in cls.measures if measure.stem == stem)

    def given_key(self, stem: str) -> str | None:
        """Return the key that gives a quantity, or None where it is not given."""
        keys = self.measure(stem).keys
        return next((key for key in keys if key in self.model_fields_set), None)

    def given(self, stem: str) -> tuple[Any, Unit] | None:
        """Return what is given for a quantity, and its unit."""
        key = self.given_key(stem)
        unit = split_unit(key)[1] if key else None
        return (getattr(self, key), unit) if key and unit else None

    def si(self, stem: str, default: float = 0.0) -> float:
        """Return a quantity in SI units and radians, or the default."""
        given = self.given(stem)
        return default if given is None else float(given[0]) * given[1].to_si

    def written(self, stem: str) -> str:
        """Return a number as the user gave it: ``from_s (5)``."""
        key = self.given_key(stem)
        return f"{key} ({getattr(self, key):.12g})" if key else stem

    @model_validator(mode="wrap")
    @classmethod
    def _check_keys(cls, data: Any, handler: ModelWrapValidatorHandler[Section]) -> Section:
        """Collect what is wrong with the keys together with what is wrong in the values."""
        if not isinstance(data, dict):
            raise fault(f"must be a mapping with {_some(cls.keys())}")
        errors = [
            InitErrorDetails(type=fault(words, of_key=True), loc=(key,), input=None)
            for key, words in _unknown_keys(cls, data)
        ]
        errors += [
            InitErrorDetails(type=fault(words, ("",)), loc=(), input=None)
            for words in _measure_faults(cls, data)
        ]
        known = {key: value for key, value in data.items() if key in cls.model_fields}
        try:
            section = handler(known)
        except ValidationError as error:
            errors += [_again(details) for details in error.errors(include_url=False)]
            section = None
        if errors or section is None:
            raise ValidationError.from_exception_data(cls.__name__, errors)
        return section


def measured(
    name: str,
    doc: str,
    measures: Iterable[Measure],
    kind: Any = Number,
    /,
    *,
    base: type[Section] | None = None,
    **fields: Any,
) -> type[Section]:
    """Make a section with a field for every unit of its quantities.

    Parameters
    ----------
    name, doc : str
    measures : iterable of Measure
    kind : type
        What a value may be.
    base : type, optional
        A section whose keys this one also has.
    **fields
        Further fields, as ``pydantic.create_model`` takes them.
    """
    measures = tuple(measures)
    with_units: dict[str, Any] = {
        key: (kind, Field(default=OMITTED, description=measure.title))
        for measure in measures
        for key in measure.keys
        if key not in fields
    }
    create: Any = create_model  # too dynamic for the type checker
    model = create(name, __base__=base or Section, __doc__=doc, **with_units, **fields)
    model.measures = measures
    exactly_one = [
        {"oneOf": [{"required": [key]} for key in measure.keys]}
        for measure in measures
        if measure.required
    ]
    if exactly_one:
        model.model_config["json_schema_extra"] = {"allOf": exactly_one}
        model.model_rebuild(force=True)
    section: type[Section] = model
    return section


def _unknown_keys(section: type[Section], data: dict[str, Any]) -> Iterable[tuple[str, str]]:
    for key in data:
        if key in section.model_fields:
            continue
        match = [measure for measure in section.measures if _tries(key, measure)]
        if key in section.elsewhere:
            yield key, section.elsewhere[key]
        elif match:
            yield key, f"{match[0].title} needs its unit in the key: {one_of(match[0].keys)}"
        else:
            hint = did_you_mean(key, section.keys())
            yield key, f"is not a key here{hint or f'; there are {_some(section.keys())}'}"


def _measure_faults(section: type[Section], data: dict[str, Any]) -> Iterable[str]:
    for measure in section.measures:
        given = [key for key in measure.keys if key in data]
        if len(given) > 1:
            yield f"{measure.title} is given twice: {' and '.join(given)}; keep one"
        tried = any(_tries(key, measure) for key in data)
        if measure.required and not given and not tried:
            yield f"{measure.title} is missing: give {one_of(measure.keys)}"


def _tries(key: str, measure: Measure) -> bool:
    """Tell whether a key means a quantity, though perhaps in no unit of it."""
    return key == measure.stem or key.startswith(f"{measure.stem}_")


def _some(keys: Sequence[str], most: int = 12) -> str:
    words = ", ".join(plain(key) for key in keys[:most])
    return f"{words}, …" if len(keys) > most else words


def _again(details: Any) -> InitErrorDetails:
    """Turn a reported error back into one that can be raised with others."""
    kind: str | PydanticCustomError = details["type"]
    if kind == "profile":
        kind = PydanticCustomError("profile", "{words}", details["ctx"])
    return InitErrorDetails(
        type=kind, loc=details["loc"], input=details["input"], ctx=details.get("ctx", {})
    )
