"""The systems' parameters, those first that were set."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from vehicle_pf_tracker.evaluation.evaluation_folder import SystemEntry


@dataclass(frozen=True, slots=True)
class ParameterRow:
    """One parameter, and whether it was set rather than left at its default."""

    name: str
    value: str
    was_set: bool


@dataclass(frozen=True, slots=True)
class SystemSection:
    """What a system was."""

    label: str
    kind: str
    parameter_set: str
    rows: tuple[ParameterRow, ...]


def system_sections(systems: tuple[SystemEntry, ...]) -> list[SystemSection]:
    """Describe all systems."""
    sections = []
    for system in systems:
        values = flat(system.parameters)
        were_set = flat(system.overrides)
        rows = [ParameterRow(name, _text(values.get(name, value)), was_set=True)
                for name, value in were_set.items()]  # fmt: skip
        rows += [ParameterRow(name, _text(value), was_set=False)
                 for name, value in values.items() if name not in were_set]  # fmt: skip
        section = SystemSection(system.label, system.kind, system.parameter_set, tuple(rows))
        sections.append(section)
    return sections


def _text(value: Any) -> str:
    """Return a value as it stands in a parameter file."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def flat(values: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return nested values by their dotted names."""
    found: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, Mapping):
            found |= flat(value, f"{prefix}{name}.")
        else:
            found[prefix + name] = value
    return found
