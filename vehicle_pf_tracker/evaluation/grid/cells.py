# Copyright 2026 vehicle_pf_tracker maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Cells of the grid: the system under comparison, the recording, the seed and the start.

A run starts on the first true box, or elsewhere to test robustness. Shifted starts and other first
frames are those of the OTB benchmark (Wu, Lim and Yang 2013, "Online object tracking: a benchmark",
spatial and temporal robustness evaluation). Failures and re-starts are those of VOT, see
`evaluation.occlusions`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source, cell_folder, safe_name
from vehicle_pf_tracker.evaluation.result_store import result_key, variant_modules
from vehicle_pf_tracker.parameters.configuration import SessionParameters
from vehicle_pf_tracker.parameters.table import Value, from_mapping, specs
from vehicle_pf_tracker.trackers.parameters import ParticleParameters
from vehicle_pf_tracker.trackers.registry import Variant, find_variant

BASELINE = "baseline:"
Settings = tuple[tuple[str, Value], ...]


@dataclass(frozen=True, slots=True)
class VariantSystem:
    """A variant with its parameters.

    Attributes
    ----------
    label : str
        Name of the system in all tables.
    variant : str
        Name of the variant in the registry.
    parameter_set : str
        Label of its parameter set; empty for the defaults.
    overrides : tuple of (str, Value)
        Parameters set on the command line.
    parameters : tuple of (str, Value)
        All parameters in effect but the seed and the target.
    """

    label: str
    variant: str
    parameter_set: str
    overrides: Settings
    parameters: Settings

    @property
    def is_deterministic(self) -> bool:
        """True if the seed has no effect: a variant without particles is deterministic."""
        return not issubclass(self._entry.parameters, ParticleParameters)

    @property
    def _entry(self) -> Variant:
        return find_variant(self.variant)

    def tracker_parameters(self, seed: int) -> Any:
        """Make the variant's parameters."""
        kind = self._entry.parameters
        return from_mapping(kind, {**self._own(kind), "seed": seed})

    def changed(self, name: str, values: Mapping[str, Value]) -> VariantSystem:
        """Return the same variant with `values`, as the parameter set `name`.

        Raises
        ------
        InputError
            If a value does not fit, alone or together with others.
        """
        kinds = {**specs(self._entry.parameters), **specs(SessionParameters)}
        checked = {key: kinds[key].check(value) for key, value in values.items()}
        changed = VariantSystem(
            f"{self.variant}@{name}", self.variant, name, tuple(sorted(checked.items())),
            tuple({**dict(self.parameters), **checked}.items()),
        )  # fmt: skip
        changed.tracker_parameters(0)
        return changed

    def session_parameters(self) -> SessionParameters:
        """Make the parameters of the session."""
        return from_mapping(SessionParameters, self._own(SessionParameters))

    def _own(self, kind: type[Any]) -> dict[str, Value]:
        table = specs(kind)
        return {name: value for name, value in self.parameters if name in table}

    def facts(self, seed: int) -> dict[str, Any]:
        """Return what determines its runs, besides the code."""
        return {"variant": self.variant, "parameters": {**dict(self.parameters), "seed": seed}}

    def to_json(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "label": self.label,
            "variant": self.variant,
            "parameter_set": self.parameter_set,
            "overrides": dict(self.overrides),
            "parameters": dict(self.parameters),
            "deterministic": self.is_deterministic,
        }


@dataclass(frozen=True, slots=True)
class BaselineSystem:
    """One of OpenCV's trackers, in an environment of its own.

    A new process repeats a run exactly, so that one run of it is enough.

    Attributes
    ----------
    baseline : str
        Name of the baseline without ``baseline:``.
    python : str
        The interpreter that runs it; empty looks where `baseline_python` says.
    models : tuple of (str, str)
        Model files by name.
    build : str
        Version of the interpreter's OpenCV, so that results of another one are not reused.
    """

    baseline: str
    python: str = ""
    models: tuple[tuple[str, str], ...] = ()
    build: str = ""

    @property
    def label(self) -> str:
        """Name of the system in all tables."""
        return f"{BASELINE}{self.baseline}"

    @property
    def is_deterministic(self) -> bool:
        """True: the seed has no effect."""
        return True

    def facts(self, seed: int) -> dict[str, Any]:
        """Return what determines its runs, besides the code."""
        return {"baseline": self.baseline, "models": self.models, "build": self.build, "seed": seed}

    def model_files(self) -> Mapping[str, Path]:
        """Return its model files."""
        return {name: Path(path) for name, path in self.models}

    def to_json(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        models: dict[str, Value] = dict(self.models)
        return {
            "label": self.label,
            "baseline": self.baseline,
            "parameter_set": "",
            "overrides": models,
            "parameters": {**models, "opencv": self.build},
            "deterministic": True,
        }


System = VariantSystem | BaselineSystem


def seeds_of(system: System, seeds: Sequence[int]) -> Sequence[int]:
    """Return the seeds that `system` runs with: the first alone where the seed has no effect."""
    return seeds[:1] if system.is_deterministic else seeds


SHIFTED, FRAMES, RESTARTS = "shifted_starts", "start_frames", "restarts"
_SHIFT = 0.1
"""Shift of OTB's spatial robustness, in widths and heights of the box."""
_SCALES = (0.8, 0.9, 1.1, 1.2)
_SIDES = {"left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1)}
_CORNERS = {
    "left_up": (-1, -1),
    "right_up": (1, -1),
    "left_down": (-1, 1),
    "right_down": (1, 1),
}
_LAST_START = 0.8
"""Share of a recording in which runs start: a fifth of it at least is left to track."""


@dataclass(frozen=True, slots=True)
class Start:
    """The start of a run.

    Attributes
    ----------
    kind : str
        Kind of robustness run it belongs to; empty for the grid itself.
    name : str
        Name among the starts of its kind.
    stamp_ns : int or None
        Stamp in ns of the true box it starts on; None for the first one.
    shift : tuple of float
        Displacement of the box, in its widths and heights.
    scale : float
        Factor of the box's sides.
    """

    kind: str = ""
    name: str = ""
    stamp_ns: int | None = None
    shift: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0

    def on(self, truths: Sequence[Truth]) -> Truth:
        """Return the truth to start on, its box shifted and scaled.

        Parameters
        ----------
        truths : sequence of Truth
            All truths of the recording, in order.
        """
        truth = next(t for t in truths if self.stamp_ns in {None, t.stamp_ns})
        box = truth.box
        centre = (
            box.centre[0] + self.shift[0] * box.width,
            box.centre[1] + self.shift[1] * box.height,
        )
        around = Box.around(centre, box.width * self.scale, box.height * self.scale)
        return replace(truth, box=around if self.moves else box)

    @property
    def moves(self) -> bool:
        """True if the box differs from the true one."""
        return self.shift != (0.0, 0.0) or self.scale != 1.0


USUAL = Start()
"""The first true box."""


def shifted_starts() -> list[Start]:
    """Return the twelve starts of OTB: eight shifts by a tenth of the box, and four scales."""
    shifts = [
        Start(SHIFTED, name, shift=(_SHIFT * x, _SHIFT * y))
        for name, (x, y) in {**_SIDES, **_CORNERS}.items()
    ]
    return shifts + [Start(SHIFTED, f"scale_{scale:g}", scale=scale) for scale in _SCALES]


def start_frames(truths: Sequence[Truth], count: int) -> list[Start]:
    """Return starts on `count` true boxes, spread evenly over most of a recording.

    The usual start is left out. Where the vehicle is hidden, even in part, the next frame in which
    it is not is taken; so there may be fewer.
    """
    indices: list[int] = []
    for number in range(1, count + 1):
        index = round(number * _LAST_START * (len(truths) - 1) / count)
        clear = (i for i in range(index, len(truths)) if truths[i].occlusion is Occlusion.NONE)
        found = next(clear, None)
        if found and found not in indices:
            indices.append(found)
    return [
        Start(FRAMES, f"start-{number}", truths[index].stamp_ns)
        for number, index in enumerate(indices, start=1)
    ]


BESIDE = "robustness"
"""Folder of the robustness runs, beside the grid's cells."""

_PACKAGE = "vehicle_pf_tracker"
_SHARED = frozenset({f"{_PACKAGE}.recordings.reader"})
_OURS = frozenset({f"{_PACKAGE}.offline.driver"})
_BASELINES = frozenset(f"{_PACKAGE}.evaluation.{name}" for name in ("baselines", "baseline_worker"))
_STARTS = frozenset({f"{_PACKAGE}.evaluation.grid.cells", f"{_PACKAGE}.evaluation.occlusions"})


@dataclass(frozen=True, slots=True)
class GridCell:
    """One run: a system on a recording with a seed, from a start.

    Attributes
    ----------
    source : Source
        The recording.
    system : VariantSystem or BaselineSystem
        The system that tracks the vehicle.
    seed : int
        Seed of the random numbers.
    start : Start
        The start of its run.
    max_diff : float
        Largest difference of stamps that belong together, in s.
    """

    source: Source
    system: System
    seed: int
    max_diff: float
    start: Start = USUAL

    @property
    def label(self) -> str:
        """Name of the cell while it runs."""
        words = (self.source.name, self.system.label, f"seed {self.seed}", self.start.kind)
        return " ".join(word for word in (*words, self.start.name) if word)

    def key(self) -> str:
        """Return its cache key: recording, parameters, seed, start, code and versions."""
        facts = {
            "recording": self.source.digest,
            "topic": self.source.topic,
            "max_diff": self.max_diff,
            "start": asdict(self.start),
            **self.system.facts(self.seed),
        }
        return result_key(facts, self._modules())

    def folder(self, evaluation: Path) -> Path:
        """Return its folder in the folder of the evaluation."""
        names = self.source.name, self.system.label, self.seed
        if not self.start.kind:
            return cell_folder(evaluation, *names)
        below = cell_folder(evaluation / BESIDE / self.start.kind, *names, cells="")
        return below / safe_name(self.start.name) if self.start.name else below

    def _modules(self) -> frozenset[str]:
        modules = _SHARED | (_STARTS if self.start.kind else frozenset())
        if isinstance(self.system, VariantSystem):
            return modules | _OURS | variant_modules(find_variant(self.system.variant))
        return modules | _BASELINES
