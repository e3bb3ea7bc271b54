# Copyright 2026 vehicle_pf_tracker maintainers
# SPDX-License-Identifier: Apache-2.0

"""Cells: a scene, a tracker on it, and the recorded scalars of the run.

A cell is the smallest piece of an experiment that has a result. It says everything that its result
depends on, so that the result can be kept and found again.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any, Protocol, TypeAlias

from reproduction.scenes.paper_scenes import FIXED_SCENES, PAPER_SCENES, make_scene
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.metrics import measure
from vehicle_pf_tracker.evaluation.scores import Scores, score_frames
from vehicle_pf_tracker.following.offline_tracker import with_target
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.table import Value, from_mapping, specs, to_mapping
from vehicle_pf_tracker.results.estimates import EstimateRow
from vehicle_pf_tracker.scenes.scene import Scene, SceneFrame
from vehicle_pf_tracker.trackers.registry import find_variant
from vehicle_pf_tracker.trackers.session import Session

Settings: TypeAlias = tuple[tuple[str, Value], ...]
"""Names and values, in a form that can be a key."""
Result: TypeAlias = dict[str, Any]
"""Result of a cell, as plain values for JSON."""


@dataclass(frozen=True, slots=True)
class SceneChoice:
    """A scene of the catalogue, its seed, and the settings that are not its defaults."""

    name: str
    seed: int = 0
    settings: Settings = ()

    @classmethod
    def of(cls, name: str, settings: Mapping[str, Value] | None = None) -> SceneChoice:
        """Choose the scene `name` with `settings`."""
        return cls(name, 0, tuple(sorted((settings or {}).items())))

    def seeded(self, seed: int) -> SceneChoice:
        """Choose the same scene with another seed."""
        return replace(self, seed=seed)

    def make(self) -> Scene:
        """Make the scene, ready to be rendered."""
        return make_scene(self.name, seed=self.seed, settings=dict(self.settings))

    def truths(self) -> list[Truth]:
        """Give the truth of every frame, without rendering any."""
        return list(self.make().truths())

    @property
    def speed(self) -> float:
        """Nominal speed of the target, px/frame."""
        fixed = FIXED_SCENES.get(self.name)
        if fixed is not None:
            return fixed.parameters.speed
        default = specs(PAPER_SCENES[self.name].parameters)["speed"].default
        return float(dict(self.settings).get("speed", default))


@dataclass(frozen=True, slots=True)
class System:
    """A variant and the parameters that are not its defaults, under a name for tables."""

    label: str
    variant: str
    settings: Settings = ()

    @classmethod
    def of(cls, label: str, variant: str, settings: Mapping[str, Value] | None = None) -> System:
        """Name `variant` with `settings`, whose names may have dots."""
        return cls(label, variant, tuple(sorted((settings or {}).items())))

    def but(self, settings: Mapping[str, Value]) -> System:
        """Set more parameters."""
        return replace(self, settings=tuple(sorted({**dict(self.settings), **settings}.items())))

    def parameters(self, seed: int) -> Any:
        """Make the variant's parameters."""
        kind = find_variant(self.variant).parameters
        return from_mapping(kind, {**dict(self.settings), "seed": seed})


class Probe(Protocol):
    """Cell at work: shown every frame of its scene in order, and then asked for its result."""

    def feed(self, shown: SceneFrame) -> None:
        """Take the next frame."""
        ...

    def result(self) -> Result:
        """Return the result of the run."""
        ...


class Cell(Protocol):
    """Unit of an experiment; `RunCell` is the usual one. Cells are keys of dictionaries."""

    @property
    def scene(self) -> SceneChoice:
        """The scene; cells on one scene share its rendering."""
        ...

    @property
    def label(self) -> str:
        """Name of the cell while it runs."""
        ...

    @property
    def variants(self) -> tuple[str, ...]:
        """Names of the variants that run."""
        ...

    @property
    def alone(self) -> bool:
        """True if nothing else may run beside it, as where time is measured."""
        ...

    def facts(self) -> dict[str, Any]:
        """Return everything that the result depends on, besides the code."""
        ...

    def start(self) -> Probe:
        """Begin to run."""
        ...


@dataclass(frozen=True, slots=True)
class RunCell:
    """One tracker with one seed on one scene, started on the first true box.

    Its result has `metrics` (those of `evaluation.metrics`, without times) and `trace`: for each
    name in `record` a list with that scalar of every frame's estimate, None where it has none.
    """

    scene: SceneChoice
    system: System
    seed: int
    record: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """Scene and tracker."""
        return f"{self.scene.name} {self.system.label}"

    @property
    def variants(self) -> tuple[str, ...]:
        """Name the one variant."""
        return (self.system.variant,)

    @property
    def alone(self) -> bool:
        """False: others may run beside it."""
        return False

    def facts(self) -> dict[str, Any]:
        """Give scene, variant, every parameter, and what is recorded."""
        return {
            "scene": asdict(self.scene),
            "variant": self.system.variant,
            "parameters": to_mapping(self.system.parameters(self.seed)),
            "record": self.record,
        }

    def start(self) -> Probe:
        """Begin to run."""
        return _Run(self)


class _Run:
    def __init__(self, cell: RunCell) -> None:
        self._cell = cell
        self._session: Session | None = None
        self._rows: list[EstimateRow] = []
        self._truths: list[Truth] = []
        self._trace: dict[str, list[Any]] = {name: [] for name in cell.record}

    def feed(self, shown: SceneFrame) -> None:
        if self._session is None:
            self._session = start_session(self._cell.system, self._cell.seed, shown)
        stamp_ns = shown.truth.stamp_ns
        estimate = self._session.feed(shown.frame, stamp_ns)
        assert estimate is not None
        scalars = estimate.scalars()
        self._rows.append(EstimateRow.from_scalars(len(self._rows) + 1, stamp_ns, scalars))
        self._truths.append(shown.truth)
        for name, values in self._trace.items():
            values.append(scalars.get(name))

    def result(self) -> Result:
        metrics = measure(score_frames(self._rows, self._truths)).to_json()
        del metrics["step_ms_p50"], metrics["step_ms_p95"]
        return {"metrics": metrics, "trace": self._trace}


def start_session(system: System, seed: int, first: SceneFrame) -> Session:
    """Make the session that follows the target from its true box in the frame `first`."""
    settings = with_target(SessionParameters(), first.truth.box)
    return Session(find_variant(system.variant), system.parameters(seed), settings)


PATH_COLUMNS = ("x", "y", "width", "height", "mode")
"""Scalars that a cell has to record for `scores`."""


def scores(cell: RunCell, result: Result) -> Scores:
    """Give the scores of every frame of a run, for figures and for what `metrics` does not have.

    Parameters
    ----------
    cell : RunCell
        Records `PATH_COLUMNS` at least.
    result : Result
        Result of the cell.
    """
    truths = _truths(cell.scene)
    columns = (result["trace"][name] for name in PATH_COLUMNS)
    rows = [
        EstimateRow(number, truth.stamp_ns, x, y, width, height, mode, None, None, None)
        for number, (truth, x, y, width, height, mode) in enumerate(
            zip(truths, *columns, strict=True), start=1
        )
    ]
    return score_frames(rows, truths)


@functools.lru_cache(maxsize=512)
def _truths(scene: SceneChoice) -> list[Truth]:
    """Give the truth, which many trackers and figures share and which takes time to make."""
    return scene.truths()
