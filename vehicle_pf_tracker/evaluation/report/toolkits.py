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

"""Runs as files that the toolkits of OTB, VOT and MOTChallenge read.

They are written to `results/` of the evaluation. Coordinates are those of the recording's truth:
nothing is shifted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import astuple
from pathlib import Path

from vehicle_pf_tracker.core.box import Box
from vehicle_pf_tracker.evaluation.evaluation_folder import safe_name
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, ScoredRun
from vehicle_pf_tracker.offline.output_files import make_folder, write_text
from vehicle_pf_tracker.trackers.estimate import Mode


def write_toolkits(evaluation: ScoredEvaluation, toolkits: Sequence[str]) -> list[Path]:
    """Write every run from the true box in the formats `toolkits`, and return the files.

    Raises
    ------
    InputError
        If one cannot be written.
    """
    written = []
    for run in evaluation.runs:
        system, name = safe_name(run.system), run.recording
        files = {
            "otb": (f"{system}/{name}_{run.seed}.txt", _otb),
            "vot": (f"{system}/unsupervised/{name}/{name}_{run.seed + 1:03d}.txt", _vot),
            "mot": (f"{system}_seed-{run.seed}/data/{name}.txt", _mot),
        }
        for toolkit in toolkits:
            place, lines = files[toolkit]
            path = evaluation.folder.path / "results" / toolkit / place
            make_folder(path.parent)
            write_text(path, "".join(f"{line}\n" for line in lines(run)))
            written.append(path)
    return written


def _otb(run: ScoredRun) -> Iterator[str]:
    """Give the scored box of each frame; NaN before the start."""
    return ("nan,nan,nan,nan" if box is None else _numbers(box) for box in run.boxes)


def _vot(run: ScoredRun) -> Iterator[str]:
    """Give the scored box of each frame, with VOT's 0 (unknown) before and 1 in the first one."""
    started = False
    for box in run.boxes:
        yield "0" if box is None else _numbers(box) if started else "1"
        started = started or box is not None


def _mot(run: ScoredRun) -> Iterator[str]:
    """Give the boxes that the system reports, as the track 1; none where it is lost."""
    for row in run.rows:
        if row.box is not None and row.mode != Mode.LOST.value:
            confidence = 1.0 if row.confidence is None else row.confidence
            yield f"{row.frame},1,{_numbers(row.box)},{confidence:.4f},-1,-1,-1"


def _numbers(box: Box) -> str:
    return ",".join(f"{value:.3f}" for value in astuple(box))
