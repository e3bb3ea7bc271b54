# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""The systems that are compared: variants with their parameters, and OpenCV's trackers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.table import Value, from_mapping, specs
from vehicle_pf_tracker.trackers.parameters import ParticleParameters
from vehicle_pf_tracker.trackers.registry import find_variant

BASELINE_PREFIX = "baseline:"
"""Beginning of the names of baselines where they stand among those of variants."""
Settings = tuple[tuple[str, Value], ...]
"""Names of parameters with their values, in order, so that equal ones are equal."""


@dataclass(frozen=True, slots=True)
class System:
    """A variant with its parameters, or a baseline in an environment of its own.

    Attributes
    ----------
    label : str
        Name of the system in all tables.
    kind : str
        The variant in the registry, or the baseline as ``baseline:<name>``.
    is_deterministic : bool
        True if the seed has no effect: for variants without particles, and for baselines, since a
        new process repeats a run exactly.
    parameter_set : str
        Label of its parameter set; empty for the defaults.
    overrides : tuple of (str, Value)
        Parameters set on the command line; of a baseline, its model files by name.
    parameters : tuple of (str, Value)
        All parameters in effect but the seed and the target; of a baseline, its model files and the
        version of its OpenCV, so that results of another one are not reused.
    python : str
        Interpreter of a baseline; empty looks where `baseline_python` says.
    """

    label: str
    kind: str
    is_deterministic: bool
    parameter_set: str = ""
    overrides: Settings = ()
    parameters: Settings = ()
    python: str = ""

    @classmethod
    def of_variant(
        cls, variant: str, parameters: Settings, parameter_set: str = "", overrides: Settings = ()
    ) -> System:
        """Make the system of a variant; a parameter set is named in its label."""
        label = f"{variant}@{parameter_set}" if parameter_set else variant
        # Only particle filters draw random numbers.
        is_deterministic = not issubclass(find_variant(variant).parameters, ParticleParameters)
        return cls(label, variant, is_deterministic, parameter_set, overrides, parameters)

    @classmethod
    def of_baseline(
        cls, name: str, python: str = "", models: Settings = (), build: str = ""
    ) -> System:
        """Make the system of a baseline; `build` is the version of its OpenCV."""
        label = f"{BASELINE_PREFIX}{name}"
        # A part of the cache key: a baseline of another OpenCV is run again.
        parameters = (*models, ("opencv", build))
        return cls(label, label, True, "", models, parameters, python)

    @classmethod
    def from_json(cls, entry: Mapping[str, Any]) -> System:
        """Read what `to_json` makes."""
        return cls(
            label=str(entry["label"]),
            kind=str(entry.get("variant") or f"{BASELINE_PREFIX}{entry['baseline']}"),
            is_deterministic=bool(entry["deterministic"]),
            parameter_set=str(entry["parameter_set"]),
            overrides=tuple(entry["overrides"].items()),
            parameters=tuple(entry["parameters"].items()),
        )

    def to_json(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        role = "baseline" if self.is_baseline else "variant"
        return {
            "label": self.label,
            role: self.kind.removeprefix(BASELINE_PREFIX),
            "parameter_set": self.parameter_set,
            "overrides": dict(self.overrides),
            "parameters": dict(self.parameters),
            "deterministic": self.is_deterministic,
        }

    @property
    def is_baseline(self) -> bool:
        """True for one of OpenCV's trackers."""
        return self.kind.startswith(BASELINE_PREFIX)

    @property
    def effective(self) -> dict[str, Value]:
        """All parameters in effect, those that were set first."""
        return {**dict(self.overrides), **dict(self.parameters)}

    def seeds(self, seeds: Sequence[int]) -> Sequence[int]:
        """Return the seeds that it runs with: the first alone where the seed has no effect."""
        return seeds[:1] if self.is_deterministic else seeds

    def facts(self, seed: int) -> dict[str, Any]:
        """Return what determines its runs, besides the code."""
        return {"system": self.kind, "parameters": {**dict(self.parameters), "seed": seed}}

    def model_files(self) -> Mapping[str, Path]:
        """Return the model files of a baseline."""
        return {name: Path(str(path)) for name, path in self.overrides}

    def tracker_parameters(self, seed: int) -> Any:
        """Make the variant's parameters."""
        return self._made(find_variant(self.kind).parameters, seed=seed)

    def session_parameters(self) -> SessionParameters:
        """Make the parameters of the session."""
        parameters: SessionParameters = self._made(SessionParameters)
        return parameters

    def _made(self, kind: type[Any], **more: Value) -> Any:
        # Those of tracker and session stand in one list: each takes its own.
        own = {name: value for name, value in self.parameters if name in specs(kind)}
        return from_mapping(kind, {**own, **more})

    def changed(self, name: str, values: Mapping[str, Value]) -> System:
        """Return the same variant with `values`, as the parameter set `name`.

        Raises
        ------
        InputError
            If a value does not fit, alone or together with others.
        """
        kinds = {**specs(find_variant(self.kind).parameters), **specs(SessionParameters)}
        checked = {key: kinds[key].check(value) for key, value in values.items()}
        parameters = tuple({**dict(self.parameters), **checked}.items())
        changed = System.of_variant(self.kind, parameters, name, tuple(sorted(checked.items())))
        # Made once to be checked: bounds that hold between two parameters show only then. The seed
        # does not matter.
        changed.tracker_parameters(0)
        return changed
