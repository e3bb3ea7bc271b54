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

"""Systems of the third paper: both filters, their schemes and interpretations, one scene."""

from __future__ import annotations

from collections.abc import Mapping
from statistics import fmean
from types import MappingProxyType
from typing import Any

from reproduction.cells import PATH, RunCell, SceneChoice, System, scores
from reproduction.experiment import DataTable, Entry, Results, Size
from vehicle_pf_tracker.core.truth import Occlusion, Truth
from vehicle_pf_tracker.evaluation.scores import Scores
from vehicle_pf_tracker.filtering.resampling import SCHEMES

SCENE = SceneChoice.of("phases")
CONVENTIONAL, ADAPTIVE = (
    System.of("conventional", "conventional"),
    System.of("adaptive", "adaptive"),
)
BOTH = (CONVENTIONAL, ADAPTIVE)
OURS, PRINTED = "our interpretation", "as printed"
STRICTER = "as printed, low weight below half the mean"
BY_SIMILARITY = "occlusion parts by similarity"
PHASES = "before", "partial", "full", "after"
"""Frames of the vehicle's way past the occluders."""
_DEFAULT_SCHEME = "multinomial"
_RECORD = (*PATH, "regime", "n_eff", "resampling_passes", "resampled_particles")


def _pair(settings: Mapping[str, Any]) -> tuple[System, System]:
    conventional, adaptive = (
        System.of(f"{system.label}, {' '.join(map(str, settings.values()))}", system.variant,
                  settings)
        for system in BOTH
    )  # fmt: skip
    return conventional, adaptive


_PRINTED = System.of("conventional as printed", "conventional", {"as_printed": True})
INTERPRETATIONS: Mapping[str, tuple[System, System]] = MappingProxyType(
    {
        OURS: BOTH,
        PRINTED: (
            _PRINTED,
            System.of("adaptive as printed", "adaptive", {"as_printed": True}),
        ),
        STRICTER: (
            _PRINTED,
            System.of("adaptive, low is half", "adaptive", {"as_printed": True, "low_weight": 0.5}),
        ),
        BY_SIMILARITY: (
            CONVENTIONAL,
            System.of("adaptive by similarity", "adaptive", {"occlusion.test": "similarity"}),
        ),
        **{
            scheme: _pair({"resampling": scheme}) for scheme in SCHEMES if scheme != _DEFAULT_SCHEME
        },
    }
)
"""Conventional and adaptive under every interpretation, and with every other scheme."""
SETTING = (
    "The scene `phases` is our counterpart of the paper's video: a car passes a parked van that "
    "hides its lower half and a parked coach that hides all of it; 15 frames per second. Each seed "
    "renders a new scene and seeds the filters. Both filters have the same criterion (0.7 of 200 "
    "particles; as printed all of them, which no filter can reach), sigma, random walk and seeds, "
    "and at most 20 passes a frame, as in the paper. The paper does not say which "
    "weights are low: those below the mean one, but where half of it is named. The scheme is "
    'multinomial but where another is named. "Before" is until something hides the vehicle for '
    'the first time, "full" is while less than a tenth of it is seen, "after" follows the last '
    'such frame, "partial" is what remains.'
)


def cell(system: System, seed: int) -> RunCell:
    """Make the cell of a filter."""
    return RunCell(SCENE.seeded(seed), system, seed, _RECORD)


def cells(size: Size) -> list[RunCell]:
    """Run both filters under every interpretation and scheme, with every seed."""
    systems = dict.fromkeys(system for pair in INTERPRETATIONS.values() for system in pair)
    return [cell(system, seed) for system in systems for seed in size.seeds]


def run_scores(results: Results, system: System, seed: int) -> Scores:
    """Hold one run against the truth again."""
    return scores(cell(system, seed), results[cell(system, seed)])


def trace(results: Results, system: System, seed: int) -> Mapping[str, list[Any]]:
    """Give what was recorded of one run."""
    recorded: Mapping[str, list[Any]] = results[cell(system, seed)]["trace"]
    return recorded


def phases(scored: Scores) -> dict[str, list[int]]:
    """Return the indices of the frames of each phase."""
    truths = [frame.truth for frame in scored.frames]
    first = next(i for i, truth in enumerate(truths) if truth is not None and truth.occlusion)
    hidden = [i for i, truth in enumerate(truths) if _is_hidden(truth)]
    last = hidden[-1]
    return {
        "before": list(range(1, first)),
        "partial": [i for i in range(first, last) if i not in set(hidden)],
        "full": hidden,
        "after": list(range(last + 1, len(truths))),
    }


def _is_hidden(truth: Truth | None) -> bool:
    return truth is not None and truth.occlusion is Occlusion.TOTAL


def resampled(results: Results, system: System, seed: int) -> int:
    """Count the particles that a whole run has drawn and weighed anew."""
    return sum(trace(results, system, seed)["resampled_particles"])


def rms(scored: Scores, chosen: list[int]) -> float:
    """Return the root of the mean squared error over the frames of these indices."""
    errors = [scored.frames[index].error for index in chosen]
    return float(fmean(error**2 for error in errors if error is not None) ** 0.5)


def data(results: Results, size: Size) -> DataTable:
    """Put every frame of every run into a row."""
    rows: list[tuple[Entry, ...]] = []
    for interpretation, pair in INTERPRETATIONS.items():
        for system in pair:
            for seed in size.seeds:
                scored = run_scores(results, system, seed)
                phase_of = {i: name for name, of in phases(scored).items() for i in of}
                found = trace(results, system, seed)
                rows += [
                    (interpretation, system.variant, seed, index + 1, phase_of.get(index),
                     frame.error,
                     found["n_eff"][index], found["resampling_passes"][index],
                     found["resampled_particles"][index], found["regime"][index])
                    for index, frame in enumerate(scored.frames)
                ]  # fmt: skip
    columns = ("interpretation", "filter", "seed", "frame", "phase", "error_px", "n_eff", "passes",
               "resampled_particles", "regime")  # fmt: skip
    return DataTable(columns, tuple(rows))
