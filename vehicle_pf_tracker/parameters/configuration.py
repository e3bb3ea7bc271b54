"""All parameters of a node as one value: its variant's, its stream's and its own."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.parameters.node_parameters import NodeParameters
from vehicle_pf_tracker.parameters.session_parameters import SessionParameters
from vehicle_pf_tracker.parameters.table import ParameterSpec, Value, from_mapping, specs
from vehicle_pf_tracker.parameters.table import to_mapping as values_of


class Parametrised(Protocol):
    """A variant as the configuration sees it."""

    @property
    def parameters(self) -> type[Any]:
        """Parameter dataclass, all of whose fields have defaults."""
        ...


@dataclass(frozen=True, slots=True)
class Configuration:
    """The three parameter tables with their values; the names are distinct over all of them.

    Attributes
    ----------
    tracker : Any
        An instance of the variant's parameter dataclass.
    """

    tracker: Any
    session: SessionParameters
    node: NodeParameters

    @classmethod
    def of(cls, variant: Parametrised) -> Configuration:
        """Return the defaults of `variant`."""
        return cls(variant.parameters(), SessionParameters(), NodeParameters())

    def specs(self) -> dict[str, ParameterSpec]:
        """Every parameter by name."""
        return {name: spec for part in self._parts() for name, spec in specs(type(part)).items()}

    def to_mapping(self) -> dict[str, Value]:
        """Value of every parameter by name."""
        return {name: value for part in self._parts() for name, value in values_of(part).items()}

    def updated(self, values: Mapping[str, object]) -> Configuration:
        """Put `values` over this configuration, all or nothing; names of others are left out.

        Raises
        ------
        InputError
            Naming every value that does not fit, alone or together with others.
        """
        changed: dict[str, Any] = {}
        problems = []
        for field in dataclasses.fields(self):
            part = getattr(self, field.name)
            own = {name: values[name] for name in specs(type(part)) if name in values}
            try:
                changed[field.name] = from_mapping(type(part), own, part)
            except InputError as error:
                problems.append(str(error))
        if problems:
            raise InputError("; ".join(problems))
        return dataclasses.replace(self, **changed)

    def _parts(self) -> tuple[Any, ...]:
        return self.tracker, self.session, self.node
