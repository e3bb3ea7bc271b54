# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Trackers under test: variants, baselines, and whatever else starts and steps."""

from __future__ import annotations

import functools
import hashlib
import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Protocol

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.evaluation.baselines import Baseline, baseline_row
from vehicle_pf_tracker.evaluation.cache_key import variant_modules
from vehicle_pf_tracker.evaluation.systems import BASELINE_PREFIX, System
from vehicle_pf_tracker.parameters.table import Value, from_mapping, to_mapping
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.trackers.estimate import Estimate
from vehicle_pf_tracker.trackers.registry import find_variant

_EVALUATION = "vehicle_pf_tracker.evaluation"


class Follower(Protocol):
    """A tracker under test: any of the package, or anything with the same two methods."""

    def start(self, frame: Frame, box: Box) -> Estimate | EstimateRow:
        """Learn the target in the first frame."""
        ...

    def step(self, frame: Frame, elapsed: float = 1.0) -> Estimate | EstimateRow:
        """Find it in the next one."""
        ...


@dataclass(frozen=True)
class StressSystem:
    """A tracker under test.

    Attributes
    ----------
    label : str
        Name of the system in all tables.
    make : callable
        Makes a new tracker for a seed. For several processes it has to be picklable: a function or
        a class of a module, or a `functools.partial` of one.
    facts : mapping
        Plain values that decide about its estimates besides `make`: parameters, a version.
    modules : tuple of str
        Modules of this package that it begins in; a change of their code, or of what they import
        from the package, invalidates kept scores. Of code elsewhere only the file that defines
        `make` does: put a version into `facts`.
    is_deterministic : bool
        The seed has no effect: it runs once.
    """

    label: str
    make: Callable[[int], Follower]
    facts: Mapping[str, Any] = field(default_factory=dict)
    modules: tuple[str, ...] = ()
    is_deterministic: bool = False

    @classmethod
    def of(cls, system: System) -> StressSystem:
        """Put a variant with its parameters, or a baseline, to the test."""
        facts = {"system": system.kind, "parameters": dict(system.parameters)}
        if system.is_baseline:
            # Its worker is a program of its own that nothing imports: it is named here.
            code = (f"{_EVALUATION}.baselines", f"{_EVALUATION}.baseline_worker", __name__)
            make = functools.partial(BaselineFollower, system)
            return cls(system.label, make, facts, code, is_deterministic=True)
        # Sorted: the same modules in another order are the same code.
        modules = tuple(sorted(variant_modules(find_variant(system.kind))))
        make_variant = functools.partial(_make_variant, system)
        return cls(system.label, make_variant, facts, modules, system.is_deterministic)

    def identity(self) -> dict[str, Any]:
        """Return what decides about its estimates, besides the seed and `modules`."""
        make = self.make.func if isinstance(self.make, functools.partial) else self.make
        # Facts say all of the package's own systems; their code is in `modules`.
        if make in {_make_variant, BaselineFollower}:
            return dict(self.facts)
        try:
            code = Path(inspect.getfile(make)).read_bytes()
        except (OSError, TypeError):  # made at a prompt, or of C
            code = b""
        name = f"{getattr(make, '__module__', '')}.{getattr(make, '__qualname__', repr(make))}"
        return {
            "label": self.label,
            "make": name,
            "code": hashlib.sha256(code).hexdigest(),
            "facts": dict(self.facts),
        }


class BaselineFollower:
    """A baseline in a process of its own, which `close` ends.

    Parameters
    ----------
    system : System
        Baseline to run.
    seed : int
        Seed, without effect: baselines are deterministic.
    """

    def __init__(self, system: System, seed: int = 0) -> None:
        del seed
        python = Path(system.python) if system.python else None
        self._baseline = Baseline(
            system.kind.removeprefix(BASELINE_PREFIX), python, system.model_files()
        )

    def start(self, frame: Frame, box: Box) -> EstimateRow:
        """Start it; see `Follower`."""
        return baseline_row(self._baseline.start(frame, box), 0, 0)

    def step(self, frame: Frame, _elapsed: float = 1.0) -> EstimateRow:
        """Step it; these trackers know no time."""
        return baseline_row(self._baseline.step(frame), 0, 0)

    def close(self) -> None:
        """End its process."""
        self._baseline.close()


def variant_system(
    name: str, parameters: Mapping[str, Value] | None = None, label: str | None = None
) -> StressSystem:
    """Make the system of a variant from its registry name.

    Parameters
    ----------
    name : str
        Name of the variant in the registry.
    parameters : mapping of str to Value or None
        Parameters that differ from the defaults, by their dotted names.
    label : str or None
        Name of the system in tables; None takes `name`.

    Raises
    ------
    InputError
        If there is no such variant, or a parameter does not fit.
    """
    kind = find_variant(name).parameters
    values = to_mapping(from_mapping(kind, dict(parameters or {})))
    # The seed is that of a run, not of the system.
    values.pop("seed")
    overrides = tuple(sorted((parameters or {}).items()))
    made = System.of_variant(name, tuple(values.items()), "", overrides)
    return StressSystem.of(replace(made, label=label or name))


def _make_variant(system: System, seed: int) -> Follower:
    return find_variant(system.kind).tracker(system.tracker_parameters(seed))
