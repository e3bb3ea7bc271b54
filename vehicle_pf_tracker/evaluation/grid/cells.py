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

"""Cells of the grid, and their starts: on the first true box, or elsewhere to test robustness.

Shifted starts and other first frames are those of the OTB benchmark (Wu, Lim and Yang 2013, "Online
object tracking: a benchmark", spatial and temporal robustness evaluation); failures and re-starts
are those of VOT, see `evaluation.failures`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source, cell_folder, safe_name
from vehicle_pf_tracker.evaluation.grid.systems import System, VariantSystem
from vehicle_pf_tracker.evaluation.identity import result_key, variant_modules
from vehicle_pf_tracker.trackers.registry import find_variant

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
_OURS = frozenset({f"{_PACKAGE}.evaluation.offline"})
_BASELINES = frozenset(f"{_PACKAGE}.evaluation.baselines.{name}" for name in ("client", "worker"))
_STARTS = frozenset({f"{_PACKAGE}.evaluation.grid.cells", f"{_PACKAGE}.evaluation.failures"})


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
