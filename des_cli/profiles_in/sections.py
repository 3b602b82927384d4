"""Sections of a profile whose keys carry units, as pydantic models.

A quantity such as the fork's angle may be given by any key of the unit table
that measures it (``fork_deg``, ``fork_rad``). The model has one field for it, annotated
with its `Measure`; one validator finds which of the keys is given, and the value stays
in that key's unit until `Section.si` is asked.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    ModelWrapValidatorHandler,
    PrivateAttr,
    ValidationError,
    model_validator,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, InitErrorDetails, PydanticCustomError

from des_cli.profiles_in.wording import did_you_mean, one_of, plain
from des_cli.units import Unit, split_unit, suffixes

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
"""A finite number; text and true/false are none."""


OMITTED: Any = None
"""Default of a key that may be left out; null in the file is refused all the same."""


@dataclass(frozen=True, slots=True)
class Measure:
    """A quantity that a section holds, as the annotation of its field.

    Parameters
    ----------
    quantity : str
        As the unit table names it.
    title : str
        In words, for messages and the schema.
    required : bool
    others : tuple of str
        Further keys that may stand in its place.
    stem : str
        The key without its unit; without it the name of the field.
    described : bool
        Whether the schema has the title.
    """

    quantity: str
    title: str
    required: bool = False
    others: tuple[str, ...] = ()
    stem: str = ""
    described: bool = True

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

    _measured: ClassVar[Mapping[str, Measure]] = {}
    _fields: ClassVar[Mapping[str, str]] = {}
    _given: dict[str, str] = PrivateAttr(default_factory=dict)

    @classmethod
    def __pydantic_init_subclass__(cls, **kwargs: Any) -> None:
        """Find the quantities among the fields, and the field of every key."""
        measured = {}
        for name, info in cls.model_fields.items():
            for each in info.metadata:
                if isinstance(each, Measure):
                    measured[name] = replace(each, stem=each.stem or name.removesuffix("_"))
        fields: dict[str, str] = {}
        for name in cls.model_fields:
            keys = measured[name].keys if name in measured else (name,)
            # What is a field by itself is that field, whatever it may stand for.
            own = cls.model_fields.keys() - measured.keys() - {name}
            fields |= {key: name for key in keys if key not in own}
        cls._measured, cls._fields, cls.measures = measured, fields, tuple(measured.values())

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Describe a property for every key instead of one for every field."""
        schema = handler(core_schema)
        found = handler.resolve_ref_schema(schema)
        properties = found.get("properties", {})
        found["properties"] = {
            key: _property(key, properties[name], cls._measured.get(name))
            for key, name in cls._fields.items()
        }
        exactly_one = [
            {"oneOf": [{"required": [key]} for key in measure.keys]}
            for measure in cls.measures
            if measure.required
        ]
        if exactly_one:
            found["allOf"] = exactly_one
        return schema

    @classmethod
    def known_keys(cls) -> list[str]:
        """Return every key that the section knows."""
        return list(cls._fields)

    @classmethod
    def measure(cls, stem: str) -> Measure:
        """Return the quantity of that name."""
        return next(measure for measure in cls.measures if measure.stem == stem)

    def given_key(self, stem: str) -> str | None:
        """Return the key that gives a quantity, or None where it is not given."""
        return next((key for key in self.measure(stem).keys if key in self._given), None)

    def given(self, stem: str) -> tuple[Any, Unit] | None:
        """Return what is given for a quantity, and its unit."""
        key = self.given_key(stem)
        unit = split_unit(key)[1] if key else None
        return (getattr(self, self._given[key]), unit) if key and unit else None

    def si(self, stem: str, default: float = 0.0) -> float:
        """Return a quantity in SI units and radians, or the default."""
        given = self.given(stem)
        return default if given is None else float(given[0]) * given[1].to_si

    def written(self, stem: str) -> str:
        """Return a number as the user gave it: ``from_s (5)``."""
        key = self.given_key(stem)
        return f"{key} ({getattr(self, self._given[key]):.12g})" if key else stem

    @model_validator(mode="wrap")
    @classmethod
    def _check_keys(cls, data: Any, handler: ModelWrapValidatorHandler[Section]) -> Section:
        """Find the field of each key, and collect all that is wrong with keys and values."""
        if not isinstance(data, dict):
            raise fault(f"must be a mapping with {_some(cls.known_keys())}")
        errors = [
            InitErrorDetails(type=fault(words, of_key=True), loc=(key,), input=None)
            for key, words in _unknown_keys(cls, data)
        ]
        errors += [
            InitErrorDetails(type=fault(words, ("",)), loc=(), input=None)
            for words in _measure_faults(cls, data)
        ]
        given = {key: cls._fields[key] for key in data if key in cls._fields}
        keys = {name: key for key, name in given.items()}
        # Of a quantity that is given twice the values are still to be checked, one by one.
        doubled = [key for key, name in given.items() if keys[name] != key]
        section = None
        for further in ("", *doubled):
            read = keys | ({given[further]: further} if further else {})
            try:
                section = handler({name: data[key] for name, key in read.items()})
            except ValidationError as error:
                found = [_again(details, read) for details in error.errors(include_url=False)]
                errors += [each for each in found if not further or each["loc"][:1] == (further,)]
        if errors or section is None:
            raise ValidationError.from_exception_data(cls.__name__, errors)
        section._given = given
        return section


_HINTS = 50
"""Unknown keys of a section for which the one that may be meant is looked for."""


def _property(key: str, schema: Any, measure: Measure | None) -> Any:
    """Return the schema of a key from that of its field."""
    if measure is None:
        return schema
    described = {"description": measure.title} if measure.described else {}
    return schema | described | {"title": key.replace("_", " ").title()}


def _unknown_keys(section: type[Section], data: dict[str, Any]) -> Iterable[tuple[str, str]]:
    unknown = [key for key in data if key not in section.known_keys()]
    for count, key in enumerate(unknown):
        match = [measure for measure in section.measures if _tries(key, measure)]
        if key in section.elsewhere:
            yield key, section.elsewhere[key]
        elif match:
            yield key, f"{match[0].title} needs its unit in the key: {one_of(match[0].keys)}"
        else:
            # Each takes a comparison of letters, and nobody reads more of them.
            hint = did_you_mean(key, section.known_keys()) if count < _HINTS else ""
            yield key, f"is not a key here{hint or f'; there are {_some(section.known_keys())}'}"


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


def _again(details: Any, keys: Mapping[str, str]) -> InitErrorDetails:
    """Turn a reported error of a field back into one of its key that can be raised with others."""
    kind: str | PydanticCustomError = details["type"]
    if kind == "profile":
        kind = PydanticCustomError("profile", "{words}", details["ctx"])
    name, *rest = details["loc"] or ("",)
    loc = (keys.get(name, name), *rest) if details["loc"] else ()
    return InitErrorDetails(type=kind, loc=loc, input=details["input"], ctx=details.get("ctx", {}))
