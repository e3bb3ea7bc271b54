# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parameters as frozen dataclasses: the one table everything else is derived from.

A field defined with `parameter` carries its default, bounds, unit, a line on the effect of turning
it, and its source. A field whose type is another such dataclass (defined with `group`) nests, and
its fields get dotted names (`reference.alpha`). ROS descriptors, YAML files, ``--set key=value``
and the tables in the documentation are all derived from `specs`, and `tune` searches the fields
marked as tuned.
"""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from operator import attrgetter
from types import MappingProxyType
from typing import Any, Literal, TypeAlias, TypeVar, cast, get_type_hints

from vehicle_pf_tracker.core.errors import InputError, brief, suggestion

Value: TypeAlias = bool | int | float | str
Effect: TypeAlias = Literal["keeps", "relearns", "restarts", "starts"]
ParametersT = TypeVar("ParametersT")

EFFECTS: Mapping[Effect, str] = {
    "keeps": "keeps track and reference",
    "relearns": "keeps the track, rebuilds the reference from the first frame's target",
    "restarts": "restarts the random numbers",
    "starts": "starts again on the new target",
}
"""Consequences of a change while tracking, in words for parameter files and pages."""

_KEY = "parameter"
"""Key of a field's metadata under which its specification, or its group's class, lies."""
_BOOLEANS = {"true": True, "1": True, "yes": True, "false": False, "0": False, "no": False}
_TYPE_NAMES = {bool: "true or false", int: "an integer", float: "a number", str: "a string"}


def plain_number(value: object) -> object:
    """Return a number of numpy, or of a library like it, as Python's own; all else as it is.

    Numpy, which has a type for each size of number, is not needed for that and not imported here.
    """
    if getattr(value, "shape", None) == () and callable(item := getattr(value, "item", None)):
        return item()
    return value


@dataclass(frozen=True, slots=True)
class ParameterSpec:
    """Full description of one parameter.

    Attributes
    ----------
    name : str
        Dotted snake_case name.
    kind : type
        Type of its value: `bool`, `int`, `float` or `str`.
    default : bool, int, float or str
        Default value.
    doc : str
        Effect of turning it, in one line.
    bounds : (float, float) or None
        Least and largest value, in `unit`; None is unbounded.
    unit : str
        Unit of its value; empty where it has none.
    choices : tuple of str
        Strings allowed; empty where any string is.
    source : str
        Paper and equation, or interpretation, that it comes from.
    effect : {"keeps", "relearns", "restarts", "starts"}
        Consequence of a change while tracking (`EFFECTS`).
    read_only : bool
        True where it can be set at start-up only.
    tuned : bool or (float, float)
        True where `tune` searches it by default; least and largest value to try, where those
        derived from default and bounds would be of no use.
    """

    name: str
    kind: type[Value]
    default: Value
    doc: str
    bounds: tuple[float, float] | None = None
    unit: str = ""
    source: str = ""
    choices: tuple[str, ...] = ()
    effect: Effect = "keeps"
    read_only: bool = False
    tuned: bool | tuple[float, float] = False

    def check(self, value: object) -> Value:
        """Return `value` in this parameter's type; integers are accepted for real numbers.

        Raises
        ------
        InputError
            If the type is wrong, the number is not finite or out of bounds, or the string is not
            allowed.
        """
        value = plain_number(value)
        # YAML writes 30 for 30.0; True is an int to Python, and no number here.
        if self.kind is float and isinstance(value, int) and not isinstance(value, bool):
            try:
                value = float(value)
            except OverflowError:
                raise InputError(f"{self.name} must be finite, got {brief(value)}") from None
        if type(value) is not self.kind:
            raise InputError(f"{self.name} must be {_TYPE_NAMES[self.kind]}, got {brief(value)}")
        checked = value
        if self.choices and checked not in self.choices:
            known = ", ".join(self.choices)
            raise InputError(f"{self.name} must be one of {known}, got {brief(value)}")
        if isinstance(checked, int | float):
            self._check_bounds(checked)
        return checked

    def _check_bounds(self, value: float) -> None:
        if isinstance(value, float) and not math.isfinite(value):
            raise InputError(f"{self.name} must be finite, got {brief(value)}")
        if self.bounds and not self.bounds[0] <= value <= self.bounds[1]:
            raise InputError(f"{self.name} must be {self.bounds_text}, got {brief(value)}")

    @property
    def bounds_text(self) -> str:
        """Bounds in words, for messages and tables; empty where there are none."""
        return "from {} to {}".format(*map(_plain, self.bounds)) if self.bounds else ""

    def parse(self, text: str) -> Value:
        """Read a value written on a command line."""
        word = text.strip()
        try:
            value = _BOOLEANS[word.lower()] if self.kind is bool else self.kind(word)
        except (ValueError, KeyError):
            raise InputError(
                f"{self.name} must be {_TYPE_NAMES[self.kind]}, got {brief(text)}"
            ) from None
        return self.check(value)


def _plain(number: float) -> str:
    return str(int(number)) if float(number).is_integer() else f"{number:g}"


def parameter(  # noqa: PLR0913 - one keyword per column of the table
    default: Value,
    doc: str,
    *,
    bounds: tuple[float, float] | None = None,
    unit: str = "",
    source: str = "",
    choices: Iterable[str] = (),
    effect: Effect = "keeps",
    read_only: bool = False,
    tuned: bool | tuple[float, float] = False,
) -> Any:
    """Make the dataclass field of one parameter; see `ParameterSpec` for the meaning of each."""
    spec = ParameterSpec(
        "",
        type(default),
        default,
        doc,
        bounds,
        unit,
        source,
        tuple(choices),
        effect,
        read_only,
        tuned,
    )
    return dataclasses.field(default=default, metadata={_KEY: spec})


def group(kind: type[Any], **changed: Value) -> Any:
    """Make the field of a nested group; `changed` overrides the group's defaults here."""
    return dataclasses.field(default_factory=lambda: kind(**changed), metadata={_KEY: kind})


def specs(cls: type[object]) -> Mapping[str, ParameterSpec]:
    """Return every parameter of the dataclass `cls` by dotted name, in order of declaration."""
    key: Any = cls
    return _specs(key)


_hints = functools.cache(get_type_hints)
"""The types of a class's fields, which else would be evaluated anew for each change."""


@functools.cache
def _specs(cls: Any) -> Mapping[str, ParameterSpec]:
    """Make the table of a dataclass, once for each."""
    hints = _hints(cls)
    defaults = cls()
    table: dict[str, ParameterSpec] = {}
    for field in dataclasses.fields(cls):
        value = getattr(defaults, field.name)
        if dataclasses.is_dataclass(value):
            for name, spec in specs(hints[field.name]).items():
                dotted = f"{field.name}.{name}"
                table[dotted] = dataclasses.replace(
                    spec, name=dotted, default=attrgetter(name)(value)
                )
        else:
            spec = field.metadata[_KEY]
            table[field.name] = dataclasses.replace(spec, name=field.name, default=value)
    return MappingProxyType(table)


def to_mapping(parameters: object) -> dict[str, Value]:
    """Return the value of every parameter by dotted name."""
    return {name: attrgetter(name)(parameters) for name in specs(type(parameters))}


def from_mapping(
    cls: type[ParametersT], values: Mapping[str, object], base: ParametersT | None = None
) -> ParametersT:
    """Make a `cls` from `base` (the defaults if None) with `values` put over it.

    All or nothing. A method ``validate(self) -> None`` of `cls` may check parameters against each
    other; it raises `InputError`.

    Raises
    ------
    InputError
        Naming every unknown name, wrong type and value out of bounds.
    """
    table = specs(cls)
    # All problems at once: a file is mended in one go.
    problems = [unknown_name(name, table) for name in values if name not in table]
    checked = to_mapping(base if base is not None else cls())
    for name, value in values.items():
        if name in table:
            try:
                checked[name] = table[name].check(value)
            except InputError as error:
                problems.append(str(error))
    if problems:
        raise InputError("; ".join(problems))
    parameters = cast("ParametersT", _build(cls, checked, ""))
    validate = getattr(parameters, "validate", None)
    if validate is not None:
        validate()
    return parameters


def _build(cls: Any, values: Mapping[str, Value], prefix: str) -> Any:
    """Make a dataclass, and its groups, of values by dotted name."""
    hints = _hints(cls)
    arguments: dict[str, Any] = {}
    for field in dataclasses.fields(cls):
        dotted = prefix + field.name
        nested = dotted not in values
        arguments[field.name] = (
            _build(hints[field.name], values, dotted + ".") if nested else values[dotted]
        )
    return cls(**arguments)


def unknown_name(name: str, known: Iterable[str]) -> str:
    """Write that there is no parameter `name`, and which one may be meant."""
    return f"there is no parameter {brief(name)}{suggestion(name, known)}"


def parse_assignments(
    table: Mapping[str, ParameterSpec], assignments: Iterable[str]
) -> dict[str, Value]:
    """Read `key=value` words as given to ``--set``.

    Raises
    ------
    InputError
        If a word has no ``=``, a name is unknown, or a value does not fit.
    """
    values: dict[str, Value] = {}
    for word in assignments:
        name, equals, text = word.partition("=")
        if not equals:
            raise InputError(f"--set expects name=value, got {brief(word)}")
        if name not in table:
            raise InputError(unknown_name(name, table))
        values[name] = table[name].parse(text)
    return values
