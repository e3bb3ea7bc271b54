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

"""A recording as a video, with the true box and those of the first systems."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import cv2
import numpy as np

from vehicle_pf_tracker.core.errors import InputError
from vehicle_pf_tracker.core.frame import Frame
from vehicle_pf_tracker.core.truth import Truth
from vehicle_pf_tracker.evaluation.evaluation_folder import Source
from vehicle_pf_tracker.evaluation.report.filmstrip import (
    Crop,
    Mark,
    colour_of,
    draw_overlay,
    numbered_frames,
)
from vehicle_pf_tracker.evaluation.report.scored_runs import ScoredEvaluation, ScoredRun, typical
from vehicle_pf_tracker.offline.output_files import make_folder
from vehicle_pf_tracker.offline.pictures import NO_ENCODER, has_encoder, video_writer

FOLDER = "videos"
WIDTH = 640
"""Width of a video in px; its height is even, as codecs want it."""
_LINE = 22
_DEFAULT_RATE = 25.0


def write_videos(
    evaluation: ScoredEvaluation,
    slots: Mapping[str, int],
    notify: Callable[[str], object],
    on_stage: Callable[[str], object] = lambda _: None,
) -> list[Path]:
    """Write a video of each recording, and return the files.

    Parameters
    ----------
    evaluation : ScoredEvaluation
        The evaluation; of each system the run with the median error is shown.
    slots : mapping of str to int
        Systems to show, with the numbers of their styles.
    notify : callable
        Called with a sentence for each video that could not be made.
    on_stage : callable
        Called with a few words before each video.
    """
    if not has_encoder():
        notify(NO_ENCODER)
    written = []
    for entry in evaluation.recordings:
        on_stage(f"the video of {entry.name}")
        path = evaluation.folder.path / FOLDER / f"{entry.name}.mp4"
        runs = {label: run for label in slots if (run := typical(evaluation.of(entry.name, label)))}
        try:
            make_folder(path.parent)
            _write(path, entry, evaluation.truths[entry.name], runs, slots)
            written.append(path)
        except InputError as error:
            notify(f"there is no video of {entry.name}: {error}")
    return written


def _write(
    path: Path,
    entry: Source,
    truths: Mapping[int, Truth],
    runs: Mapping[str, ScoredRun],
    slots: Mapping[str, int],
) -> None:
    height = round(WIDTH * entry.height / entry.width / 2) * 2
    size = (WIDTH, height + 2 * _LINE)
    with video_writer(path, size, frame_rate(truths)) as writer:
        for number, frame in numbered_frames(entry):
            image = _draw(frame, number, truths.get(number), runs, slots)
            resized = cv2.resize(image, (WIDTH, height))
            shown: Frame = np.vstack([resized, _legend(number, runs, slots)])
            writer.write(shown)


def frame_rate(truths: Mapping[int, Truth]) -> float:
    """Return the rate in Hz by the median interval of the truth's stamps."""
    frames = sorted(truths)
    stamps = np.array([truths[n].stamp_ns for n in frames], dtype=np.int64)
    intervals = np.diff(stamps) / np.diff(frames) if len(frames) > 1 else np.array([])
    usual = float(np.median(intervals)) if len(intervals) else 0.0
    return 1e9 / usual if usual > 0 else _DEFAULT_RATE


def _draw(
    frame: Frame,
    number: int,
    truth: Truth | None,
    runs: Mapping[str, ScoredRun],
    slots: Mapping[str, int],
) -> Frame:
    marks = [
        Mark(box, slots[label])
        for label, run in runs.items()
        if number <= len(run.boxes) and (box := run.boxes[number - 1]) is not None
    ]
    return draw_overlay(frame, Crop.whole(frame, WIDTH), truth.box if truth else None, marks)


def _legend(number: int, runs: Mapping[str, ScoredRun], slots: Mapping[str, int]) -> Frame:
    """Draw the number of the frame, and the systems' names with their modes, in two lines."""
    image: Frame = np.full((2 * _LINE, WIDTH, 3), 24, np.uint8)
    font, white = cv2.FONT_HERSHEY_SIMPLEX, (255, 255, 255)
    cv2.putText(image, f"frame {number}", (6, 16), font, 0.5, white, 1, cv2.LINE_AA)
    step = (WIDTH - 120) // 3
    for index, (label, run) in enumerate(runs.items()):
        x, y = 120 + index % 3 * step, 16 + index // 3 * _LINE
        cv2.rectangle(image, (x, y - 10), (x + 12, y + 2), colour_of(slots[label]), -1)
        mode = run.modes[number - 1] if number <= len(run.modes) else ""
        text = f"{slots[label] + 1} {label} {mode.lower()}"
        cv2.putText(image, text, (x + 18, y), font, 0.5, white, 1, cv2.LINE_AA)
    return image
